"""The execution of a schedule: the clock, the touchdowns that are felt, and the swing that is flown."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from surefoot.planner.geometry import greatest, sole_pose, wrap_angle
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING, TimeScaling
from surefoot.planner.steps import adaptation
from surefoot.planner.steps.beginning import in_sight
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import StepSource
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.swing.leg_reach import LegReach, around_stance_leg
from surefoot.planner.swing.trajectory import LEAST_GLIDE, SwingTrajectory, start_swing
from surefoot.planner.types import Array, FeetState, Footstep, PhaseInfo, PhaseKind

_LEAST_LEFT = 3.0
"""A phase of which less is left, or would be, until its foot is to touch down keeps its time [samples]."""

_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again, of the reference robot [m]."""

_SAME_TIME = 1e-3
"""Difference of a phase's time left that is not worth another time scaling, likewise [s]."""

_SAME_TARGET = 1e-4
"""Difference of touchdown pose that is not worth a new swing trajectory, likewise [m, rad]."""

_TOLD = 3
"""Footsteps to come that a plan tells [-]."""


class Execution:
    """Goes through a schedule one sample per tick.

    A touchdown that is late holds the clock at the end of single support. An early one fixes its footstep where it was
    felt. It does not move the clock: that was measured to cost 17 to 28 mm of DCM error. Single support of a step that
    catches the body may end with its touchdown (see `Recovery.landing`). A foot that lands short of the DCM on its own
    side goes on, where it may get there: its single support begins anew.

    Args:
        schedule, legs: see the attributes.
        window: how far a plan looks ahead [samples].

    Attributes:
        schedule: the steps in sight, which reach as far as any plan of the present phase looks.
        clock: that of the gait.
        phase: the phase now.
        landed: number of the step that landed last; its foot is the stance foot in single support.
        swing: trajectory of the swing foot; None without one.
        stops: whether the robot stands, or will with the next step that lands.
        waited: ticks for which the clock has waited for the present touchdown.
        early: the swing foot has landed before its time.
        fixed: the next footstep may not be shifted any more.
        adapted: place or time of the next footstep are being adapted.
        resent: the swing foot was sent elsewhere after it had been lifted, which is done once for a step.
        lowering: how much lower than by its law the CoM is for legs to span the step adapted now or just before [m].
        adapts: whether footsteps may be adapted at all.
        legs: what they can do; None where it is not known.
    """

    def __init__(self, schedule: Schedule, window: int, legs: LegReach | None = None) -> None:
        self.legs, self._window, parameters = legs, window, schedule.ground.parameters
        self.landed, self.waited, self.lowering, self._astray, t = 0, 0, 0.0, 0.0, parameters.sample_time
        self.early = self.fixed = self.adapted = self.resent = False
        self.swing: SwingTrajectory | None = None
        self.clock = TimeScaling(t)
        # Where footsteps were chosen for the faces that they land on it takes legs that are known to move them.
        self._wide = schedule.ground.terrain.footholds.follow
        self.adapts = parameters.step_adaptation.places and (self._wide or legs is not None)
        self._times = self._wide and legs is not None and parameters.step_adaptation.timing
        self._parameters, self._size, self._terrain = parameters, parameters.size, schedule.ground.terrain
        self._pose = np.repeat([self._size.length, 1.0], 3)
        self._hardest = math.inf if legs is None else legs.acceleration[0]  # knees are about as strong as hips
        self._lead, self._patience = parameters.touchdown_lead / t, round(parameters.late_touchdown / t)
        self.follow(schedule)

    def follow(self, schedule: Schedule) -> None:
        """Go on with another schedule, and see as far along it as any plan of the present phase looks."""
        now = max(self.clock.now, 0.0)
        self.schedule = in_sight(schedule, now, self._window)
        self.phase, self.stops = self.schedule.phase(now), self.schedule.stops(now)

    @property
    def info(self) -> PhaseInfo:
        """The phase now, in seconds."""
        phase, t = self.phase, self._parameters.sample_time
        elapsed, duration = (self.clock.now - phase.start) * t, phase.samples * t
        follows = phase if phase.stance is not None else self.schedule.phase(phase.end)
        leads_to = follows.step if follows.stance is not None else 0
        return PhaseInfo(phase.kind, phase.stance, phase.step, elapsed, duration, leads_to, self.time_left)

    @property
    def left(self) -> float:
        """Time until the present phase ends [samples]."""
        return self.clock.until(self.phase.end)

    @property
    def time_left(self) -> float:
        """Time until the present phase ends [s]."""
        return self.left * self._parameters.sample_time

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether the next two footsteps exist and may be shifted."""
        remaining = self.schedule.last.number - self.landed
        return (self.adapts and remaining >= 1 and not self.fixed, self.adapts and remaining >= 2)

    @property
    def catching(self) -> bool:
        """Whether the next footstep is being adapted, where the CoM's height does not follow faces that were chosen."""
        return self.adapted and self._wide

    @property
    def aim(self) -> Array | None:
        """Where a swing goes that deviates from its step, shape (3,) [m]; None where none does."""
        return None if self.swing is None or not (self.adapted or self.swing.bent) else self.swing.footstep

    @property
    def aimed(self) -> Schedule:
        """The schedule, with the step that is being swung where its foot now goes."""
        return self.schedule if self.aim is None or self.fixed else self.schedule.moved(self.landed + 1, self.aim)

    def samples(self, count: int) -> PhaseSamples:
        """The phases at `count` samples from now on, with one more before them and one after."""
        ahead = np.arange(-1.0, count + 1)
        if self.clock.steady:
            clock = self.clock.now + ahead
            clock[0] = max(clock[0], 0.0)
            return self.schedule.samples(clock)
        clock, rate, bend = self.clock.at(ahead)
        return self.schedule.samples(clock, (rate, bend / self._parameters.sample_time))

    def advance(self, feet: FeetState, dcm: Callable[[], adaptation.Dcm | None] = lambda: None) -> None:
        """Go on by one tick, with the feet as measured; `dcm` tells the DCM, and is asked where a foot lands."""
        clock = self.clock.advanced()
        phase, swing = self.phase, self.phase.swing_foot
        over = clock.now >= phase.end - CLOCK_ROUNDING
        if swing is not None and self.clock.now >= 0.0:
            contact = feet.contact[swing]
            felt = contact and not self.early and 2.0 * (clock.now - phase.start) > phase.samples
            lands = self._times and contact and (over or felt)
            if lands and adaptation.lands_short(self.schedule, self.landed, feet, dcm(), self.legs):
                self._swing_anew(clock)
                return
            if over and not contact and self.waited < self._patience:
                self.waited += 1
                return
            if over:
                self.land(feet.position[swing], clock.now)
            elif felt:
                self.early = True
                self.fix(feet.position[swing])
        elif over:
            self.schedule = self.schedule.forgotten(clock.now)
        elif phase.kind is PhaseKind.STAND:
            self.schedule = adaptation.with_feet_slid(self.schedule, self.landed, feet, self._size.length)
        self.clock = clock
        if over or phase.samples == math.inf:
            self.follow(self.schedule)
        self.swing = None if self.phase.swing_foot is None else self.swing

    def change(self, gait: GaitParameters, source: StepSource | None, time: float) -> None:
        """Walk on otherwise; what is left of the present phase changes in proportion to its duration.

        Args:
            gait: gives durations and swing height of the steps to come; the durations from now on.
            source: of the steps to come; the present one if None.
            time: now [s].
        """
        before = self.schedule.gait
        gait = replace(gait, first_foot=before.first_foot)
        if (gait.single_support, gait.double_support) != (before.single_support, before.double_support):
            self._retime(gait, time)
        self.schedule = replace(self.schedule, gait=gait)
        if source is not None or gait.swing_height != before.swing_height:
            self.follow(self.schedule.reordered(self.clock.now, source))

    def _retime(self, gait: GaitParameters, time: float) -> None:
        left, phase, now = self.time_left, self.phase, self.clock.now
        schedule, way = self.schedule.retimed(gait, now), phase.end - now
        lasting = schedule.usual_samples(phase) * way / phase.samples
        if phase.kind is not PhaseKind.STAND and min(way, lasting) >= _LEAST_LEFT + self._lead:
            self.clock = self.clock.scaled(way, lasting)
        self.follow(schedule)
        if self.swing is not None and self.time_left != left:
            self.swing = self.swing.retimed(time, self.time_left - left, self._parameters.sample_time)

    def end_in(self, left: float, time: float) -> bool:
        """Let the present phase end at another time, or as near to it as the clock can.

        Args:
            left: time from now on [s].
            time: now [s].

        Returns:
            Whether that is another one than before.
        """
        before, t = self.time_left, self._parameters.sample_time
        if abs(left - before) < _SAME_TIME * self._size.time:
            return False
        self.clock = self.clock.scaled(self.phase.end - self.clock.now, left / t)
        # A heel that would be lifted harder than hips swing a foot stays down.
        roll = self.roll(time)
        if roll is not None and roll.start >= time and roll.hardest(time, time + self.time_left) > self._hardest:
            self.schedule = adaptation.with_foot_flat(self.schedule, self.landed + 1)
        self.follow(self.schedule)
        if self.swing is not None:
            self.swing = self.swing.retimed(time, self.time_left - before, t)
        return True

    def fix(self, position: Array) -> None:
        """Decide where the next footstep lands, shape (3,) [m]."""
        self.schedule = self.schedule.moved(self.landed + 1, position)
        self.fixed = True

    def fix_imminent(self, time: float, feet: FeetState, margin: float) -> None:
        """Decide the next footstep shortly before it lands; with no margin [m] in haste, or once anew if lifted."""
        swing, p = self.swing, self._parameters
        frozen = (p.freeze_catching if self.catching else p.freeze_time) + CLOCK_ROUNDING
        if swing is None or swing.touchdown_time - time > frozen:
            return
        late = max(time - swing.touchdown_time, 0.0)
        if margin < 0.0 and late < swing.search.hurry_after:
            # While the foot searches for the ground a DCM that no CoP holds goes on away from it.
            self.swing = swing = replace(swing, search=replace(swing.search, hurry_after=late))
        once = margin < 0.0 and self._times and not (self.early or self.resent)
        if once and adaptation.lifted(swing, feet, time, self._size.length):
            self._swing_anew(self.clock)
            self.resent = True
        elif not self.fixed:
            self.fix(swing.footstep)

    def _swing_anew(self, clock: TimeScaling) -> None:
        self.clock, self.swing, self.waited = clock.showing(self.phase.start), None, 0
        self.early = self.fixed = False

    def land(self, position: Array, now: float) -> None:
        """Go on with the next foot, shape (3,) [m], at an instant of the clock [samples]."""
        self.schedule = self.schedule.forgotten(now)
        self.fix(position)
        self.landed += 1
        if self.adapted and self.legs is not None:
            schedule = adaptation.with_heel_lifted(self.schedule, self.landed, self.legs.radius)
            self.schedule = schedule if self._wide else adaptation.aligned(schedule, self.landed)
        self.waited, self.early, self.fixed, self.adapted, self.resent = 0, False, False, False, False

    def may_end(self, feet: FeetState, dcm: Callable[[], adaptation.Dcm | None]) -> bool:
        """Whether the foot of a step that catches has landed early, or is about to; arguments as of `advance`."""
        phase, swing = self.phase, self.phase.swing_foot
        if swing is None or not (self.adapted and self._times and self.fixed):
            return False
        past = 2.0 * (self.clock.now - phase.start) > phase.samples
        if not past or not (self.early or feet.arriving[swing]):
            return False
        return not adaptation.lands_short(self.schedule, self.landed, feet, dcm(), self.legs)

    @property
    def may_go_again(self) -> bool:
        """Whether the foot that landed last may make the next step as well: the other one is still on the ground."""
        phase, now = self.phase, self.clock.now
        if not self._times or self.fixed or not self.info.leads_to:
            return False
        rolls = phase.roll is not None and now > phase.roll.start
        # A plan in which it stands lies between its steps, so that it is seen to land.
        stood = phase.kind is PhaseKind.SINGLE or now > phase.start + CLOCK_ROUNDING
        return self.swing is None and stood and not rolls and self.schedule.step(self.landed + 1).stop is None

    def adopt(self, other: "Execution") -> None:
        """Go on as another one, which was made of this one in this tick."""
        vars(self).update(vars(other))

    def upcoming(self, time: float, free: tuple[bool, bool], shifts: Array) -> tuple[Footstep, ...]:
        """The next footsteps.

        Args:
            time: now [s].
            free: whether the first two may be shifted.
            shifts: shifts of these from their nominal increments, in the world frame, shape (2, 2) [m].
        """
        planned, ahead, left, ways, t = [], 0.0, 0.0, shifts.tolist(), self._parameters.sample_time
        for n, step in enumerate(self.schedule.after(self.landed)[:_TOLD]):
            place = step.place
            position, normal = place.position, place.normal
            x, y = ways[n] if n < len(ways) and free[n] else (0.0, 0.0)
            ahead, left = (ahead + x, left + y) if self._wide else (x, y)
            if ahead != 0.0 or left != 0.0:
                x, y, z = position.tolist()
                x, y = x + ahead, y + left
                if abs(ahead) + abs(left) > _SAME_GROUND * self._size.length:
                    z = self._terrain.height(x, y)
                    normal = self._terrain.normal(x, y) if self._terrain.has_edges else normal
                position = np.array([x, y, z])
            touchdown = time + self.clock.until(step.touchdown) * t
            planned.append(Footstep(place.foot, position, place.yaw, normal, step.number, touchdown))
        return tuple(planned)

    def swing_to(self, landing: Footstep, time: float, feet: FeetState, held: bool) -> None:
        """Let the swing foot go on to where it is to land; asked in single support only.

        Args:
            landing: the footstep.
            time: now [s].
            feet: the measured feet, from one of which a swing begins.
            held: keep to the target of before.
        """
        stance, place = self.schedule.step(self.landed).place, landing.position
        if self.swing is None:
            target = sole_pose(place, landing.yaw, landing.normal)
            foot, leaving = landing.foot, self.schedule.step(self.landed - 1).place
            yaw = leaving.yaw + wrap_angle(float(feet.yaw[foot]) - leaving.yaw)
            pose = sole_pose(feet.position[foot], yaw, leaving.normal)
            # Of the place where it landed the height is believed, too: what is off is off in both, and not the map.
            x, y, height = feet.position[stance.foot].tolist()
            self._astray = self._parameters.search.astray(self._astray, height - self._terrain.height(x, y))
            unsure, course = (feet.height_deviation, self._astray), self.schedule.step(self.phase.step).course
            numbers, hardest = self._parameters, self._hardest
            self.swing = start_swing(foot, pose, target, time, self.left, course, numbers, unsure, hardest)
        elif not (self.fixed or held):
            target = sole_pose(place, landing.yaw, landing.normal)
            target[2] -= self.swing.aim
            if greatest(np.abs(target - self.swing.target) / self._pose) > _SAME_TARGET:
                # Over edges the foot keeps to the times in which its course clears them.
                self.swing = self.swing.retargeted(time, target, self.catching, LEAST_GLIDE * self._size.time)
        if self.legs is not None:
            self.lowering = self.legs.lowering(math.dist(place, stance.position)) if self.catching else 0.0
            self.swing = around_stance_leg(self.swing, stance, self.legs, time, self._parameters.sample_time)

    def roll(self, time: float) -> FootRoll | None:
        """Pitch of the foot that leaves the ground next or has just left it; None for one that stays level."""
        span, clock = self.phase.roll, self.clock
        if span is None or clock.now >= span.end:
            return None
        start, end = (time + (at - clock.now) * clock.sample_time for at in span[:2])
        foot, toe = self.schedule.gait.step_foot(self.phase.leaves), float(self.schedule.ground.half_size[0])
        return FootRoll(foot, start, end, span.angle, toe, None if clock.steady else clock, time)
