"""The robot `humanoid100`: 100.0 kg without payload, 1.80 m tall, 25 joints."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

import surefoot.models.humanoid100.dimensions as dim
from surefoot.models import inertia
from surefoot.models.humanoid100.leg import leg
from surefoot.models.humanoid100.upper_body import upper_body
from surefoot.models.mjcf import robot_mjcf
from surefoot.models.options import foot_size, with_payload
from surefoot.models.tree import Body, Geom, Role
from surefoot.models.types import Array, RobotDescription, RobotOptions

NAME = "humanoid100"

_MATERIALS: Mapping[str, Mapping[str, str]] = {
    "shell": {"rgba": "0.84 0.85 0.87 1", "specular": "0.4", "shininess": "0.6"},
    "joint": {"rgba": "0.16 0.17 0.20 1", "specular": "0.5", "shininess": "0.5"},
    "trim": {"rgba": "0.42 0.46 0.52 1", "specular": "0.4", "shininess": "0.6"},
    "accent": {"rgba": "0.95 0.45 0.10 1", "specular": "0.4", "shininess": "0.6"},
    "rubber": {"rgba": "0.08 0.08 0.09 1", "specular": "0.1", "shininess": "0.1"},
    "visor": {"rgba": "0.05 0.10 0.16 1", "specular": "0.9", "shininess": "0.9"},
}

_NEIGHBOURS = (
    ("pelvis", "torso"),
    ("torso", "head"),
    *(("pelvis", f"{side}_thigh") for side in ("left", "right")),
    *((f"{side}_shank", f"{side}_foot") for side in ("left", "right")),
    *(("torso", f"{side}_upper_arm") for side in ("left", "right")),
)
"""Bodies with small links between them, whose shapes overlap at the joint."""

_KEPT_APART = (
    *((f"left_{part}", f"right_{part}") for part in ("thigh_shape", "shank_shape", "sole_box")),
    *((f"{side}_sole_box", f"{other}_shank_shape") for side, other in (("left", "right"), ("right", "left"))),
    *((f"{side}_{part}_shape", f"{side}_thigh_shape") for side in ("left", "right") for part in ("forearm", "hand")),
)
"""Contact shapes of different limbs that can meet in walking."""


def describe(options: RobotOptions) -> RobotDescription:
    """The robot with the chosen feet and payload.

    Raises:
        RobotError: an option is out of range or names an unknown body.
    """
    length, width = foot_size(options, dim.FOOT_LENGTH, dim.FOOT_WIDTH)
    base = with_payload(_pelvis(length, width), options, default_body="torso")
    bodies = tuple(base.walk())
    joints = tuple(body.joint for body in bodies if body.joint is not None)
    return RobotDescription(
        name=NAME,
        mjcf=robot_mjcf(NAME, replace(base, position=(0.0, 0.0, dim.LEG)), _MATERIALS, _NEIGHBOURS),
        mass=float(sum(body.inertial.mass for body in bodies)),
        joint_names=tuple(joint.name for joint in joints),
        torque_limit=_constant([joint.actuator.torque_limit for joint in joints]),
        velocity_limit=_constant([joint.actuator.velocity_limit for joint in joints]),
        position_lower=_constant([joint.lower for joint in joints]),
        position_upper=_constant([joint.upper for joint in joints]),
        sole_sites=("left_sole", "right_sole"),
        sole_length=length,
        sole_width=width,
        pelvis_body="pelvis",
        torso_body="torso",
        imu_site="imu",
        hip_width=2 * dim.HIP_HALF_WIDTH,
        leg_length=dim.LEG,
        nominal_joint_positions=_mild_crouch(tuple(joint.name for joint in joints)),
        com_height=1.0,
        bodies=tuple(body.name for body in bodies),
        kept_apart=_KEPT_APART,
    )


def _pelvis(foot_length: float, foot_width: float) -> Body:
    """The floating base; its frame is midway between the hip centres."""
    return Body(
        "pelvis",
        (0.0, 0.0, 0.0),
        inertia.ellipsoid(14.2, (0.10, 0.15, 0.10), (0.0, 0.0, 0.035)),
        geoms=(
            Geom("ellipsoid", (0.095, 0.135, 0.065), (0.0, 0.0, 0.055)),
            Geom("ellipsoid", (0.08, 0.055, 0.085), (0.0, 0.0, 0.01), material="joint"),
            Geom("sphere", (0.11,), (0.0, 0.0, 0.03), role=Role.COLLISION),
        ),
        sites=(("imu", (0.0, 0.0, 0.0)),),
        children=(
            leg("left", foot_length, foot_width),
            leg("right", foot_length, foot_width),
            upper_body(),
        ),
    )


def _constant(values: list[float]) -> Array:
    """A read-only array."""
    array: Array = np.array(values)
    array.setflags(write=False)
    return array


def _mild_crouch(joint_names: tuple[str, ...]) -> Array:
    """Joint angles [rad] with the CoM near 1.0 m above the soles and hanging arms."""
    knee = 0.65
    angles = {
        "hip_pitch": -knee / 2,
        "knee": knee,
        "ankle_pitch": -knee / 2,
        "shoulder_pitch": 0.1,
        "left_shoulder_roll": 0.12,
        "right_shoulder_roll": -0.12,
        "elbow": -0.4,
    }
    return _constant([angles.get(name, angles.get(name.split("_", 1)[-1], 0.0)) for name in joint_names])
