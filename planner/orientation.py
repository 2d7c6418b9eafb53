"""Orientation of a sole: its heading, and the pitch and roll with which it lies flat on tilted ground.

The sole's frame is turned by yaw about the vertical, then by pitch about its new lateral axis, then by roll about its
new forward axis: R = R_z(yaw) R_y(pitch) R_x(roll). Yaw is the heading of its forward axis seen from above, whatever
the tilt; uphill, pitch is negative.
"""

import math

import numpy as np

from planner.types import Array


def sole_angles(normal: Array, yaw: float) -> tuple[float, float]:
    """Pitch and roll of a sole of a heading that lies flat on ground [rad].

    Args:
        normal: unit normal of the ground, upwards, shape (3,) [-].
        yaw: heading [rad].
    """
    x, y, z = normal.tolist()
    c, s = math.cos(yaw), math.sin(yaw)
    return math.atan2(c * x + s * y, z), math.asin(s * x - c * y)


def sole_pose(position: Array, yaw: float, normal: Array) -> Array:
    """Position, yaw, pitch and roll of a sole flat on ground of a normal, shape (6,) [m, rad]."""
    return np.array([*position.tolist(), yaw, *sole_angles(normal, yaw)])


def sole_rotation(yaw: float, pitch: float, roll: float) -> Array:
    """Rotation from the sole's frame to the world, shape (3, 3)."""
    (cy, cp, cr), (sy, sp, sr) = ((f(yaw), f(pitch), f(roll)) for f in (math.cos, math.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def sole_rates(angles: Array, rates: Array, accelerations: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration of a sole in the world frame, shape (3,) each [rad/s, rad/s^2].

    With the axes z of the world, j = (-sin yaw, cos yaw, 0) of the pitch and k of the roll, the sole's forward axis,
    ω = yaw' z + pitch' j + roll' k.

    Args:
        angles: yaw, pitch, roll, shape (3,) [rad].
        rates: their rates, shape (3,) [rad/s].
        accelerations: their second derivatives, shape (3,) [rad/s^2].
    """
    yaw, pitch, _ = angles.tolist()
    (turn, tilt, lean), (turn2, tilt2, lean2) = rates.tolist(), accelerations.tolist()
    c, s, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    velocity = (lean * cp * c - tilt * s, lean * cp * s + tilt * c, turn - lean * sp)
    # Axis j turns with yaw', axis k with yaw' and pitch'.
    across, along = tilt2 + lean * turn * cp, lean2 * cp - lean * tilt * sp - tilt * turn
    return np.array(velocity), np.array(
        (along * c - across * s, along * s + across * c, turn2 - lean2 * sp - lean * tilt * cp)
    )
