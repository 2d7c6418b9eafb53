"""The reference of the whole-body controller in a control tick, as one value."""

from dataclasses import Field, make_dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surefoot.maths.algebra import Vector

Array = NDArray[np.float64]

LEVEL: Vector = (0.0, 0.0, 0.0)
"""Pitch of a foot that does not roll, and its derivatives [rad, rad/s, rad/s^2]."""


class WbcReference:
    """The reference of the whole-body controller until its next tick; world frame.

    Positions and velocities are those of now, accelerations and ZMPs those in the middle of the time until then. Arrays
    are fresh at every access. The standard library takes it for a frozen dataclass: ``dataclasses.replace`` changes it.
    Laws read the same numbers without arrays, by the symbols of the equations (``_c`` is ``com``).

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
        edge: of each foot (left, right) that on which it rolls: 1 the toe edge, -1 the heel edge, 0 none of them, its
            sole lies flat. The `swing_position` of a foot that rolls is that of the sole as if it lay flat [-].
        roll: (pitch, rate, acceleration) of each foot, heel up positive [rad, rad/s, rad/s^2].
        pelvis_yaw: angle by which the pelvis turns to the left of the heading, its rate and acceleration, shape (3,)
            [rad, rad/s, rad/s^2].
        pelvis_list: angle by which its left side is up, its rate and acceleration, shape (3,) [rad, rad/s, rad/s^2].
        catching: whether the next footstep is being adapted to catch the body, but on stairs and blocks.
    """

    __match_args__ = (
        "com", "com_velocity", "com_acceleration", "zmp", "zmp_offset", "omega", "stiffness", "heading",
        "heading_rate", "planned_contact", "load_share", "time_to_switch", "lifting_foot", "swing_foot",
        "swing_progress", "swing_position", "swing_velocity", "swing_acceleration", "swing_rotation",
        "swing_angular_velocity", "swing_angular_acceleration", "ground_normal", "edge", "roll", "pelvis_yaw",
        "pelvis_list", "catching",
    )  # fmt: skip
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]] = vars(
        make_dataclass("WbcReference", __match_args__, init=False, repr=False, eq=False)
    )["__dataclass_fields__"]

    def __init__(
        self,
        com: ArrayLike,
        com_velocity: ArrayLike,
        com_acceleration: ArrayLike,
        zmp: ArrayLike,
        zmp_offset: ArrayLike,
        omega: float,
        stiffness: float,
        heading: float,
        heading_rate: float,
        planned_contact: tuple[bool, bool],
        load_share: tuple[float, float],
        time_to_switch: float,
        lifting_foot: int,
        swing_foot: int,
        swing_progress: float,
        swing_position: ArrayLike,
        swing_velocity: ArrayLike,
        swing_acceleration: ArrayLike,
        swing_rotation: ArrayLike,
        swing_angular_velocity: ArrayLike,
        swing_angular_acceleration: ArrayLike,
        ground_normal: ArrayLike,
        edge: tuple[int, int] = (0, 0),
        roll: tuple[Vector, Vector] = (LEVEL, LEVEL),
        pelvis_yaw: Vector = LEVEL,
        pelvis_list: Vector = LEVEL,
        catching: bool = False,
    ) -> None:
        """Take the attributes.

        Raises:
            ValueError: an array has another shape.
        """
        self._c, self._c_dot = _vector(com), _vector(com_velocity)
        self._c_ddot = _vector(com_acceleration)
        self._p, self._o = _point(zmp), _point(zmp_offset)
        self.omega, self.stiffness = omega, stiffness
        self.heading, self.heading_rate = heading, heading_rate
        self.planned_contact, self.load_share = planned_contact, load_share
        self.time_to_switch, self.lifting_foot = time_to_switch, lifting_foot
        self.swing_foot, self.swing_progress = swing_foot, swing_progress
        self._s, self._s_dot = _vector(swing_position), _vector(swing_velocity)
        self._s_ddot = _vector(swing_acceleration)
        first, second, third = np.asarray(swing_rotation, dtype=np.float64)
        self._R = _vector(first), _vector(second), _vector(third)
        self._w, self._w_dot = _vector(swing_angular_velocity), _vector(swing_angular_acceleration)
        left, right = np.asarray(ground_normal, dtype=np.float64)
        self._n = _vector(left), _vector(right)
        self.edge, self.roll, self.catching = edge, roll, catching
        self.pelvis_yaw, self.pelvis_list = pelvis_yaw, pelvis_list

    @property
    def com(self) -> Array:
        """CoM position, shape (3,) [m]."""
        return np.array(self._c)

    @property
    def com_velocity(self) -> Array:
        """CoM velocity, shape (3,) [m/s]."""
        return np.array(self._c_dot)

    @property
    def com_acceleration(self) -> Array:
        """CoM acceleration, shape (3,) [m/s^2]."""
        return np.array(self._c_ddot)

    @property
    def zmp(self) -> Array:
        """Point that drives the pendulum, shape (2,) [m]."""
        return np.array(self._p)

    @property
    def zmp_offset(self) -> Array:
        """ZMP less that point, shape (2,) [m]."""
        return np.array(self._o)

    @property
    def swing_position(self) -> Array:
        """Sole centre of the swing foot, shape (3,) [m]."""
        return np.array(self._s)

    @property
    def swing_velocity(self) -> Array:
        """Velocity of that centre, shape (3,) [m/s]."""
        return np.array(self._s_dot)

    @property
    def swing_acceleration(self) -> Array:
        """Acceleration of that centre, shape (3,) [m/s^2]."""
        return np.array(self._s_ddot)

    @property
    def swing_rotation(self) -> Array:
        """Orientation of the swing sole, shape (3, 3) [-]."""
        return np.array(self._R)

    @property
    def swing_angular_velocity(self) -> Array:
        """Angular velocity of the swing sole, shape (3,) [rad/s]."""
        return np.array(self._w)

    @property
    def swing_angular_acceleration(self) -> Array:
        """Angular acceleration of the swing sole, shape (3,) [rad/s^2]."""
        return np.array(self._w_dot)

    @property
    def ground_normal(self) -> Array:
        """Normals of the ground under the soles, shape (2, 3) [-]."""
        return np.array(self._n)

    def __repr__(self) -> str:
        """All attributes, as a dataclass shows them."""
        return f"WbcReference({', '.join(f'{name}={getattr(self, name)!r}' for name in self.__match_args__)})"


def _vector(values: ArrayLike) -> Vector:
    x, y, z = np.asarray(values, dtype=np.float64).tolist()
    return x, y, z


def _point(values: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(values, dtype=np.float64).tolist()
    return x, y
