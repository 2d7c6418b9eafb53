"""An MJCF as MuJoCo compiles it, without what is no part of a robot and without looks of which it makes nothing."""

import re
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePath

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.models.robot_file.mesh_file import binary_stl, burden, is_sound_stl, mesh_content, triangles
from surefoot.models.robot_file.meshes import thinned
from surefoot.models.robot_file.mjcf import Assembled
from surefoot.models.robot_file.paths import is_file
from surefoot.models.types import RobotError

MOST_COMPILED = 400_000
"""Triangles of all meshes that MuJoCo compiles, 1.3 kB and 6 us each; dense meshes of more become coarser."""

_MOST_OF_STL = 200_000
"""Triangles that MuJoCo takes of one STL."""

_INFERRED = 'inertiafromgeom="true"'


_OF_ENGINE = re.compile(
    r"^Error: |;? perhaps this is an ASCII file\?| ?\. Try setting inertia to shell| Element name [^,]*, id -?\d+"
)
"""Text that MuJoCo adds to a reason, which helps nobody here."""


class Bare:
    """A document without what is no part of a robot: contacts with a ground, and looks that are missing or are none.

    Attributes:
        unseen: why geoms are not drawn, one error each.
    """

    def __init__(self, path: Path, document: Assembled, notes: list[str]) -> None:
        self._path, self._document, self._notes = path, document, notes
        self.unseen: list[RobotError] = []

    def compiled(self) -> mujoco.MjModel:
        """Compile it with MuJoCo, without the meshes of looks of which MuJoCo makes nothing.

        Raises:
            RobotError: it compiles nothing of it, or a mesh is missing by which the robot touches or weighs.
        """
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            mj = self._compiled()
        said = dict.fromkeys(self._said(str(warning.message)) for warning in heard)
        self._notes += [f"MuJoCo remarks: {line}" for line in said]
        return mj

    def _compiled(self) -> mujoco.MjModel:
        files = {name: text.encode() for name, text in self._document.models.items()}
        try:
            spec = mujoco.MjSpec.from_string(self._document.text, files, files)
            self._leave_out(spec, self._faults(spec))
            found = {name: content for name, content in self._contents.items() if not isinstance(content, RobotError)}
            spec.assets = files | moderate(spec, self._path, self._document, found, self._notes)
            while True:
                try:
                    return spec.compile()
                except ValueError as error:
                    self._leave_out(spec, self._fault_of_mesh(spec, error))
        except RobotError:
            raise
        except Exception as error:
            raise RobotError(("model",), f"{self._path}: {self._said(str(error))}", "mend it") from None

    @cached_property
    def _contents(self) -> "dict[str, _Content | RobotError]":
        """Content of each mesh file by the name that the document gives it, or why it cannot be read."""
        sources = {name: (mesh, PurePath(name).suffix) for name, mesh in self._document.meshes.items()}
        read = {source: _read(*source) for source in dict.fromkeys(sources.values())}
        return {name: read[source] for name, source in sources.items()}

    def _faults(self, spec: mujoco.MjSpec) -> dict[str, RobotError]:
        """Reasons why meshes cannot be read, by name."""
        found = {mesh.name: self._contents[mesh.file] for mesh in spec.meshes if mesh.file}
        return {name: fault for name, fault in found.items() if isinstance(fault, RobotError)}

    def _fault_of_mesh(self, spec: mujoco.MjSpec, error: Exception) -> dict[str, RobotError]:
        """Reason why MuJoCo makes nothing of a mesh, by its name.

        Raises:
            Exception: the error itself, if it is of something else.
        """
        named = re.search(r"Element name '([^']*)'", str(error))
        mesh = next((mesh for mesh in spec.meshes if named and mesh.name == named[1]), None)
        if mesh is None:
            raise error
        file = self._document.meshes.get(mesh.file)
        said = _OF_ENGINE.sub("", self._said(str(error)))
        what = f"mesh {file.name if file else mesh.name} is of no use, {said}"
        return {mesh.name: RobotError(("model",), what, "give it as a closed surface with a volume")}

    def _leave_out(self, spec: mujoco.MjSpec, faults: dict[str, RobotError]) -> None:
        """Delete meshes and the geoms that have them.

        Raises:
            RobotError: the robot touches with one, or one says how heavy it is.
        """
        for geom in [geom for geom in spec.geoms if geom.meshname in faults]:
            body, fault = geom.parent, faults[geom.meshname]
            named = RobotError(fault.key, f"body '{body.name}' of {self._path}: {fault.what}", fault.right)
            if geom.contype or geom.conaffinity or not body.explicitinertial:
                raise named
            self.unseen.append(named)
            spec.delete(geom)
        for mesh in [mesh for mesh in spec.meshes if mesh.name in faults]:
            spec.delete(mesh)

    def _said(self, text: str) -> str:
        """Message of MuJoCo in one line, with the files' own names and the place where it stands in them."""
        for name, mesh in self._document.meshes.items():
            text = text.replace(f"'{name}'", f"'{mesh.name}'")
        return _placed(text, self._document)


