"""An MJCF as a Pinocchio model: what MuJoCo compiled of it, with all defaults and includes."""

from pathlib import Path

import numpy as np
import pinocchio as pin

from surefoot.engines.windowless import mujoco
from surefoot.models.robot_file.bindings import Follower
from surefoot.models.robot_file.compiled import Bare
from surefoot.models.robot_file.magnitudes import Part
from surefoot.models.robot_file.mjcf import Assembled
from surefoot.models.robot_file.mjcf_bindings import MjcfBindings
from surefoot.models.robot_file.mjcf_losses import losses
from surefoot.models.robot_file.mjcf_motors import rotor, torques
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.shapes import (
    Remarks,
    Shape,
    box,
    capsule,
    cylinder,
    ellipsoid,
    placed,
    require_moderate,
    solid,
)
from surefoot.models.robot_file.sift import absent_notes
from surefoot.models.robot_file.source import ROOT, Source, physical
from surefoot.models.types import Array, RobotError

_FREE, _BALL, _HINGE = (
    int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL, mujoco.mjtJoint.mjJNT_HINGE)
)
_LEGS = 8
"""Joints that two legs have at least."""

_MESH = int(mujoco.mjtGeom.mjGEOM_MESH)


def read_mjcf(file: RobotFile, path: Path, document: Assembled) -> Source:
    """Read a robot's MJCF.

    Raises:
        RobotError: MuJoCo does not compile it, or it is no single robot of hinges.
    """
    notes, left_out = list[str](), list(absent_notes(document.absent))
    bare = Bare(path, document, notes)
    mj = bare.compiled()
    Remarks(notes, left_out).missing("visual", bare.unseen)
    return _Reader(mj, file, path, _robot_of(mj, path, left_out), notes, left_out).read()


def _robot_of(mj: mujoco.MjModel, path: Path, left_out: list[str]) -> int:
    """The body in the world that is a robot: the only one, or the only one with joints enough for two legs.

    Raises:
        RobotError: none is, or several are.
    """
    beside = [body for body in range(1, mj.nbody) if mj.body_parentid[body] == 0]
    roots = [body for body in beside if mj.body_subtreemass[body] > 0]
    joints = mj.body_rootid[mj.jnt_bodyid]
    robots = [body for body in roots if (joints == body).sum() >= _LEGS] if len(roots) > 1 else roots
    if len(robots) != 1:
        names = ", ".join(f"'{mj.body(body).name}'" for body in robots or roots) or "none"
        raise RobotError(("model",), f"{path}: has the bodies {names} in its world", "give a file with one robot alone")
    others = [f"'{mj.body(body).name}'" for body in beside if body not in robots]
    if others:
        left_out.append(f"left out: {', '.join(others)}, beside the robot in the world of its model")
    return robots[0]


