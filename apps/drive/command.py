"""``surefoot drive``: the robot live in a browser, until a signal ends it."""

import math
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.show.options import INTERRUPTED, SeatOf, Seed, Settings, overrides, scenarios_from

if TYPE_CHECKING:
    from surefoot.scenarios.file.schema import Scenario
    from surefoot.scenarios.run.simulation import Simulation

OWN = Path(__file__).with_name("drive.yaml")
"""The scenario that is driven if no other one is."""

LONGEST = "duration=3600"
"""Setting of a drive's runs, which nothing but a fall or their driver shall end."""


def drive(
    scenario: Annotated[
        str | None,
        typer.Argument(help="Catalogue name, scenario file or log; stands by default.", autocompletion=scenarios_from),
    ] = None,
    policy: SeatOf = None,
    set_: Settings = None,
    seed: Seed = None,
    out: Annotated[Path, typer.Option(help="Directory that gets a folder for each run.")] = Path("runs"),
    port: Annotated[
        int | None, typer.Option(min=1, max=65534, help="Of the page; the first free one from 8080 on by default.")
    ] = None,
) -> None:
    """Drive the robot in a browser: walk it, push it, until Ctrl-C."""
    from surefoot.scenarios.errors import SetupError, require
    from surefoot.scenarios.setup.load import load, locate

    require("viser", "replay", "surefoot drive")
    reference = scenario or str(OWN)
    asked = [LONGEST, *overrides(set_, seed, policy)]
    loaded = load(reference, asked)
    try:
        drive_scenario(loaded, out, port, typer.echo)
    except SetupError as refusal:
        raise locate(reference, asked, refusal) from None
    typer.echo("ended; the logs are whole", err=True)
    raise typer.Exit(INTERRUPTED)


def drive_scenario(scenario: "Scenario", out: Path, port: int | None, say: Callable[[str], None]) -> None:
    """Drive a scenario's robot until a signal ends it; ``say`` gets the places of page and logs, and their size.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: it is a pendulum; a log cannot be written; the port is taken.
        SetupError: a part refuses the scenario.
    """
    from surefoot.apps.drive.page import opened
    from surefoot.apps.drive.session import Inputs, Session
    from surefoot.scenarios.record.provenance import LOG_NAME
    from surefoot.scenarios.run.interrupts import held_back
    from surefoot.scenarios.run.run import own_folder
    from surefoot.scenarios.run.simulation import Simulation

    if scenario.fidelity == "pendulum":
        raise LogError("a pendulum has no body to show or to push; drive with fidelity full")

    def begin() -> "Simulation":
        folder = own_folder(out, scenario.name, scenario.seed)
        try:
            simulation = Simulation(scenario, log=folder / LOG_NAME)
        except BaseException:
            with suppress(OSError):
                folder.rmdir()
            raise
        say(f"log: {folder / LOG_NAME}, {log_size(simulation, folder / LOG_NAME)}")
        return simulation

    inputs = Inputs()
    with held_back() as interrupts, opened(port, inputs) as page:
        say(f"{page.address} drives {scenario.name} once it is open; Ctrl-C ends it")
        session = Session(begin, page, inputs)
        try:
            session.run(lambda: interrupts.count > 0)
        finally:
            session.close()


MOST_KEPT = 3
"""A flight recorder takes at most so many times what it is to keep, in its log and the one that takes its place."""

MOST_BEGINNINGS = 4
"""And so many times what a log begins with: twice the records beside the messages, and pictures of the scene."""


def log_size(simulation: "Simulation", path: Path) -> str:
    """Growth of the log of a simulation that has just begun; the simulation goes on until that is known."""
    from surefoot.scenarios.run.planning import RunFault

    with suppress(RunFault):  # its end says why
        while simulation.log_growth is None and not simulation.done:
            simulation.advance()
    growth, keep = simulation.log_growth or 0.0, simulation.walk.log.keep
    if keep is None:
        return f"{3600e-9 * growth:.1f} GB an hour while it walks; --set log.keep=60s keeps the last minute"
    most = MOST_KEPT * keep * growth + MOST_BEGINNINGS * path.stat().st_size
    return f"of which the last {keep:g} s are kept; it takes at most {math.ceil(1e-6 * most)} MB"
