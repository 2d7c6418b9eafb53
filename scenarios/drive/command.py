"""The command that lets one drive the robot."""

from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from surefoot.scenarios.drive.page import opened
from surefoot.scenarios.drive.session import Input, Session
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.loop.interrupts import held_back
from surefoot.scenarios.loop.run import made_folder, unmade
from surefoot.scenarios.record.provenance import LOG_NAME, run_folders
from surefoot.scenarios.simulation import Simulation


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

    def begin() -> Any:
        log = own_folder(out, scenario) / LOG_NAME
        simulation = Simulation(scenario, log=log)
        say(str(log))
        return simulation

    inputs: SimpleQueue[Input] = SimpleQueue()
    with held_back() as interrupts, opened(port, inputs) as page:
        session = Session(begin, page, inputs)
        try:
            say(f"{page.address} drives {scenario.name}; Ctrl-C ends it")
            session.run(lambda: interrupts.count > 0)
        finally:
            session.close()


def own_folder(out: Path, scenario: Scenario) -> Path:
    """A folder that no other run has.

    Raises:
        LogError: it cannot be made.
    """
    made_folder(out)
    for folder in run_folders(out, scenario.name, scenario.seed):
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        except OSError as error:
            raise unmade(folder, error) from None
        return folder
    raise AssertionError
