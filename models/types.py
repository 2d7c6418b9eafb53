"""What a robot is to the rest of the stack: one MJCF text and the numbers that were written into it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class RobotError(ValueError):
    """A robot was asked for in a way that no robot can have, or a description contradicts itself."""


@dataclass(frozen=True, slots=True)
class RobotOptions:
    """Choices that every robot offers.

    Attributes:
        foot_length: sole length [m]; None keeps the robot's own.
        foot_width: sole width [m]; None keeps the robot's own.
        payload_mass: point mass fixed at the CoM of `payload_body` [kg].
        payload_body: body that carries the payload; None is the torso.
    """

    foot_length: float | None = None
    foot_width: float | None = None
    payload_mass: float = 0.0
    payload_body: str | None = None


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """A robot, complete: `mjcf` is read by MuJoCo and by Pinocchio, the rest repeats facts of that text.

    Joints are revolute, one motor each, in the order of the MJCF, which is the order of both engines. Arrays are
    read-only.

    Attributes:
        name: name in the registry.
        mjcf: XML of the robot alone: free joint, explicit inertials, motors, sole and IMU sites, materials.
        mass: total mass with the payload [kg].
        joint_names: actuated joints, length nj.
        torque_limit: peak joint torque, shape (nj,) [N m].
        velocity_limit: no-load joint speed, shape (nj,) [rad/s].
        position_lower: lower joint limits, shape (nj,) [rad].
        position_upper: upper joint limits, shape (nj,) [rad].
        sole_sites: site at the centre of the bottom face of the left and of the right sole; x forward, z up.
        sole_length: sole size along x [m].
        sole_width: sole size along y [m].
        pelvis_body: the floating base.
        torso_body: body whose uprightness is controlled.
        imu_site: site of the IMU; it coincides with the frame of the floating base.
        hip_width: distance between the hip centres [m].
        leg_length: hip centre to sole with a straight leg [m].
        nominal_joint_positions: mild crouch with relaxed arms, the start of an IK, shape (nj,) [rad].
        com_height: nominal CoM height above the soles in walking [m].
        bodies: all body names.
        kept_apart: pairs of named contact shapes of different limbs that the controller keeps apart.
    """

    name: str
    mjcf: str
    mass: float
    joint_names: tuple[str, ...]
    torque_limit: Array
    velocity_limit: Array
    position_lower: Array
    position_upper: Array
    sole_sites: tuple[str, str]
    sole_length: float
    sole_width: float
    pelvis_body: str
    torso_body: str
    imu_site: str
    hip_width: float
    leg_length: float
    nominal_joint_positions: Array
    com_height: float
    bodies: tuple[str, ...]
    kept_apart: tuple[tuple[str, str], ...]