class _Reader:
    """Goes through the bodies of a compiled model; welded ones become part of what they are welded to."""

    def __init__(
        self, mj: mujoco.MjModel, file: RobotFile, path: Path, root: int, notes: list[str], left_out: list[str]
    ) -> None:
        self._mj = mj
        self._file = file
        self._path = path
        self._root = root
        self._model = pin.Model()
        self._model.name = file.name
        self._links = {mj.body(body).name for body in range(mj.nbody)}
        self._joints = {mj.joint(joint).name for joint in range(mj.njnt)}
        self._names = [mj.body(body).name or _free(f"body{body}", self._links) for body in range(mj.nbody)]
        self._place: dict[int, tuple[int, pin.SE3]] = {}
        self._added: dict[int, int] = {}
        self._notes, self._left_out = notes, left_out

    def read(self) -> Source:
        """The whole robot."""
        mj = self._mj
        for body in range(self._root, mj.nbody):
            if mj.body_rootid[body] == self._root:
                self._add_body(body)
        self._add_sites()
        names = {joint: self._model.names[added] for joint, added in self._added.items()}
        found = MjcfBindings(mj, self._root, names)
        followers = dict[str, Follower]()
        twice = [found.again(*one) for one in found.followers() if followers.setdefault(*one) is not one[1]]
        self._left_out += [*losses(mj, self._root), *found.outside()]
        source = Source(
            model=self._model,
            visual=(),
            collision=(),
            followers=followers,
            bindings=(*twice, *found.bindings()),
            notes=self._notes,
            left_out=self._left_out,
            parts=tuple(map(self._part, self._place)),
            held=self._held(),
        )
        self._add_limits()
        self._add_shapes(source)
        return source

    def _add_body(self, body: int) -> None:
        mj, model = self._mj, self._model
        name = self._name(body)
        first, count = int(mj.body_jntadr[body]), int(mj.body_jntnum[body])
        if body == self._root:
            joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), ROOT)
            offset = pin.SE3(_placement(np.zeros(3), mj.body_quat[body]).rotation, np.zeros(3))
        else:
            joint, before = self._place[int(mj.body_parentid[body])]
            offset = before * _placement(mj.body_pos[body], mj.body_quat[body])
            for index in range(first, first + count):
                joint, offset = self._add_joint(index, joint, offset, name)
                if index < first + count - 1:  # what moves between two joints of a body has no name in the file
                    between = _free(f"{name} behind {model.names[joint]}", self._links)
                    model.addFrame(pin.Frame(between, joint, 0, offset, pin.FrameType.BODY))
        self._place[body] = (joint, offset)
        frame = pin.Frame(name, joint, 0, offset, pin.FrameType.BODY)
        model.addFrame(frame)
        model.appendBodyToJoint(joint, self._inertia(body, name), offset)

    def _add_sites(self) -> None:
        """Sites as frames, since an IMU may be one."""
        mj = self._mj
        for site in range(mj.nsite):
            name, body = mj.site(site).name, int(mj.site_bodyid[site])
            if name and body in self._place and name not in self._links:
                joint, offset = self._place[body]
                place = offset * _placement(mj.site_pos[site], mj.site_quat[site])
                self._model.addFrame(pin.Frame(name, joint, 0, place, pin.FrameType.OP_FRAME))

    def _name(self, body: int) -> str:
        return self._names[body]

    def _add_joint(self, index: int, parent: int, offset: pin.SE3, body: str) -> tuple[int, pin.SE3]:
        """Put a joint at its place in the body; returns it and the body seen from it."""
        mj = self._mj
        name = mj.joint(index).name or _free(f"{body}_joint{index}", self._joints)
        kind, unit, size = int(mj.jnt_type[index]), mj.jnt_axis[index], 1
        if kind == _BALL:
            joint, size = pin.JointModelSpherical(), 3
        else:
            joint = pin.JointModelRevoluteUnaligned(unit) if kind == _HINGE else pin.JointModelPrismaticUnaligned(unit)
        there, ends = pin.SE3(np.eye(3), mj.jnt_pos[index]), self._range(index, name)
        none = np.ones(size)
        added = self._model.addJoint(parent, joint, offset * there, name, none, none, *ends)
        self._model.addJointFrame(added)
        self._added[index] = added
        first = self._model.joints[added].idx_v
        self._model.armature[first : first + size] = mj.dof_armature[mj.jnt_dofadr[index]] + rotor(mj, index)
        return added, there.inverse()

    def _range(self, index: int, name: str) -> tuple[Array, Array]:
        """Ends of a joint, counted from where it stands in the file, as all angles are; none that a ball has."""
        mj = self._mj
        if int(mj.jnt_type[index]) == _BALL:
            return -np.ones(4), np.ones(4)
        lower, upper = mj.jnt_range[index] if mj.jnt_limited[index] else (-2 * np.pi, 2 * np.pi)
        ref = float(mj.qpos0[mj.jnt_qposadr[index]])
        if ref != 0.0:
            self._notes.append(f"joint '{name}' is at its ref {ref:.6g} in the model, from where its angles count here")
        ends = np.array([lower, upper]) - ref * bool(mj.jnt_limited[index])
        return ends[:1], ends[1:]

    def _held(self) -> tuple[str, ...]:
        """Joints of the base itself; a floating base holds it nowhere."""
        mj, first = self._mj, int(self._mj.body_jntadr[self._root])
        joints = range(first, first + int(mj.body_jntnum[self._root]))
        return tuple(
            mj.joint(joint).name or f"{self._name(self._root)}_joint{joint}"
            for joint in joints
            if int(mj.jnt_type[joint]) != _FREE
        )

    def _inertia(self, body: int, name: str) -> pin.Inertia:
        mj = self._mj
        R = _placement(mj.body_ipos[body], mj.body_iquat[body]).rotation
        about = R @ np.diag(mj.body_inertia[body]) @ R.T
        repaired = physical(about, float(mj.body_mass[body]), name, self._file, self._path, self._notes)
        return pin.Inertia(float(mj.body_mass[body]), mj.body_ipos[body], about if repaired is None else repaired)

    def _part(self, body: int) -> Part:
        mj = self._mj
        moment = float(mj.body_inertia[body].max())
        return Part(self._name(body), float(mj.body_mass[body]), np.array(mj.body_ipos[body]), moment)

    def _add_limits(self) -> None:
        """Torques from the motors; of speeds an MJCF knows nothing."""
        model = self._model
        effort, speed = np.zeros(model.nv), np.zeros(model.nv)
        unlike = []
        for joint, added in self._added.items():
            lower, upper = torques(self._mj, joint)
            effort[model.joints[added].idx_v] = max(0.0, min(-lower, upper))
            unlike += [] if lower == -upper else [model.names[added]]
        if unlike:
            self._left_out.append(f"left out: the larger of unlike torques both ways of joints {', '.join(unlike)}")
        model.upperEffortLimit, model.lowerEffortLimit = effort, -effort
        model.upperVelocityLimit, model.lowerVelocityLimit = speed, -speed

    def _add_shapes(self, source: Source) -> None:
        """Sort the geoms into what touches and what is only drawn."""
        mj = self._mj
        visual: list[Shape] = []
        collision: list[Shape] = []
        for geom in range(mj.ngeom):
            if mj.body_rootid[mj.geom_bodyid[geom]] == self._root:
                touches = mj.geom_contype[geom] or mj.geom_conaffinity[geom]
                (collision if touches else visual).extend(self._shape(geom))
                require_moderate((*visual, *collision))
        source.visual, source.collision = tuple(visual or collision), tuple(collision)
        if visual and not collision:
            why = "no geom of the model collides (contype and conaffinity are 0)"
            self._notes.append(f"{why}, so links touch by what is drawn of them")

    def _shape(self, geom: int) -> list[Shape]:
        """The geom as triangles; none for planes and fields."""
        mj = self._mj
        kind, (a, b, c) = int(mj.geom_type[geom]), mj.geom_size[geom].tolist()
        material = mj.geom_matid[geom]
        red, green, blue, alpha = (mj.mat_rgba[material] if material >= 0 else mj.geom_rgba[geom]).tolist()
        rgba, link = (red, green, blue, alpha), self._name(int(mj.geom_bodyid[geom]))
        place = _placement(mj.geom_pos[geom], mj.geom_quat[geom])
        if kind == _MESH:
            mesh = mj.mesh(mj.geom_dataid[geom])
            vertices = mj.mesh_vert[mesh.vertadr[0] : mesh.vertadr[0] + mesh.vertnum[0]].astype(np.float64)
            faces = mj.mesh_face[mesh.faceadr[0] : mesh.faceadr[0] + mesh.facenum[0]].astype(np.int64)
            return [Shape(link, placed(vertices, place), faces, rgba)]
        makers = {
            "SPHERE": lambda: ellipsoid(a, a, a),
            "CAPSULE": lambda: capsule(a, 2 * b),
            "CYLINDER": lambda: cylinder(a, 2 * b),
            "BOX": lambda: box(2 * a, 2 * b, 2 * c),
            "ELLIPSOID": lambda: ellipsoid(a, b, c),
        }
        maker = makers.get(mujoco.mjtGeom(kind).name.removeprefix("mjGEOM_"))
        return [solid(link, maker(), place, rgba)] if maker else []


def _free(name: str, taken: set[str]) -> str:
    """A name for what has none in the model, other than all that are taken; it is taken then."""
    while name in taken:
        name += "_"
    taken.add(name)
    return name


def _placement(position: Array, quaternion: Array) -> pin.SE3:
    """The placement of MuJoCo's position and quaternion w, x, y, z."""
    w, x, y, z = quaternion
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized().toRotationMatrix(), np.array(position))
