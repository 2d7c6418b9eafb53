"""What legs can do to catch a body: where a foot may land beside its stance foot, how hard hips swing it there."""

import math
from dataclasses import field, replace

import numpy as np

from surefoot.planner.geometry import frame_rotation, wrap_angle
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.quintics import BRAKING, PEAK, detour, farthest
from surefoot.planner.swing.step_region import soles_apart
from surefoot.planner.swing.trajectory import SwingTrajectory
from surefoot.planner.types import Array, Footstep
from surefoot.values import dataclass


@dataclass(frozen=True, slots=True)
class LegReach:
    """Where legs let a foot land that catches the body, and how hard they swing it there.

    The frame is the stance foot's: x ahead, y to the left. Around it lie boxes that keep the soles apart; a circle
    around the hip above it is what the leg spans. Places are those of the soles' centres; so `clear` is the length of a
    sole more than the gap of that name in the planner's parameters.

    Attributes:
        radius: how far from under its hip a sole reaches at the CoM height of the gait [m].
        hip_width: distance between the hips [m].
        near: least distance beside its stance foot at which a foot clears it, centre to centre [m].
        across: how far beyond its stance foot a foot may land that is clear of it; None where legs must not cross [m].
        clear: distance ahead of or behind the stance foot from which on it is, likewise [m].
        acceleration: of a swinging sole that the hips' torques allow, forward and sideways [m/s^2].
        sole: length and width of the soles; those of points need no more room where they are turned [m].
        height: of the hips over the soles as the robot stands [m].
        length: from a hip to its sole with the knee straight [m].
        parameters: of the planner.
    """

    radius: float
    hip_width: float
    near: float
    across: float | None
    clear: float
    acceleration: tuple[float, float]
    sole: tuple[float, float] = (0.0, 0.0)
    height: float = 0.0
    length: float = math.inf
    parameters: PlannerParameters = field(default_factory=PlannerParameters)

    @property
    def stride(self) -> float:
        """Greatest distance between the feet as one of them lands, less that of the hips [m].

        The foot that lands is in reach from its hip; the other leg is stretched, and its foot rolls over its edge.
        """
        return STRIDE * self.radius

    def adapting(self, parameters: PlannerParameters) -> "LegReach | None":
        """What of it a planner makes use of by its step adaptation; None where it makes none."""
        if not parameters.step_adaptation.places:
            return None
        across = self.across if parameters.step_adaptation.crossing else None
        return replace(self, across=across, parameters=parameters)

    def turned(self, turn: float) -> "LegReach":
        """The same beside and ahead of a stance foot against which the foot that lands is turned.

        Its corners reach farther, sideways by a tenth of a sole's length at 0.2 rad.

        Args:
            turn: heading of one against the other [rad].
        """
        if abs(turn) < self.parameters.recovery.parallel:
            return self
        length, width = self.sole
        beside = soles_apart(self.sole, turn) - width
        ahead = soles_apart((width, length), turn) - length
        return replace(self, near=self.near + max(beside, 0.0), clear=self.clear + max(ahead, 0.0))

    def allowed(self, side: float, face: Array, crosses: bool) -> Array:
        """Boxes in one of which a foot may land, from its stance foot; one that is empty has its corners crossed.

        The first is beside its stance foot, those after it are beyond, ahead and behind.

        Args:
            side: +1 for a left foot, -1 for a right one.
            face: lower and upper corner of where its sole stays on the ground that was chosen, shape (2, 2) [m].
            crosses: whether it may land beyond its stance foot, as far as legs may at all.

        Returns:
            Lower and upper corners, shape (boxes, 2, 2) [m].
        """
        most = self.stride
        far = side * (most + self.hip_width)
        boxes = [_box(-most, most, side * self.near, far)]
        if crosses and self.across is not None:
            boxes.append(_box(self.clear, most, -side * self.across, far))
            boxes.append(_box(-most, -self.clear, -side * self.across, far))
        found = np.array(boxes)
        found[:, 0], found[:, 1] = np.maximum(found[:, 0], face[0]), np.minimum(found[:, 1], face[1])
        return found

    def within(self, places: Array, hips: Array) -> Array:
        """The places nearest to these that legs reach from hips, shape (..., 2) [m]."""
        way = places - hips
        share = np.minimum(1.0, self.radius / np.maximum(np.hypot(way[..., 0], way[..., 1]), 1e-9))
        return np.asarray(hips + share[..., None] * way)

    def around(self, place: Array, hip: Array, box: Array, reach: float) -> Array:
        """The part of a box with a place in it whose sides are in reach from a hip, level with the place, (2, 2)."""
        most = np.sqrt(np.maximum(reach**2 - (place - hip)[::-1] ** 2, 0.0))
        low, high = np.maximum(box[0], hip - most), np.minimum(box[1], hip + most)
        return np.stack((np.minimum(low, place), np.maximum(high, place)))

    def beside(self, place: Array, side: float) -> Array:
        """The box of a footstep that is too far ahead to know where the hips will be: both legs span it, (2, 2) [m]."""
        hip = np.array([0.0, side * self.hip_width])
        return self.around(place, hip, self.allowed(side, ANYWHERE, False)[0], 2.0 * self.radius)

    def corner(self, way: Array, side: float) -> Array | None:
        """Where a foot that comes from beyond its stance foot, or goes there, passes the corner that is in its way.

        Until it is clear ahead of the stance foot or behind it, it stays beside: it does not cross before, and is back
        before it passes.

        Args:
            way: of the foot, seen from its stance foot, shape (n, 2) [m].
            side: +1 for a left foot, -1 for a right one.

        Returns:
            The corner, seen from the stance foot, shape (2,) [m]; None where none is in the way.
        """
        ahead, beside = way[:, 0], side * way[:, 1]
        crossed = ahead[[0, -1]][beside[[0, -1]] < 0.0]
        if not len(crossed) or not ((np.abs(ahead) < self.clear) & (beside < self.near)).any():
            return None
        return np.array([math.copysign(self.clear, crossed[0]), side * self.near])

    def lowering(self, stride: float) -> float:
        """How much lower than in the gait the CoM is to be for both legs to span a stride, with some of them left [m].

        Args:
            stride: distance between the feet [m].
        """
        span = min(0.5 * stride / self.parameters.recovery.spanned, self.length)
        return max(self.height - math.sqrt(self.length**2 - span**2), 0.0)

    def edges(self, swing: Array, nominal: Array, singles: Array) -> Array:
        """Where a foot can be swung to in times: front, left, minus back and minus right edge, shape (4, n) [m].

        It may always be swung as hard as it nominally is.

        Args:
            swing: position and velocity of the foot, from its stance foot, shape (2, 2) [m, m/s].
            nominal: where it lands nominally, shape (2,) [m].
            singles: times left of it, the last as planned, shape (n,) [s].
        """
        time, edges = self._swing_times(singles), []
        usual, (here, speeds) = float(time[-1]), swing.tolist()
        for side in (1.0, -1.0):
            for at, speed, aim, most in zip(here, speeds, nominal.tolist(), self.acceleration, strict=True):
                hardest = max(most, abs(PEAK * (aim - at) / (usual * usual) - BRAKING * speed / usual))
                edges.append((side * at, hardest, side * speed))
        place, hardest, onward = np.array(edges).T[:, :, None]
        return np.asarray(place + farthest(hardest, onward, time))

    def _swing_times(self, singles: Array) -> Array:
        """Times in which a foot swings of single supports, at whose end it has arrived, shape (n,) [s]."""
        return np.maximum(singles - self.parameters.touchdown_lead, self.parameters.sample_time)

    def shortfall(self, swing: Array, side: float, singles: Array, places: Array) -> Array:
        """Way that a foot lacks of places in times since it has to pass around the stance leg, shape (boxes, n) [m].

        Asked of legs that are turned as the foot will land.

        It is bent as that of the swing will be (see `around_stance_leg`), here at nine shares of its time, and
        lacks the share by which the hips cannot swing it so hard.

        Args:
            swing: position and velocity of the foot, from its stance foot, shape (2, 2) [m, m/s].
            side: +1 for a left foot, -1 for a right one.
            singles: times left of it, shape (n,) [s].
            places: where it lands, shape (boxes, n, 2) [m].
        """
        here, speed = swing
        crossing = np.where(side * here[1] < 0.0, here[0], np.where(side * places[..., 1] < 0.0, places[..., 0], 0.0))
        lacking = np.zeros(crossing.shape)
        which = np.nonzero(crossing)
        if not len(which[0]):
            return lacking
        time = self._swing_times(singles)[which[1], None, None]
        way, onward = (places[which] - here)[:, None], speed * time
        passed = here + way * AT_REST[0][:, None] + onward * MOVING[0][:, None]
        met = ((np.abs(passed[..., 0]) < self.clear) & (side * passed[..., 1] < self.near)).any(axis=1)
        corner = np.stack((np.copysign(self.clear, crossing[which]), np.full(len(met), side * self.near)), axis=1)
        astray = corner[:, None] - passed
        rows, best = np.arange(len(met)), np.argmin((astray**2).sum(axis=-1) / DEARER, axis=1)
        bend = way * AT_REST[1][:, None] + onward * MOVING[1][:, None]
        bend = bend + astray[rows, best][:, None] * AROUND[best][..., None]
        hardest = (np.abs(bend) / (time**2 * self.acceleration)).max(axis=(1, 2))
        lacking[which] = np.where(met, (1.0 - 1.0 / np.maximum(hardest, 1.0)) * np.hypot(*way[:, 0].T), 0.0)
        return lacking


