"""A walk on a plant in another process: run, logged and judged as any other."""

from pathlib import Path

from surefoot.apps.bridge.remote import Remote
from surefoot.errors import ParameterError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.run import Result, closed_loop, run_scenario
from surefoot.scenarios.run.skeleton import End, OnProgress, run_loop
from surefoot.scenarios.setup.walk import Walk


def walk_on(remote: Remote, scenario: Scenario, out: Path, on_progress: OnProgress | None = None) -> Result:
    """Walk.

    Args:
        remote: the plant.
        scenario: what is walked; of the plant's world it knows no more than it believes.
        out: directory that gets the run's own folder.
        on_progress: called with the progress of the run.

    Raises:
        LinkError: the plant is another robot's.
        ScenarioError: the scenario cannot be run.
        SetupError: a part of it is refused.
        LogError: the log cannot be written.
    """

    def simulate(walk: Walk, writer: LogWriter, on_progress: OnProgress) -> End:
        if walk.keys.plant is not None:
            raise ParameterError(
                ("plant",), "a scenario with a plant of its own on a plant that is served", "leave it out"
            )
        end = run_loop(closed_loop(walk, writer, Parts(plant=lambda walk: remote.plant(walk, writer))), on_progress)
        remote.close("the walk is over")  # before the log is judged: a plant by the wall clock waits for nobody
        return end

    return run_scenario(scenario, out, on_progress, simulate)
