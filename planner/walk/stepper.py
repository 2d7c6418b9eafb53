"""The way of a walk through the phases in sight, and its swing foot."""

import math
from dataclasses import dataclass, replace

import numpy as np

from surefoot.planner.geometry import frame_rotation, sole_pose, wrap_angle
from surefoot.planner.parameters import StepAdaptation
from surefoot.planner.references.com_height import LIFTING
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.swing.trajectory import LEAST_GLIDE, SwingTrajectory, start_swing, swing_times
from surefoot.planner.types import Array, FeetState, Foot, Footstep, PhaseInfo, PhaseKind, PlannedFootstep
from surefoot.planner.walk.footsteps import FootstepPlan
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.hurry import PEAK, around_stance_leg
from surefoot.planner.walk.phases import CLOCK_ROUNDING, Clock, PhaseSamples
from surefoot.planner.walk.queue import StepQueue
from surefoot.planner.walk.reach import Legs, turned_room
from surefoot.planner.walk.source import StepSource

_LEAST_LEFT = 3.0
"""A phase of which less is left, or would be, until its foot is to touch down keeps its pace [samples]."""

_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again, of the reference robot [m]."""

_SAME_TIME = 1e-3
"""Difference of a phase's time left that is not worth another pace, likewise [s]."""

_SAME_TARGET = 1e-4
"""Difference of touchdown pose that is not worth a new swing trajectory, likewise [m, rad]."""


@dataclass(frozen=True, slots=True)
class Deviation:
    """A swing that does not go as its step was laid.

    Attributes:
        swing: its trajectory.
        time: now [s].
        footsteps: footholds in sight, with its own where it is aimed at.
    """

    swing: SwingTrajectory
    time: float
    footsteps: FootstepPlan


