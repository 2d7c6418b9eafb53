"""Foxglove's messages that a run is drawn with: the world once, points, outlines and forces as it goes."""

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import cast

import numpy as np
from foxglove_schemas_protobuf.ArrowPrimitive_pb2 import ArrowPrimitive
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.TriangleListPrimitive_pb2 import TriangleListPrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.descriptor import Descriptor, FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet
from google.protobuf.message import Message
from google.protobuf.timestamp_pb2 import Timestamp
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.planner.geometry.plane import CORNERS
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.types import Footstep
from surefoot.scenarios import palette
from surefoot.scenarios.log import PublishedSchema
from surefoot.scenarios.log.template import NANOS, SECONDS, Template, slot
from surefoot.sim.shapes import Shape, drawn_shapes


def published(message: type[Message]) -> PublishedSchema:
    """The schema of a message class, with every file that it imports."""
    found, files = cast("Descriptor", message.DESCRIPTOR), dict[str, FileDescriptorProto]()
    _collect(found.file, files)
    descriptors = FileDescriptorSet(file=files.values()).SerializeToString(deterministic=True)
    return PublishedSchema(found.full_name, descriptors)


def _collect(file: FileDescriptor, files: dict[str, FileDescriptorProto]) -> None:
    """Note a file after the files that it imports."""
    if file.name in files:
        return
    for imported in file.dependencies:
        _collect(imported, files)
    proto = FileDescriptorProto()
    file.CopyToProto(proto)
    files[file.name] = proto


WORLD = "world"
"""Frame that every other one is placed in."""

Rgba = tuple[float, float, float, float]


def stamp() -> Timestamp:
    """Stands for the time of a message that is to become a template."""
    return Timestamp(seconds=SECONDS, nanos=NANOS)


