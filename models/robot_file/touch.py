"""The links that touch each other, and those that are kept apart: convex hulls, and pairs of them."""

import itertools
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Coordinates
from surefoot.models.robot_file.engine_mesh import compiled, taken
from surefoot.models.robot_file.legs import SIDES, Leg
from surefoot.models.robot_file.meshes import Faces, hull
from surefoot.models.robot_file.reduced import Reduced, points_of
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.upper import Upper
from surefoot.models.types import Array, RobotError, nearest

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


_LEAST_VOLUME = 1e-12
"""Volume of a contact shape, below which an engine takes it for flat [m^3]."""


def find_hulls(reduced: Reduced, legs: tuple[Leg, Leg], upper: Upper) -> dict[int, Hull]:
    """Hulls by joint: of trunk, arms, thighs and shanks; feet touch with their soles."""
    model = reduced.model
    total = sum(inertia.mass for inertia in model.inertias)
    legged = {joint for leg in legs for joint in leg.chain}
    wanted = {joint for leg in legs for joint in (leg.thigh, leg.shank)}
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
            vertices, faces = hull(points, MOST_POINTS)
            if abs(np.linalg.det(vertices[faces]).sum()) / 6.0 > _LEAST_VOLUME:
                found[joint] = Hull(joint, vertices, faces)
    sound = taken([(one.vertices, one.faces) for one in found.values()], drawn=False)
    found = {joint: one for (joint, one), right in zip(found.items(), sound, strict=True) if right}
    shaped = [joint for joint in sorted(wanted) if reduced.collision[joint] or reduced.visual[joint]]
    if flat := [reduced.bodies[joint - 1] for joint in shaped if joint not in found]:
        reduced.left_out.append(f"left out: contact of links whose shapes have no volume: {', '.join(flat)}")
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
    model = compiled(mjcf)
    data, coordinates = mujoco.MjData(model), Coordinates(model)
    found: dict[tuple[str, str], None] = {}
    for angles in postures:
        coordinates.bend(angles, data.qpos)
        mujoco.mj_kinematics(model, data)
        for one, other in itertools.combinations(sorted(bodies), 2):
            if parents[other] != one:
                names = bodies[one], bodies[other]
                first, second = (model.geom(shape_name(name)).id for name in names)
                if mujoco.mj_geomDistance(model, data, first, second, 2 * near, None) < near:
                    found[names] = None
    return list(found)


def joined(bodies: dict[int, str], parents: list[int]) -> list[tuple[str, str]]:
    """Pairs of bodies with joints alone between them: pelvis and thigh across a hip, whose ranges say how they meet.

    Args:
        bodies: name by joint, of those that have hulls.
        parents: parent of each joint.
    """
    found = []
    for joint, name in bodies.items():
        above = parents[joint]
        while above and above not in bodies:
            above = parents[above]
        if above and above != parents[joint]:
            found.append((bodies[above], name))
    return found


def shape_name(body: str) -> str:
    """Name of a body's hull."""
    return f"{body}_shape"


def shank_spacing(data: pin.Data, legs: tuple[Leg, Leg], hulls: dict[int, Hull], room: float) -> float:
    """Lateral distance of the soles at which upright shanks keep some room between them [m].

    Args:
        data: placements with straight legs.
        legs: both.
        hulls: contact shapes by joint.
        room: between the shanks [m].
    """
    reach = 0.0
    for side, leg in zip((1.0, -1.0), legs, strict=True):
        knee = leg.shank
        sole = side * (data.oMi[leg.chain[-1]] * leg.sole.placement).translation[1]
        points = hulls[knee].vertices if knee in hulls else np.zeros((1, 3))
        lateral = points @ data.oMi[knee].rotation[1] + data.oMi[knee].translation[1]
        reach += float(sole - (side * lateral).min())
    return max(reach + room, min(leg.sole.width for leg in legs))


def limbs(legs: tuple[Leg, Leg], upper: Upper, hulls: dict[int, Hull]) -> list[tuple[int, int]]:
    """Pairs of joints whose bodies can meet: thighs and shanks of both legs, arms and thighs, arms, torso and base."""
    thighs, shanks = [leg.thigh for leg in legs], [leg.shank for leg in legs]
    pairs = [(thighs[0], thighs[1]), (shanks[0], shanks[1]), (thighs[0], shanks[1]), (thighs[1], shanks[0])]
    for arm in upper.arms:
        lower = [joint for joint in arm[len(arm) // 2 :] if joint in hulls]
        if lower:
            largest = max(lower, key=lambda joint: float(np.prod(np.ptp(hulls[joint].vertices, axis=0))))
            pairs += itertools.product(sorted({lower[-1], largest}), thighs)
        # The first link of an arm turns in its place.
        trunk = [joint for joint in sorted({upper.torso, 1}) if joint in hulls]
        pairs += itertools.product(trunk, [joint for joint in arm[1:] if joint in hulls])
    return pairs


def kept_apart(
    reduced: Reduced, file: RobotFile, hulls: dict[int, Hull], meeting: list[tuple[int, int]], legs: tuple[Leg, Leg]
) -> tuple[tuple[str, str], ...]:
    """Names of pairs of contact shapes that are kept apart: as given, or limbs that can meet, and soles.

    Raises:
        RobotError: the file names a link without a contact shape.
    """
    shapes = {joint: shape_name(reduced.bodies[joint - 1]) for joint in hulls}
    if file.keep_apart is None:
        pairs = [(shapes[one], shapes[other]) for one, other in meeting if one in shapes and other in shapes]
        soles, shanks = [f"{side}_sole_box" for side in SIDES], [leg.shank for leg in legs]
        across = [(soles[side], shapes[shanks[1 - side]]) for side in (0, 1) if shanks[1 - side] in shapes]
        return (*pairs, (soles[0], soles[1]), *across)
    found = []
    for pair in file.keep_apart:
        joints = [reduced.joint_of(link, "keep_apart") for link in pair]
        for joint, link in zip(joints, pair, strict=True):
            if joint not in shapes:
                what = f"keep_apart of {file.name} names '{link}', which has no contact shape"
                raise RobotError(("keep_apart",), what, nearest(link, tuple(reduced.bodies[j - 1] for j in shapes)))
        found.append((shapes[joints[0]], shapes[joints[1]]))
    return tuple(found)
