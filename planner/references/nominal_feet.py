"""The motion of both feet over a window as steps are planned, on which the momentum of the legs depends."""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.geometry import quintic
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.steps.phases import Phase, PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import unit_swing
from surefoot.planner.swing import rolling
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import Array, PhaseKind

_SUNK = 3e-4
"""Height by which a footstep may be off the end of its swing: twice what soles sink, of the reference robot [m]."""

Moving = tuple[PhaseSamples, Schedule, tuple[Array, Array], tuple[SwingTrajectory, float] | None]
"""Arguments of the motion of feet: see `NominalFeet.move`."""


class NominalFeet:
    """Feet over the samples of a window, in the plan frame, the left one first.

    Args:
        count: samples for which there is room.

    Attributes:
        soles: their centres as if they were level, shape (2, count, 3) [m].
        heading: shape (2, count) [rad].
        pitch: heel up, about their toe edges, or negative about their heel edges, shape (2, count) [rad].
    """

    def __init__(self, count: int) -> None:
        self.soles, self.heading, self.pitch = np.zeros((2, count, 3)), np.zeros((2, count)), np.zeros((2, count))
        self._soles, self._heading, self._pitch = self.soles, self.heading, self.pitch

    def move(
        self,
        count: int,
        samples: PhaseSamples,
        schedule: Schedule,
        frame: tuple[Array, Array],
        flown: tuple[SwingTrajectory, float] | None = None,
    ) -> None:
        """Move the feet over so many samples, but for a swing that does not go as its step was laid.

        Args:
            count: samples.
            samples: the phases over a window.
            schedule: the steps in sight, landing where they are aimed at.
            frame: the plan frame's rotation to the world, shape (2, 2), and origin, shape (2,) [m].
            flown: that swing, and the time now [s].
        """
        self._which, self._elapsed, self._clock = samples.which, samples.elapsed, samples.clock
        (rotation, origin), position = frame, schedule.positions
        self._heading_of_frame = math.atan2(rotation[1, 0], rotation[0, 0])
        places = np.empty((len(position), 4))
        places[:, :2], places[:, 2], places[:, 3] = (position[:, :2] - origin) @ rotation, position[:, 2], schedule.yaws
        self._places, self._sample_time = places, samples.sample_time
        self._sunk = _SUNK * schedule.ground.parameters.size.length
        first = 0
        swing = None
        phases = samples.phases
        steps = schedule.steps
        begin = steps[0].number
        while first < count:
            end, phase = self._end_of_phase(first, count), phases[self._which[first]]
            row = phase.leaves - 1 - begin
            swings = 1 - steps[row].place.foot
            if phase.kind is PhaseKind.SINGLE:
                planned, late = swing_of(phase, schedule, self._elapsed[first])
                if swing is None or swing.of is not planned:
                    swing = UnitSwing(planned)
                self._swing(swing, late, first, end, row, swings)
            else:
                self._rest(first, end, row, swings)
            for foot, start, over, angle in phase.rolls:
                self._roll(start, over, angle, first, end, foot)
            first = end
        if flown is not None:
            foot = flown[0].foot
            _fly(self.soles[foot, :count], self.heading[foot, :count], samples, frame, *flown)

    def _end_of_phase(self, first: int, count: int) -> int:
        """The sample after the last one of a phase, of those that are moved over."""
        end = first + 1
        while end < count and self._which[end] == self._which[first]:
            end += 1
        return end

    def _rest(self, first: int, end: int, row: int, swings: int) -> None:
        """Both feet stand: one in its place, the other one where it stood before."""
        for k in range(first, end):
            self._put(k, row, swings, 0.0, 0.0)

    def _swing(self, swing: "UnitSwing", late: float, first: int, end: int, row: int, swings: int) -> None:
        """A foot swings from the place before one to the place after it, the other foot stands there.

        Where it lands higher or lower than its swing ends it goes there: standing there a sample later it would seem to
        accelerate.
        """
        before, after = self._around(row)
        over = self._places[after, 2] - self._places[before, 2] - swing.climb
        over = over if abs(over) > self._sunk else 0.0
        for k in range(first, end):
            t = (self._elapsed[k] - late) * self._sample_time
            progress = swing.progress(t)
            self._put(k, row, swings, progress, swing.height(t) + progress * over)

    def _put(self, k: int, row: int, swings: int, progress: float, height: float) -> None:
        """One foot in its place, the other one on its way, so far over the place before [m]."""
        before, after = self._around(row)
        P = self._places
        soles = self._soles
        heading = self._heading
        stands = 1 - swings
        for axis in range(3):
            soles[stands, k, axis] = P[row, axis]
        for axis in range(2):
            soles[swings, k, axis] = P[before, axis] + progress * (P[after, axis] - P[before, axis])
        soles[swings, k, 2] = P[before, 2] + height
        heading[stands, k] = P[row, 3] - self._heading_of_frame
        heading[swings, k] = P[before, 3] + progress * (P[after, 3] - P[before, 3]) - self._heading_of_frame
        self._pitch[0, k], self._pitch[1, k] = 0.0, 0.0

    def _around(self, row: int) -> tuple[int, int]:
        """Places before and after one; of the first one in sight nothing is known before it, and the last is taken."""
        last = self._places.shape[0] - 1
        return row - 1 if row > 0 else last, min(row + 1, last)

    def _roll(self, start: float, over: float, angle: float, first: int, end: int, foot: int) -> None:
        """Pitch of a foot that rolls between two instants of the clock, see `planner.swing.rolling.FootRoll`."""
        for k in range(first, end):
            self._pitch[foot, k] += angle * rolling.bump((self._clock[k] - start) / (over - start))[0]


class UnitSwing:
    """A swing of a step to a footstep one metre ahead, in its own time.

    Args:
        swing: itself. A foot that searches for the ground is expected to find it at once.

    Attributes:
        of: the swing.
        climb: how much higher the footstep is [m].
    """

    def __init__(self, swing: SwingTrajectory) -> None:
        self.of, self.climb = swing, swing.target[2]
        self._start, self._gliding = swing.start_time, swing.glide_end - swing.start_time
        self._falls, self._touches = swing.apex_time - TOUCHING, swing.touchdown_time - TOUCHING
        self._rise_start, self._fall_start = swing.rise_start, swing.fall_start
        self._glide, self._rise, self._fall = (
            tuple(way[:, 0].tolist()) for way in (swing.level, swing.rise, swing.fall)
        )
        self._end: float = swing.target[0]
        self._low: float = swing.target[2] - swing.search.motion(-TOUCHING)[0]

    def progress(self, t: float) -> float:
        """Progress at a time [s]: share of its way [-]."""
        if t >= self._touches:
            return self._end
        return quintic.value(self._glide, algebra.clamp(t - self._start, 0.0, self._gliding))

    def height(self, t: float) -> float:
        """Height over where it was lifted at a time [s] [m]."""
        if t >= self._touches:
            return self._low
        if t >= self._falls:
            return quintic.value(self._fall, t - self._fall_start)
        return quintic.value(self._rise, t - self._rise_start)


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


def swing_of(phase: Phase, schedule: Schedule, elapsed: float) -> tuple[SwingTrajectory, float]:
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
    return unit_swing(phase.samples - late, step.climb, step.course, schedule.ground.parameters), late
