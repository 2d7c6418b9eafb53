"""How both feet move over a window as steps are planned, on which the momentum of the legs depends."""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from surefoot.native.library import Library
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.steps.phases import Phase, PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import Step, unit_swing
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.heel_off import RollSpan, bump
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import Array, Foot, PhaseKind

_SUNK = 3e-4
"""Height by which a footstep may be off the end of its swing: twice what soles sink, of the reference robot [m]."""

Feet = tuple[Array, Array, Array]
"""Nominal motion of both feet over n samples, in the plan frame, the left one first.

Soles' centres as if they were level, shape (2, n, 3) [m], their headings, shape (2, n) [rad], and their pitch about
their toe edges, shape (2, n) [rad].
"""


Moving = tuple[PhaseSamples, Schedule, tuple[Array, Array], tuple[SwingTrajectory, float] | None]
"""What feet are to move by: see `nominal_feet`."""


def nominal_feet(
    samples: PhaseSamples,
    schedule: Schedule,
    frame: tuple[Array, Array],
    flown: tuple[SwingTrajectory, float] | None = None,
) -> Feet:
    """Nominal feet in the plan frame, but for a swing that does not go as its step was laid.

    Args:
        samples: the phases over a window.
        schedule: the steps in sight, landing where they are aimed at.
        frame: the plan frame's rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        flown: that swing, and the time now [s].
    """
    (rotation, origin), position = frame, schedule.positions
    points = np.column_stack(((position[:, :2] - origin) @ rotation, position[:, 2], schedule.yaws))
    row = np.array([schedule.index(phase.leaves - 1) for phase in samples.phases])[samples.which]
    progress, height, rolled = _swings(samples, schedule)
    before, after = points[row - 1], points[np.minimum(row + 1, len(points) - 1)]
    stance, swing = points[row], before + progress[:, None] * (after - before)
    swing[:, 2] = before[:, 2] + height
    if flown is not None:
        _fly(swing[:, :3], swing[:, 3], samples, frame, *flown)
    left = np.array([step.place.foot is Foot.LEFT for step in schedule.steps])[row]
    soles = np.where(np.stack((left, ~left))[..., None], stance, swing)
    pitch = rolled * np.stack((~left, left))
    return soles[..., :3], soles[..., 3] - np.arctan2(rotation[1, 0], rotation[0, 0]), pitch


def _over(row: int, swing: SwingTrajectory, schedule: Schedule) -> float:
    """How far over its swing's end a foot lands [m]: standing there a sample later it would seem to accelerate."""
    height = schedule.positions[:, 2]
    over = float(height[min(row + 1, len(height) - 1)] - height[row - 1] - swing.target[2])
    return over if abs(over) > _SUNK * schedule.ground.parameters.size.length else 0.0


def _fly(
    soles: Array,
    heading: Array,
    samples: PhaseSamples,
    frame: tuple[Array, Array],
    trajectory: SwingTrajectory,
    time: float,
) -> None:
    """Put a foot where a trajectory has it; soles of shape (n, 3) [m] and heading of shape (n,) [rad] are changed."""
    (rotation, origin), which = frame, samples.which[: len(soles)]
    now = np.flatnonzero(which == which[1])
    now = now[now > 0]
    times = np.asarray(time + samples.sample_time * (now - 1.0), dtype=np.float64)
    way = trajectory.positions(times)
    soles[now, :2] = (way[:, :2] - origin) @ rotation
    soles[now, 2] = np.maximum(way[:, 2], trajectory.target[2])
    # Before now it was where it accelerates as it does now: its own past may be on another trajectory.
    for values in (soles, heading):
        values[0] = 2.0 * values[1] - values[2] if len(now) > 1 else values[1]
    if time < trajectory.touchdown_time:
        bend = trajectory.evaluate(time)[2, :3] * samples.sample_time**2
        soles[0] += np.append(bend[:2] @ rotation, bend[2])


