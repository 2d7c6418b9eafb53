"""The page: a recording of the scene in viser's own viewer, with charts beside it that follow its timeline."""

import dataclasses
import html
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from surefoot.scenarios import palette
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.show.logview import FOOT_NAMES, STANCES, LogView, MissingError, rows_at
from surefoot.scenarios.show.replay.content import Array, Replay, ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.gate import serving
from surefoot.scenarios.show.replay.scene import ViserScene


@dataclass(frozen=True, slots=True)
class Curve:
    """A quantity of a chart, and where a log has it.

    Attributes:
        name: what it is.
        color: of the line.
        topic: of its channel.
        field: of that.
        size: of the field.
        component: of the field.
        planned: whether it is what should be, which is drawn dashed.
    """

    name: str
    color: palette.Color
    topic: str
    field: str
    size: int
    component: int
    planned: bool = False


@dataclass(frozen=True, slots=True)
class Chart:
    """Curves over one axis.

    Attributes:
        label: of the axis, with its unit.
        digits: that a value is shown with, after the point.
        curves: on it.
        from_stance: whether they are of points that are seen from the stance foot.
    """

    label: str
    digits: int
    curves: tuple[Curve, ...]
    from_stance: bool = False

    def values(self, view: LogView, time: Array) -> dict[Curve, Array]:
        """The curves that a log has, at the times of the frames, shape (n,) each, NaN where there is nothing."""
        found = {}
        for curve in self.curves:
            with suppress(MissingError):
                rows = rows_at(view.time(curve.topic), time)
                values = view.field(curve.topic, curve.field, curve.size)[rows]
                points = view.from_stance(time, values[:, :2]) if self.from_stance else values
                found[curve] = points[:, curve.component]
        return found

    def to_json(self, values: Mapping[Curve, Array] | None = None) -> dict[str, Any]:
        """The chart for a script, as JSON: the curves with their values, or all of them without any."""
        curves = []
        for curve in self.curves if values is None else values:
            shown = {"name": curve.name, "color": palette.hexadecimal(curve.color), "planned": curve.planned}
            if values is not None:
                rounded = values[curve].round(4).tolist()
                shown["values"] = [value if abs(value) < np.inf else None for value in rounded]
            curves.append(shown)
        return {"label": self.label, "digits": self.digits, "curves": curves}


def _balance(axis: int) -> tuple[Curve, ...]:
    """Points of balance along an axis, as they are and as planned."""
    return (
        Curve("ZMP", palette.ZMP, "/contact", "zmp", 3, axis),
        Curve("CoM", palette.COM, "/truth", "com", 3, axis),
        Curve("DCM", palette.DCM, "/estimate", "dcm", 2, axis),
        Curve("ZMP planned", palette.ZMP_PLANNED, "/reference", "zmp", 2, axis, planned=True),
        Curve("CoM planned", palette.COM_PLANNED, "/reference", "com", 3, axis, planned=True),
        Curve("DCM planned", palette.DCM_PLANNED, "/reference", "dcm", 2, axis, planned=True),
    )


_MARGINS = (
    Curve("steps as planned", palette.DCM_PLANNED, "/plan", "capture_margin", 2, 0, planned=True),
    Curve("steps moved", palette.DCM, "/plan", "capture_margin", 2, 1),
)
_FORCES = tuple(
    Curve(f"{name} foot", palette.FEET[foot], "/contact", "normal_force", 2, foot)
    for foot, name in enumerate(FOOT_NAMES)
)
CHARTS = (
    Chart("forward of the stance foot [m]", 3, _balance(0), from_stance=True),
    Chart("left of the stance foot [m]", 3, _balance(1), from_stance=True),
    Chart("DCM inside what is captured [m]", 3, _MARGINS),
    Chart("normal force [N]", 0, _FORCES),
)
"""Charts beside the picture of every replay and of a robot that is driven."""


