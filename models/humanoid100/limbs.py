"""Legs and arms of `humanoid100`: its lengths, its motors, and the bodies that hang on pelvis and torso.

Lengths are those of a person of 1.80 m, in metres, with the joints standing straight. The masses beside the bodies
follow the adult male averages of de Leva (1996), scaled to 100 kg; motors and links of the multi-axis joints take
their share from the neighbouring segments.

Motors are sized like frameless torque motors of about 115, 95, 70 and 40 mm outer diameter. Gears are those of
low-ratio planetary drives, so that the reflected rotor inertia stays of the order of the links' own.
"""

from surefoot.models import inertia
from surefoot.models.actuator import Actuator, Motor
from surefoot.models.mjcf import Body, Geom, Joint, Role

HIP_HALF_WIDTH = 0.10
THIGH = 0.43
SHANK = 0.43
ANKLE_HEIGHT = 0.08
LEG = THIGH + SHANK + ANKLE_HEIGHT
WAIST_HEIGHT = 0.12  # waist joints above the hip centres
SHOULDER_HEIGHT = 0.40  # shoulder centres above the waist joints
SHOULDER_HALF_WIDTH = 0.215
NECK_HEIGHT = 0.475  # neck joints above the waist joints
UPPER_ARM = 0.30
FOREARM = 0.26

FOOT_LENGTH = 0.075  # the paper's foot
FOOT_WIDTH = 0.075
SOLE_THICKNESS = 0.02

MOTOR_115 = Motor(rotor_inertia=2.5e-4, peak_torque=15.0, no_load_speed=320.0)
MOTOR_95 = Motor(rotor_inertia=1.5e-4, peak_torque=10.0, no_load_speed=320.0)
MOTOR_70 = Motor(rotor_inertia=5.0e-5, peak_torque=5.0, no_load_speed=400.0)
MOTOR_40 = Motor(rotor_inertia=1.0e-5, peak_torque=1.4, no_load_speed=500.0)

HIP_YAW = Actuator(MOTOR_70, gear_ratio=28.0)  # 140 N m
HIP_ROLL = Actuator(MOTOR_95, gear_ratio=28.0)  # 280 N m
HIP_PITCH = Actuator(MOTOR_115, gear_ratio=25.0)  # 375 N m
KNEE = Actuator(MOTOR_115, gear_ratio=25.0)  # 375 N m
ANKLE_PITCH = Actuator(MOTOR_95, gear_ratio=22.0)  # 220 N m
ANKLE_ROLL = Actuator(MOTOR_70, gear_ratio=28.0)  # 140 N m
WAIST = Actuator(MOTOR_95, gear_ratio=25.0)  # 250 N m
SHOULDER = Actuator(MOTOR_70, gear_ratio=20.0)  # 100 N m
ELBOW = Actuator(MOTOR_70, gear_ratio=14.0)  # 70 N m
NECK = Actuator(MOTOR_40, gear_ratio=20.0)  # 28 N m


def sole_centre_ahead_of_ankle(foot_length: float) -> float:
    """Distance from the ankle axis forward to the sole centre [m].

    Zero for the paper's foot; 0.022 m for a human foot of 0.22 m, whose toe is longer than its heel.
    """
    return 0.15 * max(foot_length - FOOT_LENGTH, 0.0)


def leg(side: str, foot_length: float, foot_width: float) -> Body:
    """The left or right leg, to hang on the pelvis.

    Args:
        side: "left" or "right"; the prefix of every name.
        foot_length: sole length [m].
        foot_width: sole width [m].
    """
    outward = 1.0 if side == "left" else -1.0
    roll = _mirrored(-0.6, 1.0, outward)
    return Body(
        f"{side}_hip_yaw_link",
        (0.0, outward * HIP_HALF_WIDTH, 0.0),
        inertia.sphere(1.0, 0.05),
        Joint(f"{side}_hip_yaw", "yaw", *_mirrored(-0.8, 1.0, outward), HIP_YAW),
        (Geom("cylinder", (0.052,), ends=(0.0, 0.0, 0.03, 0.0, 0.0, 0.085), material="joint"),),
        children=(
            Body(
                f"{side}_hip_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(1.0, 0.05),
                Joint(f"{side}_hip_roll", "roll", *roll, HIP_ROLL),
                (Geom("cylinder", (0.05,), ends=(-0.068, 0.0, 0.0, 0.068, 0.0, 0.0), material="joint"),),
                children=(_thigh(side, outward, _shank(side, foot(side, foot_length, foot_width))),),
            ),
        ),
    )


