"""``surefoot serve`` and ``surefoot walk``: a simulated robot and its controller in processes of their own."""

import json
import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.lazy import importing
from surefoot.scenarios.errors import ScenarioError, SetupError
from surefoot.scenarios.show.options import (
    INTERRUPTED,
    MISSED,
    AsJson,
    SeatOf,
    Seed,
    Settings,
    overrides,
    scenarios_from,
    with_options,
)

if TYPE_CHECKING:
    from surefoot.scenarios.log import Log
    from surefoot.scenarios.run.run import Result

DEFAULT_SCENARIO = "walk"

SOFT_START = 0.3
"""Time in which joints go over from being held to their commands, in real time [s]."""

_Scenario = typer.Argument(help="Catalogue name, scenario file or log.", autocompletion=scenarios_from)


@dataclass(frozen=True, slots=True)
class ServeOptions:
    """The arguments of `surefoot serve`."""

    scenario: Annotated[str | None, _Scenario] = None
    robot: Annotated[str | None, typer.Option(help="Robot, for which the scenario is scaled.")] = None
    set_: Settings = None
    seed: Seed = None
    port: Annotated[int, typer.Option(min=0, max=65535, help="That is listened at; 0: any free one.")] = 7447
    bind: Annotated[
        str, typer.Option(metavar="HOST", help="Address of this machine; all but the default lets others in.")
    ] = "127.0.0.1"
    real_time: Annotated[
        bool, typer.Option("--real-time", help="Go by the wall clock and wait for nobody; else in lockstep.")
    ] = False
    delay: Annotated[float, typer.Option(help="By which every command comes later [s].")] = 0.0
    jitter: Annotated[float, typer.Option(help="Most of what is added to that, by chance [s].")] = 0.0
    drop: Annotated[float, typer.Option(help="Share of states, and of commands, that get lost.")] = 0.0
    pause: Annotated[float, typer.Option(help="How long the controller hears nothing, once a second [s].")] = 0.0
    watchdog: Annotated[float, typer.Option(help="Without a new command for so long joints are damped [s].")] = 0.1
    soft_start: Annotated[
        float | None,
        typer.Option(help="Of joints that were held [s]; by default 0.3 in real time, else 0."),
    ] = None


@with_options(ServeOptions)
def serve(options: ServeOptions) -> None:
    """Serve the simulated robot to a controller in another process."""
    with importing():
        from surefoot.apps.bridge.host import Care, Host
        from surefoot.apps.bridge.limits import TORQUE_RATE
        from surefoot.apps.bridge.line import Disturbance
        from surefoot.apps.bridge.serve import Server
        from surefoot.scenarios.run.interrupts import held_back
        from surefoot.scenarios.run.run import one_thread
        from surefoot.scenarios.run.skeleton import refusing
        from surefoot.scenarios.setup.load import load, locate
        from surefoot.scenarios.setup.walk import resolve

    reference = options.scenario or DEFAULT_SCENARIO
    asked = overrides(options.set_, options.seed)
    if options.robot is not None:
        written = load(reference)
        asked = [f"sized_for={written.sized_for or written.robot}", f"robot={options.robot}", *asked]
    loaded = load(reference, asked)
    try:
        with refusing():
            found = resolve(loaded)
            disturbance = Disturbance(options.delay, options.jitter, options.drop, options.pause, found.seed)
            apart = options.real_time or not disturbance.none
            soft = (SOFT_START if options.real_time else 0.0) if options.soft_start is None else options.soft_start
            care = Care(disturbance, options.watchdog, soft, TORQUE_RATE if apart else math.inf)
            server = Server(Host(found, care), options.bind, options.port, _say, options.real_time)
    except SetupError as refusal:
        raise locate(reference, asked, refusal) from None
    typer.echo(
        f"{server.address} serves {loaded.name} on {loaded.robot}; walk it with: surefoot walk --on {server.address}"
    )
    with held_back() as interrupts, one_thread():
        served = server.run(lambda: interrupts.count > 0)
    _say(f"ended at {served.time:.3f} s, {served.said}")
    if served.late:
        _say(f"too slow for real time: the plant's clock was put back by {served.late:.3f} s in all")
    if interrupts.count:
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if served.in_order else MISSED)


def _say(sentence: str) -> None:
    typer.echo(sentence, err=True)


@dataclass(frozen=True, slots=True)
class WalkOptions:
    """The arguments of `surefoot walk`."""

    scenario: Annotated[str | None, _Scenario] = None
    on: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of the plant, as surefoot serve says it.")] = None
    shadow: Annotated[Path | None, typer.Option(metavar="LOG", help="Hear what this log holds, and move nothing.")] = (
        None
    )
    against: Annotated[
        Path | None,
        typer.Option(metavar="BASELINE", help="With --shadow: hold the outputs against those in this log."),
    ] = None
    tolerance: Annotated[
        float | None, typer.Option(help="Of values that agree: relative, and absolute below 1; 1e-6 by default.")
    ] = None
    update: Annotated[bool, typer.Option("--update", help="Make the new log the baseline.")] = False
    policy: SeatOf = None
    set_: Settings = None
    seed: Seed = None
    out: Annotated[Path, typer.Option(help="Directory that gets the run's own folder.")] = Path("runs")
    as_json: AsJson = False


