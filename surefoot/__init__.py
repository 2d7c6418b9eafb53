"""Surefoot: a humanoid walking stack in full physics.

    import surefoot

    scenario = surefoot.load("walk", {"gait.steps": 12})
    result = surefoot.run(scenario, seed=3)
    log = surefoot.read(result.log)

    sim = surefoot.Simulation(scenario)
    tick = sim.step()

Names are imported when they are first asked for, so that ``import surefoot`` costs nothing. The layers are there to be
used alone: `surefoot.planner`, `surefoot.wbc`, `surefoot.sim`, `surefoot.models`.
"""

from typing import TYPE_CHECKING

from surefoot.lazy import face
from surefoot.native import modules

if TYPE_CHECKING:
    from surefoot.errors import ParameterError, PartError, PluginError
    from surefoot.joints import JointCommand, Servo
    from surefoot.planner.steps.commands import Command
    from surefoot.planner.types import Twist
    from surefoot.readings import Reading, Readings
    from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
    from surefoot.scenarios.file.schema import Scenario
    from surefoot.scenarios.judge.verdict import Verdict, judge
    from surefoot.scenarios.log.reader import Log, read
    from surefoot.scenarios.run.assembly import Parts
    from surefoot.scenarios.run.controller import Controller
    from surefoot.scenarios.run.planning import RunFault
    from surefoot.scenarios.run.plant import Plant
    from surefoot.scenarios.run.run import Result, run
    from surefoot.scenarios.run.saved import State
    from surefoot.scenarios.run.simulation import Simulation, Tick
    from surefoot.scenarios.setup.load import load
    from surefoot.scenarios.setup.walk import Walk
    from surefoot.sim.measurement import Measurement
    from surefoot.version import __version__

__all__ = [
    "Command",
    "Controller",
    "JointCommand",
    "Log",
    "LogError",
    "Measurement",
    "ParameterError",
    "PartError",
    "Parts",
    "Plant",
    "PluginError",
    "Reading",
    "Readings",
    "Result",
    "RunFault",
    "Scenario",
    "ScenarioError",
    "Servo",
    "SetupError",
    "Simulation",
    "State",
    "Tick",
    "Twist",
    "Verdict",
    "Walk",
    "__version__",
    "judge",
    "load",
    "read",
    "run",
]

# A law that was edited in a checkout is compiled before anything is imported that it is a part of.
modules.refresh()

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            "errors": ("ParameterError", "PartError", "PluginError"),
            "joints": ("JointCommand", "Servo"),
            "planner.steps.commands": ("Command",),
            "planner.types": ("Twist",),
            "readings": ("Reading", "Readings"),
            "sim.measurement": ("Measurement",),
            "scenarios.errors": ("LogError", "ScenarioError", "SetupError"),
            "scenarios.file.schema": ("Scenario",),
            "scenarios.judge.verdict": ("Verdict", "judge"),
            "scenarios.log.reader": ("Log", "read"),
            "scenarios.run.planning": ("RunFault",),
            "scenarios.run.plant": ("Plant",),
            "scenarios.run.assembly": ("Parts",),
            "scenarios.run.controller": ("Controller",),
            "scenarios.run.run": ("Result", "run"),
            "scenarios.setup.load": ("load",),
            "scenarios.setup.walk": ("Walk",),
            "scenarios.run.saved": ("State",),
            "scenarios.run.simulation": ("Simulation", "Tick"),
            "version": ("__version__",),
        },
    )