@dataclass(frozen=True, slots=True)
class _Content:
    """The content of a mesh file.

    Attributes:
        source: the file, and the ending of its kind.
        data: as MuJoCo can read it.
        cost: see `burden`.
    """

    source: tuple[Path, str]
    data: bytes
    cost: int


def _read(mesh: Path, ending: str) -> _Content | RobotError:
    """Read a mesh file; an STL that is text becomes one that is none, which MuJoCo can read."""
    if not is_file(mesh):
        return RobotError(("model",), f"mesh {mesh.name} is not there", f"put it at {mesh}")
    try:
        data = mesh_content(mesh, ending)
        if ending == ".stl" and not is_sound_stl(data):
            data = binary_stl(triangles(mesh, ending, data))
    except RobotError as error:
        return error
    return _Content((mesh, ending), data, burden(ending, data))


def moderate(
    spec: mujoco.MjSpec, path: Path, document: Assembled, contents: dict[str, _Content], notes: list[str]
) -> dict[str, bytes]:
    """Contents of a document's mesh files, dense ones made coarser where they say nothing of inertia or size.

    Raises:
        RobotError: a mesh cannot be read, or those that cannot be made coarser have too many triangles.
    """
    burdens = {name: content.cost for name, content in contents.items()}
    found = {name: content.data for name, content in contents.items()}
    exact, meshes = _exact(spec, document), [mesh for mesh in spec.meshes if mesh.file in contents]
    free = [mesh for mesh in meshes if mesh.name not in exact and not mesh.file.endswith(".msh")]
    fixed = sum(burdens[mesh.file] for mesh in meshes) - sum(burdens[mesh.file] for mesh in free)
    if fixed > MOST_COMPILED:
        what = f"{path}: it has {fixed} triangles in MSH and in meshes by which bodies have inertia or size"
        raise RobotError(("model",), what, f"give STL and bodies with an inertial, or at most {MOST_COMPILED}")
    level = _level(sorted(burdens[mesh.file] for mesh in free), max(MOST_COMPILED - fixed, MOST_COMPILED // 4))
    most, thin = min(level, _MOST_OF_STL), dict[tuple[Path, str], bytes]()
    for mesh in [mesh for mesh in free if burdens[mesh.file] > most]:
        content = contents[mesh.file]
        if content.source not in thin:
            thin[content.source] = binary_stl(thinned(triangles(*content.source, content.data), most))
        mesh.file = f"thin {PurePath(mesh.file).stem}.stl"
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # says nothing here, and a volume may be missing
        found[mesh.file] = thin[content.source]
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


def _placed(said: str, document: Assembled) -> str:
    """Message of MuJoCo in one line, with the place where it stands in the files."""
    line = re.search(r",? *\bline (\d+)", said)
    place = document.places[int(line[1]) - 1] if line and 0 < int(line[1]) <= len(document.places) else ""
    said = " ".join((said.replace(line[0], "") if line else said).split())[:200]
    return f"{said}, {place}" if place else said
