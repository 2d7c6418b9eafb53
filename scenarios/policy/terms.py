"""Observation terms: functions of what is known of the robot, each with its frame and unit."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.maths import algebra
from surefoot.parts.plugins import Registry
from surefoot.planner.types import Twist
from surefoot.scenarios.documented import doc_of

Array = NDArray[np.float64]

_KEY = ("controller", "policy")


@dataclass(frozen=True, slots=True)
class Seen:
    """The values that a policy may be given at a decision.

    Attributes:
        time: since the policy was reset [s].
        walked: time in which it was not to stand, of it [s].
        since: time since it was last to stand [s].
        rotation: orientation of the base in the world, shape (3, 3).
        torso_rotation: orientation of the torso in the world, shape (3, 3).
        angular_velocity: of the base in its frame, shape (3,) [rad/s].
        torso_angular_velocity: of the torso in its frame, shape (3,) [rad/s].
        linear_velocity: of the base in its frame, shape (3,) [m/s].
        height: of the base over the lower sole [m].
        position: of the joints that the term tells, shape (k,) [rad].
        default: of these joints in the default posture, shape (k,) [rad].
        velocity: of these joints, shape (k,) [rad/s].
        action: last output of the network as it was, zero at first, shape (m,).
        command: velocity to be followed.
        stands: whether the robot is to stand, rather than to follow a velocity or to march in place.
    """

    time: float
    walked: float
    since: float
    rotation: Array
    torso_rotation: Array
    angular_velocity: Array
    torso_angular_velocity: Array
    linear_velocity: Array
    height: float
    position: Array
    default: Array
    velocity: Array
    action: Array
    command: Twist
    stands: bool


Observation = Callable[..., Any]
"""A function of the observed values, and of options by name, that returns numbers."""


def angular_velocity(seen: Seen, body: str = "base") -> Array:
    """Angular velocity of the base, or the torso, in its frame, 3 [rad/s]."""
    return seen.angular_velocity if body == "base" else seen.torso_angular_velocity


def gravity(seen: Seen, body: str = "base") -> Array:
    """Direction of gravity in the frame of the base, or the torso, (0, 0, -1) upright, 3 [-]."""
    R = seen.rotation if body == "base" else seen.torso_rotation
    return np.array(-R[2])


def orientation(seen: Seen, order: str = "wxyz", body: str = "base") -> Array:
    """Quaternion of the base, or the torso, in the world, w first, or last with order xyzw, 4 [-]."""
    R = seen.rotation if body == "base" else seen.torso_rotation
    x, y, z, w = quaternion(R)
    return np.array([x, y, z, w] if order == "xyzw" else [w, x, y, z])


def roll_pitch(seen: Seen) -> Array:
    """Roll and pitch of the base, of angles about z, y, x in turn, 2 [rad]."""
    R = seen.rotation
    return np.array([math.atan2(R[2, 1], R[2, 2]), -math.asin(algebra.clamp(float(R[2, 0]), -1.0, 1.0))])


def linear_velocity(seen: Seen) -> Array:
    """Velocity of the base in its frame, which no sensor of a robot tells, 3 [m/s]."""
    return seen.linear_velocity


def command(seen: Seen, axes: Sequence[int] = (0, 1, 2)) -> Array:
    """Velocity to be followed: forward, left, of the heading, or some of these axes, 3 [m/s, m/s, rad/s]."""
    return np.array([seen.command[axis] for axis in axes])


def moving(seen: Seen) -> Array:
    """1 where a velocity is to be followed or the robot marches, 0 where it is to stand, 1 [-]."""
    return np.array([0.0 if seen.stands else 1.0])


def joint_position(seen: Seen, relative: bool = True) -> Array:
    """Angles of the joints less those of the default posture, or as they are, k [rad]."""
    return seen.position - seen.default if relative else seen.position


def joint_velocity(seen: Seen) -> Array:
    """Speeds of the joints, k [rad/s]."""
    return seen.velocity


def last_action(seen: Seen) -> Array:
    """Last output of the network before clip and scale, m [-]."""
    return seen.action


def phase(
    seen: Seen,
    period: float = 0.8,
    offsets: Sequence[float] = (0.0,),
    waves: Sequence[str] = ("sin", "cos"),
    grouped: bool = False,
    begin: float = 0.0,
    stance: float = 0.5,
    rest: float | Literal["zeros"] | None = None,
    clock: Literal["always", "walking", "anew"] = "always",
) -> Array:
    """Sine and cosine of a clock at each offset, or all sines first, 2 for each [-].

    Args:
        seen: what is known.
        period: of the clock [s].
        offsets: shares of it, one for each foot [-].
        waves: which of sin and cos are given.
        grouped: wave by wave, else offset by offset.
        begin: share at the reset [-].
        stance: share that is taken for the first half turn [-].
        rest: share at which the clock stands while the robot is to stand, or zeros for all numbers then; None where it
            is given as it is [-].
        clock: runs always, only while the robot is to walk, or anew from when it last was to stand.
    """
    times = {"always": seen.time, "walking": seen.walked, "anew": seen.since}
    if clock not in times:
        raise ParameterError(_KEY, f"term phase has no clock '{clock}'", "give always, walking or anew")
    if isinstance(rest, str) and rest != "zeros":
        raise ParameterError(_KEY, f"term phase has rest '{rest}'", "give a share, or zeros")
    turn = begin + times[clock] / period
    shares = [(turn + one) % 1.0 for one in offsets]
    if seen.stands and rest is not None:
        if rest == "zeros":
            return np.zeros(len(offsets) * len(waves))
        shares = [rest] * len(offsets)
    turns = [
        math.pi * (share / stance if share < stance else 1.0 + (share - stance) / (1.0 - stance)) for share in shares
    ]
    found = np.array([[math.sin(turn) if wave == "sin" else math.cos(turn) for wave in waves] for turn in turns])
    return found.T.ravel() if grouped else found.ravel()


def height(seen: Seen) -> Array:
    """Height of the base over the lower sole, 1 [m]."""
    return np.array([seen.height])


def constant(seen: Seen, values: Sequence[float] = (0.0,)) -> Array:
    """Numbers that never change, such as a height that is asked for."""
    return np.array(values, dtype=np.float64)


OWN: Mapping[str, Observation] = {
    function.__name__: function
    for function in (
        angular_velocity, gravity, orientation, roll_pitch, linear_velocity, command, moving, joint_position,
        joint_velocity, last_action, phase, height, constant,
    )
}  # fmt: skip
OF_BASE = frozenset(OWN) - {"height"}
"""Terms that need no more than base and joints, but for options."""

TERMS: Registry[Observation] = Registry("surefoot.observations", None, OWN)
"""All terms by name: ours, then those of other packages."""


def quaternion(R: Array) -> tuple[float, float, float, float]:
    """The quaternion of a rotation, shape (3, 3), its real part last and not negative."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(R).as_quat(canonical=True).tolist()
    return x, y, z, w


def meaning(name: str) -> str:
    """Meaning of a term, in a line."""
    return doc_of(TERMS[name]).strip().split("\n", 1)[0]
