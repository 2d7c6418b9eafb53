"""What a scenario's fidelity is: what walks, and which of its keys that feels."""

from dataclasses import dataclass

from surefoot.planner.references.com_height import Rise
from surefoot.scenarios.file.schema import PendulumSettings

_NO_CONTACT = (
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("sensing", "force_estimate"),
    ("gait", "heel_off"),
    ("start", "angle_noise"),
    ("errors", "friction"),
    ("errors", "torso_com"),
    ("errors", "ground"),
    ("errors", "ground_noise"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""


@dataclass(frozen=True, slots=True)
class Fidelity:
    """What walks.

    Attributes:
        thing: it, in the words of a message.
        has_body: whether it has masses, joints and contacts.
        rise: support phase in which its CoM climbs unless the scenario says it. A pendulum can do what the paper does,
            and climbs in double support; legs cannot, and climb in single support.
        unfelt: keys, of a group each, without effect on it.
    """

    thing: str
    has_body: bool
    rise: Rise
    unfelt: tuple[tuple[str, str], ...]


FIDELITIES = {
    "full": Fidelity(
        "whole body", True, Rise.SINGLE, tuple(("pendulum", name) for name in PendulumSettings.model_fields)
    ),
    "pendulum": Fidelity("pendulum", False, Rise.DOUBLE, _NO_CONTACT),
}
"""By the values of the key ``fidelity``."""
