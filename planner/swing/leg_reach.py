"""The reach of legs that catch a body: landing places beside the stance foot, and how hard hips swing a foot there."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation, wrap_angle
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.boxes import landing_boxes
from surefoot.planner.swing.step_region import soles_apart
from surefoot.planner.swing.trajectory import SwingTrajectory
from surefoot.planner.types import Array, Footstep


@dataclass(frozen=True)
class LegReach:
    """The landing places of a foot that catches the body, and the acceleration with which legs swing it there.

    The frame is the stance foot's: x ahead, y to the left. Around it lie boxes that keep the soles apart; a circle
    around the hip above it is what the leg spans. Places are those of the soles' centres; so `clear` is the length of a
    sole more than the gap of that name in the planner's parameters.

    Attributes:
        radius: how far from under its hip a sole reaches at the CoM height of the gait [m].
        hip_width: distance between the hips [m].
        near: least distance beside its stance foot at which a foot clears it, centre to centre [m].
        across: how far beyond its stance foot a foot may land that is clear of it; None where legs must not cross [m].
        clear: distance ahead of or behind the stance foot from which on it is, centre to centre [m].
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
        """The part of it that a planner uses by its step adaptation; None if it uses none."""
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
        count = 3 if crosses and self.across is not None else 1
        found = np.empty((count, 2, 2))
        extents = self.stride, self.hip_width, self.near, self.clear
        landing_boxes(found[:, 0], found[:, 1], extents, self.across or 0.0, side, face, count)
        return found

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
        """The corner in the way of a foot that comes from beyond its stance foot, or goes there; None if there is none.

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
        """Height that the CoM has to lose for both legs to span a stride, with some of their length left [m].

        Args:
            stride: distance between the feet [m].
        """
        span = min(0.5 * stride / self.parameters.recovery.spanned, self.length)
        return max(self.height - math.sqrt(self.length**2 - span**2), 0.0)


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
