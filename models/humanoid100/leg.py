"""The leg: hip yaw, roll, pitch; knee; ankle pitch, roll; the foot."""

import surefoot.models.humanoid100.actuators as act
import surefoot.models.humanoid100.dimensions as dim
from surefoot.models import inertia
from surefoot.models.humanoid100.foot import foot
from surefoot.models.tree import Body, Geom, Joint, Role


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
        (0.0, outward * dim.HIP_HALF_WIDTH, 0.0),
        inertia.sphere(1.0, 0.05),
        Joint(f"{side}_hip_yaw", "yaw", *_mirrored(-0.8, 1.0, outward), act.HIP_YAW),
        (Geom("cylinder", (0.052,), ends=(0.0, 0.0, 0.03, 0.0, 0.0, 0.085), material="joint"),),
        children=(
            Body(
                f"{side}_hip_roll_link",
                (0.0, 0.0, 0.0),
                inertia.sphere(1.0, 0.05),
                Joint(f"{side}_hip_roll", "roll", *roll, act.HIP_ROLL),
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
    knee = (0.0, 0.0, -dim.THIGH)
    return Body(
        f"{side}_thigh",
        (0.0, 0.0, 0.0),
        inertia.cylinder(8.0, 0.07, 0.40, (0.0, 0.0, -0.175)),
        Joint(f"{side}_hip_pitch", "pitch", -2.3, 1.0, act.HIP_PITCH),
        (
            Geom("cylinder", (0.062,), ends=(0.0, -0.045, 0.0, 0.0, 0.06 * outward, 0.0), material="joint"),
            Geom("ellipsoid", (0.078, 0.07, 0.15), (0.008, 0.008 * outward, -0.155)),
            Geom("capsule", (0.05,), ends=(0.0, 0.0, -0.16, 0.0, 0.0, -0.36)),
            Geom("ellipsoid", (0.045, 0.05, 0.11), (0.042, 0.006 * outward, -0.19), material="trim"),
            Geom("sphere", (0.06,), knee, role=Role.COLLISION),
            _shape(f"{side}_thigh", 0.065, (0.005, 0.0, -0.1, 0.0, 0.0, -0.37)),
        ),
        children=(shank,),
    )


def _shank(side: str, foot_body: Body) -> Body:
    return Body(
        f"{side}_shank",
        (0.0, 0.0, -dim.THIGH),
        inertia.cylinder(4.35, 0.055, 0.40, (0.0, 0.0, -0.165)),
        Joint(f"{side}_knee", "pitch", 0.0, 2.4, act.KNEE),
        (
            Geom("cylinder", (0.053,), ends=(0.0, -0.054, 0.0, 0.0, 0.054, 0.0), material="joint"),
            Geom("ellipsoid", (0.03, 0.042, 0.055), (0.038, 0.0, 0.005), material="accent"),
            Geom("ellipsoid", (0.056, 0.05, 0.13), (-0.018, 0.0, -0.15)),
            Geom("capsule", (0.036,), ends=(0.012, 0.0, -0.07, 0.0, 0.0, -0.35)),
            _shape(f"{side}_shank", 0.048, (-0.01, 0.0, -0.06, 0.0, 0.0, -0.36)),
        ),
        children=(foot_body,),
    )
