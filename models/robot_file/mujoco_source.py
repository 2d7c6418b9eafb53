"""An MJCF as a Pinocchio model: what MuJoCo compiled of it, with all defaults and includes."""

import re
from pathlib import Path, PurePath

import numpy as np
import pinocchio as pin

from surefoot.engine import mujoco
from surefoot.models.robot_file.mesh_file import binary_stl, burden, mesh_content, triangles
from surefoot.models.robot_file.meshes import thinned
from surefoot.models.robot_file.mjcf import Assembled
from surefoot.models.robot_file.mjcf_bindings import MjcfBindings
from surefoot.models.robot_file.mjcf_losses import losses
from surefoot.models.robot_file.mjcf_motors import rotor, torques
from surefoot.models.robot_file.paths import is_file
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.shapes import (
    Shape,
    box,
    capsule,
    cylinder,
    ellipsoid,
    placed,
    require_moderate,
    solid,
    told_missing,
)
from surefoot.models.robot_file.sift import told_absent
from surefoot.models.robot_file.source import ROOT, Source, physical
from surefoot.models.types import Array, RobotError

_HINGE, _SLIDE = (int(kind) for kind in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE))
_LEGS = 8
"""Joints that two legs have at least."""

_MESH = int(mujoco.mjtGeom.mjGEOM_MESH)

MOST_COMPILED = 400_000
"""Triangles of all meshes that MuJoCo compiles, 1.3 kB and 6 us each; dense meshes of more become coarser."""

_MOST_OF_STL = 200_000
"""Triangles that MuJoCo takes of one STL."""

_INFERRED = 'inertiafromgeom="true"'


def read_mjcf(file: RobotFile, path: Path, document: Assembled) -> Source:
    """Read a robot's MJCF.

    Raises:
        RobotError: MuJoCo does not compile it, or it is no single robot of hinges.
    """
    notes, left_out = list[str](), list(told_absent(document.absent))
    try:
        mj = _bare(path, document, notes).compile()
    except RobotError:
        raise
    except Exception as error:
        raise RobotError(("model",), f"{path}: {_placed(str(error), document)}", "mend it") from None
    return _Reader(mj, file, path, _robot_of(mj, path, left_out), notes, left_out).read()


def _bare(path: Path, document: Assembled, notes: list[str]) -> mujoco.MjSpec:
    """The document without looks that are missing.

    Raises:
        RobotError: a mesh is missing that the robot touches with, or that says how heavy it is.
    """
    files = {name: text.encode() for name, text in document.models.items()}
    there = {name: mesh for name, mesh in document.meshes.items() if is_file(mesh)}
    spec = mujoco.MjSpec.from_string(document.text, files, files)
    missing = {mesh.name: document.meshes[mesh.file] for mesh in spec.meshes if mesh.file and mesh.file not in there}
    told = []
    for geom in [geom for geom in spec.geoms if geom.meshname in missing]:
        body, file = geom.parent, missing[geom.meshname]
        what = f"body '{body.name}' of {path}: mesh {file.name} is not there"
        if geom.contype or geom.conaffinity or not body.explicitinertial:
            raise RobotError(("model",), what, f"put it at {file}")
        told.append(what)
        spec.delete(geom)
    for mesh in [mesh for mesh in spec.meshes if mesh.name in missing]:
        spec.delete(mesh)
    notes += told_missing("visual", told)
    spec.assets = files | _moderate(spec, path, document, there, notes)
    return spec