LEAD = 3.0
"""Longest time before a replay at which the step began in which it begins [s]."""


def beside_replay(log: Log, replay: Replay) -> LogView:
    """The view from which the charts beside a replay are drawn."""
    reads = {topic: set(names) for topic, names in STANCES.items()}
    for chart in CHARTS:
        for curve in chart.curves:
            reads.setdefault(curve.topic, set()).add(curve.field)
    begin, end = float(replay.time[0]), float(replay.time[-1])
    return LogView(log, begin - LEAD, end, {topic: tuple(sorted(names)) for topic, names in reads.items()})


MOST_FRAMES = 600
"""Frames of a page, which holds all of them at once, as does the browser that shows it: 20 s at the full rate."""


def write_page(log: Path, out: Path, window: ReplayWindow | None = None, replace: bool = False) -> float:
    """Write the page of a log.

    Returns:
        frames per simulated second, fewer than asked for where there would be more than `MOST_FRAMES` [Hz].

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the log cannot be read; the file exists, and shall not be replaced, or cannot be written.
    """
    refuse_existing(out, replace)
    opened = read(log)
    replay = extract(opened, dataclasses.replace(window or ReplayWindow(), most=MOST_FRAMES))
    view = beside_replay(opened, replay)
    charts = [chart.to_json(chart.values(view, replay.time)) for chart in CHARTS]
    with write_whole(out, replace) as temporary:
        temporary.write_text(page(replay, charts), encoding="utf-8")
    return replay.frame_rate


def page(replay: Replay, charts: Sequence[Mapping[str, Any]] = ()) -> str:
    """The page as text, with charts from `Chart.to_json` beside the picture.

    Raises:
        MissingExtraError: viser is not installed.
    """
    with serving() as server, server.atomic():  # or its thread is woken for each change of a frame
        scene = ViserScene(server, replay)
        recorder = server.get_scene_serializer()
        for frame in range(1, len(replay)):
            recorder.insert_sleep(float(replay.time[frame] - replay.time[frame - 1]))
            scene.show(frame)
        recorded: str = recorder.as_html()
        layers = scene.moving_layers
    return taken_in(recorded, f"<title>{html.escape(replay.title)}</title>", column(replay, layers, charts))


def column(replay: Replay, layers: tuple[str, ...], charts: Sequence[Mapping[str, Any]]) -> str:
    """The column beside the picture: title, legend, charts, and the room for viser's switches of the layers."""
    time = replay.time.round(4).tolist()
    legend = (
        f'<span><b style="background:{palette.hexadecimal(c)}"></b>{name}</span>' for name, c in replay.legend().items()
    )
    return filled(
        beside(files(__package__).joinpath("column.html").read_text(encoding="utf-8")),
        {"time": time, "layers": layers, "charts": charts},
        title=html.escape(replay.title),
        span=f"{time[0]:.1f} s to {time[-1]:.1f} s",
        legend="".join(legend),
    )


def beside(column: str) -> str:
    """The template of a column beside a picture, with what all columns share in front of it."""
    return files(__package__).joinpath("beside.html").read_text(encoding="utf-8").replace("@", "@@") + column


class _Template(Template):
    delimiter = "@"  # JavaScript has other uses for the usual one


def filled(template: str, data: Any = None, **names: str) -> str:
    """A template of a page with its names filled in.

    Args:
        template: text, in which ``@name`` stands for a name, and ``@data`` for the data.
        data: for a script, as JSON; what is no finite number cannot be in it.
        names: HTML by name.
    """
    # An end of the script inside a text would end it.
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    return _Template(template).substitute(names, data=text)


def taken_in(page: str, head: str, column: str) -> str:
    """A viewer's own page with elements before all in its head, and others behind all in its body."""
    before, inside = page.split("<head>", 1)
    top, after = inside.rsplit("</body>", 1)
    return f"{before}<head>{head}{top}{column}</body>{after}"
