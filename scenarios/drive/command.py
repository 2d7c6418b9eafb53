"""The command that lets one drive the robot."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue

from surefoot.scenarios.drive.page import opened
from surefoot.scenarios.drive.session import Input, Session
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.loop.interrupts import held_back
from surefoot.scenarios.loop.run import own_folder
from surefoot.scenarios.record.provenance import LOG_NAME
from surefoot.scenarios.simulation import Simulation

OWN = Path(__file__).with_name("drive.yaml")
"""The scenario that is driven if no other one is."""

LONGEST = "duration=3600"
"""Setting of a drive's runs, which nothing but a fall or their driver shall end."""


def drive(scenario: Scenario, out: Path, port: int | None, say: Callable[[str], None]) -> None:
    """Drive a scenario's robot until a signal ends it.

    Args:
        scenario: of every run.
        out: directory that gets a folder for each run.
        port: of the page; the first free one if None.
        say: is told where the page is, and where each run's log.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: it is a pendulum; a log cannot be written; the port is taken.
        SetupError: a part refuses the scenario.
    """
    if scenario.fidelity == "pendulum":
        raise LogError("a pendulum has no body to show or to push; drive with fidelity full")

    def begin() -> Simulation:
        folder = own_folder(out, scenario.name, scenario.seed)
        try:
            simulation = Simulation(scenario, log=folder / LOG_NAME)
        except BaseException:
            with suppress(OSError):
                folder.rmdir()
            raise
        say(f"log: {folder / LOG_NAME}")
        return simulation

    inputs: SimpleQueue[Input] = SimpleQueue()
    with held_back() as interrupts, opened(port, inputs) as page:
        say(f"{page.address} drives {scenario.name}; Ctrl-C ends it")
        session = Session(begin, page, inputs)
        try:
            session.run(lambda: interrupts.count > 0)
        finally:
            session.close()