def _mirrored(inner: float, outer: float, outward: float) -> tuple[float, float]:
    """Limits of a joint that turns outward with positive angles on the left, negative ones on the right."""
    return (inner, outer) if outward > 0 else (-outer, -inner)


def _shape(link: str, radius: float, ends: tuple[float, float, float, float, float, float]) -> Geom:
    """The capsule by which a link touches others."""
    return Geom("capsule", (radius,), ends=ends, role=Role.COLLISION, name=f"{link}_shape")


def _thigh(side: str, outward: float, shank: Body) -> Body:
    knee = (0.0, 0.0, -THIGH)
    return Body(
        f"{side}_thigh",
        (0.0, 0.0, 0.0),
        inertia.cylinder(8.0, 0.07, 0.40, (0.0, 0.0, -0.175)),
        Joint(f"{side}_hip_pitch", "pitch", -2.3, 1.0, HIP_PITCH),
        (
            Geom("cylinder", (0.062,), ends=(0.0, -0.045, 0.0, 0.0, 0.06 * outward, 0.0), material="joint"),
            Geom("ellipsoid", (0.078, 0.07, 0.15), (0.008, 0.008 * outward, -0.155)),
            Geom("capsule", (0.05,), ends=(0.0, 0.0, -0.16, 0.0, 0.0, -0.36)),
            Geom("ellipsoid", (0.045, 0.05, 0.11), (0.042, 0.006 * outward, -0.19), material="trim"),
            Geom("sphere", (0.06,), knee, role=Role.COLLISION, name=f"{side}_knee_shape"),
            _shape(f"{side}_thigh", 0.065, (0.005, 0.0, -0.1, 0.0, 0.0, -0.37)),
        ),
        children=(shank,),
    )


def _shank(side: str, foot_body: Body) -> Body:
    return Body(
        f"{side}_shank",
        (0.0, 0.0, -THIGH),
        inertia.cylinder(4.35, 0.055, 0.40, (0.0, 0.0, -0.165)),
        Joint(f"{side}_knee", "pitch", 0.0, 2.4, KNEE),
        (
            Geom("cylinder", (0.053,), ends=(0.0, -0.054, 0.0, 0.0, 0.054, 0.0), material="joint"),
            Geom("ellipsoid", (0.03, 0.042, 0.055), (0.038, 0.0, 0.005), material="accent"),
            Geom("ellipsoid", (0.056, 0.05, 0.13), (-0.018, 0.0, -0.15)),
            Geom("capsule", (0.036,), ends=(0.012, 0.0, -0.07, 0.0, 0.0, -0.35)),
            _shape(f"{side}_shank", 0.048, (-0.01, 0.0, -0.06, 0.0, 0.0, -0.36)),
        ),
        children=(foot_body,),
    )


def foot(side: str, length: float, width: float) -> Body:
    """Ankle pitch, ankle roll and the foot, to hang on the shank.

    Args:
        side: "left" or "right"; the prefix of every name.
        length: sole length [m].
        width: sole width [m].
    """
    centre = sole_centre_ahead_of_ankle(length)
    half_sole = SOLE_THICKNESS / 2
    sole = Geom(
        "box",
        (length / 2, width / 2, half_sole),
        (centre, 0.0, half_sole - ANKLE_HEIGHT),
        material="rubber",
        role=Role.SOLE,
        name=f"{side}_sole_box",
    )
    foot_body = Body(
        f"{side}_foot",
        (0.0, 0.0, 0.0),
        inertia.box(1.45, (length, width, 0.05), (centre, 0.0, 0.025 - ANKLE_HEIGHT)),
        Joint(f"{side}_ankle_roll", "roll", -0.6, 0.6, ANKLE_ROLL),
        (sole, *_shoe(length, width, centre)),
        sites=((f"{side}_sole", (centre, 0.0, -ANKLE_HEIGHT)),),
    )
    return Body(
        f"{side}_ankle_link",
        (0.0, 0.0, -SHANK),
        inertia.sphere(0.3, 0.03),
        Joint(f"{side}_ankle_pitch", "pitch", -1.05, 1.05, ANKLE_PITCH),
        (Geom("cylinder", (0.036,), ends=(0.0, -0.042, 0.0, 0.0, 0.042, 0.0), material="joint"),),
        children=(foot_body,),
    )


