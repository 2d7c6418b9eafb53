"""The command line. Exit codes: 0 criteria met, 1 missed, 2 bad input or usage, 70 a defect, 130 interrupted."""

import json
import sys
import traceback
from pathlib import Path
from typing import Annotated

import typer

from scenarios.errors import LogError, ScenarioError, SetupError

app = typer.Typer(
    name="surefoot",
    help="A humanoid walks in full physics, and its log gives the verdict.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

MISSED, BAD_INPUT, DEFECT, INTERRUPTED = 1, 2, 70, 130

AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]


@app.command("list")
def list_() -> None:
    """List scenarios and robots, one line each."""
    from scenarios import catalogue
    from scenarios.robots import RegisteredRobots

    for name in catalogue.names():
        typer.echo(f"scenario  {name:<16} {catalogue.summary(name)}")
    for name in RegisteredRobots().names():
        typer.echo(f"robot     {name}")


@app.command()
def run(
    scenario: Annotated[str, typer.Argument(help="Catalogue name or path of a scenario file.")],
    set_: Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Set a key; repeatable.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed, over that of the scenario.")] = None,
    out: Annotated[Path, typer.Option(help="Directory for the log and the verdict.")] = Path("runs"),
    as_json: AsJson = False,
) -> None:
    """Run a scenario, write its log and judge it."""
    from scenarios.console import ProgressLine, print_result
    from scenarios.load import load_scenario, locate
    from scenarios.run import run_scenario

    overrides = [*(set_ or ()), *([f"seed={seed}"] if seed is not None else [])]
    loaded = load_scenario(scenario, overrides)
    with ProgressLine(loaded.name) as progress:
        try:
            result = run_scenario(loaded, out, progress)
        except SetupError as refusal:
            raise locate(scenario, overrides, refusal) from None
    if as_json:
        typer.echo(json.dumps({**result.verdict.to_json(), "log": str(result.log)}, allow_nan=False))
    else:
        print_result(result.verdict, result.log)
    if result.interrupted:
        typer.echo(f"interrupted; the log up to here is whole: {result.log}", err=True)
        raise typer.Exit(INTERRUPTED)
    raise typer.Exit(0 if result.verdict.passed else MISSED)


@app.command()
def inspect(
    log: Annotated[Path, typer.Argument(help="A log, also a truncated one.")],
    topic: Annotated[str | None, typer.Option(help="Summarise the fields of one topic instead.")] = None,
    as_json: AsJson = False,
) -> None:
    """Show verdict, metrics, health, topics and rates of a log."""
    from scenarios import inspection
    from scenarios.console import print_inspection, print_topic
    from scenarios.log import read

    opened = read(log)
    if topic is not None:
        fields = inspection.topic_summary(opened, topic)
        if as_json:
            typer.echo(json.dumps(fields, allow_nan=False))
        else:
            print_topic(topic, fields)
        return
    found = inspection.inspect(opened)
    if as_json:
        typer.echo(json.dumps(found.to_json(), allow_nan=False))
    else:
        print_inspection(found)
    raise typer.Exit(0 if found.verdict.passed else MISSED)


@app.command()
def recover(
    log: Annotated[Path, typer.Argument(help="A truncated or damaged log.")],
    out: Annotated[Path, typer.Argument(help="The whole log to write.")],
) -> None:
    """Make a whole, indexed log of what a truncated one still holds."""
    from scenarios.log.recover import recover as recover_log

    recovery = recover_log(log, out)
    for loss in recovery.lost:
        typer.echo(f"lost: {loss}", err=True)
    typer.echo(f"{recovery.messages} messages from {recovery.start:.3f} s to {recovery.end:.3f} s", err=True)
    typer.echo(str(out))


@app.command()
def replay(
    log: Annotated[Path, typer.Argument(help="A log, also a truncated or growing one.")],
    html: Annotated[Path | None, typer.Option(help="Write one page that opens offline.")] = None,
    video: Annotated[Path | None, typer.Option(help="Write an mp4 video.")] = None,
    live: Annotated[bool, typer.Option("--live", help="Serve it on this machine, following a growing log.")] = False,
    start: Annotated[float | None, typer.Option("--from", help="First time [s].")] = None,
    end: Annotated[float | None, typer.Option("--to", help="Last time [s].")] = None,
) -> None:
    """Show a log in 3D: as a page, as a video or live."""
    if (html is not None) + (video is not None) + live != 1:
        raise typer.BadParameter("give one of --html FILE, --video FILE and --live")
    from scenarios.replay import command
    from scenarios.replay.frames import Window

    window = Window(start, end)
    if html is not None:
        command.html_page(log, html, window)
        typer.echo(str(html))
    elif video is not None:
        command.video(log, video, window)
        typer.echo(str(video))
    else:
        command.live(log, window, typer.echo)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for editors."""
    from scenarios.schema import Scenario

    typer.echo(json.dumps(Scenario.model_json_schema(), indent=2))


def main() -> None:
    """Run the command line.

    An error that the user can mend is one message; a defect of the program is a traceback and an exit code of its own.
    """
    try:
        app()
    except (ScenarioError, LogError) as error:
        typer.echo(str(error), err=True)
        sys.exit(BAD_INPUT)
    except Exception:
        traceback.print_exc()
        sys.exit(DEFECT)
