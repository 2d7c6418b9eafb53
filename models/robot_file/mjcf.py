"""An MJCF with all that it includes as one text, beside the meshes that it names: an engine opens no file for it.

Includes and meshes are found as MuJoCo finds them. Elements go that `mjcf_schema` leaves out.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from xml.sax.saxutils import quoteattr

from surefoot.models.robot_file.document import DEEPEST, MOST_ELEMENTS, Node, number, read_xml, refuse
from surefoot.models.robot_file.paths import is_file, resolve
from surefoot.models.robot_file.quantities import TURN, check_numbers, of_mjcf
from surefoot.models.robot_file.sift import Absent, sift
from surefoot.models.robot_file.urdf import MOST_SHAPES

_MOST_FILES = 200
_FOLDERS = ("meshdir", "texturedir", "assetdir", "strippath")
_MESHES = {"stl": ".stl", "obj": ".obj", "vnd.mujoco.msh": ".msh", "msh": ".msh"}
"""Ending by kind of content, or by ending."""


_Size = tuple[int, int]
"""Elements and geoms."""


@dataclass(frozen=True, slots=True)
class Assembled:
    """A document that refers to nothing outside.

    Attributes:
        root: of the main file, with what it includes.
        text: what an engine reads, an element a line.
        places: file and line of each line.
        models: other documents of robots that are attached, by the name that the text gives them.
        meshes: files by the name that the text gives them, whether or not they are there.
        files: each reference with the file that it means; None where there is none.
        absent: elements that are left out.
    """

    root: Node
    text: str
    places: tuple[str, ...]
    models: Mapping[str, str]
    meshes: Mapping[str, Path]
    files: tuple[tuple[str, Path | None], ...]
    absent: tuple[Absent, ...]


def assembled(root: Node) -> Assembled:
    """Put an MJCF together.

    Raises:
        RobotError: a file is not there, includes itself, or the whole is too large or has numbers that no robot has.
    """
    assembly = _Assembly()
    assembly.add(root, (root.file,))
    lines = list(_lines(root))
    text, places = "\n".join(line for line, _ in lines), tuple(place for _, place in lines)
    return Assembled(
        root, text, places, assembly.models, assembly.meshes, tuple(assembly.files), tuple(assembly.absent)
    )


@dataclass
class _Assembly:
    """Gathers the files of a document, and what its parts come to when an engine has repeated them."""

    models: dict[str, str] = field(default_factory=dict)
    meshes: dict[str, Path] = field(default_factory=dict)
    files: list[tuple[str, Path | None]] = field(default_factory=list)
    absent: list[Absent] = field(default_factory=list)

    def add(self, root: Node, opened: tuple[Path, ...]) -> "_Size":
        """Complete a document; returns how many elements and geoms it comes to."""
        main = opened[-1]
        self._include(root, main.parent, [*opened], 0)
        self.absent += sift(root)
        check_numbers(root, of_mjcf)
        _check_angles(root)
        folder = _folder_of_meshes(root)
        for mesh in _assets(root, "mesh"):
            self._add_mesh(mesh, main.parent, folder)
        sizes = {model.get("name", ""): self._add_model(model, opened) for model in _assets(root, "model")}
        for node in root.elements():
            for name, value in node.attrib.items():
                if name.startswith("file") and value not in {*self.meshes, *self.models}:
                    refuse(node, f"{node.tag} has the {name} '{value}'", "leave it out")
        size, shapes = _size(root, sizes, 1)
        if size > MOST_ELEMENTS or shapes > MOST_SHAPES:
            what = f"comes to {size} elements with {shapes} geoms"
            refuse(root, what, f"give a robot of at most {MOST_ELEMENTS} with {MOST_SHAPES}")
        return size, shapes

    def _include(self, node: Node, folder: Path, opened: list[Path], depth: int) -> None:
        """Put what a node includes in its place."""
        if depth > DEEPEST:
            refuse(node, f"nests more than {DEEPEST} elements", "give it flatter")
        children: list[Node] = []
        for child in node.nodes:
            if child.tag != "include":
                self._include(child, folder, opened, depth + 1)
                children.append(child)
                continue
            path = self._found(child, (folder, child.file.parent))
            if path in opened:
                refuse(child, f"'{child.get('file')}' is included already", "include each file once")
            opened.append(path)
            part = read_xml(path)
            self._include(part, folder, opened, depth)
            children += part.nodes
        node[:] = children

    def _found(self, node: Node, folders: tuple[Path, ...]) -> Path:
        """The file that an element names.

        Raises:
            RobotError: it is not there.
        """
        path = self._named(node, folders)
        if not is_file(path):
            refuse(node, f"{node.tag} {node.get('file')} is not there", f"put it at {path}, or correct the reference")
        return path

    def _named(self, node: Node, folders: tuple[Path, ...]) -> Path:
        """The first file that is there of those that an element may mean, or else the first."""
        reference = node.get("file", "")
        if not reference or len(self.files) >= _MOST_FILES:
            what = f"{node.tag} names no file" if not reference else f"names more than {_MOST_FILES} files"
            refuse(node, what, "give the model of one robot")
        candidates = [resolve(reference.replace("\\", "/"), folder) for folder in folders]
        path = next((path for path in candidates if is_file(path)), None)
        self.files.append((reference, path))
        return path or candidates[0]

    def _add_mesh(self, mesh: Node, main: Path, folder: "_Folder") -> None:
        reference = mesh.get("file")
        if reference is None:
            return
        if folder.strip:
            mesh.set("file", PurePosixPath(reference.replace("\\", "/")).name)
        path = self._named(mesh, (main / folder.name, mesh.file.parent, mesh.file.parent / folder.name))
        kind = mesh.attrib.pop("content_type", "").rpartition("/")[2] or path.suffix[1:].lower()
        if kind not in _MESHES:
            refuse(mesh, f"mesh {reference} is '{kind}'", "give STL, OBJ or MSH")
        mesh.set("name", mesh.get("name") or path.stem)
        mesh.set("file", f"mesh{len(self.meshes)}{_MESHES[kind]}")
        self.meshes[mesh.get("file", "")] = path

    def _add_model(self, model: Node, opened: tuple[Path, ...]) -> "_Size":
        """Put a document that is attached beside the main one; returns what it comes to."""
        path = self._found(model, (opened[-1].parent, model.file.parent))
        if path in opened:
            refuse(model, f"'{model.get('file')}' is part of itself", "attach another")
        root = read_xml(path)
        size = self.add(root, (*opened, path))
        if name := model.get("name") or root.get("model"):
            model.set("name", name)
        model.set("file", f"model{len(self.models)}.xml")
        self.models[model.get("file", "")] = "\n".join(line for line, _ in _lines(root))
        return size


@dataclass(frozen=True, slots=True)
class _Folder:
    name: str
    strip: bool


def _folder_of_meshes(root: Node) -> _Folder:
    """Settings that the compiler sections of a document have together, which are taken out of them."""
    name, strip = "", False
    for compiler in root.findall("compiler"):
        name = compiler.get("meshdir", compiler.get("assetdir", name))
        strip = compiler.get("strippath", str(strip)).lower() == "true"
        for attribute in _FOLDERS:
            compiler.attrib.pop(attribute, None)
    return _Folder(name, strip)


def _check_angles(root: Node) -> None:
    """Refuse Euler angles beyond a turn in a document whose angles are radians.

    Raises:
        RobotError: says which.
    """
    if [unit for compiler in root.findall("compiler") if (unit := compiler.get("angle"))][-1:] != ["radian"]:
        return
    for node in root.elements():
        angles = [number(token) or 0.0 for token in node.get("euler", "").split()]
        if max(map(abs, angles), default=0.0) > TURN:
            what = f"euler of {node.tag} '{node.get('name', '')}' is '{node.get('euler')}' in a file of radians"
            refuse(node, what, f'give at most {TURN:g} rad, or <compiler angle="degree"/>')


def _assets(root: Node, tag: str) -> list[Node]:
    return [node for asset in root.findall("asset") for node in asset if isinstance(node, Node) and node.tag == tag]


def _size(node: Node, sizes: Mapping[str, _Size], times: int) -> _Size:
    """Elements and geoms below a node and itself, when all is repeated and attached."""
    size, shapes = 1, int(node.tag == "geom")
    if node.tag == "attach":
        size, shapes = sizes.get(node.get("model", ""), (1, 0))
    size, shapes = times * size, times * shapes
    if node.tag == "replicate":
        count = number(node.get("count", ""))
        if count is None or not 0 <= count <= MOST_ELEMENTS:
            refuse(node, f"count of replicate is '{node.get('count', '')}'", f"give one up to {MOST_ELEMENTS}")
        times = min(times * round(count), MOST_ELEMENTS + 1)
    for child in node.nodes:
        more, geoms = _size(child, sizes, times)
        size, shapes = size + more, shapes + geoms
    return size, shapes


def _lines(node: Node) -> Iterator[tuple[str, str]]:
    """Text of a node, an element a line, with the place of each."""
    head = "".join(f" {name}={quoteattr(value)}" for name, value in node.attrib.items())
    yield f"<{node.tag}{head}{'' if len(node) else '/'}>", node.place
    for child in node.nodes:
        yield from _lines(child)
    if len(node):
        yield f"</{node.tag}>", node.place
