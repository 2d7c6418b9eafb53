"""What is known of horizon and preview before the motion is planned."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import ExternalLoad
from surefoot.planner.geometry import greatest
from surefoot.planner.model.dcm import natural_frequency
from surefoot.planner.model.time_scaling import Course, TimeScaling
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import HeightPreview, HeightProfile, preview_height
from surefoot.planner.references.height_transition import HeightTransition
from surefoot.planner.references.leg_offset import LegOffset, softening
from surefoot.planner.references.zmp_reference import (
    Support,
    SupportKey,
    ZmpReference,
    load_left,
    present_support,
    zmp_reference,
)
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import GRAVITY, Array


@dataclass(frozen=True, slots=True)
class OffsetTable:
    """What the swing leg adds to the ZMP over a window and some samples more: planner state that outlives a tick.

    It was made for the CoM of its first tick; the offset hardly depends on it (see `planner.references.leg_offset`). So
    a plan depends on the ticks before it not only by the jerk and the swing that go on, but by at most `ticks` - 1 of
    them in this as well.

    Attributes:
        start: tick of the clock that it was made at.
        key: of the support then, whose plan frame is that of the values.
        course: of the clock's last time scaling.
        aim: where a swing goes that deviated from its step then, shape (3,) [m].
        values: shape (m, 2) [m].
        ticks: for which it serves.
    """

    start: int
    key: SupportKey
    course: Course
    aim: Array | None
    values: Array
    ticks: int

    def holds(self, clock: TimeScaling, key: SupportKey, aim: Array | None, apart: float) -> bool:
        """Whether it still serves: the same support, footholds and clock, aims so far apart, and few ticks later."""
        ticks = clock.ticks
        if self.key != key or self.course != clock.course or not self.start < ticks < self.start + self.ticks:
            return False
        if aim is None or self.aim is None:
            return aim is self.aim
        return bool(greatest(np.abs(aim - self.aim)) <= apart)

    def guess(self, ticks: int, key: SupportKey, count: int) -> Array | None:
        """About what the next one will be, shape (count, 2) [m]; None where the last one tells nothing of it."""
        passed = ticks - self.start
        if self.key != key or passed >= len(self.values):
            return None
        values = self.values[passed : passed + count]
        return np.concatenate((values, np.repeat(values[-1:], count - len(values), axis=0)))

    def since(self, ticks: int, count: int) -> Array:
        """So many offsets from a tick at which it holds, shape (count, 2) [m]."""
        return self.values[ticks - self.start : ticks - self.start + count]


@dataclass(frozen=True, slots=True)
class Window:
    """References over the window of one tick, in the plan frame.

    Attributes:
        reference: ZMP reference that the footsteps define.
        driving: what of it drives the pendulum: the reference less `offset`.
        offset: what the swing leg and a lasting force add to the ZMP, shape (n, 2) [m].
        height: CoM height.
        stiffness: λ of the pendulum, softened by the legs' masses, shape (n,) [1/s^2].
        omega: ω of its DCM, shape (n,) [1/s].
        load_left: planned share of the weight on the left foot, shape (n,) [-].
        contacts: planned contacts (left, right), shape (n, 2).
    """

    reference: ZmpReference
    driving: ZmpReference
    offset: Array
    height: HeightPreview
    stiffness: Array
    omega: Array
    load_left: Array
    contacts: NDArray[np.bool_]


Beyond = tuple[PhaseSamples, Array, HeightPreview]
"""The walk at all samples that are looked at: phases, with a sample before and one after, ZMP [m], and CoM height."""


def lean(lasting: ExternalLoad, rotation: Array, height: HeightPreview) -> Array:
    """What a lasting force adds to the ZMP, by which the body has to lean into it, in the plan frame.

    The moment balance about the ZMP (see `planner.references.leg_offset`) with a force m f on the body and its moment
    m n about the CoM has, with h = c_z - p_z and λ = (g + z'') / h,

        p_x = c_x - c_x'' / λ + f_x / λ + n_y / (g + z''),      p_y = c_y - c_y'' / λ + f_y / λ - n_x / (g + z'').

    Args:
        lasting: the force, per mass.
        rotation: plan frame to world, shape (2, 2).
        height: CoM height over n samples.

    Returns:
        Shape (n, 2) [m].
    """
    x, y = lasting.moment[:2].tolist()
    turning = np.array([y, -x]) @ rotation
    pressing = GRAVITY + height.height[2]
    return np.asarray(lasting.force[:2] @ rotation / height.stiffness[:, None] + turning / pressing[:, None])


class ReferencePreview:
    """Looks ahead along a walk.

    Args:
        gait: the walk.
        profile: law of its CoM height.
        parameters: of the planner.
        half_size: half of the sole's length and width, shape (2,) [m].
    """

    def __init__(
        self, gait: GaitParameters, profile: HeightProfile, parameters: PlannerParameters, half_size: Array
    ) -> None:
        self._gait, self._profile, self._half_size = gait, profile, half_size
        self._leg, self._margin, self._sample_time = parameters.leg, parameters.foot_margin, parameters.sample_time
        self._count, self._length = parameters.horizon + parameters.preview + 1, parameters.size.length
        self._room = parameters.cop_room
        self._numbers = parameters.recovery
        self._offsets: OffsetTable | None = None
        self._legs: LegOffset | None = None
        if self._leg.chain is not None:
            self._legs = LegOffset(self._leg, float(half_size[0]), parameters.sample_time, self.reach)
        # Of the last plan its tick, the course of the clock, the height, and how much lower than by its law that is.
        self._transition: HeightTransition | None = None
        self._before: tuple[int, Course, Array, float] | None = None
        self._softening = softening(self._leg)

    @property
    def reach(self) -> int:
        """Samples that are looked at: offsets serve for some ticks, at the last of which they are to cover a window."""
        return self._count + self._numbers.offset_ticks - 1

    def support(self, execution: Execution) -> Support:
        """What carries the robot now."""
        return present_support(execution, self._half_size, self._margin, self._room)

    def window(
        self,
        execution: Execution,
        support: Support,
        position: Array,
        time: float,
        lasting: ExternalLoad | None = None,
    ) -> Window:
        """The window that begins now, as the clock goes.

        Args:
            execution: the clock and the steps in sight.
            support: what carries the robot now, with the plan frame.
            position: CoM now in the plan frame, shape (2,) [m].
            time: now [s].
            lasting: force that goes on acting on the body.
        """
        samples, count = execution.samples(self.reach), self._count
        # The paper's ZMP planner, and its vertical motion planner with the varying dynamics.
        whole = zmp_reference(samples, support.table).part(slice(1, self.reach + 1))
        on = partial(self._transferred, execution)
        high = preview_height(self._profile, self._gait, samples, support.heights, whole.height, self._length, on)
        offset = self._offset(execution, (samples, whole.point, high), support, position, time, lasting)
        reference, height, window = whole.part(slice(count)), high.part(count), slice(1, count + 1)
        stiffness = self._softening * height.stiffness
        if lasting is not None:
            offset = offset + lean(lasting, support.rotation, height)
        return Window(
            reference=reference,
            driving=ZmpReference(reference.point - offset, reference.gain, reference.half_size, reference.height),
            offset=offset,
            height=height,
            stiffness=stiffness,
            omega=natural_frequency(stiffness, self._sample_time),
            load_left=load_left(samples, support.on_left)[window],
            contacts=samples.contacts[window],
        )

    def _transferred(self, execution: Execution, height: Array) -> Array | None:
        """The height where a step that is adapted has changed how the clock goes or set it, or is too long for it.

        It is None where that is by its law.

        Args:
            execution: the clock and the steps in sight.
            height: z, z', z'' by its law, shape (3, n), which is overwritten.
        """
        clock, lower, leaves, numbers = execution.clock, execution.lowering, False, self._numbers
        course, law = clock.course, height
        if self._before is not None:
            tick, followed, before, low = self._before
            pushed = execution.adapted or self._transition is not None or not clock.coefficients
            leaves = followed != course and pushed
            leaves |= abs(lower - low) > numbers.same_height or (low > 0.0) is not (lower > 0.0)
            lower = lower if leaves else low
        if lower:
            height[0] -= lower
        if leaves:
            state = before[:, min(clock.ticks - tick, 1)]
            left, t = execution.left, self._sample_time
            transition = HeightTransition.onto(height, state, clock.ticks, left, t, numbers.lifting)
            self._transition = transition
        if self._transition is not None:
            if clock.ticks >= self._transition.start + self._transition.samples:
                self._transition = None
            else:
                height = self._transition.over(height, clock.ticks)
        self._before = clock.ticks, course, height[:, :2].copy(), lower
        return None if height is law and not lower else height

    def _offset(
        self,
        execution: Execution,
        beyond: Beyond,
        support: Support,
        position: Array,
        time: float,
        lasting: ExternalLoad | None,
    ) -> Array:
        """What the legs add to the ZMP, shape (n, 2) [m]; `beyond` is the walk ahead, others are those of `window`."""
        count, clock = self._count, execution.clock
        if self._legs is None:
            return np.zeros((count, 2))
        last, table, key, aim = execution.schedule.phases[-1], self._offsets, support.key, execution.aim
        # In the final standing, where the walk's clock does not matter, none serves: its values go on with time.
        left = last.start - clock.now if math.isinf(last.samples) else math.inf
        # A swing that a command retimes is laid anew at every tick, by what the clock shows then.
        serves = left > 0.0 and (clock.steady or execution.adapted)
        if table is None or not serves or not table.holds(clock, key, aim, self._numbers.same_swing):
            # No longer than until the robot stands will they serve.
            count += int(min(self._numbers.offset_ticks - 1, max(left, 0.0) + 1))
            samples, point, height = beyond
            point = point if lasting is None else point - lean(lasting, support.rotation, height)
            frame = support.rotation, support.origin
            flown = None if execution.swing is None or aim is None else (execution.swing, time)
            moving = samples, execution.aimed, frame, flown
            # While a step is adapted it is made from the last one.
            guess = None
            if table is not None and (aim is not None or not clock.steady):
                guess = table.guess(clock.ticks, key, count)
            values = self._legs.made(moving, point[:count], height.part(count), position, guess)
            table = self._offsets = OffsetTable(clock.ticks, key, clock.course, aim, values, self._numbers.offset_ticks)
        return table.since(clock.ticks, self._count)