def _box(back: float, ahead: float, near: float, far: float) -> tuple[tuple[float, float], ...]:
    return (back, min(near, far)), (ahead, max(near, far))


STRIDE = 2.6
"""Greatest stride over the reach of a leg: at 2, where both legs span it flat, a body that runs is not caught [-]."""

ANYWHERE = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])
"""The face of a foot that may land on any ground: its lower and upper corner [m]."""


def around_stance_leg(
    swing: SwingTrajectory, stance: Footstep, legs: LegReach, time: float, sample_time: float
) -> SwingTrajectory:
    """A swing, that from beyond the stance foot or to there bent to pass around the stance leg.

    A way round that the hips cannot swing the foot in the time left would only make it late: then it goes straight.

    Args:
        swing: that of the next footstep.
        stance: the foot beside which it passes.
        legs: what they can do.
        time: now [s].
        sample_time: of the plans [s].
    """
    if swing.bent or time >= swing.glide_end:
        return swing
    first, end, side = max(time, swing.start_time), swing.glide_end + 0.5 * sample_time, swing.foot.side
    last = first + (math.ceil((end - first) / sample_time) - 1) * sample_time
    (u, v, _), left_x, left_y = stance.position.tolist(), -side * math.sin(stance.yaw), side * math.cos(stance.yaw)
    (x, y), (z, w) = swing.places(first, last)
    if left_x * (x - u) + left_y * (y - v) >= 0.0 and left_x * (z - u) + left_y * (w - v) >= 0.0:
        return swing  # as nearly all of them: beside its stance foot at both ends
    rotation, origin, times = frame_rotation(stance.yaw), stance.position[:2], np.arange(first, end, sample_time)
    way = (swing.positions(times)[:, :2] - origin) @ rotation
    corner = legs.turned(wrap_angle(float(swing.target[3]) - stance.yaw)).corner(way, side)
    if corner is None:
        return swing
    bent = swing.around(origin + rotation @ corner, sample_time)
    hardest = np.abs(bent.bends(times) @ rotation).max(axis=0)
    return bent if (hardest <= legs.acceleration).all() else swing


