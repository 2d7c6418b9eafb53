"""How far hips swing a foot in the time that is left, straight or around the stance leg."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import frame_rotation, wrap_angle
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.trajectory import SwingTrajectory, detour
from surefoot.planner.types import Array, Footstep

PEAK = 5.77
"""Greatest acceleration of a quintic from rest to rest, over way / T²: 10 / √3 [-]."""

_BRAKING, _GAINING = 1.9, 3.9
"""What a speed takes off that at the end of a quintic to rest, and at its begin, over speed / T: its extremes [-]."""


@dataclass(frozen=True, slots=True)
class SwingLimits:
    """Where hips swing a foot in the time that is left, with no more than their acceleration.

    A swing is a quintic to rest; what it takes is known in closed form, so that many places and times cost little.

    Attributes:
        legs: give the acceleration and the stance leg's corner.
        lead: time by which a foot arrives before its swing ends [s].
        least: shortest time of a swing [s].
    """

    legs: LegReach
    lead: float
    least: float

    @classmethod
    def of(cls, legs: LegReach, parameters: PlannerParameters) -> "SwingLimits":
        """Those of legs with a planner's times."""
        return cls(legs, parameters.touchdown_lead, parameters.sample_time)

    def edges(self, swing: Array, nominal: Array, singles: Array) -> Array:
        """Where a foot can be swung to in times: front, left, minus back and minus right edge, shape (4, n) [m].

        It may always be swung as hard as it nominally is.

        Args:
            swing: position and velocity of the foot, from its stance foot, shape (2, 2) [m, m/s].
            nominal: where it lands nominally, shape (2,) [m].
            singles: times left of it, the last as planned, shape (n,) [s].
        """
        time, edges = np.maximum(singles - self.lead, self.least), []
        usual, (here, speeds) = float(time[-1]), swing.tolist()
        for side in (1.0, -1.0):
            for at, speed, aim, most in zip(here, speeds, nominal.tolist(), self.legs.acceleration, strict=True):
                hardest = max(most, abs(PEAK * (aim - at) / (usual * usual) - _BRAKING * speed / usual))
                onward = side * speed
                edges.append((side * at, hardest, (_BRAKING if onward > 0.0 else _GAINING) * onward))
        place, hardest, onward = np.array(edges).T[:, :, None]
        return np.asarray(place + (hardest * time**2 + onward * time) / PEAK)

    def shortfall(self, swing: Array, side: float, legs: LegReach, singles: Array, places: Array) -> Array:
        """Way that a foot lacks of places in times since it has to pass around the stance leg, shape (boxes, n) [m].

        It is bent as that of the swing will be (see `around_stance_leg`), here at nine shares of its time, and
        lacks the share by which the hips cannot swing it so hard.

        Args:
            swing: position and velocity of the foot, from its stance foot, shape (2, 2) [m, m/s].
            side: +1 for a left foot, -1 for a right one.
            legs: turned as the foot will land.
            singles: times left of it, shape (n,) [s].
            places: where it lands, shape (boxes, n, 2) [m].
        """
        here, speed = swing
        crossing = np.where(side * here[1] < 0.0, here[0], np.where(side * places[..., 1] < 0.0, places[..., 0], 0.0))
        lacking = np.zeros(crossing.shape)
        which = np.nonzero(crossing)
        if not len(which[0]):
            return lacking
        time = np.maximum(singles - self.lead, self.least)[which[1], None, None]
        way, onward = (places[which] - here)[:, None], speed * time
        passed = here + way * _AT_REST[0][:, None] + onward * _MOVING[0][:, None]
        met = ((np.abs(passed[..., 0]) < legs.clear) & (side * passed[..., 1] < legs.near)).any(axis=1)
        corner = np.stack((np.copysign(legs.clear, crossing[which]), np.full(len(met), side * legs.near)), axis=1)
        astray = corner[:, None] - passed
        rows, best = np.arange(len(met)), np.argmin((astray**2).sum(axis=-1) / _DEARER, axis=1)
        bend = way * _AT_REST[1][:, None] + onward * _MOVING[1][:, None]
        bend = bend + astray[rows, best][:, None] * _AROUND[best][..., None]
        hardest = (np.abs(bend) / (time**2 * legs.acceleration)).max(axis=(1, 2))
        lacking[which] = np.where(met, (1.0 - 1.0 / np.maximum(hardest, 1.0)) * np.hypot(*way[:, 0].T), 0.0)
        return lacking


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
    rotation, origin, side = frame_rotation(stance.yaw), stance.position[:2], swing.foot.side
    times = np.arange(max(time, swing.start_time), swing.glide_end + 0.5 * sample_time, sample_time)
    if not (side * ((swing.positions(times[[0, -1]])[:, :2] - origin) @ rotation)[:, 1] < 0.0).any():
        return swing  # as nearly all of them: beside its stance foot at both ends
    way = (swing.positions(times)[:, :2] - origin) @ rotation
    corner = legs.turned(wrap_angle(float(swing.target[3]) - stance.yaw)).corner(way, side)
    if corner is None:
        return swing
    bent = swing.around(origin + rotation @ corner, sample_time)
    hardest = np.abs([bent.evaluate(instant)[2, :2] @ rotation for instant in times.tolist()]).max(axis=0)
    return bent if (hardest <= legs.acceleration).all() else swing


_SHARES = np.linspace(0.1, 0.9, 9)
"""Shares of a swing's time at which its way around the stance leg is looked at [-]."""

_DEARER = (_SHARES * (1.0 - _SHARES)) ** 5
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


_AT_REST, _MOVING, _AROUND = _unit_ways()