def _shoe(length: float, width: float, centre: float) -> tuple[Geom, ...]:
    """The drawn shoe: an instep that fills the sole, and a shaft up to the ankle."""
    sole_top = SOLE_THICKNESS - ANKLE_HEIGHT
    return (
        Geom("ellipsoid", (length / 2, width / 2, 0.04), (centre, 0.0, sole_top + 0.002)),
        Geom("capsule", (min(0.032, 0.45 * width),), ends=(0.0, 0.0, -0.04, 0.0, 0.0, -0.01)),
    )


def arm(side: str) -> Body:
    """The left or right arm, to hang on the torso.

    Args:
        side: "left" or "right"; the prefix of every name.
    """
    outward = 1.0 if side == "left" else -1.0
    roll = (-0.3, 2.8) if side == "left" else (-2.8, 0.3)
    inner = -0.035 * outward
    return Body(
        f"{side}_shoulder_pitch_link",
        (0.0, outward * SHOULDER_HALF_WIDTH, SHOULDER_HEIGHT),
        inertia.sphere(0.45, 0.045),
        Joint(f"{side}_shoulder_pitch", "pitch", -3.0, 1.3, SHOULDER),
        (Geom("cylinder", (0.052,), ends=(0.0, 2.0 * inner, 0.0, 0.0, inner, 0.0), material="joint"),),
        children=(
            Body(
                f"{side}_shoulder_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(0.3, 0.045),
                Joint(f"{side}_shoulder_roll", "roll", *roll, SHOULDER),
                (
                    Geom("ellipsoid", (0.062, 0.062, 0.066), (0.0, 0.004 * outward, 0.006)),
                    Geom("cylinder", (0.035,), ends=(-0.064, 0.0, 0.0, 0.064, 0.0, 0.0), material="accent"),
                ),
                children=(_upper_arm(side),),
            ),
        ),
    )


def _upper_arm(side: str) -> Body:
    return Body(
        f"{side}_upper_arm",
        (0.0, 0.0, 0.0),
        inertia.cylinder(2.0, 0.045, 0.28, (0.0, 0.0, -0.14)),
        Joint(f"{side}_shoulder_yaw", "yaw", -1.5, 1.5, SHOULDER),
        (
            Geom("capsule", (0.043,), ends=(0.0, 0.0, -0.06, 0.0, 0.0, -0.24)),
            Geom("ellipsoid", (0.052, 0.048, 0.09), (0.006, 0.0, -0.13)),
            Geom("capsule", (0.045,), ends=(0.0, 0.0, -0.06, 0.0, 0.0, -0.26), role=Role.COLLISION),
        ),
        children=(_forearm(side),),
    )


def _forearm(side: str) -> Body:
    wrist = -FOREARM
    return Body(
        f"{side}_forearm",
        (0.0, 0.0, -UPPER_ARM),
        inertia.stacked(
            inertia.cylinder(1.65, 0.038, 0.24, (0.0, 0.0, -0.11)),
            inertia.ellipsoid(0.6, (0.04, 0.02, 0.09), (0.0, 0.0, wrist - 0.08)),
        ),
        Joint(f"{side}_elbow", "pitch", -2.4, 0.0, ELBOW),
        (
            Geom("cylinder", (0.044,), ends=(0.0, -0.043, 0.0, 0.0, 0.043, 0.0), material="joint"),
            Geom("capsule", (0.034,), ends=(0.0, 0.0, -0.03, 0.0, 0.0, wrist + 0.03)),
            Geom("ellipsoid", (0.046, 0.043, 0.09), (0.004, 0.0, -0.1)),
            Geom("cylinder", (0.03,), ends=(0.0, 0.0, wrist - 0.02, 0.0, 0.0, wrist + 0.01), material="accent"),
            Geom("ellipsoid", (0.042, 0.022, 0.055), (0.0, 0.0, wrist - 0.06), material="joint"),
            Geom("capsule", (0.014,), ends=(0.012, 0.0, wrist - 0.08, 0.018, 0.0, wrist - 0.135), material="joint"),
            Geom("capsule", (0.014,), ends=(-0.012, 0.0, wrist - 0.08, -0.008, 0.0, wrist - 0.135), material="joint"),
            Geom("sphere", (0.045,), (0.0, 0.0, wrist - 0.08), role=Role.COLLISION, name=f"{side}_hand_shape"),
            Geom("sphere", (0.045,), role=Role.COLLISION),
            Geom(
                "capsule",
                (0.038,),
                ends=(0.0, 0.0, -0.04, 0.0, 0.0, wrist),
                role=Role.COLLISION,
                name=f"{side}_forearm_shape",
            ),
        ),
    )