@with_options(WalkOptions)
def walk(options: WalkOptions) -> None:
    """Walk a robot that another process serves, or a log's shadow."""
    _refuse_odd(options)
    if options.on is not None and options.shadow is None:
        walked = partial(_on, options.on)
    elif options.shadow is not None and options.on is None:
        walked = partial(_in_shadow, options.shadow)
    else:
        raise typer.BadParameter("give one of --on ADDRESS and --shadow LOG")
    before = None if options.against is None else _baseline(options)
    with importing():
        from surefoot.scenarios.setup.load import locate
        from surefoot.scenarios.show.console import print_result

    asked = overrides(options.set_, options.seed, options.policy)
    reference = options.scenario or (None if options.shadow is None else str(options.shadow))
    try:
        name, result = walked(options, asked)
    except SetupError as refusal:
        if reference is None:
            raise ScenarioError([str(refusal)]) from None
        raise locate(reference, asked, refusal) from None
    if options.against is not None and not result.interrupted:
        raise typer.Exit(_hold(options, options.against, before, result.log))
    if options.as_json:
        typer.echo(json.dumps({**result.verdict.to_json(), "log": str(result.log)}, allow_nan=False))
    else:
        print_result(name, result.verdict, result.log)
    if result.interrupted:
        typer.echo(f"interrupted; the log up to here is whole: {result.log}", err=True)
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if result.verdict.passed else MISSED)


def _refuse_odd(options: WalkOptions) -> None:
    """Refuse options of a baseline without one, or without a shadow."""
    baseline, shadow = options.against, options.shadow
    if baseline is None and (options.update or options.tolerance is not None):
        raise typer.BadParameter("--update and --tolerance are of a baseline; give it by --against BASELINE")
    if baseline is not None and shadow is None:
        raise typer.BadParameter("--against BASELINE is of a shadow; give --shadow LOG with it")
    if options.update and baseline is not None and shadow is not None and baseline.resolve() == shadow.resolve():
        raise typer.BadParameter("--update would replace the log that is heard; give a baseline of its own")


def _baseline(options: WalkOptions) -> "Log | None":
    """The log of the baseline, looked at before anything is walked."""
    from surefoot.apps.bridge.against import known

    assert options.against is not None
    return known(options.against, options.update)


def _hold(options: WalkOptions, baseline: Path, before: "Log | None", log: Path) -> int:
    """Hold a log against its baseline, say it, and make it the baseline where that is asked; gives the exit code."""
    from surefoot.apps.bridge.against import held, update
    from surefoot.scenarios.show.compare import TOLERANCE

    found = None if before is None else held(before, log, TOLERANCE if options.tolerance is None else options.tolerance)
    if options.as_json:
        typer.echo(json.dumps({"log": str(log), "agrees": None} if found is None else found.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(() if found is None else found.lines()) or f"no baseline at {baseline} yet")
        typer.echo(f"log: {log}")
    if not options.update:
        return 0 if found is not None and found.agrees else MISSED
    if found is None or not found.agrees:
        update(baseline, log)
        typer.echo(f"written: {baseline}", err=options.as_json)
    return 0


def _on(address: str, options: WalkOptions, asked: list[str]) -> "tuple[str, Result]":
    """Walk on the plant at an address: the user's scenario, else that of the plant."""
    from surefoot.apps.bridge.remote import Remote
    from surefoot.apps.bridge.walk import walk_on
    from surefoot.scenarios.setup.load import load, read_scenario
    from surefoot.scenarios.show.console import ProgressLine

    loaded = None if options.scenario is None else load(options.scenario, asked)
    hello = {} if loaded is None else {"robot": loaded.robot, "rate": loaded.rates.control}
    remote = Remote(address, hello)
    ended = "refused"
    try:
        said = remote.welcome
        scenario = loaded or read_scenario(said.scenario, f"scenario served as {said.name}", said.name, asked)
        progress = ProgressLine(scenario.name)
        with progress:
            result = walk_on(remote, scenario, options.out, progress)
        ended = "interrupted"  # else the plant has got the message that the walk is over
    finally:
        remote.close(ended)
    return scenario.name, result


def _in_shadow(log: Path, options: WalkOptions, asked: list[str]) -> "tuple[str, Result]":
    """Walk in the shadow of a log: the user's scenario, else that of the log."""
    from surefoot.apps.bridge.shadow import walk_in_shadow
    from surefoot.scenarios.setup.load import load
    from surefoot.scenarios.show.console import ProgressLine

    scenario = load(options.scenario or str(log), asked)
    progress = ProgressLine(scenario.name)
    with progress:
        result = walk_in_shadow(log, scenario, options.out, progress)
    return scenario.name, result
