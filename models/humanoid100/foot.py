"""Ankle and foot with a four-corner box sole."""

import surefoot.models.humanoid100.actuators as act
import surefoot.models.humanoid100.dimensions as dim
from surefoot.models import inertia
from surefoot.models.tree import Body, Geom, Joint, Role


def foot(side: str, length: float, width: float) -> Body:
    """Ankle pitch, ankle roll and the foot, to hang on the shank.

    Args:
        side: "left" or "right"; the prefix of every name.
        length: sole length [m].
        width: sole width [m].
    """
    centre = dim.sole_centre_ahead_of_ankle(length)
    half_sole = dim.SOLE_THICKNESS / 2
    sole = Geom(
        "box",
        (length / 2, width / 2, half_sole),
        (centre, 0.0, half_sole - dim.ANKLE_HEIGHT),
        material="rubber",
        role=Role.SOLE,
        name=f"{side}_sole_box",
    )
    foot_body = Body(
        f"{side}_foot",
        (0.0, 0.0, 0.0),
        inertia.box(1.45, (length, width, 0.05), (centre, 0.0, 0.025 - dim.ANKLE_HEIGHT)),
        Joint(f"{side}_ankle_roll", "roll", -0.6, 0.6, act.ANKLE_ROLL),
        (sole, *_upper(length, width, centre)),
        sites=((f"{side}_sole", (centre, 0.0, -dim.ANKLE_HEIGHT)),),
    )
    return Body(
        f"{side}_ankle_link",
        (0.0, 0.0, -dim.SHANK),
        inertia.sphere(0.3, 0.03),
        Joint(f"{side}_ankle_pitch", "pitch", -1.05, 1.05, act.ANKLE_PITCH),
        (Geom("cylinder", (0.036,), ends=(0.0, -0.042, 0.0, 0.0, 0.042, 0.0), material="joint"),),
        children=(foot_body,),
    )


def _upper(length: float, width: float, centre: float) -> tuple[Geom, ...]:
    """The drawn shoe: an instep that fills the sole, and a shaft up to the ankle."""
    sole_top = dim.SOLE_THICKNESS - dim.ANKLE_HEIGHT
    return (
        Geom("ellipsoid", (length / 2, width / 2, 0.04), (centre, 0.0, sole_top + 0.002)),
        Geom("capsule", (min(0.032, 0.45 * width),), ends=(0.0, 0.0, -0.04, 0.0, 0.0, -0.01)),
    )
