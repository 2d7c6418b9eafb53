"""Axes of time: panels below each other, and behind all curves what happened: supports, pushes, a fall."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import SINGLE_SUPPORT, RunView, Window
from surefoot.scenarios.judge.walking import fall_time
from surefoot.scenarios.palette import BLACK, PUSH
from surefoot.scenarios.show.kit.figures import Area, heading, legend, or_say
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

_DOUBLE_SUPPORT = 1
_SINGLE_GREY, _DOUBLE_GREY = "#E4E4E4", "#F4F4F4"
_MOST = 400
"""Phases and pushes beyond this many are not drawn: a minute of walking shows them, an hour is grey anyway."""

_MOST_NAMED = 80
"""More phases than these leave no room for the name of each stance foot."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A time from its start to its end [s] in which a value lasted."""

    start: float
    end: float
    value: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Background:
    """The events in a window.

    Attributes:
        phases: with the phase and the stance foot as values.
        pushes: times with an external force.
        fall: time of a fall [s], None without one.
    """

    phases: tuple[Stretch, ...]
    pushes: tuple[Stretch, ...]
    fall: float | None

    def shade(self, axes: Iterable[Axes]) -> None:
        """Draw it behind all axes; the first of them also names the stance feet."""
        for number, one in enumerate(axes):
            start, end = one.get_xlim()
            seen = [phase for phase in self.phases if phase.end > start and phase.start < end]
            for stretch in seen:
                self._shade_phase(one, stretch, named=number == 0 and len(seen) <= _MOST_NAMED)
            for push in self.pushes:
                one.axvspan(push.start, push.end, color=PUSH, alpha=0.35, linewidth=0)
            if self.fall is not None:
                one.axvline(self.fall, color=BLACK, linewidth=1.2, linestyle=":")

    def handles(self) -> list[Patch | Line2D]:
        """Entries of the legend that explain it."""
        kinds = {stretch.value[0] for stretch in self.phases}
        entries: list[Patch | Line2D] = []
        if SINGLE_SUPPORT in kinds:
            entries.append(Patch(color=_SINGLE_GREY, label="single support (L, R: the stance foot)"))
        if _DOUBLE_SUPPORT in kinds:
            entries.append(Patch(facecolor=_DOUBLE_GREY, edgecolor="#C8C8C8", linewidth=0.4, label="double support"))
        if self.pushes:
            entries.append(Patch(color=PUSH, alpha=0.35, label="push"))
        if self.fall is not None:
            entries.append(Line2D([], [], color=BLACK, linewidth=1.2, linestyle=":", label="fall"))
        return entries

    @staticmethod
    def _shade_phase(axes: Axes, stretch: Stretch, named: bool) -> None:
        phase, stance = stretch.value
        if phase not in (SINGLE_SUPPORT, _DOUBLE_SUPPORT):
            return
        single = phase == SINGLE_SUPPORT
        axes.axvspan(stretch.start, stretch.end, color=_SINGLE_GREY if single else _DOUBLE_GREY, zorder=0, linewidth=0)
        if named and single and stance in (0, 1):
            middle, name = (stretch.start + stretch.end) / 2, FOOT_NAMES[stance][0].upper()
            place = axes.get_xaxis_transform()
            axes.text(
                middle, 0.985, name, transform=place, ha="center", va="top", fontsize=6.5, color="#6E6E6E", clip_on=True
            )


NOTHING = Background((), (), None)
"""Behind axes that are not of the time of one run."""


@dataclass(frozen=True, slots=True)
class Panel:
    """One of several axes below each other over one axis of time.

    Attributes:
        label: of its values, with their unit.
        draw: draws into it; what the log has not got is written there instead.
        columns: of its legend; 0 for none.
        height: over that of the others [-].
        handles: of its legend, beside those of its curves.
        in_parts: whether it is drawn part by part of a long log, each beside the one before.
    """

    label: str
    draw: Callable[[Axes, LogView], None]
    columns: int = 0
    height: float = 1.0
    handles: tuple[Patch, ...] = ()
    in_parts: bool = True

    def drawn(self, axes: Axes, view: LogView) -> None:
        """Draw a window.

        Raises:
            MissingError: no part of it has what is drawn.
        """
        missing, parts = [], list(view.parts()) if self.in_parts else [view]
        for part in parts:
            try:
                self.draw(axes, part)
            except MissingError as absent:
                missing.append(absent)
        if len(missing) == len(parts):
            raise missing[0]


def draw_panels(
    area: Area,
    view: LogView,
    behind: Background,
    title: str,
    panels: Sequence[Panel],
    stretch: tuple[float, float] | None = None,
) -> list[Axes]:
    """Draw panels under a title, if any, over a stretch of time, all by default [s]; gives their axes, top first."""
    heights = [panel.height for panel in panels]
    axes: list[Axes] = list(area.subplots(len(panels), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0])
    if title:
        heading(area, title)
    start, end = stretch or (view.start, view.end)
    margin = 1e-3 if end <= start else 0.0
    axes[-1].set_xlim(start - margin, end + margin)
    axes[-1].set_xlabel("time [s]")
    area.align_ylabels(axes)
    behind.shade(axes)
    for one, panel in zip(axes, panels, strict=True):
        one.set_ylabel(panel.label)
        with or_say(one):
            panel.drawn(one, view if stretch is None else view.within(*stretch))
        if panel.columns:
            legend(one, panel.columns, panel.handles)
    return axes


def background(view: LogView) -> Background:
    """Find the events in a window, as far as the log has them."""
    return Background(_phases(view), _pushes(view), _fall(view))


def stretches(time: np.ndarray, values: np.ndarray) -> tuple[Stretch, ...]:
    """Times in which a row of integers, shape (n, k), stayed the same, on a clock of shape (n,) [s]."""
    starts = np.flatnonzero(np.concatenate(([True], np.any(values[1:] != values[:-1], axis=1))))
    ends = np.append(starts[1:], len(time) - 1)
    rows = np.nan_to_num(values[starts]).astype(int).tolist()
    bounds = zip(time[starts].tolist(), time[ends].tolist(), rows, strict=True)
    return tuple(Stretch(start, end, tuple(row)) for start, end, row in bounds)


def _phases(view: LogView) -> tuple[Stretch, ...]:
    try:
        clock = [view.field("/reference", name) for name in ("phase", "stance")]
        found = stretches(view.time("/reference"), np.stack(clock, axis=1))
    except MissingError:
        return ()
    return found if len(found) <= _MOST else ()


def _pushes(view: LogView) -> tuple[Stretch, ...]:
    for topic in ("/measurement", "/truth"):
        try:
            pushed = np.any(np.nan_to_num(view.field(topic, "external_force", 3)) != 0.0, axis=1)
        except MissingError:
            continue
        found = [s for s in stretches(view.time(topic), pushed[:, None]) if s.value[0]]
        return tuple(found) if len(found) <= _MOST else ()
    return ()


def _fall(view: LogView) -> float | None:
    """Time of a fall in the window; not of one from before, after which the robot lies at its begin [s]."""
    try:
        run = RunView(Window(view.log, view.channels))
        time = fall_time(run) if run.has("/truth") else None
    except LogError:
        return None
    if time is None or not view.start <= time <= view.end:
        return None
    return time if time > run.time[0] or time <= view.log.time_range()[0] else None
