"""The commands that show a log: inspect, plot, compare, recover and replay."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from surefoot.lazy import importing
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.show.options import MISSED, AsJson, From, LogFile, Replace, To, with_options

if TYPE_CHECKING:
    from surefoot.scenarios.log import Log
    from surefoot.scenarios.show.export import Selection

app = typer.Typer()


@dataclass(frozen=True, slots=True)
class InspectOptions:
    """The arguments of `surefoot inspect`."""

    log: LogFile
    topic: Annotated[
        list[str] | None, typer.Option(help="Summarise or export a topic instead; repeatable, into one table.")
    ] = None
    field: Annotated[str | None, typer.Option(help="Only this field of the topic.")] = None
    start: From = None
    end: To = None
    export: Annotated[Path | None, typer.Option(help="Write the topic to a .csv, .npz or .parquet file.")] = None
    where: Annotated[
        str | None,
        typer.Option(
            metavar="CONDITION", help="When that holds, such as 'zmp_edge < 0.01 and /truth:torso_tilt > 0.2'."
        ),
    ] = None
    strict: Annotated[bool, typer.Option("--strict", help="Fail a log that cannot be proven to be whole.")] = False
    force: Replace = False
    as_json: AsJson = False


@app.command()
@with_options(InspectOptions)
def inspect(options: InspectOptions) -> None:
    """Show verdict, metrics, health, topics and rates of a log."""
    with importing():
        from surefoot.scenarios.judge import inspection
        from surefoot.scenarios.log import read
        from surefoot.scenarios.show.console import print_inspection
        from surefoot.scenarios.show.moment import Moment
        from surefoot.scenarios.show.touching import touching

    opened, asked = read(options.log), options.topic or []
    if (asked or options.where is not None) and options.strict:
        raise LogError("--strict is of the verdict; leave --topic and --where away")
    if options.where is not None:
        _show_stretches(opened, options.where, asked, options)
        return
    if asked:
        _show_topics(opened, asked, options)
        return
    if (options.field, options.start, options.end, options.export) != (None, None, None, None):
        raise LogError("--field, --from, --to and --export choose from topics; name one with --topic")
    found, touches = inspection.inspect(opened, options.strict), touching(opened)
    if options.as_json:
        bodies = [touch._asdict() for touch in touches]
        shown = {**found.to_json(), "touching": bodies}
        for one in shown["health"]:
            one["look_at"] = None if one["time"] is None else Moment(opened.path, one["time"]).to_json()
        typer.echo(json.dumps(shown, allow_nan=False))
    else:
        print_inspection(found, touches)
    raise typer.Exit(0 if found.verdict.passed else MISSED)


def _show_topics(log: "Log", topics: list[str], options: InspectOptions) -> None:
    """Summarise topics, or export them and say where they are; what is said in words is printed."""
    from surefoot.scenarios.judge.inspection import topic_summary
    from surefoot.scenarios.show.console import print_topic
    from surefoot.scenarios.show.export import Joined, export, selected

    if EVENTS in topics and EVENTS in log:
        if len(topics) > 1:
            raise LogError(f"{EVENTS} has words, which no table of numbers holds; ask for it alone")
        _show_events(log, options)
        return
    if len(topics) > 1 and options.field is not None:
        raise LogError(f"--field is of one topic, and {len(topics)} are named; leave it away, or name one")
    if len(set(topics)) < len(topics):
        raise LogError("--topic names one twice; name each once")
    chosen = [selected(log, topic, options.start, options.end, options.field) for topic in topics]
    one, *others = chosen
    if options.export is not None:
        count = export(Joined(tuple(chosen)) if others else one, options.export, options.force)
        file = str(options.export)
        typer.echo(json.dumps({"file": file, "messages": count}) if options.as_json else file)
    else:
        summary = _summary_of(chosen) if others else topic_summary(one)
        if options.as_json:
            typer.echo(json.dumps(summary, allow_nan=False))
        else:
            print_topic(", ".join(topics), summary)
    for loss in log.damage:
        typer.echo(f"not read: {loss}", err=True)


def _summary_of(chosen: "list[Selection]") -> dict[str, Any]:
    """Summaries of several topics, by fields that are called by their topic."""
    from surefoot.scenarios.judge.inspection import topic_summary
    from surefoot.scenarios.show.export import prefixed

    found: dict[str, Any] = {}
    for one in chosen:
        names = (field.name for field in prefixed(one.topic, one.fields))
        found |= dict(zip(names, topic_summary(one).values(), strict=True))
    return found


def _show_stretches(log: "Log", question: str, topics: list[str], options: InspectOptions) -> None:
    """Print when a question holds."""
    from surefoot.scenarios.judge.questions import stretches
    from surefoot.scenarios.show.console import print_stretches

    if options.field is not None or options.export is not None:
        raise LogError(
            f"{'--field' if options.field is not None else '--export'} is of topics; leave it or --where away"
        )
    found, units = stretches(log, question, options.start, options.end, topics)
    if options.as_json:
        typer.echo(json.dumps([one._asdict() for one in found], allow_nan=False))
    else:
        print_stretches(question, found, units[0])
    for loss in log.damage:
        typer.echo(f"not read: {loss}", err=True)


EVENTS = "/events"
"""Topic whose messages are in words."""


def _show_events(log: "Log", options: InspectOptions) -> None:
    """Print what happens, in words."""
    from surefoot.scenarios.record.foxglove.views import events
    from surefoot.scenarios.show.console import print_table

    if options.field is not None or options.export is not None:
        option = "--field" if options.field is not None else "--export"
        raise LogError(f"{option} is of topics with numbers; {EVENTS} has words, which --json gives for programs")
    first = -math.inf if options.start is None else options.start
    last = math.inf if options.end is None else options.end
    found = list(events(log, first, last))
    if options.as_json:
        typer.echo(json.dumps([one._asdict() for one in found], allow_nan=False))
        return
    rows = ((f"{one.time:.3f}", one.kind, one.text) for one in found)
    print_table(("time [s]", "kind", "event"), rows)


@app.command()
def plot(
    log: LogFile,
    out: Annotated[Path | None, typer.Option(help="PNG, SVG or PDF; figures.png beside the log by default.")] = None,
    what: Annotated[str | None, typer.Option(metavar="NAME", help="One figure instead of the page of all.")] = None,
    start: From = None,
    end: To = None,
    force: Replace = False,
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
    force: Replace = False,
    as_json: AsJson = False,
) -> None:
    """Show two logs side by side, and where their channels part."""
    from surefoot.scenarios.output import refuse_existing
    from surefoot.scenarios.show.compare import TOLERANCE, draw, print_comparison
    from surefoot.scenarios.show.compare import compare as compare_logs

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
    force: Replace = False,
) -> None:
    """Make a whole, indexed log of what a truncated one still holds."""
    from surefoot.scenarios.log.recover import recover as recover_log

    recovery = recover_log(log, out, force)
    for loss in recovery.lost:
        typer.echo(f"lost: {loss}", err=True)
    typer.echo(f"{recovery.messages} messages from {recovery.start:.3f} s to {recovery.end:.3f} s", err=True)
    typer.echo(str(out))


@dataclass(frozen=True, slots=True)
class MotionOptions:
    """The arguments of `surefoot motion`."""

    log: LogFile
    out: Annotated[Path, typer.Option(help="File to write: .npz, or .csv with rows of root and joints.")]
    fps: Annotated[float | None, typer.Option(help="Frames per second [Hz]; 50 by default, of a csv file 30.")] = None
    joints: Annotated[
        Path | None, typer.Option(metavar="CONTRACT", help="Contract of a policy: its joints in its order.")
    ] = None
    start: From = None
    end: To = None
    force: Replace = False


@app.command()
@with_options(MotionOptions)
def motion(options: MotionOptions) -> None:
    """Write the motion of a log for those who train by imitation."""
    from surefoot.scenarios.log import read
    from surefoot.scenarios.record.provenance import RunConstants
    from surefoot.scenarios.show.motion import write_motion

    opened, joints = read(options.log), None
    if options.joints is not None:
        from surefoot.scenarios.policy.files import read as read_policy

        names = RunConstants.from_metadata(opened.metadata, str(opened.path)).joint_names
        joints = read_policy(options.joints, names).contract.joints
    found = write_motion(opened, options.out, options.fps, joints, options.start, options.end, options.force)
    typer.echo(f"{len(found.time)} frames from {found.time[0]:.3f} s to {found.time[-1]:.3f} s", err=True)
    typer.echo(str(options.out))


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """The arguments of `surefoot replay`."""

    log: Annotated[Path, typer.Argument(help="A log, also a truncated or growing one.")]
    html: Annotated[Path | None, typer.Option(help="Write one page that opens offline.")] = None
    video: Annotated[Path | None, typer.Option(help="Write an mp4 video.")] = None
    rrd: Annotated[Path | None, typer.Option(help="Write a recording for the viewer rerun.")] = None
    live: Annotated[bool, typer.Option("--live", help="Serve it on this machine, following a growing log.")] = False
    start: From = None
    end: To = None
    speed: Annotated[float, typer.Option(help="Of the video over that of the run, 0.1 to 10.")] = 1.0
    camera: Annotated[
        str, typer.Option(help="Of the video: follow, side, front, fixed, or azimuth,elevation,distance [deg, deg, m].")
    ] = "follow"
    size: Annotated[str, typer.Option(metavar="WxH", help="Of the video [px].")] = "1280x720"
    beside: Annotated[
        Path | None, typer.Option(metavar="MOTION", help="A motion, .npz or .csv, to be drawn beside the robot.")
    ] = None
    force: Replace = False


@app.command()
@with_options(ReplayOptions)
def replay(options: ReplayOptions) -> None:
    """Show a log in 3D: as a page, as a video, in rerun or live."""
    if (options.html is not None) + (options.video is not None) + (options.rrd is not None) + options.live != 1:
        raise typer.BadParameter("give one of --html FILE, --video FILE, --rrd FILE and --live")
    if options.video is None and (options.speed, options.camera, options.size) != (1.0, "follow", "1280x720"):
        raise typer.BadParameter("--speed, --camera and --size are of a video; give them with --video FILE")
    from surefoot.scenarios.show.replay.content import ReplayWindow

    window = ReplayWindow(options.start, options.end, beside=options.beside)
    if options.html is not None:
        from surefoot.scenarios.show.replay.page import write_page

        rate = write_page(options.log, options.html, window, options.force)
        if rate < window.frame_rate:
            right = "--from and --to choose a part that is shown at the full rate"
            typer.echo(f"note: the page shows {rate:.3g} pictures of a simulated second; {right}", err=True)
        typer.echo(str(options.html))
    elif options.video is not None:
        from surefoot.scenarios.show.replay.video import Film, write_video

        write_video(
            options.log, options.video, window, Film.of(options.speed, options.camera, options.size), options.force
        )
        typer.echo(str(options.video))
    elif options.rrd is not None:
        from surefoot.scenarios.show.replay.rrd import write_rrd

        write_rrd(options.log, options.rrd, window, options.force)
        typer.echo(str(options.rrd))
    else:
        from surefoot.scenarios.show.replay.live import serve

        serve(options.log, window, typer.echo)