def pose(position: Iterable[float], quaternion: Iterable[float] = (0.0, 0.0, 0.0, 1.0)) -> Pose:
    """A pose of x y z [m] and qx qy qz qw."""
    x, y, z = position
    qx, qy, qz, qw = quaternion
    return Pose(position=Vector3(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


def color(rgba: Sequence[float]) -> Color:
    """A colour of red, green, blue and opacity, 0 to 1."""
    r, g, b, a = (float(part) for part in rgba)
    return Color(r=r, g=g, b=b, a=a)


def sphere(position: Iterable[float], diameter: float, rgba: Rgba) -> SpherePrimitive:
    """A ball at x y z [m]."""
    return SpherePrimitive(pose=pose(position), size=Vector3(x=diameter, y=diameter, z=diameter), color=color(rgba))


def arrow(position: Iterable[float], quaternion: Iterable[float], length: float, rgba: Rgba) -> ArrowPrimitive:
    """An arrow from x y z [m] along the x axis of a quaternion qx qy qz qw, head included in nothing but its look."""
    return ArrowPrimitive(
        pose=pose(position, quaternion), shaft_length=length, shaft_diameter=0.02, head_length=0.05,
        head_diameter=0.04, color=color(rgba),
    )  # fmt: skip


def loop(points: Iterable[Iterable[float]], rgba: Rgba) -> LinePrimitive:
    """A closed line through points x y z [m], three pixels wide."""
    corners = [Point3(x=x, y=y, z=z) for x, y, z in points]
    return LinePrimitive(
        type=LinePrimitive.LINE_LOOP, pose=pose((0.0, 0.0, 0.0)), thickness=3.0, scale_invariant=True, points=corners,
        color=color(rgba),
    )  # fmt: skip


def scene(*entities: SceneEntity) -> SceneUpdate:
    """A scene update of these entities."""
    return SceneUpdate(entities=entities)


BALLS: tuple[tuple[str, float, Rgba], ...] = (
    ("CoM", 0.06, (*palette.COM, 1.0)),
    ("CoM planned", 0.03, (*palette.COM_PLANNED, 1.0)),
    ("ZMP", 0.03, (*palette.ZMP, 1.0)),
    ("ZMP planned", 0.02, (*palette.ZMP_PLANNED, 1.0)),
    ("DCM", 0.03, (*palette.DCM, 1.0)),
    ("DCM planned", 0.02, (*palette.DCM_PLANNED, 1.0)),
)
"""Points that are drawn: entity, diameter [m], colour."""

ARROWS: tuple[tuple[str, Rgba], ...] = (
    ("left contact", (*palette.FEET[0], 1.0)),
    ("right contact", (*palette.FEET[1], 1.0)),
    ("push", (*palette.PUSH, 1.0)),
)
"""Forces that are drawn: entity, colour."""

LOOPS: tuple[tuple[str, int, Rgba], ...] = (
    ("support", 8, (*palette.SUPPORT, 1.0)),
    *((f"footstep {k}", 4, (*palette.FOOTSTEP, 1.0 - 0.25 * k)) for k in range(3)),
)
"""Outlines that are drawn: entity, vertices, colour."""


def transforms(frames: tuple[str, ...]) -> Template:
    """``foxglove.FrameTransforms`` of frames in the world; values: all x y z [m], then all qw qx qy qz."""
    n = len(frames)

    def one(i: int, name: str) -> FrameTransform:
        p, q = 3 * i, 3 * n + 4 * i
        return FrameTransform(
            timestamp=stamp(), parent_frame_id=WORLD, child_frame_id=name,
            translation=Vector3(x=slot(p), y=slot(p + 1), z=slot(p + 2)),
            rotation=Quaternion(w=slot(q), x=slot(q + 1), y=slot(q + 2), z=slot(q + 3)),
        )  # fmt: skip

    return Template(FrameTransforms(transforms=[one(i, name) for i, name in enumerate(frames)]), 7 * n)


def joint_states(names: tuple[str, ...]) -> Template:
    """``foxglove.JointStates``; values: all positions [rad], then all velocities [rad/s], then all torques [N m]."""
    n = len(names)
    joints = [
        JointState(name=name, position=slot(i), velocity=slot(n + i), effort=slot(2 * n + i))
        for i, name in enumerate(names)
    ]
    return Template(JointStates(timestamp=stamp(), joints=joints), 3 * n)


def points() -> Template:
    """``foxglove.SceneUpdate`` of `BALLS`; values: x y z of each [m]."""
    entities = [
        SceneEntity(timestamp=stamp(), frame_id=WORLD, id=name, spheres=[sphere(_slots(3 * i, 3), diameter, rgba)])
        for i, (name, diameter, rgba) in enumerate(BALLS)
    ]
    return Template(scene(*entities), 3 * len(BALLS))


def forces() -> Template:
    """``foxglove.SceneUpdate`` of `ARROWS`; values of each: x y z [m], qx qy qz qw, length [m]."""
    entities = []
    for i, (name, rgba) in enumerate(ARROWS):
        *place, length = _slots(8 * i, 8)
        drawn = arrow(place[:3], place[3:], length, rgba)
        entities.append(SceneEntity(timestamp=stamp(), frame_id=WORLD, id=name, arrows=[drawn]))
    return Template(scene(*entities), 8 * len(ARROWS))


def outlines() -> Template:
    """``foxglove.SceneUpdate`` of `LOOPS`; values: x y z of each vertex [m]."""
    entities, first = [], 0
    for name, vertices, rgba in LOOPS:
        line = loop([_slots(first + 3 * k, 3) for k in range(vertices)], rgba)
        entities.append(SceneEntity(timestamp=stamp(), frame_id=WORLD, id=name, lines=[line]))
        first += 3 * vertices
    return Template(scene(*entities), first)


def _slots(first: int, count: int) -> list[float]:
    return [slot(first + k) for k in range(count)]


Array = NDArray[np.float64]

METRES_PER_NEWTON = 1e-3
"""Length of a force's arrow over the force."""

LIFT = 0.002
"""Outlines are drawn this far above the ground, so that they are not hidden by it [m]."""

_VERTICES = sum(vertices for _, vertices, _ in LOOPS)

NOWHERE = (0.0, 0.0, -1000.0)
"""Place of a point that does not exist now, such as the ZMP of a robot in flight; out of sight [m]."""


def force_arrow(origin: Array, force: Array) -> tuple[float, ...]:
    """Values of an arrow: x y z [m], qx qy qz qw of the rotation that takes x to the force, length [m].

    Args:
        origin: where the force acts, world frame, shape (3,) [m].
        force: world frame, shape (3,) [N].
    """
    x, y, z = force.tolist()
    size = math.sqrt(x * x + y * y + z * z)
    if not size > 0.0:
        return (*origin.tolist(), 0.0, 0.0, 0.0, 1.0, 0.0)
    # Half-way rotation from x to the unit force d: q ~ (x cross d, 1 + x . d); straight back turns about z.
    y, z, w = -z / size, y / size, 1.0 + x / size
    if w < 1e-9:
        y, z, w = 0.0, 1.0, 0.0
    norm = math.sqrt(y * y + z * z + w * w)
    return (*origin.tolist(), 0.0, y / norm, z / norm, w / norm, METRES_PER_NEWTON * size)


class Outlines:
    """The support polygon and the footsteps to come, as the values of their template.

    Attributes:
        values: x y z of every vertex of `LOOPS`, flat [m].
        ground: height of the lower foothold [m].
    """

    def __init__(self, half_length: float, half_width: float) -> None:
        """Open them for soles of this half size [m]."""
        self._corners = [(a * half_length, b * half_width) for a, b in CORNERS.tolist()]
        self.values: list[float] = []
        self.ground = 0.0

    def update(self, plan: WalkPlan) -> None:
        """Take over a plan; a footstep that is not there shrinks to a point of the last one."""
        self.ground = min(foot.position.item(2) for foot in plan.footholds)
        height, polygon = self.ground + LIFT, plan.support_polygon.tolist()
        values: list[float] = []
        for x, y in polygon:
            values += (x, y, height)
        values += values[-3:] * (LOOPS[0][1] - len(polygon))
        for step in plan.footsteps:
            self._outline(step, values)
        self.values = values + values[-3:] * (_VERTICES - len(values) // 3)

    def _outline(self, footstep: Footstep, values: list[float]) -> None:
        """Add the corners of a sole."""
        x, y, z = footstep.position.tolist()
        c, s = math.cos(footstep.yaw), math.sin(footstep.yaw)
        across, along, up = footstep.normal.tolist()
        slope_x, slope_y = -across / up, -along / up
        for a, b in self._corners:
            u, v = c * a - s * b, s * a + c * b
            values += (x + u, y + v, z + slope_x * u + slope_y * v + LIFT)


FINEST = 2.0**-14
"""Vertices of meshes are rounded to this: too fine to be seen, and short numbers can be compressed [m]."""


def world_scene(mjcf: str) -> SceneUpdate:
    """Turn the geoms of an MJCF text into one entity per body; the ground plane is left to the viewer's grid."""
    entities: dict[int, SceneEntity] = {}
    for shape in drawn_shapes(mujoco.MjModel.from_xml_string(mjcf)):
        name = shape.body_name
        _add(shape, entities.setdefault(shape.body, SceneEntity(frame_id=name, id=name, frame_locked=True)))
    return SceneUpdate(entities=[entities[body] for body in sorted(entities) if _drawn(entities[body])])


@lru_cache(maxsize=8)
def scene_data(mjcf: str) -> bytes:
    """The message of `world_scene`; run after run of a campaign has the same one."""
    return world_scene(mjcf).SerializeToString(deterministic=True)


def _drawn(entity: SceneEntity) -> bool:
    return bool(entity.cubes or entity.spheres or entity.cylinders or entity.triangles)


def _add(shape: Shape, entity: SceneEntity) -> None:
    """Add a shape to an entity."""
    turn, tint = np.roll(shape.quaternion, -1), color(shape.color)
    size, place = _vector(2.0 * shape.half_size), pose(shape.position, turn)
    if shape.kind == "box":
        entity.cubes.append(CubePrimitive(size=size, pose=place, color=tint))
    elif shape.kind == "ellipsoid":
        entity.spheres.append(SpherePrimitive(size=size, pose=place, color=tint))
    elif shape.kind in ("cylinder", "capsule"):
        entity.cylinders.append(CylinderPrimitive(size=size, bottom_scale=1.0, top_scale=1.0, pose=place, color=tint))
    elif shape.mesh is not None:
        corners = [Point3(x=x, y=y, z=z) for x, y, z in (np.round(shape.mesh.vertices / FINEST) * FINEST).tolist()]
        entity.triangles.append(
            TriangleListPrimitive(pose=place, points=corners, color=tint, indices=shape.mesh.faces.ravel().tolist())
        )
    if shape.kind == "capsule":
        ball = _vector(2.0 * shape.half_size[[0, 0, 0]])
        for end in shape.ends:
            entity.spheres.append(SpherePrimitive(size=ball, pose=pose(end, turn), color=tint))


def _vector(size: NDArray[np.float64]) -> Vector3:
    x, y, z = (float(part) for part in size)
    return Vector3(x=x, y=y, z=z)