def _swings(samples: PhaseSamples, schedule: Schedule) -> tuple[Array, Array, Array]:
    """Progress of the swing foot [-], height of its sole above lift-off [m] and its pitch [rad], shape (n,) each."""
    progress, height, pitch = np.zeros((3, len(samples.which)))
    for number in np.unique(samples.which).tolist():
        phase, here = samples.phases[number], samples.which == number
        if phase.kind is PhaseKind.SINGLE:
            swing, late = _swing(phase, schedule, float(samples.elapsed[here][0]))
            # A foot that searches for the ground is expected to find it at once.
            times = np.minimum((samples.elapsed[here] - late) * samples.sample_time, swing.touchdown_time - TOUCHING)
            way = swing.positions(times)
            over = _over(schedule.index(phase.leaves - 1), swing, schedule)
            progress[here], height[here] = way[:, 0], way[:, 2] + over * way[:, 0]
        if phase.roll is not None:
            start, end, angle = phase.roll
            share = (samples.clock[here] - start) / (end - start)
            pitch[here] = [angle * bump(s)[0] for s in share.tolist()]
    return progress, height, pitch


def _swing(phase: Phase, schedule: Schedule, elapsed: float) -> tuple[SwingTrajectory, float]:
    """The swing of a single support, and how long after the phase it begins [samples].

    A foot is lifted by a plan. Of a phase that begins between two of them it has the rest, and swings the faster.

    Args:
        phase: the single support.
        schedule: the steps in sight.
        elapsed: how long it has lasted at one of the samples [samples].
    """
    step, late = schedule.step(phase.step), elapsed % 1.0
    if min(late, 1.0 - late) <= CLOCK_ROUNDING:
        return step.swing, 0.0
    return _rest_of(step, phase.samples - late, schedule.ground), late


@lru_cache(maxsize=16)
def _rest_of(step: Step, samples: float, ground: Ground) -> SwingTrajectory:
    """The swing of a step that has so many samples, the same from plan to plan."""
    return unit_swing(samples, step.climb, step.course, ground.parameters)


_LEVEL = RollSpan(0.0, 1.0, 0.0)
"""That of a foot that does not roll."""

_ROW = 34
"""Numbers by which the kernel knows a phase [-]."""


