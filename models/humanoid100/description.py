"""The robot `humanoid100`: 100.0 kg without payload, 1.80 m tall, 25 joints."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from surefoot.models import inertia
from surefoot.models.humanoid100.limbs import (
    FOOT_LENGTH,
    FOOT_WIDTH,
    HIP_HALF_WIDTH,
    LEG,
    NECK,
    NECK_HEIGHT,
    SHOULDER_HALF_WIDTH,
    SHOULDER_HEIGHT,
    WAIST,
    WAIST_HEIGHT,
    arm,
    leg,
)
from surefoot.models.mjcf import Body, Geom, Joint, Role, robot_mjcf
from surefoot.models.options import foot_size, with_payload
from surefoot.models.types import Array, JointRoles, Robot, RobotDescription, RobotOptions, fixed

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
    *((f"left_{part}", f"right_{part}") for part in ("thigh_shape", "knee_shape", "shank_shape", "sole_box")),
    *(
        (f"{side}_{part}", f"{other}_{across}")
        for part, across in (("knee_shape", "thigh_shape"), ("knee_shape", "shank_shape"), ("sole_box", "shank_shape"))
        for side, other in (("left", "right"), ("right", "left"))
    ),
    *(
        (f"{side}_{part}_shape", f"{other}_shape")
        for side in ("left", "right")
        for part in ("forearm", "hand")
        for other in ("left_thigh", "right_thigh", "pelvis")
    ),
)
"""Contact shapes of different limbs that can meet in walking."""

_LEG_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
_ROLES = JointRoles(
    left_leg=tuple(f"left_{joint}" for joint in _LEG_JOINTS),
    right_leg=tuple(f"right_{joint}" for joint in _LEG_JOINTS),
    knees=("left_knee", "right_knee"),
    waist=("waist_yaw", "waist_roll", "waist_pitch"),
    arm_swing=("left_shoulder_pitch", "right_shoulder_pitch"),
)


@lru_cache(maxsize=16)
def describe(options: RobotOptions) -> RobotDescription:
    """The robot with the chosen feet and payload.

    Raises:
        RobotError: an option is out of range or names an unknown body.
    """
    length, width = foot_size(options, FOOT_LENGTH, FOOT_WIDTH)
    base = with_payload(_pelvis(length, width), options, default_body="torso")
    bodies = tuple(base.walk())
    joints = tuple(body.joint for body in bodies if body.joint is not None)
    return RobotDescription(
        name=NAME,
        mjcf=robot_mjcf(NAME, replace(base, position=(0.0, 0.0, LEG)), _MATERIALS, _NEIGHBOURS),
        mass=float(sum(body.inertial.mass for body in bodies)),
        joint_names=tuple(joint.name for joint in joints),
        roles=_ROLES,
        torque_limit=fixed([joint.actuator.torque_limit for joint in joints]),
        velocity_limit=fixed([joint.actuator.velocity_limit for joint in joints]),
        position_lower=fixed([joint.lower for joint in joints]),
        position_upper=fixed([joint.upper for joint in joints]),
        sole_sites=("left_sole", "right_sole"),
        sole_length=length,
        sole_width=width,
        pelvis_body="pelvis",
        torso_body="torso",
        imu_site="imu",
        hip_width=2 * HIP_HALF_WIDTH,
        leg_length=LEG,
        shank_spacing=0.11,  # the contact shapes of the shanks are a decimetre thick
        nominal_joint_positions=_mild_crouch(tuple(joint.name for joint in joints)),
        straight_joint_positions=fixed([0.0] * len(joints)),
        com_height=1.0,
        bodies=tuple(body.name for body in bodies),
        kept_apart=_KEPT_APART,
    )


HUMANOID100 = Robot(NAME, describe)


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
    return fixed([angles.get(name, angles.get(name.split("_", 1)[-1], 0.0)) for name in joint_names])


def _pelvis(foot_length: float, foot_width: float) -> Body:
    """The floating base; its frame is midway between the hip centres."""
    return Body(
        "pelvis",
        (0.0, 0.0, 0.0),
        inertia.ellipsoid(14.2, (0.10, 0.15, 0.10), (0.0, 0.0, 0.035)),
        geoms=(
            Geom("ellipsoid", (0.095, 0.135, 0.065), (0.0, 0.0, 0.055)),
            Geom("ellipsoid", (0.08, 0.055, 0.085), (0.0, 0.0, 0.01), material="joint"),
            Geom("sphere", (0.11,), (0.0, 0.0, 0.03), role=Role.COLLISION, name="pelvis_shape"),
        ),
        sites=(("imu", (0.0, 0.0, 0.0)),),
        children=(
            leg("left", foot_length, foot_width),
            leg("right", foot_length, foot_width),
            _upper_body(),
        ),
    )


def _upper_body() -> Body:
    """Everything above the pelvis: waist yaw, roll, pitch; torso with arms and head."""
    return Body(
        "waist_yaw_link",
        (0.0, 0.0, WAIST_HEIGHT),
        inertia.sphere(1.0, 0.06),
        Joint("waist_yaw", "yaw", -1.2, 1.2, WAIST),
        (Geom("cylinder", (0.085,), ends=(0.0, 0.0, -0.035, 0.0, 0.0, 0.0), material="joint"),),
        children=(
            Body(
                "waist_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(1.0, 0.06),
                Joint("waist_roll", "roll", -0.6, 0.6, WAIST),
                (Geom("cylinder", (0.055,), ends=(-0.07, 0.0, 0.0, 0.07, 0.0, 0.0), material="joint"),),
                children=(_torso(),),
            ),
        ),
    )


def _torso() -> Body:
    shoulder = (SHOULDER_HALF_WIDTH - 0.06, SHOULDER_HEIGHT)
    return Body(
        "torso",
        (0.0, 0.0, 0.0),
        inertia.stacked(
            inertia.ellipsoid(11.9, (0.10, 0.14, 0.12), (0.0, 0.0, 0.11)),
            inertia.ellipsoid(21.6, (0.12, 0.17, 0.19), (0.0, 0.0, 0.31)),
        ),
        Joint("waist_pitch", "pitch", -0.5, 1.2, WAIST),
        (
            Geom("ellipsoid", (0.085, 0.115, 0.13), (0.0, 0.0, 0.09), material="joint"),
            Geom("ellipsoid", (0.115, 0.165, 0.18), (0.0, 0.0, 0.30)),
            Geom("capsule", (0.07,), ends=(0.0, -shoulder[0], shoulder[1], 0.0, shoulder[0], shoulder[1])),
            Geom("ellipsoid", (0.05, 0.075, 0.085), (0.06, 0.07, 0.335), material="trim"),
            Geom("ellipsoid", (0.05, 0.075, 0.085), (0.06, -0.07, 0.335), material="trim"),
            Geom("ellipsoid", (0.012, 0.026, 0.026), (0.114, 0.0, 0.325), material="accent"),
            Geom("capsule", (0.045,), ends=(-0.095, 0.05, 0.22, -0.095, 0.05, 0.37), material="joint"),
            Geom("capsule", (0.045,), ends=(-0.095, -0.05, 0.22, -0.095, -0.05, 0.37), material="joint"),
            Geom("cylinder", (0.045,), ends=(0.0, 0.0, 0.44, 0.0, 0.0, 0.48), material="joint"),
            Geom("capsule", (0.115,), ends=(0.0, 0.0, 0.12, 0.0, 0.0, 0.34), role=Role.COLLISION),
            Geom("capsule", (0.07,), ends=(0.0, -0.2, 0.4, 0.0, 0.2, 0.4), role=Role.COLLISION),
        ),
        children=(arm("left"), arm("right"), _neck()),
    )


def _neck() -> Body:
    head = Body(
        "head",
        (0.0, 0.0, 0.0),
        inertia.ellipsoid(7.5, (0.095, 0.08, 0.12), (0.01, 0.0, 0.13)),
        Joint("neck_pitch", "pitch", -0.7, 0.8, NECK),
        (
            Geom("capsule", (0.04,), ends=(0.0, 0.0, 0.0, 0.0, 0.0, 0.06), material="joint"),
            Geom("ellipsoid", (0.098, 0.082, 0.098), (0.005, 0.0, 0.155)),
            Geom("ellipsoid", (0.07, 0.062, 0.08), (0.022, 0.0, 0.115)),
            Geom("ellipsoid", (0.075, 0.074, 0.042), (0.046, 0.0, 0.158), material="visor"),
            Geom("cylinder", (0.032,), ends=(0.0, -0.086, 0.148, 0.0, 0.086, 0.148), material="accent"),
            Geom("sphere", (0.1,), (0.01, 0.0, 0.15), role=Role.COLLISION),
        ),
    )
    return Body(
        "neck_yaw_link",
        (0.0, 0.0, NECK_HEIGHT),
        inertia.sphere(0.6, 0.05),
        Joint("neck_yaw", "yaw", -1.3, 1.3, NECK),
        (Geom("cylinder", (0.05,), ends=(0.0, 0.0, -0.02, 0.0, 0.0, 0.01), material="joint"),),
        children=(head,),
    )
