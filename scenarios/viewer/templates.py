"""Messages that a run repeats, with slots where its numbers come."""

from collections.abc import Sequence

from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3

from scenarios.log.template import Template, slot
from scenarios.viewer.messages import WORLD, Rgba, arrow, loop, scene, sphere, stamp

BALLS: tuple[tuple[str, float, Rgba], ...] = (
    ("CoM", 0.06, (0.90, 0.62, 0.00, 1.0)),
    ("CoM planned", 0.03, (0.34, 0.34, 0.34, 1.0)),
    ("ZMP", 0.03, (0.84, 0.37, 0.00, 1.0)),
    ("ZMP planned", 0.02, (0.0, 0.0, 0.0, 1.0)),
    ("DCM", 0.03, (0.00, 0.45, 0.70, 1.0)),
    ("DCM planned", 0.02, (0.34, 0.71, 0.91, 1.0)),
)
"""Points that are drawn: entity, diameter [m], colour (Okabe and Ito's palette, distinct to colour-blind eyes)."""

ARROWS: tuple[tuple[str, Rgba], ...] = (
    ("left contact", (0.00, 0.62, 0.45, 1.0)),
    ("right contact", (0.80, 0.47, 0.65, 1.0)),
    ("push", (0.84, 0.10, 0.10, 1.0)),
)
"""Forces that are drawn: entity, colour."""

LOOPS: tuple[tuple[str, int, Rgba], ...] = (
    ("support", 8, (0.00, 0.62, 0.45, 1.0)),
    *((f"footstep {k}", 4, (0.00, 0.45, 0.70, 1.0 - 0.25 * k)) for k in range(3)),
)
"""Outlines that are drawn: entity, vertices, colour."""


def transforms(frames: Sequence[str]) -> Template:
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


def joint_states(names: Sequence[str]) -> Template:
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