class CompiledFeet:
    """Kernel beside `nominal_feet`, and where it writes.

    Args:
        kernels: the library.
        sample_time: [s].
        most: samples over which feet may be moved.

    Attributes:
        arrays: soles, heading and pitch, of which the first samples are told: as of `Feet`, by name.
    """

    def __init__(self, kernels: Library, sample_time: float, most: int) -> None:
        self._which, (self._elapsed, self._clock) = np.empty(most, dtype=np.int64), np.empty((2, most))
        self._soles, self._heading, self._pitch = (np.empty((2, most, *size)) for size in ((3,), (), ()))
        self.arrays: dict[str, Any] = {"soles": self._soles, "heading": self._heading, "pitch": self._pitch}
        self._feet = kernels.fill(
            "NominalFeet",
            sample_time=sample_time,
            touching=TOUCHING,
            heading_of_frame=0.0,
            sunk=0.0,
            most=most,
            which=self._which,
            elapsed=self._elapsed,
            clock=self._clock,
            phases=self._clock,
            first=0,
            count=0,
            steps=self._clock,
            **self.arrays,
        )
        self._place = kernels.bind("nominal_feet_make", self._feet)
        # Of which phases there are rows, from one up to another; of which steps and plan frame the kernel is told.
        self._phases: tuple[Phase, ...] = ()
        self._rows, self._from, self._to = np.zeros((0, _ROW)), 0, 0
        self._placed: tuple[Schedule, Array] | None = None
        self._places = np.zeros((0, 4))

    def move(
        self,
        count: int,
        samples: PhaseSamples,
        schedule: Schedule,
        frame: tuple[Array, Array],
        flown: tuple[SwingTrajectory, float] | None,
    ) -> None:
        """Move the feet over so many samples; other arguments as of `nominal_feet`."""
        which, phases = samples.which[:count], samples.phases
        self._which[:count], self._elapsed[:count] = which, samples.elapsed[:count]
        self._clock[:count] = samples.clock[:count]
        first, last = which[[0, -1]].tolist()
        self.turn_to(phases, schedule, frame)
        # Phases beyond those asked for wait until they are: where all were laid at once, that plan took the longest.
        if not self._from <= first <= self._to:
            self._from = self._to = first
        if last >= self._to:
            self._lay(self._rows[self._to : last + 1], phases[self._to : last + 1], schedule)
            self._to = last + 1
        rows = self._rows[first : last + 1]
        elapsed = samples.elapsed[which.searchsorted(range(first, last + 1))].tolist()
        late = [gone % 1.0 for gone in elapsed]
        if any(CLOCK_ROUNDING < begun < 1.0 - CLOCK_ROUNDING for begun in late):
            rows = rows.copy()
            for row, phase, gone in zip(rows, phases[first : last + 1], elapsed, strict=True):
                if phase.kind is PhaseKind.SINGLE:
                    _swing_in(row, phase, schedule, gone)
        self._feet.point(phases=rows)
        self._place(count)
        if flown is not None:
            foot = flown[0].foot
            _fly(self._soles[foot, :count], self._heading[foot, :count], samples, frame, *flown)

    def turn_to(self, phases: tuple[Phase, ...], schedule: Schedule, frame: tuple[Array, Array]) -> None:
        """Look at other phases, or steps, or from another plan frame, from now on."""
        if phases is not self._phases:
            self._keep(phases)
        if self._placed is None or self._placed[0] is not schedule or self._placed[1] is not frame[0]:
            self._placed = schedule, frame[0]
            self._place_steps(schedule, frame)

    def _keep(self, phases: tuple[Phase, ...]) -> None:
        """Look at other phases, of which those have rows already that were seen before: the very same ones."""
        before, rows, gone = self._phases, np.empty((len(phases), _ROW)), 0
        while gone < len(before) and before[gone] is not phases[0]:
            gone += 1
        same = 0
        for one, other in zip(before[gone:], phases, strict=False):
            if one is not other:
                break
            same += 1
        rows[:same] = self._rows[gone : gone + same]
        self._phases, self._rows = phases, rows
        self._from, self._to = max(self._from - gone, 0), min(max(self._to - gone, 0), same)

    def _place_steps(self, schedule: Schedule, frame: tuple[Array, Array]) -> None:
        """Tell the kernel the places of steps."""
        (rotation, origin), position, struct = frame, schedule.positions, self._feet.struct
        self._places = places = np.empty((len(position), 4))
        places[:, :2], places[:, 2], places[:, 3] = (position[:, :2] - origin) @ rotation, position[:, 2], schedule.yaws
        struct.heading_of_frame = math.atan2(rotation[1, 0], rotation[0, 0])
        struct.first, struct.count = schedule.steps[0].number, len(position)
        struct.sunk = _SUNK * schedule.ground.parameters.size.length
        self._feet.point(steps=places)

    def _lay(self, rows: Array, phases: tuple[Phase, ...], schedule: Schedule) -> None:
        """Fill the rows of phases, shape (n, 34), with swings that begin with theirs."""
        heads = []
        for row, phase in zip(rows, phases, strict=True):
            stands, single = phase.leaves - 1, phase.kind is PhaseKind.SINGLE
            if single:
                _swing_in(row, phase, schedule, 0.0)
            right = schedule.step(stands).place.foot is Foot.RIGHT
            heads.append((stands, right, single, 0.0, *(phase.roll or _LEVEL)))
        rows[:, :7] = heads


def _swing_in(row: Array, phase: Phase, schedule: Schedule, elapsed: float) -> None:
    """Tell the swing of a single support in its row; see `_swing`."""
    swing, row[3] = _swing(phase, schedule, elapsed)
    row[7:] = _told(swing)


@lru_cache(maxsize=16)
def _told(swing: SwingTrajectory) -> Array:
    """The swing of a step as the kernel takes it, shape (27,)."""
    end, past = swing.target, swing.search.motion(-TOUCHING)[0]
    times = swing.start_time, swing.glide_end, swing.apex_time, swing.touchdown_time, swing.rise_start, swing.fall_start
    ways = swing.level[:, 0], swing.rise[:, 0], swing.fall[:, 0]
    return np.concatenate(((*times, end[0], end[2] - past), *ways, end[2:3]))
