"""A step: where and when it lands, and what its swing over the ground takes."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation, seen_from
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.footsteps import Path
from surefoot.planner.steps.gait import WEIGHT_SHIFT, GaitParameters, in_samples
from surefoot.planner.swing import rolling
from surefoot.planner.swing.course import Ground, swing_course
from surefoot.planner.swing.quintics import PEAK
from surefoot.planner.swing.rolling import RollSpan
from surefoot.planner.swing.step_region import check_reach
from surefoot.planner.swing.trajectory import SwingCourse, SwingTrajectory, start_swing
from surefoot.planner.types import Array, Foot, Footstep, Twist

_MEASURED = 6
"""Decimals to which heights of footholds are compared: start feet may be some nanometres off the ground [-]."""

_LOOKED_AT = 60
"""Instants of a swing over edges at which its acceleration is looked at [-]."""


@dataclass(frozen=True)
class Stop:
    """Standing before a step, and the double support in which the weight then goes onto the stance foot.

    Attributes:
        stand: how long the robot stands [samples].
        shift: how long the double support takes [samples].
        rest: part of it before the ZMP begins to move [samples].
    """

    stand: float
    shift: float
    rest: float

    @classmethod
    def usual(cls, stand: float, double: float, farther: float = 1.0) -> "Stop":
        """A stop whose weight shift rests for all but the last of `WEIGHT_SHIFT` double supports.

        Args:
            stand: how long the robot stands [samples].
            double: usual double support [samples].
            farther: how many times as far as usual the weight goes, and as long it takes [-].
        """
        rest = (WEIGHT_SHIFT - 1) * double
        return cls(stand, farther * double + rest, rest)

    def retimed(self, double: float) -> "Stop":
        """The stop with another usual double support [samples]."""
        return Stop.usual(self.stand, double) if self.rest else Stop(self.stand, double, 0.0)


@dataclass(frozen=True, eq=False)
class Step:
    """A step in sight, or one that has landed; the start feet count as steps -1 and 0.

    Attributes:
        number: in the walk, from 1.
        ordinal: number by which its source knows it, which does not count steps that were inserted.
        inserted: whether it was inserted between those of its source.
        stride: what it does to the path.
        path: where the nominal path comes to with it.
        nominal: its footstep as it was laid.
        place: its footstep now: moved, or measured once it has landed. Landing errors do not enter its heading, which
            therefore does not drift.
        course: of its swing over the ground.
        swing: that swing to a footstep one metre ahead, in its own time.
        climb: height of its nominal footstep above where its foot nominally stood before [m].
        lift: by which the lower of both feet, which the body follows, is higher with it than before [m].
        room: by which it may land elsewhere on its face, least and greatest way in its own heading, shape (2, 2) [m].
        hardest: greatest acceleration of its foot over edges, times the square of its duration; zero without edges [m].
        support: number in the walk of the support point of the ZMP on its stance foot.
        stop: standing before it; None where it follows a step.
        lift_off: when its foot leaves the ground, on the clock [samples].
        single_support: duration of its single support [samples].
        double_support: duration of the double support after it [samples].
        toe_off: roll of its foot as it leaves the ground; None for one that stays level.
        heel_strike: roll of its foot as it comes to the ground; None for one that lands flat.
    """

    number: int
    ordinal: int
    inserted: bool
    stride: Twist
    path: Path
    nominal: Footstep
    place: Footstep
    course: SwingCourse
    swing: SwingTrajectory
    climb: float = 0.0
    lift: float = 0.0
    room: Array = field(default_factory=lambda: np.zeros((2, 2)))
    hardest: float = 0.0
    support: int = -1
    stop: Stop | None = None
    lift_off: float = 0.0
    single_support: float = 0.0
    double_support: float = 0.0
    toe_off: RollSpan | None = None
    heel_strike: RollSpan | None = None

    @property
    def touchdown(self) -> float:
        """Time at which its foot lands, on the clock [samples]."""
        return self.lift_off + self.single_support

    @property
    def end(self) -> float:
        """End of the double support after it, on the clock [samples]."""
        return self.touchdown + self.double_support

    def landing(self, position: Array, normal: Array) -> "Step":
        """The step that lands elsewhere, positions and normals of shape (3,) [m, -]."""
        return replace(self, place=Footstep(self.place.foot, position, self.place.yaw, normal))

    def beside(self, shift: Array, terrain: Terrain) -> Footstep:
        """The footstep so far from its nominal place as its face goes.

        Args:
            shift: world frame, shape (2,) [m].
            terrain: gives its height and normal there.
        """
        place = self.nominal
        xy = place.position[:2] + terrain.footholds.shifted(shift, place.yaw, self.room)
        position = np.append(xy, terrain.heights(xy[None]))
        return Footstep(place.foot, position, place.yaw, terrain.normals(xy[None])[0])

    def retimed(
        self, before: "Step", lasting: tuple[float, float], begun: float, now: float, parameters: PlannerParameters
    ) -> "Step":
        """A step to come in other times, as far as these have not begun.

        A roll that has begun stays, and the swing lasts at least until its foot is level.

        Args:
            before: the step before it.
            lasting: single and double support [samples].
            begun: when the present phase began [samples].
            now: on the clock [samples].
            parameters: of the planner.
        """
        (single, double), stop, leaving = lasting, self.stop, self.toe_off
        if stop is not None and before.end + stop.stand > begun:
            stop = stop.retimed(double)
        lift_off = lift_off_after(before, stop)
        if leaving is not None and now < leaving.start:
            ramp, early = ramp_before(before, stop), leaves_early(before, stop, parameters)
            leaving = rolling.toe_off(leaving.foot, ramp, lift_off, single, leaving.angle, early)
        elif leaving is not None:
            single = max(single, (leaving.end - lift_off) / rolling.LEVEL_AGAIN)
        swing = unit_swing(single, self.climb, self.course, parameters)
        step = replace(
            self, stop=stop, lift_off=lift_off, single_support=single, double_support=double, toe_off=leaving,
            swing=swing,
        )  # fmt: skip
        return step.standing(double, now)

    def standing(self, double: float, now: float) -> "Step":
        """The step with another double support after it, as far as its foot has not begun to roll by now [samples].

        A roll that has begun stays, and the double support lasts at least until its foot is flat.
        """
        landing = self.heel_strike
        if landing is not None and now < landing.start:
            landing = rolling.heel_strike(landing.foot, self.touchdown, self.single_support, double, -landing.angle)
            landing = landing._replace(start=max(landing.start, now))
        elif landing is not None:
            double = max(double, landing.end - self.touchdown)
        return replace(self, double_support=double, heel_strike=landing)


def durations(gait: GaitParameters, sample_time: float) -> tuple[float, float]:
    """Single and double support of a gait [samples]."""
    return in_samples(gait.single_support, sample_time), in_samples(gait.double_support, sample_time)


def climb_of(start: Footstep, place: Footstep) -> float:
    """Height by which a foot lands above the foothold that it leaves [m]."""
    return round(float(place.position[2]) - float(start.position[2]), _MEASURED)


def lift_off_after(before: Step, stop: Stop | None) -> float:
    """Time at which a foot leaves the ground after a step and a stop, on the clock [samples]."""
    return before.end if stop is None else before.end + stop.stand + stop.shift


def ramp_before(before: Step, stop: Stop | None) -> float:
    """Time that the weight takes to leave a foot after a step and a stop [samples]."""
    return before.double_support if stop is None else stop.shift - stop.rest


def leaves_early(before: Step, stop: Stop | None, parameters: PlannerParameters) -> bool:
    """Return true if a foot rolls as soon as the other one lands: on its heel, with ankles that bear it on its toes."""
    return stop is None and before.heel_strike is not None and parameters.toes_bear


def start_step(number: int, place: Footstep, path: Path, gait: GaitParameters, ground: Ground) -> Step:
    """A start foot, as a step from which others are laid."""
    course = SwingCourse(0.5, 0.0, 1.0, 0.0)
    single, _ = durations(gait, ground.parameters.sample_time)
    return Step(
        number=number,
        ordinal=number,
        inserted=False,
        stride=Twist(width=gait.step_width),
        path=path,
        nominal=place,
        place=place,
        course=course,
        swing=unit_swing(single, 0.0, course, ground.parameters),
    )


def _lift_of(start: Footstep, stance: Footstep, place: Footstep) -> float:
    """Height by which the lower foot rises with a step [m]."""
    off, other, to = (float(one.position[2]) for one in (start, stance, place))
    return round(min(to, other) - min(other, off), _MEASURED)


def _swing_as(
    before: tuple[Step, Step], single: float, climb: float, course: SwingCourse, parameters: PlannerParameters
) -> SwingTrajectory:
    """The swing of an equal step before, or a new one."""
    alike = [one.swing for one in before if (one.single_support, one.climb, one.course) == (single, climb, course)]
    return alike[0] if alike else unit_swing(single, climb, course, parameters)


def make_step(
    stride: Twist, before: tuple[Step, Step], gait: GaitParameters, ground: Ground, stop: Stop | None, inserted: bool
) -> Step:
    """The step after two others, where it nominally lands.

    Args:
        stride: what it does to the path.
        before: the last step of its foot, and that of the other one.
        gait: gives the feet, durations, swing height and roll.
        ground: on which it is laid.
        stop: standing before it.
        inserted: whether its source does not know of it.

    Raises:
        ParameterError: no swing clears the edges before it, or it is out of reach.
    """
    (start, stance), parameters, terrain = (step.nominal for step in before), ground.parameters, ground.terrain
    last, number = before[1], before[1].number + 1
    single, double = durations(gait, parameters.sample_time)
    foot = gait.step_foot(number)
    path, xy = last.path.advanced(stride, foot)
    position, normal = np.append(xy, terrain.heights(xy[None])), terrain.normals(xy[None])[0]
    place = Footstep(foot, position, path.yaw, normal)
    climb, lift = climb_of(start, place), _lift_of(start, stance, place)
    half_length, edged = float(ground.half_size[0]), terrain.footholds.edged(climb)
    rolls = gait.heel_strike != 0.0 and not edged
    pitch = rolling.landing_pitch(stance, place, half_length, gait.step_length, gait.heel_strike) if rolls else 0.0
    strikes = pitch > 0.0
    course = swing_course(number, start, place, single, gait.swing_height, ground)
    course = replace(course, braking=rolling.BRAKING, lead=rolling.LEAD, sinking=rolling.SINKING) if strikes else course
    swing = _swing_as(before, single, climb, course, parameters)
    lift_off = lift_off_after(last, stop)
    toe_off = None
    if gait.heel_off != 0.0 and rolling.strides(start, stance, half_length):
        early = leaves_early(last, stop, parameters)
        toe_off = rolling.toe_off(foot, ramp_before(last, stop), lift_off, single, gait.heel_off, early)
    step = Step(
        number=number,
        ordinal=last.ordinal + (not inserted),
        inserted=inserted,
        stride=stride,
        path=path,
        nominal=place,
        place=place,
        climb=climb,
        lift=lift,
        room=terrain.free_area(position, path.yaw, ground.half_size, parameters.size.length),
        course=course,
        swing=swing,
        hardest=_hardest(swing, math.dist(xy, start.position[:2])) if edged else 0.0,
        support=last.support + 1 + (stop is not None),
        stop=stop,
        lift_off=lift_off,
        single_support=single,
        double_support=double,
        toe_off=toe_off,
        heel_strike=rolling.heel_strike(foot, lift_off + single, single, double, pitch) if strikes else None,
    )
    check_reach(number, seen_from(stance, place), parameters)
    return step


def known_step(
    nominal_steps: tuple[Step, ...],
    before: tuple[Step, Step],
    stride: Twist,
    stop: Stop | None,
    lasting: tuple[float, float],
) -> Step | None:
    """The step after two others as it was laid before the walk; None where it would be laid otherwise now.

    A walk is laid out once, since a swing over edges takes milliseconds to find.

    Args:
        nominal_steps: steps in order, without gaps.
        before: the last step of its foot, and that of the other one.
        stride: what it does to the path.
        stop: standing before it.
        lasting: single and double support [samples].
    """
    one, other = before
    at = other.number - nominal_steps[0].number if nominal_steps else 0
    if not 0 < at < len(nominal_steps) - 1:
        return None
    first, second, step = nominal_steps[at - 1], nominal_steps[at], nominal_steps[at + 1]
    same = one.nominal is first.nominal and other.nominal is second.nominal and other.path is second.path
    asked = other.ordinal, other.support, other.end, other.double_support, stride, stop, *lasting
    laid_first = second.ordinal, second.support, second.end, second.double_support
    then = *laid_first, step.stride, step.stop, step.single_support, step.double_support
    return step if same and asked == then else None


def room_left(step: Step, stance: Footstep, parallel: float) -> Array:
    """Distances by which a step may be moved on its face from its landing place now, in the heading of its stance foot.

    Least and greatest way, shape (2, 2) [m]; see `turned_room`.
    """
    yaw, (x, y, _), (u, v, _) = step.nominal.yaw, step.place.position.tolist(), step.nominal.position.tolist()
    c = math.cos(yaw)
    s = math.sin(yaw)
    x = x - u
    y = y - v
    ((a, b), (d, e)) = step.room.tolist()
    ahead, left = x * c + y * s, y * c - x * s
    return turned_room(np.array(((a - ahead, b - left), (d - ahead, e - left))), yaw - stance.yaw, parallel)


def turned_room(room: Array, angle: float, parallel: float) -> Array:
    """The part of a room around a footstep that is a box in another frame, where the footstep has a heading [rad].

    Rooms are given as least and greatest way, shape (2, 2) [m]; up to the angle `parallel` both are the same [rad].
    """
    if abs(angle) < parallel or not all(map(math.isfinite, room.ravel().tolist())):
        return room
    # As far as the room goes along each axis; of the rhombus between these ends the box with half their ways.
    axes = frame_rotation(angle).T
    ways = [min(max(low / a, high / a) if abs(a) > 1e-9 else np.inf for a, low, high in zip(axis, *room, strict=True))
            for axis in (-axes[:, 0], -axes[:, 1], axes[:, 0], axes[:, 1])]  # fmt: skip
    half = 0.5 * np.array(ways).reshape(2, 2)
    return np.array([-half[0], half[1]])


def shortest_swing(step: Step, hips: float, lifting: float) -> float:
    """Shortest time in which foot and body, with an acceleration each [m/s^2], can come to the height of a step [s]."""
    return math.sqrt(max(PEAK * abs(step.lift) / lifting, step.hardest / hips))


def _hardest(swing: SwingTrajectory, way: float) -> float:
    """Greatest acceleration of a unit swing over so much way, times the square of its duration [m]."""
    instants = np.linspace(0.0, swing.touchdown_time, _LOOKED_AT, endpoint=False)
    bends = np.abs([swing.evaluate(at)[2, [0, 2]] for at in instants.tolist()]).max(axis=0)
    return float((bends * (way, 1.0)).max()) * swing.touchdown_time**2


def unit_swing(samples: float, climb: float, course: SwingCourse, parameters: PlannerParameters) -> SwingTrajectory:
    """A swing of so many samples from the origin at time 0 to a footstep one metre ahead that lies higher [m]."""
    end = np.array([1.0, 0.0, climb, 0.0, 0.0, 0.0])
    return start_swing(Foot.LEFT, (np.zeros(6), end), (0.0, samples), course, parameters)
