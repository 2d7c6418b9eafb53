"""The command line.

Exit codes: 0 criteria met, 1 missed, 2 bad input or usage or no room for output, 70 a defect, 129, 130 and 143 ended by
SIGHUP, Ctrl-C and SIGTERM, 141 nobody reads the output any more.
"""

import json
import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from surefoot.errors import PluginError
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.robots import command as robots
from surefoot.scenarios.terminal import BAD_INPUT, Commands, keys_from, set_up_streams

if TYPE_CHECKING:
    from surefoot.scenarios.log import Log


app = typer.Typer(
    name="surefoot",
    cls=Commands,
    help="A humanoid walks in full physics, and its log gives the verdict.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

app.add_typer(robots.app, name="robot")

MISSED, DEFECT, INTERRUPTED = 1, 70, 130

_FARTHEST = 1e9


def _finite(value: float | None) -> float | None:
    """Refuse what is no time of a log."""
    if value is not None and not abs(value) <= _FARTHEST:
        raise typer.BadParameter(f"{value} is no time of a log; give seconds, such as 2.5")
    return value


From = Annotated[float | None, typer.Option("--from", metavar="T", help="From this time on [s].", callback=_finite)]
To = Annotated[float | None, typer.Option("--to", metavar="T", help="Up to this time [s].", callback=_finite)]

Force = Annotated[bool, typer.Option("--force", "-f", help="Replace the file if it exists.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]


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


def _scenarios(incomplete: str) -> list[str]:
    """Catalogue names that begin so; where there is none, shells go on to complete file names."""
    from surefoot.scenarios import catalogue

    return [name for name in catalogue.names() if name.startswith(incomplete)]


def _settings(incomplete: str) -> list[str]:
    """Keys that begin so, each as the beginning of a setting."""
    return [f"{key}=" for key in keys_from(incomplete)]


@app.command("list")
def list_(as_json: AsJson = False) -> None:
    """List scenarios, campaigns, robots and parts, one line each."""
    from surefoot.scenarios.show import listing

    if as_json:
        typer.echo(json.dumps(listing.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(listing.lines()))
    for refusal in listing.refusals():
        typer.echo(refusal, err=True)


@app.command()
def run(
    scenario: Annotated[
        str, typer.Argument(help="Catalogue name, scenario file, or a log to run again.", autocompletion=_scenarios)
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Set a key; repeatable.", autocompletion=_settings),
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed, over that of the scenario.")] = None,
    out: Annotated[Path, typer.Option(help="Directory that gets the run's own folder.")] = Path("runs"),
    video: Annotated[Path | None, typer.Option(help="Also render the run to this .mp4 file.")] = None,
    view: Annotated[bool, typer.Option("--view", help="Show the run in a browser while it goes on.")] = False,
    force: Annotated[bool, typer.Option("--force", "-f", help="Replace the video if it exists.")] = False,
    as_json: AsJson = False,
) -> None:
    """Run a scenario, write its log and judge it."""
    from surefoot.scenarios.loop.run import run_scenario
    from surefoot.scenarios.setup.load import load as load_scenario
    from surefoot.scenarios.setup.load import locate
    from surefoot.scenarios.show.console import ProgressLine, print_result
    from surefoot.scenarios.show.replay.command import LiveView, check

    overrides = [*(set_ or ()), *([f"seed={seed}"] if seed is not None else [])]
    loaded = load_scenario(scenario, overrides)
    if video or view:
        check(loaded.fidelity, video=video, view=view, replace=force)
    with ProgressLine(loaded.name) as progress:
        live = LiveView(progress)
        try:
            result = run_scenario(loaded, out, live if view else progress, on_begin=live.begin)
        except SetupError as refusal:
            raise locate(scenario, overrides, refusal) from None
    if as_json:
        typer.echo(json.dumps({**result.verdict.to_json(), "log": str(result.log)}, allow_nan=False))
    else:
        print_result(loaded.name, result.verdict, result.log)
    if result.interrupted:
        typer.echo(f"interrupted; the log up to here is whole: {result.log}", err=True)
        raise typer.Exit(INTERRUPTED)
    if video:
        from surefoot.scenarios.show.replay import command
        from surefoot.scenarios.show.replay.poses import Window

        command.video(result.log, video, Window(), replace=force)
    live.wait()
    raise typer.Exit(0 if result.verdict.passed else MISSED)


@app.command()
def drive(
    scenario: Annotated[
        str | None,
        typer.Argument(help="Catalogue name, scenario file or log; stands by default.", autocompletion=_scenarios),
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Set a key; repeatable.", autocompletion=_settings),
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed, over that of the scenario.")] = None,
    out: Annotated[Path, typer.Option(help="Directory that gets a folder for each run.")] = Path("runs"),
    port: Annotated[
        int | None, typer.Option(min=1, max=65534, help="Of the page; the first free one from 8080 on by default.")
    ] = None,
) -> None:
    """Drive the robot in a browser: walk it, push it, until Ctrl-C."""
    from surefoot.scenarios.drive.command import LONGEST, OWN
    from surefoot.scenarios.drive.command import drive as drive_scenario
    from surefoot.scenarios.errors import require
    from surefoot.scenarios.setup.load import load as load_scenario
    from surefoot.scenarios.setup.load import locate

    require("viser", "replay", "surefoot drive")
    reference = scenario or str(OWN)
    overrides = [LONGEST, *(set_ or ()), *([f"seed={seed}"] if seed is not None else [])]
    loaded = load_scenario(reference, overrides)
    try:
        drive_scenario(loaded, out, port, typer.echo)
    except SetupError as refusal:
        raise locate(reference, overrides, refusal) from None
    typer.echo("ended; the logs are whole", err=True)
    raise typer.Exit(INTERRUPTED)


@app.command()
def inspect(
    log: Annotated[Path, typer.Argument(help="A log, also a truncated one.")],
    topic: Annotated[str | None, typer.Option(help="Summarise or export one topic instead.")] = None,
    field: Annotated[str | None, typer.Option(help="Only this field of the topic.")] = None,
    start: From = None,
    end: To = None,
    export: Annotated[Path | None, typer.Option(help="Write the topic to a .csv, .npz or .parquet file.")] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Show verdict, metrics, health, topics and rates of a log."""
    from surefoot.scenarios.judge import inspection
    from surefoot.scenarios.log import read
    from surefoot.scenarios.show.console import print_inspection

    opened = read(log)
    if topic is not None:
        _show_topic(opened, topic, (start, end), field, export, force, as_json)
        return
    if (field, start, end, export) != (None, None, None, None):
        raise LogError("--field, --from, --to and --export choose from one topic; name it with --topic")
    found = inspection.inspect(opened)
    if as_json:
        typer.echo(json.dumps(found.to_json(), allow_nan=False))
    else:
        print_inspection(found)
    raise typer.Exit(0 if found.verdict.passed else MISSED)


def _show_topic(
    log: "Log",
    topic: str,
    span: tuple[float | None, float | None],
    field: str | None,
    file: Path | None,
    force: bool,
    as_json: bool,
) -> None:
    """Summarise a topic, or export it and say where it is."""
    from surefoot.scenarios.judge.inspection import topic_summary
    from surefoot.scenarios.show.console import export, print_topic, selected

    channel = selected(log, topic, *span, field)
    for loss in log.damage:
        typer.echo(f"not read: {loss}", err=True)
    if file is not None:
        export(channel, file, force)
        typer.echo(json.dumps({"file": str(file), "messages": len(channel)}) if as_json else str(file))
    elif as_json:
        typer.echo(json.dumps(topic_summary(channel), allow_nan=False))
    else:
        print_topic(topic, topic_summary(channel))


@app.command()
def plot(
    log: Annotated[Path, typer.Argument(help="A log, also a truncated one.")],
    out: Annotated[Path | None, typer.Option(help="PNG, SVG or PDF; figures.png beside the log by default.")] = None,
    what: Annotated[str | None, typer.Option(metavar="NAME", help="One figure instead of the page of all.")] = None,
    start: From = None,
    end: To = None,
    force: Force = False,
) -> None:
    """Draw the figures that a walking engineer looks at."""
    from surefoot.scenarios.show.figures.page import plot as plot_log

    drawn = plot_log(log, out, what, start, end, force)
    for note in drawn.notes:
        typer.echo(f"note: {note}", err=True)
    typer.echo(str(drawn.path))


@app.command()
def compare(
    a: Annotated[Path, typer.Argument(metavar="A", help="A log.")],
    b: Annotated[Path, typer.Argument(metavar="B", help="Another log.")],
    out: Annotated[Path | None, typer.Option(help="Draw both over each other: PNG, SVG or PDF.")] = None,
    tolerance: Annotated[
        float | None, typer.Option(help="Of values that still agree: relative, and absolute below 1; 1e-6 by default.")
    ] = None,
    exit_code: Annotated[
        bool,
        typer.Option("--exit-code", help="Exit with 1 unless they are the same: to the bit, or within --tolerance."),
    ] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Show two logs side by side, and where their channels part."""
    from surefoot.scenarios.output import refuse_existing
    from surefoot.scenarios.show.compare.compare import TOLERANCE, draw, print_comparison
    from surefoot.scenarios.show.compare.compare import compare as compare_logs

    if out is not None:
        refuse_existing(out, force)
    found, first, second = compare_logs(a, b, TOLERANCE if tolerance is None else tolerance)
    if out is not None:
        draw(found, first, second, out, force)
    if as_json:
        typer.echo(json.dumps(found.to_json(), allow_nan=False))
    else:
        print_comparison(found)
    same = found.identical if tolerance is None else found.agree
    raise typer.Exit(MISSED if exit_code and not same else 0)


@app.command()
def recover(
    log: Annotated[Path, typer.Argument(help="A truncated or damaged log.")],
    out: Annotated[Path, typer.Argument(help="The whole log to write.")],
    force: Force = False,
) -> None:
    """Make a whole, indexed log of what a truncated one still holds."""
    from surefoot.scenarios.log.recover import recover as recover_log

    recovery = recover_log(log, out, force)
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
    start: From = None,
    end: To = None,
    speed: Annotated[float, typer.Option(help="Of the video over that of the run, 0.1 to 10.")] = 1.0,
    camera: Annotated[
        str, typer.Option(help="Of the video: follow, side, front, fixed, or azimuth,elevation,distance [deg, deg, m].")
    ] = "follow",
    size: Annotated[str, typer.Option(metavar="WxH", help="Of the video [px].")] = "1280x720",
    force: Force = False,
) -> None:
    """Show a log in 3D: as a page, as a video or live."""
    if (html is not None) + (video is not None) + live != 1:
        raise typer.BadParameter("give one of --html FILE, --video FILE and --live")
    if video is None and (speed, camera, size) != (1.0, "follow", "1280x720"):
        raise typer.BadParameter("--speed, --camera and --size are of a video; give them with --video FILE")
    from surefoot.scenarios.show.replay import command
    from surefoot.scenarios.show.replay.poses import Window

    window = Window(start, end)
    if html is not None:
        command.html_page(log, html, window, force)
        typer.echo(str(html))
    elif video is not None:
        command.video(log, video, window, command.Filming(speed, camera, size), force)
        typer.echo(str(video))
    else:
        command.live(log, window, typer.echo)


@app.command()
def paper(
    out: Annotated[Path, typer.Option(help="Directory for the page and its runs.")] = Path("runs/paper"),
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at once; as many as cores by default.")] = None,
    force: Annotated[bool, typer.Option("--force", "-f", help="Replace the page of an earlier time.")] = False,
) -> None:
    """Run the paper's experiments; write what holds as an HTML page.

    Begun again, it goes on where it stopped.
    """
    from surefoot.scenarios.paper.page import paper as run_paper
    from surefoot.scenarios.sweep.engine import InterruptedRunsError
    from surefoot.scenarios.sweep.sweep import cores

    try:
        written = run_paper(out, jobs or cores(), force)
    except InterruptedRunsError:
        typer.echo(f"interrupted; finished runs are kept in {out}, the same command goes on from there", err=True)
        raise typer.Exit(INTERRUPTED) from None
    for name in written.failures:
        typer.echo(f"could not run: {name}", err=True)
    verdicts = ", ".join(f"{verdict}: {count}" for verdict, count in written.verdicts.items() if count)
    typer.echo(f"{written.runs} runs, {written.falls} falls, {len(written.failures)} could not run")
    typer.echo(f"claims: {verdicts}")
    typer.echo(str(written.page))
    raise typer.Exit(MISSED if written.failures else 0)


def _campaigns(incomplete: str) -> list[str]:
    """Campaigns that begin so."""
    from surefoot.scenarios.sweep.campaign import shipped

    return [name for name in shipped() if name.startswith(incomplete)]


@app.command()
def sweep(
    spec: Annotated[
        str, typer.Argument(help="A campaign's name, or its specification, a YAML file.", autocompletion=_campaigns)
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Fix a key, even one that varies.", autocompletion=_settings),
    ] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Runs of each, over those of the campaign.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at once; as many as cores by default.")] = None,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this dask scheduler instead.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Directory of the results; runs/NAME by default.")] = None,
    as_json: AsJson = False,
) -> None:
    """Run a campaign: a grid, samples or thresholds over any key.

    Begun again, it goes on where it stopped.
    """
    from surefoot.scenarios.sweep.campaign import read_campaign
    from surefoot.scenarios.sweep.engine import InterruptedRunsError
    from surefoot.scenarios.sweep.sweep import cores
    from surefoot.scenarios.sweep.sweep import sweep as run_sweep

    if jobs is not None and cluster is not None:
        raise typer.BadParameter("--jobs is of this machine; give it without --cluster")
    campaign = read_campaign(spec, set_ or (), seeds)
    folder = out or Path("runs") / campaign.spec.name
    try:
        swept = run_sweep(campaign, folder, jobs or cores(), cluster)
    except InterruptedRunsError:
        typer.echo(f"interrupted; finished runs are kept in {folder}, the same command goes on from there", err=True)
        raise typer.Exit(INTERRUPTED) from None
    for text in swept.notes():
        typer.echo(text, err=True)
    if as_json:
        typer.echo(json.dumps(swept.to_json(), allow_nan=False))
    else:
        typer.echo("\n".join(swept.lines()))
    raise typer.Exit(0 if swept.complete and swept.ran else MISSED)


@app.command()
def check(
    scenarios: Annotated[
        list[str] | None, typer.Argument(help="Catalogue names, files or folders; all of the catalogue by default.")
    ] = None,
    update: Annotated[bool, typer.Option("--update", help="Write the baselines anew, and show the change.")] = False,
    baselines: Annotated[
        Path | None, typer.Option(help="Directory of the baselines; beside the scenario files by default.")
    ] = None,
    set_: Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Set a key; repeatable.")] = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Runs at once; as many as cores by default.")] = None,
    out: Annotated[Path, typer.Option(help="Directory of the logs.")] = Path("runs/check"),
    junit: Annotated[Path | None, typer.Option(help="Also write JUnit XML to this file.")] = None,
    markdown: Annotated[Path | None, typer.Option(help="Also write a summary for a CI page to this file.")] = None,
    force: Force = False,
) -> None:
    """Hold scenarios against their baselines."""
    from surefoot.scenarios.check import check as checking
    from surefoot.scenarios.check import report
    from surefoot.scenarios.output import refuse_existing
    from surefoot.scenarios.show.console import plain_console
    from surefoot.scenarios.sweep.sweep import cores

    console = plain_console()
    for report_file in (junit, markdown):
        if report_file is not None:
            refuse_existing(report_file, force)
    chosen = checking.cases(scenarios or (), baselines, set_ or ())
    try:
        found = checking.check(
            chosen, out, jobs or cores(), lambda one: report.print_checked(one, console), update=update
        )
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(INTERRUPTED) from None
    if junit is not None:
        report.write(junit, report.junit(found), force)
    if markdown is not None:
        report.write(markdown, report.markdown(found).encode(), force)
    typer.echo(report.summary(found))
    raise typer.Exit(checking.exit_code(found))


@app.command()
def show(scenario: Annotated[str, typer.Argument(help="Catalogue name.", autocompletion=_scenarios)]) -> None:
    """Print the YAML of a scenario or campaign, to start from."""
    from surefoot.scenarios.show.listing import starter

    typer.echo(starter(scenario), nl=False)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for editors."""
    from surefoot.scenarios.setup.published import published

    typer.echo(json.dumps(published(), indent=2))


def main() -> None:
    """Run the command line.

    An error that the user can mend is one message; a defect of the program is a traceback and an exit code of its own.
    """
    from surefoot.scenarios.loop import interrupts

    set_up_streams()
    interrupts.obey_all()
    try:
        code = _code()
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(interrupts.exit_code() if code == INTERRUPTED else code)


def _meant(end: SystemExit) -> bool:
    """Whether the command line itself ends the program, and no part of others that leaves."""
    *_, (frame, _) = traceback.walk_tb(end.__traceback__)
    return str(frame.f_globals.get("__name__")).partition(".")[0] in ("surefoot", "typer", "click")


def _code() -> int | str | None:
    """Exit code of the command."""
    try:
        app(prog_name=app.info.name)  # not how it was started, which is no name that a shell can complete
    except SystemExit as end:
        if _meant(end):
            return end.code
        traceback.print_exc()
        return DEFECT
    except (ScenarioError, LogError, PluginError) as error:
        typer.echo(str(error), err=True)
        return BAD_INPUT
    except KeyboardInterrupt:
        raise
    except BaseException:
        traceback.print_exc()
        return DEFECT
    return 0
