"""Which links touch each other, and which are kept apart: convex hulls, and pairs of them."""

import itertools
from contextlib import suppress
from dataclasses import dataclass

import mujoco

from surefoot.models.robot_file.legs import Leg
from surefoot.models.robot_file.meshes import Faces, hull
from surefoot.models.robot_file.reduced import Reduced, points_of
from surefoot.models.robot_file.upper import Upper
from surefoot.models.types import Array, RobotError

MOST_POINTS = 80
_LIGHTEST = 0.004
"""Share of the whole mass below which a link other than leg and hand has no contact shape [-]."""


@dataclass(frozen=True, slots=True)
class Hull:
    """The contact shape of a body.

    Attributes:
        joint: that moves the body.
        vertices: in the joint's frame, shape (n, 3) [m].
        faces: triangles, outward, shape (m, 3).
    """

    joint: int
    vertices: Array
    faces: Faces


def find_hulls(reduced: Reduced, legs: tuple[Leg, Leg], upper: Upper) -> dict[int, Hull]:
    """Hulls by joint: of trunk, arms, thighs and shanks; feet touch with their soles."""
    model = reduced.model
    total = sum(inertia.mass for inertia in model.inertias)
    legged = {joint for leg in legs for joint in leg.joints}
    wanted = {leg.joints[leg.knee + offset] for leg in legs for offset in (-1, 0)}
    wanted |= {arm[-1] for arm in upper.arms}
    wanted |= {
        joint
        for joint in range(1, model.njoints)
        if joint not in legged and model.inertias[joint].mass > _LIGHTEST * total
    }
    found = {}
    for joint in sorted(wanted):
        points = points_of(reduced.collision[joint] or reduced.visual[joint])
        with suppress(RobotError):  # what is flat or has no shape touches nothing
            found[joint] = Hull(joint, *hull(points, MOST_POINTS))
    return found


def overlapping(
    mjcf: str, postures: list[Array], bodies: dict[int, str], parents: list[int], near: float
) -> list[tuple[str, str]]:
    """Pairs of bodies, neighbours aside, whose hulls are closer than a distance in one of the postures.

    Args:
        mjcf: text of the robot with its hulls.
        postures: joint angles, shape (nj,) each [rad].
        bodies: name by joint, of those that have hulls.
        parents: parent of each joint.
        near: the distance [m].
    """
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    found = {}
    for angles in postures:
        data.qpos[7:] = angles
        mujoco.mj_kinematics(model, data)
        for one, other in itertools.combinations(sorted(bodies), 2):
            if parents[other] != one:
                names = bodies[one], bodies[other]
                first, second = (model.geom(shape_name(name)).id for name in names)
                if mujoco.mj_geomDistance(model, data, first, second, 2 * near, None) < near:
                    found[names] = None
    return list(found)


def shape_name(body: str) -> str:
    """Name of a body's hull."""
    return f"{body}_shape"
