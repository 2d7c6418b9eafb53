"""Where a foot may land beside its stance foot: in reach, apart from it, and not crossed."""

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from surefoot.errors import ParameterError, at_least, at_most
from surefoot.planner.geometry import frame_rotation
from surefoot.planner.parameters import PlannerParameters, RecoveryParameters, StepAdaptation
from surefoot.planner.types import Array, Foot, Footstep

LANDING_ROUNDING = 1e-9
"""Places in the region are compared with this tolerance, since they are sums of rounded ways [m, rad]."""


@dataclass(frozen=True, slots=True)
class Landing:
    """Where a foot lands, seen from its stance foot.

    Attributes:
        ahead: forward distance in the stance foot's frame [m].
        beside: distance to the foot's own side, negative when the legs cross [m].
        turn: heading against the stance foot, positive to the left [rad].
    """

    ahead: float
    beside: float
    turn: float

    @classmethod
    def between(cls, stance: Footstep, place: Footstep) -> "Landing":
        """That of a footstep."""
        ahead, left = (place.position - stance.position)[:2] @ frame_rotation(stance.yaw)
        return cls(float(ahead), float(left if place.foot is Foot.LEFT else -left), place.yaw - stance.yaw)


def soles_apart(sole: tuple[float, float], turn: float) -> float:
    """Distance beside at which a sole just clears the other one, wherever ahead it lands [m].

    Args:
        sole: length and width of both [m].
        turn: heading of one against the other [rad].
    """
    length, width = sole
    return 0.5 * (width + (length * abs(math.sin(turn)) + width * abs(math.cos(turn))))


class Fault(NamedTuple):
    """What is wrong with a landing.

    Attributes:
        what: the fault, in a clause that follows "the foot".
        right: what would be right.
    """

    what: str
    right: str


@dataclass(frozen=True, slots=True)
class StepRegion:
    """Bounds of a landing.

    Two soles that are `nearest` apart sideways keep the gap whatever the distance ahead, so that a foot neither lands
    on the other one, nor passes through it, nor crosses over.

    Attributes:
        length: largest distance ahead or behind [m].
        width: least and largest distance beside [m].
        sole: length and width of the soles [m].
        gap: least distance between two soles side by side [m].
        turn: largest change of heading; beyond about 0.7 rad the thighs touch [rad].
        leg_span: largest distance from the point `hip_width` beside the stance foot, where both legs stand upright [m].
        hip_width: distance between the hips [m].
    """

    length: float
    width: tuple[float, float]
    sole: tuple[float, float]
    gap: float = RecoveryParameters().sole_gap
    turn: float = 0.5
    leg_span: float = math.inf
    hip_width: float = 0.0

    def nearest(self, turn: float) -> float:
        """Least distance beside for a foot that lands turned [m]."""
        return max(self.width[0], soles_apart(self.sole, turn) + self.gap)

    def contains(self, place: Landing) -> bool:
        """Whether a foot may land there."""
        return self.why_not(place) is None

    def why_not(self, place: Landing) -> Fault | None:
        """What is wrong with a landing; None when nothing is."""
        near, far = self.nearest(place.turn), self.width[1]
        if abs(place.turn) > self.turn + LANDING_ROUNDING:
            return Fault(f"turns by {place.turn:.3g} rad against its stance foot", f"{self.turn:g} rad is the most")
        if place.beside < near - LANDING_ROUNDING:
            what = "crosses" if place.beside < 0.0 else "would touch"
            return Fault(f"{what} its stance foot, {place.beside:.3f} m beside it", f"{at_least(near)} m is the least")
        if place.beside > far + LANDING_ROUNDING:
            return Fault(f"lands {place.beside:.3f} m beside its stance foot", f"{far:g} m is the most")
        if abs(place.ahead) > self.length + LANDING_ROUNDING:
            return Fault(f"lands {place.ahead:.3f} m ahead of its stance foot", f"{self.length:g} m is the most")
        stretch = math.hypot(place.ahead, place.beside - self.hip_width)
        if stretch > self.leg_span + LANDING_ROUNDING:
            what = f"lands {stretch:.3f} m from where the legs stand upright"
            return Fault(what, f"{at_most(self.leg_span)} m is the most")
        return None


