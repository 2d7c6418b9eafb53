"""The Pinocchio model of a robot, from the very text that MuJoCo compiles."""

import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import names_of
from surefoot.models.coupling import coupled
from surefoot.models.types import RobotDescription, RobotError


def pinocchio_model(description: RobotDescription) -> pin.Model:
    """Read the robot's MJCF with Pinocchio; sites are frames, armatures are inside the mass matrix.

    Joints that follow others have no coordinate (see `surefoot.engines.mimic`).

    Effort and velocity limits come from the description, because the MJCF reader does not take them from motors.

    Raises:
        RobotError: Pinocchio's total mass or joint order is not the description's.
    """
    model = coupled(pin.Model(_read(description.mjcf)), description.couplings)
    mass = sum(inertia.mass for inertia in model.inertias)
    if abs(mass - description.mass) > 1e-9 * description.mass:
        what = f"Pinocchio reads {mass:.12g} kg from the MJCF of {description.name}"
        raise RobotError(("mass",), what, f"it must be {description.mass:.12g} kg")
    joints = names_of(model)
    if joints != description.joint_names:
        what = f"Pinocchio reads the joints {joints} of {description.name}"
        raise RobotError(("joint_names",), what, f"they must be {description.joint_names}")
    base_effort = np.zeros(6)
    model.upperEffortLimit = np.concatenate((base_effort, description.torque_limit))
    model.lowerEffortLimit = -model.upperEffortLimit
    free = np.full(6, np.inf)
    model.upperVelocityLimit = np.concatenate((free, description.velocity_limit))
    model.lowerVelocityLimit = -model.upperVelocityLimit
    return model


class Scratch(threading.local):
    """Pinocchio's memory for what is worked out and read at once: to make one takes longer than most of that.

    Args:
        model: the robot.

    Attributes:
        data: each thread's own.
    """

    def __init__(self, model: pin.Model) -> None:
        self.data = model.createData()


def limb_shapes(description: RobotDescription) -> pin.GeometryModel:
    """The robot's contact shapes, with the pairs that it must keep apart as collision pairs."""
    geometry = pin.GeometryModel(_shapes(description.mjcf))
    for one, other in description.kept_apart:
        geometry.addCollisionPair(pin.CollisionPair(geometry.getGeometryId(one), geometry.getGeometryId(other)))
    return geometry


@lru_cache(maxsize=8)
def _read(mjcf: str) -> pin.Model:
    """The model of a text, kept since several parts of a run ask for it, and it takes 30 ms."""
    with _file(mjcf) as path:
        return pin.buildModelFromMJCF(path)


def _shapes(mjcf: str) -> pin.GeometryModel:
    """Contact shapes of a text, on the joints of its model."""
    with _file(mjcf) as path:
        return pin.buildGeomFromMJCF(_read(mjcf), path, pin.GeometryType.COLLISION)


@contextmanager
def _file(mjcf: str) -> Iterator[str]:
    """The text as a file: Pinocchio reads MJCF from files only."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.xml"
        path.write_text(mjcf, encoding="utf-8")
        yield str(path)
