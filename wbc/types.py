"""Values that cross the whole-body controller's boundary.

Robot states follow Pinocchio: ``q = [base position, base quaternion xyzw, joints]`` and
``v = [base linear, base angular, joints]`` with the base velocity in the base frame. Foot arrays hold the left
foot first. Wrenches are ``[fx, fy, fz, tx, ty, tz]`` at the sole centre in the sole frame. Units are SI.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.similarity import GRAVITY as GRAVITY
from surefoot.values import opened

Array = NDArray[np.float64]


class SolveStatus(IntEnum):
    """Where the torque of one tick came from."""

    SOLVED = 0
    """The default solver solved the QP."""
    SECOND_SOLVER = 1
    """The default solver failed and another one solved it."""
    EQUALITIES_ONLY = 2
    """All failed: dynamics and contacts hold, inequalities are dropped and the torque is clipped."""
    HELD = 3
    """Nothing could be solved: the last torque is held and faded into damping."""
    SOFTENED = 4
    """Nothing holds all limits: some are broken, of those of the joints' motion and of the distances between limbs.

    Where that does not do, soles that are to rest move as well."""


@dataclass(frozen=True, slots=True)
class RobotState:
    """State of the floating-base robot.

    Attributes:
        q: configuration, shape (nq,) [m, -, rad].
        v: velocity, shape (nv,) [m/s, rad/s].
    """

    q: Array
    v: Array


NONE_TOUCHES = (False, False)


@dataclass(frozen=True, slots=True)
class FootSensing:
    """What the feet feel.

    Attributes:
        normal_force: force along each sole's normal, (left, right) [N].
        wrench: sole wrenches in the sole frames, shape (2, 6) [N, N·m]; without them no load is estimated.
        contact: which soles the ground carries, (left, right); None where the normal forces shall tell.
        load_deviation: standard deviations of the force and of the moment that momentum and wrenches give for a load,
            zero for the truth, infinite where they give none [N, N·m].
        wrench_age: time since the wrenches acted, by latency and filters; zero for the truth [s].
        touching: soles that nothing is felt of yet, and that are about to come to the ground, (left, right).
    """

    normal_force: tuple[float, float]
    wrench: Array | None = None
    contact: tuple[bool, bool] | None = None
    load_deviation: tuple[float, float] = (0.0, 0.0)
    wrench_age: float = 0.0
    touching: tuple[bool, bool] = NONE_TOUCHES


_put = object.__setattr__

ARRAYS: Mapping[str, tuple[int, tuple[int, ...]]] = {
    "com": (0, (3,)),
    "com_velocity": (3, (3,)),
    "com_acceleration": (6, (3,)),
    "zmp": (9, (2,)),
    "zmp_offset": (11, (2,)),
    "swing_position": (13, (3,)),
    "swing_velocity": (16, (3,)),
    "swing_acceleration": (19, (3,)),
    "swing_angular_velocity": (22, (3,)),
    "swing_angular_acceleration": (25, (3,)),
    "swing_rotation": (28, (3, 3)),
    "ground_normal": (37, (2, 3)),
}
"""Where the arrays of a reference are in its numbers, and their shapes."""
_IN_NUMBERS: Mapping[str, tuple[int, tuple[int, ...]]] = {
    **ARRAYS,
    "omega": (43, ()),
    "stiffness": (44, ()),
    "heading": (45, ()),
    "heading_rate": (46, ()),
    "load_share": (47, (2,)),
    "roll": (49, (3,)),
}
"""Where the fields of a reference are in its numbers, and their shapes; arrays first, then plain numbers."""


def in_numbers(name: str) -> slice:
    """Where a field of a reference is in its numbers."""
    start, shape = _IN_NUMBERS[name]
    return slice(start, start + math.prod(shape))


@dataclass(frozen=True, slots=True)
class WbcReference:
    """What the whole-body controller shall do until its next tick; world frame.

    Positions and velocities are those of now, accelerations and ZMPs those in the middle of the time until then.

    Attributes:
        com: CoM position, shape (3,) [m].
        com_velocity: CoM velocity, shape (3,) [m/s].
        com_acceleration: CoM acceleration, shape (3,) [m/s^2].
        zmp: the point p that drives the pendulum, c'' = λ (c - p), in the horizontal plane, shape (2,) [m].
        zmp_offset: the ZMP less that point, what the swing leg's inertia adds, shape (2,) [m].
        omega: natural frequency of the time-varying DCM [1/s].
        stiffness: pendulum stiffness λ = (g + z'') / (z - p_z) [1/s^2].
        heading: yaw of pelvis and torso [rad].
        heading_rate: its rate [rad/s].
        planned_contact: which feet the plan has on the ground, (left, right).
        load_share: share of the weight the plan puts on each foot, (left, right), sums to 1 [-].
        time_to_switch: time until the plan's next contact change [s]; infinite when standing.
        lifting_foot: index of the foot that the plan lifts at that change, -1 for none.
        swing_foot: index of the swing foot, -1 when both feet stand.
        swing_progress: share of the swing that has passed, 0 to 1 [-].
        swing_position: sole centre of the swing foot, shape (3,) [m].
        swing_velocity: its velocity, shape (3,) [m/s].
        swing_acceleration: its acceleration, shape (3,) [m/s^2].
        swing_rotation: orientation of its sole, shape (3, 3) [-].
        swing_angular_velocity: of its sole, shape (3,) [rad/s].
        swing_angular_acceleration: of its sole, shape (3,) [rad/s^2].
        ground_normal: unit normals of the ground on which the soles stand, or will land, shape (2, 3) [-].
        rolling_foot: index of the foot that rolls about its toe edge, -1 for none; its `swing_position` is that of the
            sole as if it lay flat.
        roll: (pitch, rate, acceleration) of that foot, heel up positive [rad, rad/s, rad/s^2].
        catching: whether the next footstep is being adapted to catch the body, but on stairs and blocks.
        numbers: the same side by side, in the order of `in_numbers`, shape (55,) [SI]; None where it was made field by
            field.
    """

    com: Array
    com_velocity: Array
    com_acceleration: Array
    zmp: Array
    zmp_offset: Array
    omega: float
    stiffness: float
    heading: float
    heading_rate: float
    planned_contact: tuple[bool, bool]
    load_share: tuple[float, float]
    time_to_switch: float
    lifting_foot: int
    swing_foot: int
    swing_progress: float
    swing_position: Array
    swing_velocity: Array
    swing_acceleration: Array
    swing_rotation: Array
    swing_angular_velocity: Array
    swing_angular_acceleration: Array
    ground_normal: Array
    rolling_foot: int = -1
    roll: tuple[float, float, float] = (0.0, 0.0, 0.0)
    catching: bool = False
    numbers: Array | None = field(init=False, default=None, repr=False, compare=False)

    @classmethod
    def of_numbers(
        cls,
        numbers: Array,
        planned_contact: tuple[bool, bool],
        time_to_switch: float,
        lifting_foot: int,
        swing_foot: int,
        swing_progress: float,
        rolling_foot: int,
        catching: bool = False,
    ) -> "WbcReference":
        """A reference out of its numbers side by side, and what they do not know of it.

        Those numbers become fields when they are first read.

        Args:
            numbers: in the order of `in_numbers`, shape (55,) [SI].
            planned_contact: as of the attribute.
            time_to_switch: likewise [s].
            lifting_foot: likewise.
            swing_foot: likewise.
            swing_progress: likewise [-].
            rolling_foot: likewise.
            catching: likewise.
        """
        made = _OpenReference()
        made.numbers, made.planned_contact, made.time_to_switch = numbers, planned_contact, time_to_switch
        made.lifting_foot, made.swing_foot, made.swing_progress = lifting_foot, swing_foot, swing_progress
        made.rolling_foot, made.catching, made.__class__ = rolling_foot, catching, cls
        return made  # type: ignore[no-any-return]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """A field that has not been read before."""
            if name not in _IN_NUMBERS:
                raise AttributeError(f"{type(self).__name__} has no attribute '{name}'")
            start, shape = _IN_NUMBERS[name]
            part = self.numbers[start : start + math.prod(shape)]
            value = part.reshape(shape) if name in ARRAYS else tuple(part.tolist()) if shape else part.item()
            _put(self, name, value)
            return value


_OpenReference = opened(WbcReference)


@dataclass(frozen=True, slots=True)
class WbcReport:
    """What the controller did in one tick. Arrays are overwritten by the next tick.

    Attributes:
        torque: joint torques, shape (nj,) [N·m].
        status: where the torque came from.
        iterations: iterations of the solver that answered.
        primal_residual: largest violation of the QP's constraints [-].
        dual_residual: largest violation of stationarity, NaN where the solver does not tell [-].
        acceleration: planned generalised acceleration, shape (nv,) [m/s^2, rad/s^2].
        wrench: planned contact wrenches, shape (2, 6) [N, N·m].
        active: contacts held by the QP, (left, right).
        felt: contacts felt by the feet, (left, right).
        task_error: residuals of all tasks before weighting, shape (rows,) [m/s^2, rad/s^2, N, N m]; names and sizes of
            the tasks are ``WholeBodyController.task_layout``.
        build_time: wall-clock time of load, contacts and assembly [s].
        solve_time: wall-clock time of the solve and of what it means [s].
        load: with which it counted.
    """

    torque: Array
    status: SolveStatus
    iterations: int
    primal_residual: float
    dual_residual: float
    acceleration: Array
    wrench: Array
    active: tuple[bool, bool]
    felt: tuple[bool, bool]
    task_error: Array
    build_time: float
    solve_time: float
    load: ExternalLoad = NO_LOAD


@dataclass(frozen=True, slots=True)
class WbcAnswer:
    """What a solution means for the robot. Arrays are overwritten by the next one.

    Attributes:
        torque: joint torques within their limits, shape (nj,) [N·m].
        acceleration: planned generalised acceleration, shape (nv,) [m/s^2, rad/s^2].
        wrench: planned contact wrenches, in the sole frames, shape (2, 6) [N, N·m].
        task_error: residuals of all tasks before weighting, shape (rows,) [m/s^2, rad/s^2, N, N m].
    """

    torque: Array
    acceleration: Array
    wrench: Array
    task_error: Array
