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

from surefoot.scenarios.record.foxglove.drawing import WORLD, color, pose

HIDDEN_GROUP = 3
"""Geom groups from here on are not drawn, as in MuJoCo's own viewer."""

_Geom = mujoco.mjtGeom


def world_scene(mjcf: str) -> SceneUpdate:
    """Turn the geoms of an MJCF text into one entity per body; the ground plane is left to the viewer's grid."""
    model = mujoco.MjModel.from_xml_string(mjcf)
    entities = {body: _entity(model, body) for body in range(model.nbody)}
    for geom in range(model.ngeom):
        if model.geom_group[geom] < HIDDEN_GROUP:
            _add(model, geom, entities[int(model.geom_bodyid[geom])])
    return SceneUpdate(entities=[entity for entity in entities.values() if _drawn(entity)])


def _entity(model: mujoco.MjModel, body: int) -> SceneEntity:
    name = model.body(body).name if body else WORLD
    return SceneEntity(frame_id=name, id=name, frame_locked=True)


def _drawn(entity: SceneEntity) -> bool:
    return bool(entity.cubes or entity.spheres or entity.cylinders)


def _add(model: mujoco.MjModel, geom: int, entity: SceneEntity) -> None:
    """Add a geom to an entity; kinds that have no primitive are left out."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    position, quaternion = model.geom_pos[geom], model.geom_quat[geom]
    place, tint = pose(position, np.roll(quaternion, -1)), color(_rgba(model, geom))
    if kind == _Geom.mjGEOM_BOX:
        entity.cubes.append(CubePrimitive(size=_vector(2.0 * size), pose=place, color=tint))
    elif kind == _Geom.mjGEOM_SPHERE:
        entity.spheres.append(SpherePrimitive(size=_vector(2.0 * size[[0, 0, 0]]), pose=place, color=tint))
    elif kind == _Geom.mjGEOM_ELLIPSOID:
        entity.spheres.append(SpherePrimitive(size=_vector(2.0 * size), pose=place, color=tint))
    elif kind in (_Geom.mjGEOM_CYLINDER, _Geom.mjGEOM_CAPSULE):
        shape = _vector(2.0 * size[[0, 0, 1]])
        entity.cylinders.append(CylinderPrimitive(size=shape, bottom_scale=1.0, top_scale=1.0, pose=place, color=tint))
    if kind == _Geom.mjGEOM_CAPSULE:
        for end in _ends(position, quaternion, size[1]):
            ball = pose(end, np.roll(quaternion, -1))
            entity.spheres.append(SpherePrimitive(size=_vector(2.0 * size[[0, 0, 0]]), pose=ball, color=tint))


def _ends(
    position: NDArray[np.float64], quaternion: NDArray[np.float64], half: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centres of a capsule's caps."""
    axis = np.zeros(3)
    mujoco.mju_rotVecQuat(axis, np.array([0.0, 0.0, half]), quaternion)
    return position - axis, position + axis


def _rgba(model: mujoco.MjModel, geom: int) -> list[float]:
    material = int(model.geom_matid[geom])
    rgba: list[float] = (model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]).tolist()
    return rgba


def _vector(size: NDArray[np.float64]) -> Vector3:
    x, y, z = (float(part) for part in size)
    return Vector3(x=x, y=y, z=z)