def _moderate(
    spec: mujoco.MjSpec, path: Path, document: Assembled, there: dict[str, Path], notes: list[str]
) -> dict[str, bytes]:
    """What is in the mesh files of a document, dense ones made coarser where they say nothing of inertia or size.

    Raises:
        RobotError: a mesh cannot be read, or those that cannot be made coarser have too many triangles.
    """
    sources = {name: (mesh, PurePath(name).suffix) for name, mesh in there.items()}
    contents = {source: mesh_content(*source) for source in dict.fromkeys(sources.values())}
    costs = {source: burden(source[1], data) for source, data in contents.items()}
    burdens = {name: costs[source] for name, source in sources.items()}
    found = {name: contents[source] for name, source in sources.items()}
    exact, meshes = _exact(spec, document), [mesh for mesh in spec.meshes if mesh.file in there]
    free = [mesh for mesh in meshes if mesh.name not in exact and not mesh.file.endswith(".msh")]
    fixed = sum(burdens[mesh.file] for mesh in meshes) - sum(burdens[mesh.file] for mesh in free)
    if fixed > MOST_COMPILED:
        what = f"{path}: it has {fixed} triangles in MSH and in meshes by which bodies have inertia or size"
        raise RobotError(("model",), what, f"give STL and bodies with an inertial, or at most {MOST_COMPILED}")
    level = _level(sorted(burdens[mesh.file] for mesh in free), max(MOST_COMPILED - fixed, MOST_COMPILED // 4))
    most, thin = min(level, _MOST_OF_STL), dict[tuple[Path, str], bytes]()
    for mesh in [mesh for mesh in free if burdens[mesh.file] > most]:
        source = sources[mesh.file]
        if source not in thin:
            thin[source] = binary_stl(thinned(triangles(*source, contents[source]), most))
        mesh.file = f"thin {PurePath(mesh.file).stem}.stl"
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # says nothing here, and a volume may be missing
        found[mesh.file] = thin[source]
    if thin:
        names = ", ".join(sorted({file.name for file, _ in thin}))
        notes.append(f"meshes are dense and made coarser, with at most {most} triangles each: {names}")
    used = {mesh.file for mesh in spec.meshes}
    return {name: data for name, data in found.items() if name in used}


def _exact(spec: mujoco.MjSpec, document: Assembled) -> set[str]:
    """Names of meshes by which a body has its inertia, or a geom of another shape its size."""
    inferred = any(_INFERRED in text for text in (document.text, *document.models.values()))
    found = set()
    for geom in spec.geoms:
        weightless = geom.mass == 0.0 or (np.isnan(geom.mass) and geom.density == 0.0)
        weighs = not weightless and (inferred or not geom.parent.explicitinertial)
        if geom.meshname and (weighs or geom.type != mujoco.mjtGeom.mjGEOM_MESH):
            found.add(geom.meshname)
    return found


def _level(counts: list[int], most: int) -> int:
    """Up to what each of some ascending counts may go so that together they are at most `most`."""
    for at, count in enumerate(counts):
        if count * (len(counts) - at) > most:
            return most // (len(counts) - at)
        most -= count
    return most + max(counts, default=0)


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
        self._mj, self._file, self._path, self._root = mj, file, path, root
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
        self._left_out += [*losses(mj, self._root), *found.outside()]
        source = Source(
            model=self._model,
            visual=(),
            collision=(),
            followers=dict(found.followers()),
            bindings=tuple(found.bindings()),
            notes=self._notes,
            left_out=self._left_out,
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
        kind, at = int(mj.jnt_type[index]), mj.jnt_pos[index]
        if kind not in (_HINGE, _SLIDE):
            raise RobotError(
                ("model",), f"{self._path}: joint '{name}' is neither hinge nor slide", "give it as hinges"
            )
        if mj.qpos0[mj.jnt_qposadr[index]] != 0.0:
            raise RobotError(("model",), f"{self._path}: joint '{name}' has a ref", "remove it")
        unit = mj.jnt_axis[index]
        joint = pin.JointModelRevoluteUnaligned(unit) if kind == _HINGE else pin.JointModelPrismaticUnaligned(unit)
        there = pin.SE3(np.eye(3), at)
        lower, upper = mj.jnt_range[index] if mj.jnt_limited[index] else (-2 * np.pi, 2 * np.pi)
        one = np.ones(1)
        added = self._model.addJoint(parent, joint, offset * there, name, one, one, one * lower, one * upper)
        self._model.addJointFrame(added)
        self._added[index] = added
        armature = mj.dof_armature[mj.jnt_dofadr[index]] + rotor(mj, index)
        self._model.armature[self._model.joints[added].idx_v] = armature
        return added, there.inverse()

    def _inertia(self, body: int, name: str) -> pin.Inertia:
        mj = self._mj
        R = _placement(mj.body_ipos[body], mj.body_iquat[body]).rotation
        about = R @ np.diag(mj.body_inertia[body]) @ R.T
        repaired = physical(about, float(mj.body_mass[body]), name, self._file, self._path, self._notes)
        return pin.Inertia(float(mj.body_mass[body]), mj.body_ipos[body], about if repaired is None else repaired)

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


def _placed(said: str, document: Assembled) -> str:
    """What MuJoCo says in one line, with the place where it stands in the files."""
    line = re.search(r",? *\bline (\d+)", said)
    place = document.places[int(line[1]) - 1] if line and 0 < int(line[1]) <= len(document.places) else ""
    said = " ".join((said.replace(line[0], "") if line else said).split())[:200]
    return f"{said}, {place}" if place else said


def _placement(position: Array, quaternion: Array) -> pin.SE3:
    """Of MuJoCo's position and quaternion w, x, y, z."""
    w, x, y, z = quaternion
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized().toRotationMatrix(), np.array(position))
