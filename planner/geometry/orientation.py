"""The orientation of soles, as rotations and as angles with their rates.

The sole's frame is turned by yaw about the vertical, then by pitch about its new lateral axis, then by roll about its
new forward axis: R = R_z(yaw) R_y(pitch) R_x(roll). Yaw is the heading of its forward axis seen from above, whatever
the tilt; uphill, pitch is negative.
"""

import math

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.types import Array


def sole_rotation(yaw: float, pitch: float, roll: float) -> Array:
    """Rotation from the sole's frame to the world, shape (3, 3)."""
    R = np.empty((3, 3))
    turn_sole((yaw, pitch, roll), R)
    return R


def turn_sole(angles: algebra.Vector, R: Array) -> None:
    """Write what `sole_rotation` gives into an array, shape (3, 3)."""
    x, y, z = rows(angles)
    algebra.put_row(R, 0, x)
    algebra.put_row(R, 1, y)
    algebra.put_row(R, 2, z)


def rows(angles: algebra.Vector) -> tuple[algebra.Vector, algebra.Vector, algebra.Vector]:
    """Rows of what `sole_rotation` gives."""
    cy, cp, cr = math.cos(angles[0]), math.cos(angles[1]), math.cos(angles[2])
    sy, sp, sr = math.sin(angles[0]), math.sin(angles[1]), math.sin(angles[2])
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


def sole_rates(angles: Array, rates: Array, accelerations: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration of a sole in the world frame, shape (3,) each [rad/s, rad/s^2].

    Args:
        angles: yaw, pitch, roll, shape (3,) [rad].
        rates: their rates, shape (3,) [rad/s].
        accelerations: their second derivatives, shape (3,) [rad/s^2].
    """
    angle, turning, bending = (algebra.vector(np.asarray(part, float)) for part in (angles, rates, accelerations))
    return np.array(sole_spin(angle, turning)), np.array(sole_spin_rate(angle, turning, bending))


def sole_spin(angles: algebra.Vector, rates: algebra.Vector) -> algebra.Vector:
    """Angular velocity of a sole, of arguments as `sole_rates` takes them.

    With the axes z of the world, j = (-sin yaw, cos yaw, 0) of the pitch and k of the roll, the sole's forward axis,
    ω = yaw' z + pitch' j + roll' k.
    """
    turn, tilt, lean = rates
    c, s, cp, sp = math.cos(angles[0]), math.sin(angles[0]), math.cos(angles[1]), math.sin(angles[1])
    return lean * cp * c - tilt * s, lean * cp * s + tilt * c, turn - lean * sp


def sole_spin_rate(angles: algebra.Vector, rates: algebra.Vector, accelerations: algebra.Vector) -> algebra.Vector:
    """Its angular acceleration, of the same: axis j turns with yaw', axis k with yaw' and pitch'."""
    turn, tilt, lean = rates
    turn2, tilt2, lean2 = accelerations
    c, s, cp, sp = math.cos(angles[0]), math.sin(angles[0]), math.cos(angles[1]), math.sin(angles[1])
    across, along = tilt2 + lean * turn * cp, lean2 * cp - lean * tilt * sp - tilt * turn
    return along * c - across * s, along * s + across * c, turn2 - lean2 * sp - lean * tilt * cp


def roll_sole(
    level: Array, rates: Array, pivot: float, pitch: float, rate: float, centre: Array, velocity: Array
) -> None:
    """Write where the centre of a sole is, and how it moves, that is turned about an edge of it.

    Args:
        level: pose of the sole as if it were level, x, y, z [m], yaw, pitch, roll [rad], shape (6,).
        rates: its rates, shape (6,) [m/s, rad/s].
        pivot: the edge, ahead of the sole's centre [m].
        pitch: by which it is turned [rad].
        rate: of that [rad/s].
        centre: to be written, shape (3,) [m]; it may be part of `level`.
        velocity: to be written, shape (3,) [m/s]; it may be part of `rates`.
    """
    angles, turning = algebra.vector(level[3:]), algebra.vector(rates[3:])
    sine, cosine = math.sin(pitch), math.cos(pitch)
    R = np.empty((3, 3))
    turn_sole(angles, R)
    away = algebra.rotate(R, (pivot * (1.0 - cosine), 0.0, pivot * sine))
    moving = algebra.rotate(R, (pivot * rate * sine, 0.0, pivot * rate * cosine))
    turned = algebra.cross(sole_spin(angles, turning), away)
    algebra.put(centre, algebra.add(algebra.vector(level), away))
    algebra.put(velocity, algebra.add(algebra.add(algebra.vector(rates), moving), turned))