_SHARES = np.linspace(0.1, 0.9, 9)
"""Shares of a swing's time at which its way around the stance leg is looked at [-]."""

DEARER = (_SHARES * (1.0 - _SHARES)) ** 5
"""What a way round at these is divided by to be compared."""


def _unit_ways() -> tuple[Array, Array, Array]:
    """Quintics to rest in a unit of time and their accelerations at `_SHARES`, shape (2, 9) each.

    One goes a unit of way from rest, one has a unit of speed and goes none; of a way round by a unit at each of these
    shares the accelerations, shape (9, 9).
    """
    u = _SHARES
    rest = np.stack((u**3 * (10.0 - 15.0 * u + 6.0 * u**2), 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)))
    moving = np.stack((u - 6.0 * u**3 + 8.0 * u**4 - 3.0 * u**5, -36.0 * u + 96.0 * u**2 - 60.0 * u**3))
    order = np.arange(6.0)
    factors = (order * (order - 1.0))[2:]
    around = []
    for share in u.tolist():
        since = np.where(u <= share, u, u - share)[:, None] ** order[:4] * factors
        before, after = detour(share, 1.0)
        around.append(np.where(u <= share, since @ before[2:], since @ after[2:]))
    return rest, moving, np.array(around)


AT_REST, MOVING, AROUND = _unit_ways()
