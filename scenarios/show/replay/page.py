"""The page: a recording of the scene in viser's own viewer, with charts beside it that follow its timeline."""

import html
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.scenarios.output import write_whole
from surefoot.scenarios.palette import (
    COM,
    COM_PLANNED,
    DCM,
    DCM_PLANNED,
    FEET,
    ZMP,
    ZMP_PLANNED,
    Color,
    hexadecimal,
)
from surefoot.scenarios.show.kit.viewer import filled, taken_in
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError
from surefoot.scenarios.show.replay.content import Array, Replay
from surefoot.scenarios.show.replay.gate import serving
from surefoot.scenarios.show.replay.scene import ViserScene


@dataclass(frozen=True, slots=True)
class Curve:
    """A quantity over the frames of a replay.

    Attributes:
        name: what it is.
        color: of the line.
        planned: whether it is what should be, which is drawn dashed.
        values: by frame, NaN where there is none, shape (n,).
    """

    name: str
    color: Color
    planned: bool
    values: Array


@dataclass(frozen=True, slots=True)
class Chart:
    """Curves over one axis.

    Attributes:
        label: of the axis, with its unit.
        digits: that a value is shown with, after the point.
        curves: on it; none where the log lacks what they need.
    """

    label: str
    digits: int
    curves: tuple[Curve, ...]


BALANCE = (
    ("ZMP", ZMP, False, "/contact", "zmp", 3),
    ("CoM", COM, False, "/truth", "com", 3),
    ("DCM", DCM, False, "/estimate", "dcm", 2),
    ("ZMP planned", ZMP_PLANNED, True, "/reference", "zmp", 2),
    ("CoM planned", COM_PLANNED, True, "/reference", "com", 3),
    ("DCM planned", DCM_PLANNED, True, "/reference", "dcm", 2),
)
"""Points seen from the stance foot: name, colour, whether planned, topic, field and its size."""

MARGINS = (("steps as planned", DCM_PLANNED, True), ("steps moved", DCM, False))
"""The columns of ``/plan.capture_margin``: name, colour, whether dashed."""

AXES = (
    ("forward of the stance foot [m]", 3),
    ("left of the stance foot [m]", 3),
    ("DCM inside what is captured [m]", 3),
    ("normal force [N]", 0),
)
"""Label of each chart, and digits after the point."""

FEET_NAMES = tuple(f"{name} foot" for name in FOOT_NAMES)


def charts(view: LogView, time: Array) -> tuple[Chart, ...]:
    """Balance seen from the stance foot, its margins, and the forces under the feet, at the times of the frames."""
    forward, left = [], []
    for name, color, planned, topic, field, size in BALANCE:
        try:
            seen = view.from_stance(time, _sampled(view, topic, field, size, time)[:, :2])
        except MissingError:
            continue
        forward.append(Curve(name, color, planned, seen[:, 0]))
        left.append(Curve(name, color, planned, seen[:, 1]))
    drawn = (forward, left, _margins(view, time), _forces(view, time))
    return tuple(Chart(label, digits, tuple(curves)) for (label, digits), curves in zip(AXES, drawn, strict=True))


def _margins(view: LogView, time: Array) -> Iterator[Curve]:
    try:
        margins = _sampled(view, "/plan", "capture_margin", 2, time)
    except MissingError:
        return
    for (name, color, dashed), values in zip(MARGINS, margins.T, strict=True):
        yield Curve(name, color, dashed, values)


def _forces(view: LogView, time: Array) -> Iterator[Curve]:
    try:
        force = _sampled(view, "/contact", "normal_force", 2, time)
    except MissingError:
        return
    for foot, name in enumerate(FEET_NAMES):
        yield Curve(name, FEET[foot], False, force[:, foot])


def _sampled(view: LogView, topic: str, field: str, size: int, time: Array) -> Array:
    """What a field was at the times of the frames, shape (n, size)."""
    values, clock = view.field(topic, field, size), view.time(topic)
    return np.asarray(values[np.maximum(np.searchsorted(clock, time + 1e-9, side="right") - 1, 0)])


def write_page(replay: Replay, path: Path, beside: Iterable[Chart] = (), replace: bool = False) -> None:
    """Write the page.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the file exists, and shall not be replaced, or cannot be written.
    """
    with write_whole(path, replace) as temporary:
        temporary.write_text(page(replay, beside), encoding="utf-8")


def page(replay: Replay, beside: Iterable[Chart] = ()) -> str:
    """The page as text.

    Raises:
        MissingExtraError: viser is not installed.
    """
    with serving() as server:
        scene = ViserScene(server, replay)
        recorder = server.get_scene_serializer()
        for frame in range(1, len(replay)):
            recorder.insert_sleep(float(replay.time[frame] - replay.time[frame - 1]))
            scene.show(frame)
        recorded: str = recorder.as_html()
        layers = scene.moving_layers
    return taken_in(recorded, f"<title>{html.escape(replay.title)}</title>", column(replay, layers, beside))


def column(replay: Replay, layers: tuple[str, ...], beside: Iterable[Chart]) -> str:
    """What stands beside the picture: title, legend, charts, and the room for viser's switches of the layers."""
    time = replay.time.round(4).tolist()
    data = {"time": time, "layers": layers, "charts": [_chart(chart) for chart in beside]}
    legend = (f'<span><b style="background:{hexadecimal(c)}"></b>{name}</span>' for name, c in replay.legend().items())
    return filled(
        files(__package__).joinpath("column.html").read_text(encoding="utf-8"),
        data,
        title=html.escape(replay.title),
        span=f"{time[0]:.1f} s to {time[-1]:.1f} s",
        legend="".join(legend),
    )


def _chart(chart: Chart) -> dict[str, Any]:
    curves = [
        {
            "name": curve.name,
            "color": hexadecimal(curve.color),
            "planned": curve.planned,
            "values": [value if abs(value) < np.inf else None for value in curve.values.round(4).tolist()],
        }
        for curve in chart.curves
    ]
    return {"label": chart.label, "digits": chart.digits, "curves": curves}
