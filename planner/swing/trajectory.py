"""Swing foot trajectory: quintic over the ground, up to an apex and softly down, replanned at every planner tick."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from surefoot.maths import linear
from surefoot.planner.geometry.plane import shift, shifted
from surefoot.planner.geometry.quintic import between
from surefoot.planner.parameters import GroundSearch, PlannerParameters
from surefoot.planner.swing.quintics import detour, straight_time, to_rest, up_and_down
from surefoot.planner.types import Array, Foot

TOUCHING = 1e-9
"""Times of ticks carry rounding; a piece begins this much early [s]."""

FEWEST_SWING_SAMPLES = 4
"""Planner samples of a single support: lift-off, apex, descent and touchdown [-]."""

_GLIDING = [0, 1, 3, 4, 5]
"""Columns of all but z: x, y and the angles [-]."""

LEAST_GLIDE = 0.1
"""A new target is reached by touchdown instead of by the end of the glide when less than this is left of it, of the
reference robot: a shorter quintic would jerk the foot [s]."""

_MOST_LEAD = 0.25
"""Share of a single support by which its swing ends before it at most, so that a short one still swings [-]."""


@dataclass(frozen=True, eq=False)
class SwingTrajectory:
    """Motion of a swing foot; columns are x, y, z [m], yaw, pitch, roll [rad] in the world frame.

    All but z are one quintic from the state at the last change of target to rest at the target. So an unchanged target
    is continued identically. Before and after this glide they rest, so that the sole leaves and meets tilted ground
    flat on it. z is one quintic up to the apex and one down to the touchdown height, joined with continuous
    acceleration. After the touchdown time all but z hold and z goes on downwards in search of the ground.

    Attributes:
        foot: the foot that swings.
        start_time: local time zero of the glide, before which all but z rest [s].
        glide_end: when they come to rest [s].
        apex_time: when the sole is highest [s].
        touchdown_time: when it is planned to land [s].
        target: touchdown position and angles, shape (6,).
        clearance: height of the apex above the higher of lift-off and touchdown [m].
        search: how it goes on after the touchdown time, if it feels no ground.
        aim: how far the target lies below the footstep, where the ground's height is unsure [m].
        lifting: vertical acceleration that it is not to exceed where it is replanned [m/s^2].
        level: coefficients of all but z from `start_time`, shape (6, 5).
        rise_start: local time zero of the rise [s].
        rise: coefficients of z until the apex, shape (6, 1).
        fall_start: local time zero of the fall [s].
        fall: coefficients of z from the apex on, shape (6, 1).
        bend_time: where the way bends round a corner; infinite for one that does not [s].
        onward: coefficients of all but z from there on, shape (6, 5).
    """

    foot: Foot
    start_time: float
    glide_end: float
    apex_time: float
    touchdown_time: float
    target: Array
    clearance: float
    search: GroundSearch
    level: Array
    rise_start: float
    rise: Array
    fall_start: float
    fall: Array
    bend_time: float = math.inf
    onward: Array = field(default_factory=lambda: np.zeros((6, len(_GLIDING))))
    aim: float = 0.0
    lifting: float = math.inf

    @property
    def footstep(self) -> Array:
        """Landing place of the foot: its target without what it is aimed below that, shape (3,) [m]."""
        place = self.target[:3].copy()
        place[2] += self.aim
        return place

    @property
    def bent(self) -> bool:
        """True if the way bends round a corner."""
        return self.bend_time < math.inf

    def coefficients(self, time: float) -> Array:
        """Polynomials in the local time from `time` on, valid until the next of the times above, shape (6, 6)."""
        result = np.zeros((6, 6))
        if time >= self.touchdown_time - TOUCHING:
            result[0] = self.target
            way, speed, bend = self.search.motion(time - self.touchdown_time)
            result[:3, 2] = self.target[2] - way, -speed, -0.5 * bend
            return result
        if time >= self.glide_end - TOUCHING:
            result[0] = self.target
        elif time >= self.start_time - TOUCHING:
            after, glide = time >= self.bend_time - TOUCHING, np.empty((6, len(_GLIDING)))
            level, begin = (self.onward, self.bend_time) if after else (self.level, self.start_time)
            linear.product(shift(time - begin), level, glide)
            result[:, :2], result[:, 3:] = glide[:, :2], glide[:, 2:]  # faster than by a list of columns
        else:
            result[0, :2], result[0, 3:] = self.level[0, :2], self.level[0, 2:]
        if time >= self.apex_time - TOUCHING:
            result[:, 2] = shifted(self.fall, time - self.fall_start)[:, 0]
        else:
            result[:, 2] = shifted(self.rise, time - self.rise_start)[:, 0]
        return result

    def evaluate(self, time: float) -> Array:
        """Position, velocity and acceleration at an instant after the start, shape (3, 6)."""
        state = self.coefficients(time)[:3]
        state[2] *= 2.0
        return state

    def positions(self, times: Array) -> Array:
        """Position at instants from the start on, of shape (n,) [s]; shape (n, 6)."""
        gliding = np.clip(times - self.start_time, 0.0, self.glide_end - self.start_time)
        result = np.empty((len(times), 6))
        result[:, _GLIDING] = gliding[:, None] ** _EXPONENTS @ self.level
        if self.bent:
            after = gliding + self.start_time - self.bend_time
            bent = np.flatnonzero(after >= 0.0)[:, None]
            result[bent, _GLIDING] = after[bent] ** _EXPONENTS @ self.onward
        rising, falling = ((times - start)[:, None] ** _EXPONENTS for start in (self.rise_start, self.fall_start))
        result[:, 2] = np.where(
            times < self.apex_time - TOUCHING, (rising @ self.rise)[:, 0], (falling @ self.fall)[:, 0]
        )
        for k in np.flatnonzero(times >= self.touchdown_time - TOUCHING):
            result[k] = self.target
            result[k, 2] -= self.search.motion(float(times[k]) - self.touchdown_time)[0]
        return result

    def bends(self, times: Array) -> Array:
        """Horizontal acceleration at instants from the start of the glide on, shape (n, 2) [m/s^2]."""
        after = times >= self.bend_time - TOUCHING
        since = times - np.where(after, self.bend_time, self.start_time)
        powers = _BENDING * since[:, None] ** _EXPONENTS[:-2]
        bends = np.where(after[:, None], powers @ self.onward[2:, :2], powers @ self.level[2:, :2])
        bends[times >= self.glide_end - TOUCHING] = 0.0
        return bends

    def places(self, *times: float) -> list[tuple[float, float]]:
        """Places of a swing that does not bend at instants, x and y in plain numbers, which are fast [m]."""
        (a, u, *_), (b, v, *_), (c, w, *_), (d, x, *_), (e, y, *_), (f, z, *_) = self.level.tolist()
        found, lasting = [], self.glide_end - self.start_time
        for time in times:
            t = min(max(time - self.start_time, 0.0), lasting)
            here = a + t * (b + t * (c + t * (d + t * (e + t * f)))), u + t * (v + t * (w + t * (x + t * (y + t * z))))
            landed = time >= self.touchdown_time - TOUCHING
            found.append((float(self.target[0]), float(self.target[1])) if landed else here)
        return found

    def retargeted(
        self, time: float, target: Array, gliding: bool = False, least: float = LEAST_GLIDE
    ) -> "SwingTrajectory":
        """The trajectory that goes on from its own state at `time` to another target.

        Args:
            time: instant of the change, before the touchdown [s].
            target: new touchdown position and angles, shape (6,).
            gliding: go on until the touchdown, which takes the least acceleration.
            least: go on until then as well when less than this is left of the glide [s].
        """
        state = self.evaluate(time)
        start = max(time, self.start_time)
        keeps = time < self.glide_end - least and not gliding
        end = self.glide_end if keeps else self.touchdown_time
        level = to_rest(state[:, _GLIDING], target[_GLIDING], end - start)
        moved = replace(self, start_time=start, glide_end=end, level=level, target=np.array(target), bend_time=math.inf)
        if target[2] == self.target[2]:
            return moved
        return moved._with_height(
            time, state[:, 2:3], max(float(state[0, 2]), float(target[2]) + self.aim) + self.clearance
        )

    def around(self, corner: Array, grid: float) -> "SwingTrajectory":
        """The trajectory that passes a corner on its way to the same target at the same time, with the least jerk.

        The way is bent by what has the least jerk among all that are at rest at both ends and reach the corner at some
        time: two quintics that are joined smoothly up to the fourth derivative. It is the dearer the nearer that time
        is to an end, by (u (1 - u))^-5 at a share u of the glide. The cheapest of the ticks is taken.

        Args:
            corner: to be passed, x and y in the world frame, shape (2,) [m].
            grid: sample time of the plans [s].
        """
        start, duration = self.start_time, self.glide_end - self.start_time
        times = grid * np.arange(1.0, math.ceil(duration / grid - TOUCHING))
        if len(times) < 1:
            return self
        share = times / duration
        ways = corner - times[:, None] ** _EXPONENTS @ self.level[:, :2]
        best = int(np.argmin((ways**2).sum(axis=1) / (share * (1.0 - share)) ** 5))
        time, way = float(times[best]), np.append(ways[best], np.zeros(len(_GLIDING) - 2))
        before, after = detour(time, duration)
        onward = shifted(self.level, time) + after[:, None] * way
        return replace(self, level=self.level + before[:, None] * way, bend_time=start + time, onward=onward)

    def retimed(self, time: float, delay: float, grid: float) -> "SwingTrajectory":
        """The trajectory that goes on from its own state at `time` to the same target and apex at other times.

        What is left until each instant changes in proportion; but for the touchdown they stay on a grid from now on.
        A foot on its way down that has so much more time that it would pass below its target is lifted once more.

        Args:
            time: instant of the change [s].
            delay: by which the touchdown is put off [s].
            grid: sample time of the plans [s].
        """
        share, touchdown = 1.0 + delay / (self.touchdown_time - time), self.touchdown_time + delay

        def put_off(instant: float) -> float:
            return instant if instant < time + TOUCHING else time + round(share * (instant - time) / grid) * grid

        state = self.evaluate(time)
        start, end = max(put_off(self.start_time), time), min(put_off(self.glide_end), touchdown)
        moved = replace(self, touchdown_time=touchdown, start_time=start, glide_end=end)
        if time < self.glide_end - TOUCHING:
            end = max(end, min(start + grid, touchdown))
            end = min(end, start + max(straight_time(state[:, :2], self.target[:2]), self.glide_end - start))
            level = to_rest(state[:, _GLIDING], self.target[_GLIDING], end - start)
            moved = replace(moved, glide_end=end, level=level, bend_time=math.inf)
        if time < self.apex_time - TOUCHING:
            moved = replace(moved, apex_time=min(max(put_off(self.apex_time), time + grid), touchdown - grid))
            top = float((self.apex_time - self.rise_start) ** _EXPONENTS @ self.rise[:, 0])
            return moved._with_height(time, state[:, 2:3], top)
        again = time + round(0.5 * (touchdown - time) / grid) * grid
        sinks = touchdown - time > straight_time(state[:, 2:3], self.target[2:3])
        if sinks and math.isfinite(self.lifting) and time + TOUCHING < again < touchdown - TOUCHING:
            moved = replace(moved, apex_time=again)
        return moved._with_height(time, state[:, 2:3], max(float(state[0, 2]), self.footstep[2] + self.clearance))

    def _with_height(self, time: float, state: Array, apex: float) -> "SwingTrajectory":
        """Height from a state at `time` on, shape (3, 1), over an apex [m]; see `up_and_down`."""
        end, times = (self.target.item(2), self.search.touchdown_speed), (time, self.apex_time, self.touchdown_time)
        rise, fall = up_and_down(tuple(state[:, 0].tolist()), apex, end, times, self.lifting, TOUCHING)
        if rise is None:
            return replace(self, apex_time=min(self.apex_time, time), fall_start=time, fall=fall)
        return replace(self, rise_start=time, rise=rise, fall_start=self.apex_time, fall=fall)


_EXPONENTS = np.arange(6)
_BENDING = (_EXPONENTS * (_EXPONENTS - 1.0))[2:]


@dataclass(frozen=True)
class SwingCourse:
    """The division of a swing's time, in shares of it.

    Attributes:
        apex: when the sole is highest [-].
        glide_start: when it begins to move forward, sideways and to turn [-].
        glide_end: when that is done [-].
        height: of the apex above the higher of lift-off and touchdown [m].
        braking: deceleration with which it comes to rest, over way and square of time; 0 comes to rest smoothly [-].
        lead: time by which it ends before the single support, over `PlannerParameters.touchdown_lead` [-].
        sinking: speed by which it comes down faster at touchdown than the ground search says, for the reference robot
            [m/s].
    """

    apex: float
    glide_start: float
    glide_end: float
    height: float
    braking: float = 0.0
    lead: float = 1.0
    sinking: float = 0.0


def start_swing(
    foot: Foot,
    ends: tuple[Array, Array],
    support: tuple[float, float],
    course: SwingCourse,
    parameters: PlannerParameters,
    doubt: tuple[float, float] = (0.0, 0.0),
    lifting: float = math.inf,
) -> SwingTrajectory:
    """Swing from rest, which ends some time before the single support does.

    Args:
        foot: the foot that swings.
        ends: lift-off and touchdown position and angles, shape (6,) each.
        support: when its single support begins [s], and how long that lasts [samples].
        course: of the swing; its instants are on a grid of samples.
        parameters: of the planner.
        doubt: standard deviation of its height over the stance foot, and how high that is believed over its footstep;
            it stands, so that the ground is there. Of the truth, whose deviation is zero, neither counts [m].
        lifting: vertical acceleration that it is not to exceed where it is replanned [m/s^2].
    """
    (pose, footstep), (start, samples) = ends, support
    t, (search, aim), begin = parameters.sample_time, parameters.search.for_deviation(*doubt), pose.tolist()
    if course.sinking:
        speed = search.touchdown_speed + course.sinking * parameters.size.factor("m/s")
        search = replace(search, touchdown_speed=speed, speed=max(speed, search.speed))
    target = np.array(footstep)
    target[2] -= aim
    touchdown = start + samples * t - min(course.lead * parameters.touchdown_lead, _MOST_LEAD * samples * t)
    glide_start, apex, glide_end = (
        start + round(share * samples) * t for share in (course.glide_start, course.apex, course.glide_end)
    )
    glide_end, end = min(glide_end, touchdown), target.tolist()
    gliding = glide_end - glide_start
    brake = course.braking / (gliding * gliding)
    ways = [((begin[k], 0.0, 0.0), (end[k], 0.0, brake * (begin[k] - end[k])), gliding) for k in _GLIDING]
    top, still, times = max(begin[2], footstep.item(2)) + course.height, (begin[2], 0.0, 0.0), (start, apex, touchdown)
    rise, fall = up_and_down(still, top, (end[2], search.touchdown_speed), times, lifting, TOUCHING)
    falls = rise is None
    return SwingTrajectory(
        foot=foot,
        start_time=glide_start,
        glide_end=glide_end,
        apex_time=min(apex, start) if falls else apex,
        touchdown_time=touchdown,
        target=target,
        clearance=course.height,
        search=search,
        level=np.array([*zip(*(between(*way) for way in ways), strict=True)]),
        rise_start=start,
        rise=np.zeros((6, 1)) if rise is None else rise,
        fall_start=start if falls else apex,
        fall=fall,
        aim=aim,
        lifting=lifting,
    )