class Stepper:
    """Advances the phases one sample per tick and books the touchdowns.

    A touchdown that is late holds the clock at the end of single support; an early one fixes its footstep where it was
    felt and never moves the clock (moving it was measured to cost 17 to 28 mm of DCM error).

    Args:
        queue: the steps in sight.
        window: how far a plan looks ahead [samples].
        legs: what they can do; None where it is not known.

    Attributes:
        queue: the steps in sight.
        revision: how often the footholds have changed.
        landed: number of the step that landed last.
        sample_time: length of a sample [s].
        clock: the gait's.
        phase: the phase now.
        swing: trajectory of the swing foot; None without one.
        waited: ticks for which the clock has waited for the present touchdown.
        early: the swing foot has landed before its time.
        fixed: the next footstep may not be shifted any more.
        adapted: place or time of the next footstep are being adapted.
        stride: of the step that is being adapted, or was before the present double support; zero without [m].
        wide: whether footsteps may land anywhere in reach, and those after them are shifted with them.
        adapts: whether footsteps may be adapted at all.
    """

    def __init__(self, queue: StepQueue, window: int, legs: Legs | None = None) -> None:
        self.queue, self._legs = queue, legs
        self._window, self._terrain, self._parameters = window, queue.ground.terrain, queue.ground.parameters
        parameters = self._parameters
        self.revision = 0
        self.landed = 0
        self.swing: SwingTrajectory | None = None
        self.waited = 0
        self.early = False
        self.fixed = False
        self.adapted = False
        self.stride = 0.0
        self.wide = self._terrain.free_footholds
        # Where footsteps were chosen for the faces that they land on it takes legs that are known to move them.
        adapts = parameters.step_adaptation is not StepAdaptation.NONE
        self.adapts = adapts and (self.wide or legs is not None)
        self.sample_time, self._size = parameters.sample_time, parameters.size
        self._pose = np.repeat([self._size.length, 1.0], 3)
        self._lead = parameters.touchdown_lead / parameters.sample_time
        self.clock = Clock(self.sample_time)
        self._patience = round(parameters.late_touchdown / parameters.sample_time)
        self._look_ahead(0.0)

    @property
    def footsteps(self) -> FootstepPlan:
        """Footholds in sight, landed ones as measured."""
        return self.queue.footsteps

    @property
    def row(self) -> int:
        """Row of the foot that landed last; it is the stance foot in single support."""
        return self.landed + 1 - self.footsteps.first

    @property
    def info(self) -> PhaseInfo:
        """The phase now, in seconds."""
        phase, t = self.phase, self.sample_time
        follows = phase if phase.stance is not None else self.queue.phase(phase.end)
        leads_to = follows.step if follows.stance is not None else 0
        elapsed, duration = (self.clock.now - phase.start) * t, phase.samples * t
        return PhaseInfo(phase.kind, phase.stance, phase.step, elapsed, duration, leads_to, self.time_left)

    @property
    def swing_foot(self) -> Foot | None:
        """The swinging foot in single support."""
        stance = self.phase.stance
        return None if stance is None else stance.other

    @property
    def remaining(self) -> int:
        """Footsteps in sight that have not landed."""
        return len(self.footsteps.feet) - 1 - self.row

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether the next two footsteps exist and may be shifted."""
        remaining = self.remaining
        return (self.adapts and remaining >= 1 and not self.fixed, self.adapts and remaining >= 2)

    @property
    def left(self) -> float:
        """Time until the present phase ends [samples]."""
        return self.clock.until(self.phase.end)

    @property
    def time_left(self) -> float:
        """Time until the present phase ends [s]."""
        return self.left * self.sample_time

    @property
    def transfer_time(self) -> float:
        """Duration of the double support that follows a single support, zero in other phases [s]."""
        phase = self.phase
        if phase.kind is not PhaseKind.SINGLE:
            return 0.0
        return self.queue.phase(phase.end).samples * self.sample_time

    def samples(self, count: int) -> PhaseSamples:
        """The phases at `count` samples from now on, with one more before them and one after."""
        return self.queue.samples(self.clock.flow(np.arange(-1.0, count + 1)))

    def room(self, ahead: int) -> Array:
        """By which the next footstep (0) or a later one may be moved on its face.

        Returns:
            Least and greatest way in the heading of the foot that landed last, shape (2, 2) [m].
        """
        step = self.queue.steps[self.landed + 1 + ahead]
        way = (self.footsteps.position[self.row + 1 + ahead] - step.place.position)[:2] @ frame_rotation(step.place.yaw)
        return turned_room(step.room - way, step.place.yaw - float(self.footsteps.yaw[self.row]))

    @property
    def quickest(self) -> float:
        """Shortest time in which body and foot can come to the height of the next footstep [s].

        Zero where no legs are known.
        """
        step = self.queue.steps[self.landed + 1]
        if self._legs is None:
            return 0.0
        return math.sqrt(max(PEAK * abs(step.lift) / LIFTING, step.hardest / self._legs.acceleration[0]))

    @property
    def may_cross(self) -> bool:
        """Whether the next footstep may lie beyond its stance foot, as far as the ground is concerned.

        A leg that lets the body down from its face has its knee in the way.
        """
        return self.wide or self.queue.steps[self.landed + 1].lift >= 0.0

    @property
    def climbs_next(self) -> bool:
        """Whether a foot swings, on faces that footsteps were chosen for, and the step after it climbs."""
        step = self.queue.steps.get(self.landed + 2)
        return self.swing_foot is not None and not self.wide and step is not None and step.climb != 0.0

    def turn(self, ahead: int) -> float:
        """Heading of the next footstep (0) or a later one against the one before it; zero where there is none [rad]."""
        yaws = self.footsteps.yaw[self.row + ahead : self.row + ahead + 2]
        return wrap_angle(float(yaws[1] - yaws[0])) if len(yaws) == 2 else 0.0

    @property
    def stands(self) -> bool:
        """Whether no foot is to swing before the robot stands, which may be moved to step."""
        return self.adapts and self.info.leads_to == 0 and self.stops

    @property
    def stops(self) -> bool:
        """Whether the robot stands, or will with the next step that lands."""
        return self.queue.stops(self.phase)

    @property
    def astride(self) -> float:
        """How far from where it was to the robot has one foot from the other, if it stands; else zero [m]."""
        if self.phase.kind is not PhaseKind.STAND:
            return 0.0
        here, place = self.footsteps.position, [self.queue.steps[self.landed - back].place.position for back in (0, 1)]
        return float(np.hypot(*(here[self.row] - here[self.row - 1] - place[0] + place[1])[:2]))

    def go_on(self, foot: Foot | None = None, at_once: bool = True) -> None:
        """Make a step on the spot where the robot stands or would stand next (see `StepQueue.go_on`)."""
        self.queue.go_on(self.phase, foot, at_once)
        self.revision += 1
        self._look_ahead(self.clock.now)

    def step_again(self) -> None:
        """Make a step with each foot where it is, before the next one (see `StepQueue.step_again`)."""
        self.queue.step_again(self.phase)
        self.revision += 1
        self._look_ahead(self.clock.now)

    def change(self, gait: GaitParameters, source: StepSource | None, time: float) -> None:
        """Walk on otherwise; what is left of the present phase changes in proportion to its duration.

        Args:
            gait: gives durations and swing height of the steps to come; the durations from now on.
            source: of the steps to come; the present one if None.
            time: now [s].
        """
        before = self.queue.gait
        gait = replace(gait, first_foot=before.first_foot)
        if (gait.single_support, gait.double_support) != (before.single_support, before.double_support):
            self._retime(gait, time)
        self.queue.gait = gait
        if source is not None or gait.swing_height != before.swing_height:
            self.queue.reorder(self.phase, source)
            self.revision += 1
            self._look_ahead(self.clock.now)

    def _retime(self, gait: GaitParameters, time: float) -> None:
        left, phase, now = self.time_left, self.phase, self.clock.now
        length, way = self.queue.retime(gait, phase, now), phase.end - now
        lasting = length * way / phase.samples
        if phase.kind is not PhaseKind.STAND and min(way, lasting) >= _LEAST_LEFT + self._lead:
            self.clock.take(way, lasting)
        self.revision += 1
        self._look_ahead(now)
        if self.swing is not None and self.time_left != left:
            self.swing = self.swing.retimed(time, self.time_left - left, self.sample_time)

    def end_in(self, left: float, time: float) -> bool:
        """Let the present phase end at another time, or as near to it as the clock can (see `Pace.over`).

        Args:
            left: time from now on [s].
            time: now [s].

        Returns:
            Whether that is another one than before.
        """
        before = self.time_left
        if abs(left - before) < _SAME_TIME * self._size.time:
            return False
        self.clock.take(self.phase.end - self.clock.now, left / self.sample_time)
        self._look_ahead(self.clock.now)
        if self.swing is not None:
            self.swing = self.swing.retimed(time, self.time_left - before, self.sample_time)
        return True

    @property
    def aim(self) -> Array | None:
        """Where a swing goes that deviates from its step, shape (3,) [m]; None where none does."""
        return None if self.swing is None or not (self.adapted or self.swing.bent) else self.swing.target[:3]

    def deviation(self, time: float) -> Deviation | None:
        """How the swing deviates from its step; None where it does not.

        Args:
            time: now [s].
        """
        if self.swing is None or self.aim is None:
            return None
        aimed = self.footsteps
        if not self.fixed:
            aimed = aimed.moved(self.row + 1, self.aim, self._terrain)
        return Deviation(self.swing, time, aimed)

    def advance(self, feet: FeetState) -> None:
        """Go on by one tick.

        Args:
            feet: the measured feet.
        """
        following, _, _ = self.clock.after(1.0)
        phase, swing = self.phase, self.swing_foot
        if swing is not None and self.clock.now >= 0.0:
            contact = feet.contact[swing]
            if following >= phase.end - CLOCK_ROUNDING:
                if not contact and self.waited < self._patience:
                    self.waited += 1
                    return
                self._land(feet.position[swing])
            elif contact and not self.early and 2.0 * (following - phase.start) > phase.samples:
                self.early = True
                self.fix(feet.position[swing])
        self.clock.advance()
        if following >= phase.end - CLOCK_ROUNDING:
            self.queue.enter(following)
        if following >= phase.end - CLOCK_ROUNDING or phase.samples == np.inf:
            self._look_ahead(following)
        if self.swing_foot is None:
            self.swing = None

    def _look_ahead(self, clock: float) -> None:
        """See as far as any plan of the phase at an instant on the clock looks; a step ordered may end a stand."""
        more = self.queue.extend(clock + self._window, clock)
        self.phase = self.queue.phase(clock)
        if self.phase.samples < np.inf:
            more |= self.queue.extend(self.phase.end + self._window, clock)
        self.revision += more

    def upcoming(self, time: float, shifts: Array) -> tuple[PlannedFootstep, ...]:
        """The next footsteps, at most three.

        Args:
            time: now [s].
            shifts: shifts of the first two from their nominal increments, in the world frame, shape (2, 2) [m].
        """
        steps, planned = self.footsteps, []
        shift = np.zeros(2)
        for ahead, row in enumerate(range(self.row + 1, min(self.row + 4, len(steps.feet)))):
            position, normal = steps.position[row].copy(), steps.normal[row]
            if ahead < 2 and self.free[ahead]:
                shift = shift + shifts[ahead] if self.wide else shifts[ahead]
            elif not self.wide:
                shift = np.zeros(2)
            position[:2] += shift
            if abs(shift[0]) + abs(shift[1]) > _SAME_GROUND * self._size.length:
                x, y = float(position[0]), float(position[1])
                position[2] = self._terrain.height(x, y)
                normal = self._terrain.normal(x, y) if self._terrain.has_edges else normal
            footstep = Footstep(steps.feet[row], position, float(steps.yaw[row]), normal)
            step = self.landed + 1 + ahead
            left = self.clock.until(self.queue.lift_off(step).end)
            planned.append(PlannedFootstep(step, footstep, time + left * self.sample_time))
        return tuple(planned)

    def fix(self, position: Array) -> None:
        """Decide the next footstep.

        Args:
            position: where it lands, shape (3,) [m].
        """
        self.queue.footsteps = self.footsteps.moved(self.row + 1, np.array(position), self._terrain)
        self.revision += 1
        self.fixed = True

    def _land(self, position: Array) -> None:
        self.fix(position)
        self.landed += 1
        if self.adapted and self._legs is not None:
            self.queue.lift_heel(self.landed, self._legs.radius)
            if not self.wide:
                self.queue.go_beside(self.landed)
                self.revision += 1
        self.waited, self.early, self.fixed, self.adapted = 0, False, False, False

    def fix_imminent(self, time: float) -> None:
        """Decide the next footstep where its foot now lands, shortly before it does."""
        if self.swing is None or self.fixed:
            return
        if self.swing.touchdown_time - time <= self._parameters.freeze_time + 1e-9:
            self.fix(self.swing.target[:3])

    def swing_to(self, landing: Footstep, time: float, feet: FeetState, held: bool) -> None:
        """Let the swing foot go on to where it is to land; asked in single support only.

        Args:
            landing: the footstep.
            time: now [s].
            feet: the measured feet, from one of which a swing begins.
            held: keep to the target of before.
        """
        target = sole_pose(landing.position, landing.yaw, landing.normal)
        self.stride = math.dist(landing.position, self.footsteps.position[self.row]) if self.adapted else 0.0
        if self.swing is None:
            foot, leaving = landing.foot, self.footsteps.footstep(self.row - 1)
            yaw = leaving.yaw + wrap_angle(float(feet.yaw[foot]) - leaving.yaw)
            pose = sole_pose(feet.position[foot], yaw, leaving.normal)
            course = self.queue.steps[self.phase.step].course
            times = swing_times(time, self.left, course, self._parameters)
            self.swing = start_swing(foot, pose, target, times, course.height, self._parameters)
        elif not (self.fixed or held) and (np.abs(target - self.swing.target) / self._pose).max() > _SAME_TARGET:
            # Over edges the foot keeps to the times in which its course clears them.
            self.swing = self.swing.retargeted(time, target, self.adapted and self.wide, LEAST_GLIDE * self._size.time)
        if self.adapted and self.swing.search.hurry_after > 0.0:
            # While a foot that is to catch the body searches for the ground the DCM goes on away from it.
            self.swing = replace(self.swing, search=replace(self.swing.search, hurry_after=0.0))
        if self._legs is not None:
            stance = self.footsteps.footstep(self.row)
            self.swing = around_stance_leg(self.swing, stance, self._legs, time, self.sample_time)

    @property
    def lowering(self) -> float:
        """How much lower than by its law the CoM is to be for the legs to span the step that is adapted [m]."""
        return self._legs.lowering(self.stride) if self.wide and self._legs is not None and self.stride else 0.0

    def roll(self, time: float) -> FootRoll | None:
        """Pitch of the foot that leaves the ground next or has just left it; None for one that stays level."""
        span, now = self.phase.roll, self.clock.now
        if span is None or now >= span.end:
            return None
        foot = self.queue.gait.step_foot(self.phase.row)
        start, end = (time + (at - now) * self.sample_time for at in span[:2])
        return FootRoll(foot, start, end, span.angle, float(self.queue.ground.half_size[0]), self.clock.hurry(time))
