"""The arm: shoulder pitch, roll, yaw; elbow; the hand is part of the forearm."""

import surefoot.models.humanoid100.actuators as act
import surefoot.models.humanoid100.dimensions as dim
from surefoot.models import inertia
from surefoot.models.tree import Body, Geom, Joint, Role


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
        (0.0, outward * dim.SHOULDER_HALF_WIDTH, dim.SHOULDER_HEIGHT),
        inertia.sphere(0.45, 0.045),
        Joint(f"{side}_shoulder_pitch", "pitch", -3.0, 1.3, act.SHOULDER),
        (Geom("cylinder", (0.052,), ends=(0.0, 2.0 * inner, 0.0, 0.0, inner, 0.0), material="joint"),),
        children=(
            Body(
                f"{side}_shoulder_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(0.3, 0.045),
                Joint(f"{side}_shoulder_roll", "roll", *roll, act.SHOULDER),
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
        Joint(f"{side}_shoulder_yaw", "yaw", -1.5, 1.5, act.SHOULDER),
        (
            Geom("capsule", (0.043,), ends=(0.0, 0.0, -0.06, 0.0, 0.0, -0.24)),
            Geom("ellipsoid", (0.052, 0.048, 0.09), (0.006, 0.0, -0.13)),
            Geom("capsule", (0.045,), ends=(0.0, 0.0, -0.06, 0.0, 0.0, -0.26), role=Role.COLLISION),
        ),
        children=(_forearm(side),),
    )


def _forearm(side: str) -> Body:
    wrist = -dim.FOREARM
    return Body(
        f"{side}_forearm",
        (0.0, 0.0, -dim.UPPER_ARM),
        inertia.stacked(
            inertia.cylinder(1.65, 0.038, 0.24, (0.0, 0.0, -0.11)),
            inertia.ellipsoid(0.6, (0.04, 0.02, 0.09), (0.0, 0.0, wrist - 0.08)),
        ),
        Joint(f"{side}_elbow", "pitch", -2.4, 0.0, act.ELBOW),
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
