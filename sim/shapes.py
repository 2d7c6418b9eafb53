"""Shapes to draw of a world: the geoms of a MuJoCo model as plain shapes on bodies."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.sim.measurement import Array

Color = tuple[float, float, float, float]
Kind = Literal["box", "ellipsoid", "cylinder", "capsule", "mesh"]

HIDDEN_GROUP = 3
"""Geom groups from here on are not drawn, as in MuJoCo's own viewer: they are for inertia and contact."""

_Geom = mujoco.mjtGeom
_KINDS: dict[int, tuple[Kind, tuple[int, int, int]]] = {
    int(_Geom.mjGEOM_BOX): ("box", (0, 1, 2)),
    int(_Geom.mjGEOM_SPHERE): ("ellipsoid", (0, 0, 0)),
    int(_Geom.mjGEOM_ELLIPSOID): ("ellipsoid", (0, 1, 2)),
    int(_Geom.mjGEOM_CYLINDER): ("cylinder", (0, 0, 1)),
    int(_Geom.mjGEOM_CAPSULE): ("capsule", (0, 0, 1)),
    int(_Geom.mjGEOM_MESH): ("mesh", (0, 1, 2)),
}
"""Kind of each drawn geom type, and which of MuJoCo's sizes are its half sizes along x, y and z."""


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles of a mesh in the frame of its shape.

    Attributes:
        vertices: shape (n, 3) [m].
        faces: vertices of each triangle, counter-clockwise from outside, shape (m, 3).
    """

    vertices: Array
    faces: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """A shape fixed to a body.

    Attributes:
        kind: what it is; a sphere is an ellipsoid.
        half_size: half sides of a box, half axes of an ellipsoid; radius, radius and half length of the straight part
            of a cylinder or a capsule along z; half the extent of a mesh; shape (3,) [m].
        position: of its centre in the frame of the body, shape (3,) [m].
        quaternion: of its axes in the frame of the body, w x y z, shape (4,).
        color: red, green, blue and opacity, 0 to 1.
        body: number of the body; 0 is the world.
        body_name: name of the body.
        mesh: its triangles, if it is a mesh.
    """

    kind: Kind
    half_size: Array
    position: Array
    quaternion: Array
    color: Color
    body: int
    body_name: str
    mesh: Mesh | None = None

    @property
    def rotation(self) -> Array:
        """From its axes to those of the body, shape (3, 3)."""
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, self.quaternion)
        return rotation.reshape(3, 3)

    @property
    def ends(self) -> tuple[Array, Array]:
        """Ends of its straight part along z, for a capsule the centres of its caps, shape (3,) each [m]."""
        axis = np.zeros(3)
        mujoco.mju_rotVecQuat(axis, np.array([0.0, 0.0, self.half_size[2]]), self.quaternion)
        return self.position - axis, self.position + axis


def drawn_shapes(model: mujoco.MjModel) -> Iterator[Shape]:
    """Every visible geom in the order of the model; the endless ground and height fields are left to the viewer."""
    for geom in range(model.ngeom):
        known = _KINDS.get(int(model.geom_type[geom]))
        if known is not None and model.geom_group[geom] < HIDDEN_GROUP:
            kind, sizes = known
            body = int(model.geom_bodyid[geom])
            yield Shape(
                kind=kind,
                half_size=model.geom_size[geom].take(sizes),
                position=model.geom_pos[geom].copy(),
                quaternion=model.geom_quat[geom].copy(),
                color=_color(model, geom),
                body=body,
                body_name=model.body(body).name,
                mesh=_mesh(model, int(model.geom_dataid[geom])) if kind == "mesh" else None,
            )


def _color(model: mujoco.MjModel, geom: int) -> Color:
    """Colour of the material, or else the geom's own."""
    material = int(model.geom_matid[geom])
    red, green, blue, opacity = (model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]).tolist()
    return red, green, blue, opacity


def _mesh(model: mujoco.MjModel, mesh: int) -> Mesh:
    first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    face, faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    return Mesh(vertices, model.mesh_face[face : face + faces].astype(np.int64))
