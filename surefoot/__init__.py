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

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from surefoot.errors import ParameterError as ParameterError
    from surefoot.plugins import PluginError as PluginError
    from surefoot.scenarios.errors import LogError as LogError
    from surefoot.scenarios.errors import ScenarioError as ScenarioError
    from surefoot.scenarios.errors import SetupError as SetupError
    from surefoot.scenarios.file.schema import Scenario as Scenario
    from surefoot.scenarios.judge.verdict import Verdict as Verdict
    from surefoot.scenarios.judge.verdict import judge as judge
    from surefoot.scenarios.log.reader import Log as Log
    from surefoot.scenarios.log.reader import read as read
    from surefoot.scenarios.loop.faults import RunFault as RunFault
    from surefoot.scenarios.loop.full import Parts as Parts
    from surefoot.scenarios.loop.run import Result as Result
    from surefoot.scenarios.loop.run import run as run
    from surefoot.scenarios.setup.load import load as load
    from surefoot.scenarios.simulation import Simulation as Simulation
    from surefoot.scenarios.simulation import Tick as Tick

__version__: str

_HOMES = {
    "LogError": ("scenarios.errors", "LogError"),
    "Log": ("scenarios.log.reader", "Log"),
    "ParameterError": ("errors", "ParameterError"),
    "Parts": ("scenarios.loop.full", "Parts"),
    "PluginError": ("plugins", "PluginError"),
    "Result": ("scenarios.loop.run", "Result"),
    "RunFault": ("scenarios.loop.faults", "RunFault"),
    "Scenario": ("scenarios.file.schema", "Scenario"),
    "ScenarioError": ("scenarios.errors", "ScenarioError"),
    "SetupError": ("scenarios.errors", "SetupError"),
    "Simulation": ("scenarios.simulation", "Simulation"),
    "Tick": ("scenarios.simulation", "Tick"),
    "Verdict": ("scenarios.judge.verdict", "Verdict"),
    "judge": ("scenarios.judge.verdict", "judge"),
    "load": ("scenarios.setup.load", "load"),
    "read": ("scenarios.log.reader", "read"),
    "run": ("scenarios.loop.run", "run"),
}
"""Module, below this package, and name there of everything on the face."""

__all__ = [
    "Log",
    "LogError",
    "ParameterError",
    "Parts",
    "PluginError",
    "Result",
    "RunFault",
    "Scenario",
    "ScenarioError",
    "SetupError",
    "Simulation",
    "Tick",
    "Verdict",
    "__version__",
    "judge",
    "load",
    "read",
    "run",
]


if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there

    def __getattr__(name: str) -> Any:
        """Import a name of the face when it is first asked for."""
        if name == "__version__":
            return _version()
        if name not in _HOMES:
            raise AttributeError(f"module 'surefoot' has no attribute '{name}'")
        module, inner = _HOMES[name]
        return getattr(import_module(f"surefoot.{module}"), inner)


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("surefoot")
    except PackageNotFoundError:  # a source tree on the path that was never installed
        return "0+unknown"


def __dir__() -> list[str]:
    """The face, for completion."""
    return sorted({*globals(), *__all__})