@dataclass(frozen=True, slots=True)
class LegReach:
    """Where legs let a foot land that catches the body, and how hard they swing it there.

    The frame is the stance foot's: x ahead, y to the left. Around it lie boxes that keep the soles apart; a circle
    around the hip above it is what the leg spans.

    Attributes:
        radius: how far from under its hip a sole reaches at the CoM height of the gait [m].
        hip_width: distance between the hips [m].
        near: least distance beside its stance foot at which a foot clears it [m].
        across: how far beyond its stance foot a foot may land that is clear of it; None where legs must not cross [m].
        clear: distance ahead of or behind the stance foot from which on it is [m].
        acceleration: of a swinging sole that the hips' torques allow, forward and sideways [m/s^2].
        sole: length and width of the soles; those of points need no more room where they are turned [m].
        height: of the hips over the soles as the robot stands [m].
        length: from a hip to its sole with the knee straight [m].
        numbers: the planner's, of recovery.
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
    numbers: RecoveryParameters = field(default_factory=RecoveryParameters)

    def adapting(self, parameters: PlannerParameters) -> "LegReach | None":
        """What of it a planner makes use of by its step adaptation; None where it makes none."""
        if parameters.step_adaptation is StepAdaptation.NONE:
            return None
        across = self.across if parameters.step_adaptation is StepAdaptation.CROSSING else None
        return replace(self, across=across, numbers=parameters.recovery)

    def turned(self, turn: float) -> "LegReach":
        """The same beside and ahead of a stance foot against which the foot that lands is turned.

        Its corners reach farther, sideways by a tenth of a sole's length at 0.2 rad.

        Args:
            turn: heading of one against the other [rad].
        """
        if abs(turn) < self.numbers.parallel:
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
        most = 2.0 * self.radius
        boxes = [self._box(side, -most, most, self.near)]
        if crosses and self.across is not None:
            boxes.append(self._box(side, self.clear, most, -self.across))
            boxes.append(self._box(side, -most, -self.clear, -self.across))
        found = np.array(boxes)
        found[:, 0], found[:, 1] = np.maximum(found[:, 0], face[0]), np.minimum(found[:, 1], face[1])
        return found

    def _box(self, side: float, back: float, ahead: float, near: float) -> tuple[tuple[float, float], ...]:
        low, high = sorted((side * near, side * (2.0 * self.radius + self.hip_width)))
        return (back, low), (ahead, high)

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
        span = min(0.5 * stride / self.numbers.spanned, self.length)
        return max(self.height - math.sqrt(self.length**2 - span**2), 0.0)


ANYWHERE = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])
"""The face of a foot that may land on any ground: its lower and upper corner [m]."""


def turned_room(room: Array, angle: float, parallel: float) -> Array:
    """The part of a room around a footstep that is a box in another frame.

    Args:
        room: least and greatest way in the footstep's heading, shape (2, 2) [m].
        angle: heading of the footstep in that frame [rad].
        parallel: angle up to which it is the same there [rad].

    Returns:
        Least and greatest way in that frame, shape (2, 2) [m].
    """
    if not np.isfinite(room).all() or abs(angle) < parallel:
        return room
    # As far as the room goes along each axis; of the rhombus between these ends the box with half their ways.
    axes = frame_rotation(angle).T
    ways = [min(max(low / a, high / a) if abs(a) > 1e-9 else np.inf for a, low, high in zip(axis, *room, strict=True))
            for axis in (-axes[:, 0], -axes[:, 1], axes[:, 0], axes[:, 1])]  # fmt: skip
    half = 0.5 * np.array(ways).reshape(2, 2)
    return np.array([-half[0], half[1]])


def reach_box(parameters: PlannerParameters, side: float) -> tuple[Array, Array]:
    """Where a footstep may land from its stance foot: lower and upper corner in the plan frame, shape (2,) [m].

    It is the paper's reachable area, in which its step law saturates a step.

    Args:
        parameters: planner parameters.
        side: +1 for a left step, -1 for a right one.
    """
    x = parameters.reach_length
    near, far = sorted(side * width for width in parameters.reach_width)
    return np.array([-x, near]), np.array([x, far])


def check_reach(number: int, place: Landing, parameters: PlannerParameters) -> None:
    """Refuse a nominal footstep outside the reach box.

    Args:
        number: of the footstep, from 1.
        place: where it lands.
        parameters: give the box.

    Raises:
        ParameterError: it is out of reach; its key is ("footsteps", number - 1, "ahead" or "beside").
    """
    low, high = reach_box(parameters, 1.0)
    for axis, name in enumerate(("ahead", "beside")):
        way = getattr(place, name)
        if not low[axis] - LANDING_ROUNDING <= way <= high[axis] + LANDING_ROUNDING:
            ahead = "ahead of" if name == "ahead" else name
            what = f"footstep {number} would land {way:.3f} m {ahead} its stance foot"
            key = ("footsteps", number - 1, name)
            raise ParameterError(key, what, f"it must be {low[axis]:g} to {high[axis]:g} m")
