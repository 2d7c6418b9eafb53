"""Waist, torso, neck and head."""

import surefoot.models.humanoid100.actuators as act
import surefoot.models.humanoid100.dimensions as dim
from surefoot.models import inertia
from surefoot.models.humanoid100.arm import arm
from surefoot.models.tree import Body, Geom, Joint, Role


def upper_body() -> Body:
    """Everything above the pelvis: waist yaw, roll, pitch; torso with arms and head."""
    return Body(
        "waist_yaw_link",
        (0.0, 0.0, dim.WAIST_HEIGHT),
        inertia.sphere(1.0, 0.06),
        Joint("waist_yaw", "yaw", -1.2, 1.2, act.WAIST),
        (Geom("cylinder", (0.085,), ends=(0.0, 0.0, -0.035, 0.0, 0.0, 0.0), material="joint"),),
        children=(
            Body(
                "waist_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(1.0, 0.06),
                Joint("waist_roll", "roll", -0.6, 0.6, act.WAIST),
                (Geom("cylinder", (0.055,), ends=(-0.07, 0.0, 0.0, 0.07, 0.0, 0.0), material="joint"),),
                children=(_torso(),),
            ),
        ),
    )


def _torso() -> Body:
    shoulder = (dim.SHOULDER_HALF_WIDTH - 0.06, dim.SHOULDER_HEIGHT)
    return Body(
        "torso",
        (0.0, 0.0, 0.0),
        inertia.stacked(
            inertia.ellipsoid(11.9, (0.10, 0.14, 0.12), (0.0, 0.0, 0.11)),
            inertia.ellipsoid(21.6, (0.12, 0.17, 0.19), (0.0, 0.0, 0.31)),
        ),
        Joint("waist_pitch", "pitch", -0.5, 1.2, act.WAIST),
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
        Joint("neck_pitch", "pitch", -0.7, 0.8, act.NECK),
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
        (0.0, 0.0, dim.NECK_HEIGHT),
        inertia.sphere(0.6, 0.05),
        Joint("neck_yaw", "yaw", -1.3, 1.3, act.NECK),
        (Geom("cylinder", (0.05,), ends=(0.0, 0.0, -0.02, 0.0, 0.0, 0.01), material="joint"),),
        children=(head,),
    )
