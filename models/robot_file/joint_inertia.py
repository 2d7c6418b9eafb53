"""The inertia that the joints of a robot feel, all of them together: whether an engine can follow what they do.

A link without mass between two joints is no fault: both move what hangs on them. It is one where joints repeat each
other's motion, as two hinges on one line do, and no rotor tells them apart: the joint-space inertia is singular then,
and any torque makes accelerations without bound. Seen by the joints' own inertias it has the unit diagonal

    D^-1/2 M(q) D^-1/2,  D = diag M(q),

whose least eigenvalue is 1 for joints that feel nothing of each other, and half the square of the angle between two
hinges of one body that are nearly on a line.
"""

from collections.abc import Iterator, Sequence

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import names_of
from surefoot.models.types import Array, RobotError

LEAST = 1e-5
"""Eigenvalue below which joints repeat each other's motion: hinges within a quarter of a degree; public humanoids have
3e-3 or more in all their range [-]."""

_RANDOM = 32
"""Configurations at random, beside those with one joint at an end of its range."""

_PART = 0.3
"""Share of the largest part of a direction from which on a joint belongs to it [-]."""


def require_inertia(model: pin.Model, postures: Sequence[Array], notes: list[str]) -> None:
    """Refuse joints that repeat each other's motion in a posture; those that do elsewhere in their ranges are noted.

    Args:
        model: joint 1 is the floating base.
        postures: joint angles in which the robot stands and walks, shape (nj,) each [rad].
        notes: gets the note.

    Raises:
        RobotError: names the joints.
    """
    for angles in postures:
        least, joints = _least(model, angles)
        if least < LEAST:
            what = f"joints {joints} of {model.name} repeat each other's motion where the robot stands"
            right = f"lock all but one of them, or give armature: {{PATTERN: kg m^2}} (scaled inertia {least:.1e})"
            raise RobotError(("armature",), what, right)
    worst = min((_least(model, angles) for angles in _within(model, postures[0])), key=lambda found: found[0])
    if worst[0] < LEAST:
        notes.append(
            f"joints {worst[1]} repeat each other's motion somewhere in their ranges, and torques move them there "
            "without bound; give armature: {PATTERN: kg m^2} if they have rotors"
        )


def _least(model: pin.Model, angles: Array) -> tuple[float, str]:
    """The least eigenvalue, and the joints that move in its direction."""
    q = pin.neutral(model)
    q[7:] = angles
    upper = np.triu(pin.crba(model, model.createData(), q))
    M = upper + np.triu(upper, 1).T
    scale = 1.0 / np.sqrt(np.diag(M))
    values, directions = np.linalg.eigh(scale[:, None] * M * scale)
    part = np.abs(directions[6:, 0])
    names = [name for name, one in zip(names_of(model), part, strict=True) if one > _PART * part.max()]
    return float(values[0]), " and ".join(f"'{name}'" for name in names)


def _within(model: pin.Model, posture: Array) -> Iterator[Array]:
    """Configurations all over the ranges of the joints, shape (nj,) each [rad]."""
    lower, upper = model.lowerPositionLimit[7:], model.upperPositionLimit[7:]
    for joint in range(len(posture)):
        for end in (lower, upper):
            angles = posture.copy()
            angles[joint] = end[joint]
            yield angles
    rng = np.random.default_rng(0)
    yield from rng.uniform(lower, upper, (_RANDOM, len(posture)))
