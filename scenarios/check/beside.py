"""A run beside the one before it, at the time at which they part: two pictures by one camera, and the channels.

What is compared are copies of both logs that have few messages in a second (`write_thinned`).
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import StringConstraints

from surefoot.scenarios.check.signs import Parting
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.show.compare import distinct_texts
from surefoot.scenarios.show.differences import ChannelDifference, compare_channels
from surefoot.sim.gl import RenderingUnavailableError

if TYPE_CHECKING:
    from surefoot.scenarios.show.replay.content import Array, Replay
    from surefoot.sim.render import Camera, Image

APART = 1e-3
"""Values of a channel part that differ by more than this times the greater one, or than this where both are below 1.

Another processor gives other last bits, which grow at each touchdown; they stay below this for some steps.
"""

MOST_CHANNELS = 3
"""Channels that are named."""

SIZE = (480, 360)
"""Width and height of a picture [px]."""

_FRAMES = 10.0
"""Pictures in a second of which the one that is drawn is chosen [Hz]."""


PICTURES = "pictures"
"""Folder of the pictures in that of a history."""

Picture = Annotated[str, StringConstraints(pattern=rf"^{PICTURES}/[A-Za-z0-9][A-Za-z0-9._-]*\.png$")]


@dataclass(frozen=True, slots=True)
class Beside:
    """A run beside the one before.

    Attributes:
        commit: at which that was checked; empty outside of a repository.
        time: of the pictures: the end of the stage in which the runs first part, or of the shorter run; where no stage
            parts, when the CoMs are farthest apart [s].
        channels: that part first, a text each with place, time and both values.
        pictures: paths of the two pictures in the folder of the history, that of the run before first; () without any.
        note: why there are none.
    """

    commit: str = ""
    time: float = 0.0
    channels: tuple[str, ...] = ()
    pictures: tuple[Picture, ...] = ()
    note: str = ""


DrawRuns = Callable[[Log, Log, float], "list[Image]"]
"""From two logs and a time [s] to a picture of each."""


def beside(
    before: Log,
    now: Log,
    partings: Sequence[Parting],
    history: Path,
    name: str,
    commit: str,
    by: DrawRuns | None = None,
) -> Beside:
    """Hold two runs beside each other, and draw both.

    Args:
        before: log of the run before.
        now: log of the run.
        partings: of the two, in order.
        history: folder that gets the pictures.
        name: beginning of the names of the pictures.
        commit: at which the run before was checked.
        by: draws both; by default `draw`.
    """
    channels = parting_first(before, now)
    time = _moment(before, now, partings)
    found = Beside(commit, time, tuple(map(_text, channels)))
    try:
        drawn = (by or draw)(before, now, time)
    except LogError as why:
        return replace(found, note=f"no pictures: {str(why).partition(': ')[2].partition(';')[0]}")
    except RenderingUnavailableError as why:
        return replace(found, note=f"no pictures: {why}")
    names = tuple(f"{PICTURES}/{name}-{which}.png" for which in ("before", "now"))
    with suppress(OSError):
        (history / PICTURES).mkdir(exist_ok=True)
    for one, picture in zip(names, drawn, strict=True):
        with write_whole(history / one, replace=True) as temporary:
            temporary.write_bytes(_png(picture))
    return replace(found, pictures=names)


def parting_first(before: Log, now: Log) -> list[ChannelDifference]:
    """The channels that part first, at most three; of those that part at one time the one nearest to the cause."""
    parted = [one for one in compare_channels(before, now, APART) if _time(one) is not None]
    return sorted(parted, key=lambda one: _time(one) or 0.0)[:MOST_CHANNELS]


def _time(one: ChannelDifference) -> float | None:
    """First time at which a channel parts by more than a little [s]."""
    times = [one.tolerated.time if one.tolerated else None, one.only_one]
    return min((time for time in times if time is not None), default=None)


def _text(one: ChannelDifference) -> str:
    at = one.tolerated
    if at is None or (one.only_one is not None and one.only_one < at.time):
        return f"{one.topic} at {one.only_one:.3f} s: only one run has a message there"
    before, now = distinct_texts(at.a, at.b)
    return f"{one.topic} {at.field} at {at.time:.3f} s: {before} -> {now}"


def _moment(before: Log, now: Log, partings: Sequence[Parting]) -> float:
    """The end of the stage in which two runs first part, as far as both logs reach; without one see `_farthest` [s]."""
    last = min(log.time_range()[1] for log in (before, now))
    return min(partings[0].end if partings else _farthest(before, now), last)


def _farthest(before: Log, now: Log) -> float:
    """Time at which the CoMs of two runs are farthest apart [s]."""
    both = [log["/truth"] for log in (before, now)]
    rows = min(map(len, both))
    apart = np.linalg.norm(both[1].field("com")[:rows] - both[0].field("com")[:rows], axis=1)
    return float(both[0].time[np.argmax(np.nan_to_num(apart))]) if rows else 0.0


def draw(before: Log, now: Log, time: float) -> "list[Image]":
    """Pictures of two runs at a time [s] by one camera, which sees both robots.

    Raises:
        LogError: a log holds no robot, or nothing at that time.
        RenderingUnavailableError: the machine has no off-screen OpenGL.
    """
    from surefoot.scenarios.show.replay.content import ReplayWindow
    from surefoot.scenarios.show.replay.extract import extract
    from surefoot.scenarios.show.replay.video import CAMERA, WIDER

    window = ReplayWindow(max(time - 1.0 / _FRAMES, 0.0), time, frame_rate=_FRAMES)
    replays = [extract(log, window) for log in (before, now)]
    places = [replay.followed()[-1] for replay in replays]
    apart = float(np.linalg.norm(places[1] - places[0]))
    camera = replace(CAMERA, distance=CAMERA.distance + WIDER * apart)
    return [_picture(replay, camera, (places[0] + places[1]) / 2) for replay in replays]


def _picture(replay: "Replay", camera: "Camera", look_at: "Array") -> "Image":
    from surefoot.scenarios.show.replay.video import QUALITY, marks_of
    from surefoot.sim.render import render_frames

    marks = [marks_of(replay, len(replay) - 1)]
    (picture,) = render_frames(replay.mjcf, replay.configuration[-1:], SIZE, camera, QUALITY, marks, [look_at])
    return picture


def _png(picture: "Image") -> bytes:
    from matplotlib.image import imsave

    drawn = BytesIO()
    imsave(drawn, picture, format="png")
    return drawn.getvalue()
