"""The simulated world as primitives, each locked to the frame of its body."""

import mujoco
import numpy as np
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from numpy.typing import NDArray

from surefoot.scenarios.record.foxglove.drawing import color, pose
from surefoot.sim.shapes import Shape, drawn_shapes


def world_scene(mjcf: str) -> SceneUpdate:
    """Turn the geoms of an MJCF text into one entity per body; the ground plane is left to the viewer's grid."""
    entities: dict[int, SceneEntity] = {}
    for shape in drawn_shapes(mujoco.MjModel.from_xml_string(mjcf)):
        name = shape.body_name
        _add(shape, entities.setdefault(shape.body, SceneEntity(frame_id=name, id=name, frame_locked=True)))
    return SceneUpdate(entities=[entities[body] for body in sorted(entities) if _drawn(entities[body])])


def _drawn(entity: SceneEntity) -> bool:
    return bool(entity.cubes or entity.spheres or entity.cylinders)


def _add(shape: Shape, entity: SceneEntity) -> None:
    """Add a shape to an entity; meshes, which have no primitive, are left out."""
    turn, tint = np.roll(shape.quaternion, -1), color(shape.color)
    size, place = _vector(2.0 * shape.half_size), pose(shape.position, turn)
    if shape.kind == "box":
        entity.cubes.append(CubePrimitive(size=size, pose=place, color=tint))
    elif shape.kind == "ellipsoid":
        entity.spheres.append(SpherePrimitive(size=size, pose=place, color=tint))
    elif shape.kind in ("cylinder", "capsule"):
        entity.cylinders.append(CylinderPrimitive(size=size, bottom_scale=1.0, top_scale=1.0, pose=place, color=tint))
    if shape.kind == "capsule":
        ball = _vector(2.0 * shape.half_size[[0, 0, 0]])
        for end in shape.ends:
            entity.spheres.append(SpherePrimitive(size=ball, pose=pose(end, turn), color=tint))


def _vector(size: NDArray[np.float64]) -> Vector3:
    x, y, z = (float(part) for part in size)
    return Vector3(x=x, y=y, z=z)
