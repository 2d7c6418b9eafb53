"""Pieces of Foxglove messages: poses, colours, primitives."""

from collections.abc import Iterable, Sequence

from foxglove_schemas_protobuf.ArrowPrimitive_pb2 import ArrowPrimitive
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

from scenarios.log.template import NANOS, SECONDS

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
