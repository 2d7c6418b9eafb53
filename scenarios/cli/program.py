"""The program ``surefoot``: the commands of the core, and what the program's end says.

Exit codes: 0 criteria met, 1 missed, 2 bad input or usage or no room for output, 70 a defect, 129, 130 and 143 ended by
SIGHUP, Ctrl-C and SIGTERM, 141 nobody reads the output any more.
"""

import io
import json
import os
import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.errors import PluginError
from surefoot.lazy import importing
from surefoot.scenarios.check import command as checking
from surefoot.scenarios.cli.found import AllCommands
from surefoot.scenarios.errors import LinkError, LogError, ScenarioError, SetupError
from surefoot.scenarios.output import reason
from surefoot.scenarios.show import commands as shown
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
    from _typeshed import ReadableBuffer

DEFECT, BAD_INPUT, UNREAD = 70, 2, 141


app = typer.Typer(
    name="surefoot",
    cls=AllCommands,
    help="A humanoid walks in full physics, and its log gives the verdict.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _print_version(wanted: bool) -> None:
    """Print the version and end, if it is wanted."""
    if wanted:
        import surefoot

        typer.echo(f"surefoot {surefoot.__version__}")
        raise typer.Exit


@app.callback()
def _surefoot(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", is_eager=True, callback=_print_version)
    ] = False,
) -> None:
    """Take the options that need no command."""


@app.command("list")
def list_(context: typer.Context, as_json: AsJson = False) -> None:
    """List scenarios, campaigns, robots and parts, one line each."""
    from surefoot.scenarios.cli import listing

    if as_json:
        typer.echo(json.dumps(listing.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(listing.lines()))
    commands = context.find_root().command
    clashes = commands.table.registry.clashes().values() if isinstance(commands, AllCommands) else ()
    for refusal in (*listing.refusals(), *map(str, clashes)):
        typer.echo(refusal, err=True)


@app.command()
def show(scenario: Annotated[str, typer.Argument(help="Catalogue name.", autocompletion=scenarios_from)]) -> None:
    """Print the YAML of a scenario or campaign, to start from."""
    from surefoot.scenarios.cli.starter import starter

    typer.echo(starter(scenario), nl=False)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for editors."""
    from surefoot.scenarios.cli.published import schema_text

    typer.echo(schema_text())


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The arguments of `surefoot run`."""

    scenario: Annotated[
        str, typer.Argument(help="Catalogue name, scenario file, or a log to run again.", autocompletion=scenarios_from)
    ]
    policy: SeatOf = None
    set_: Settings = None
    seed: Seed = None
    out: Annotated[Path, typer.Option(help="Directory that gets the run's own folder.")] = Path("runs")
    video: Annotated[Path | None, typer.Option(help="Also render the run to this .mp4 file.")] = None
    view: Annotated[bool, typer.Option("--view", help="Show the run in a browser while it goes on.")] = False
    force: Annotated[bool, typer.Option("--force", "-f", help="Replace the video if it exists.")] = False
    as_json: AsJson = False


@app.command()
@with_options(RunOptions)
def run(options: RunOptions) -> None:
    """Run a scenario, write its log and judge it."""
    with importing():
        from surefoot.native import modules
        from surefoot.scenarios.run.run import run_scenario
        from surefoot.scenarios.setup.load import load, locate
        from surefoot.scenarios.show.console import ProgressLine, print_result
        from surefoot.scenarios.show.replay.beside import LiveView, check

    asked = overrides(options.set_, options.seed, options.policy)
    loaded = load(options.scenario, asked)
    if options.video or options.view:
        check(loaded.fidelity, video=options.video, view=options.view, replace=options.force)
    progress = ProgressLine(loaded.name)
    with LiveView(progress) as live:
        try:
            with progress:
                result = run_scenario(loaded, options.out, live if options.view else progress, on_begin=live.begin)
        except SetupError as refusal:
            raise locate(options.scenario, asked, refusal) from None
        if options.as_json:
            typer.echo(json.dumps({**result.verdict.to_json(), "log": str(result.log)}, allow_nan=False))
        else:
            print_result(loaded.name, result.verdict, result.log)
        if reason := modules.missing():
            typer.echo(f"run interpreted, about {modules.SLOWER} times slower: {reason}", err=True)
        if result.interrupted:
            typer.echo(f"interrupted; the log up to here is whole: {result.log}", err=True)
            raise typer.Exit(INTERRUPTED)
        if options.video:
            from surefoot.scenarios.show.replay.video import write_video

            write_video(result.log, options.video, replace=options.force)
        live.wait()
    raise typer.Exit(0 if result.verdict.passed else MISSED)


for product in (shown, checking):
    app.add_typer(product.app)


def program(arguments: Sequence[str] | None = None) -> None:
    """Run the command line.

    An error that the user can mend is one message; a defect of the program is a traceback and an exit code of its own.

    Args:
        arguments: words behind the program's name; those that it was started with by default.
    """
    from surefoot.scenarios.run import interrupts

    set_up_streams()
    interrupts.obey_all()
    try:
        code = _code(arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(interrupts.exit_code() if code == INTERRUPTED else code)


def _meant(end: SystemExit) -> bool:
    """Return true if the command line itself ends the program, and no part of others that leaves."""
    *_, (frame, _) = traceback.walk_tb(end.__traceback__)
    return str(frame.f_globals.get("__name__")).partition(".")[0] in ("surefoot", "typer", "click")


def _code(arguments: Sequence[str] | None) -> int | str | None:
    """Exit code of the command."""
    try:
        app(arguments, prog_name=app.info.name)  # not how it was started, which is no name that a shell can complete
    except SystemExit as end:
        if _meant(end):
            return end.code
        traceback.print_exc()
        return DEFECT
    except (ScenarioError, LinkError, LogError, PluginError) as error:
        typer.echo(str(error), err=True)
        return BAD_INPUT
    except KeyboardInterrupt:
        raise
    except BaseException:
        traceback.print_exc()
        return DEFECT
    return 0


class _Stream(io.FileIO):
    """Standard output or error, whose end ends the program and is no defect: a pipe is closed, a disk is full."""

    ended = False

    def write(self, data: "ReadableBuffer") -> int:
        """Write, unless there is no use in it any more."""
        size = memoryview(data).nbytes
        if self.ended:
            return size
        try:
            return super().write(data) or 0
        except OSError as error:
            self.ended = True
            if isinstance(error, BrokenPipeError):
                raise SystemExit(UNREAD) from None
            if self.fileno() == 1:
                typer.echo(f"standard output: cannot be written, {reason(error)}; give it more room", err=True)
            raise SystemExit(BAD_INPUT) from None


def set_up_streams() -> None:
    """Set up standard output and error; a name that is no text is shown escaped."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by whoever has started the program
            setattr(sys, name, Path(os.devnull).open("w"))  # noqa: SIM115  as long as the program
        elif stream is getattr(sys, f"__{name}__") and isinstance(stream, io.TextIOWrapper):
            stream.flush()
            raw = io.BufferedWriter(_Stream(stream.fileno(), "w", closefd=False))
            on_screen = name == "stderr" or stream.isatty()
            safe = io.TextIOWrapper(raw, stream.encoding, "backslashreplace", line_buffering=on_screen)
            setattr(sys, name, safe)
