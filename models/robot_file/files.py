"""A model with all the files that it is made of, found by the one parser that also gives it to the engines."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from surefoot.models.robot_file.document import MODEL, SRDF, Node, read_xml, root_of, signature
from surefoot.models.robot_file.mjcf import Assembled, assembled
from surefoot.models.robot_file.paths import is_file, resolve
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.urdf import check_urdf
from surefoot.models.types import RobotError

MOST_TEXT = 48 << 20
"""Bytes of all OBJ and DAE of a URDF, 0.15 us each."""

MOST_COMPILED = 48 << 20
"""Bytes of all mesh files of an MJCF, each read before dense ones become coarser."""


@dataclass(frozen=True, slots=True)
class Document:
    """A model as it was read; nothing but its files is ever opened for it.

    Attributes:
        path: of its main file.
        root: its elements, with what it includes.
        mjcf: what MuJoCo reads; None for a URDF.
        references: what it refers to, with the file that is meant; None where there is none.
    """

    path: Path
    root: Node
    mjcf: Assembled | None
    references: tuple[tuple[str, Path | None], ...]

    @property
    def files(self) -> tuple[Path, ...]:
        """All that are there, the main one first."""
        return (self.path, *dict.fromkeys(file for _, file in self.references if file is not None))


def read_document(path: Path) -> Document:
    """Read a model, and find what it is made of.

    Raises:
        RobotError: it cannot be read, is neither URDF nor MJCF, or has what no robot has.
    """
    root = read_xml(path, MODEL)
    if root.tag == "mujoco":
        mjcf = assembled(root)
        _require_small(mjcf.meshes.values(), MOST_COMPILED, path, "meshes", "coarser ones")
        return Document(path, root, mjcf, mjcf.files)
    if root.tag != "robot":
        what = f"{path}: neither URDF nor MJCF"
        raise RobotError(("model",), what, "give a file with <robot> or <mujoco> at its root")
    check_urdf(root)
    references = tuple(_meshes(root, path))
    texts = [file for _, file in references if file is not None and file.suffix.lower() in (".obj", ".dae")]
    _require_small(texts, MOST_TEXT, path, "OBJ and DAE", "binary STL")
    return Document(path, root, None, references)


def _require_small(files: Iterable[Path], most: int, path: Path, what: str, instead: str) -> None:
    """Refuse more bytes than an engine should read.

    Raises:
        RobotError: all files together have more than `most`.
    """
    size = sum((*signature(file), 0, 0, 0)[2] for file in set(files))
    if size > most:
        right = f"give at most {most}, or {instead}"
        raise RobotError(("model",), f"{path}: its {what} have {size} bytes together", right)


def _meshes(root: Node, path: Path) -> Iterator[tuple[str, Path | None]]:
    """Meshes of links, with the file beside each that may have its colours."""
    for reference in dict.fromkeys(mesh.get("filename", "") for mesh in root.elements() if mesh.tag == "mesh"):
        try:
            place = resolve(reference, path.parent, "mesh")
        except RobotError:
            yield reference, None
            continue
        colours = (place.with_suffix(".mtl"),) if place.suffix.lower() == ".obj" else ()
        yield from ((reference, file if is_file(file) else None) for file in (place, *colours))


@dataclass(frozen=True, slots=True)
class Originals:
    """A robot file with its model, each as it was read, once.

    Attributes:
        file: the robot file.
        document: its model.
        srdf: that is of the model; None where there is none.
    """

    file: RobotFile
    document: Document
    srdf: Path | None


def originals(file: RobotFile, folder: Path) -> Originals:
    """Read the model of a robot file in a folder.

    Raises:
        RobotError: it cannot be read, is neither URDF nor MJCF, or has what no robot has; or its SRDF is not there.
    """
    document = read_document(resolve(file.model, folder))
    return Originals(file, document, _srdf_of(file, document))


def _srdf_of(file: RobotFile, document: Document) -> Path | None:
    """The SRDF that the file names, or the one beside the model that is of a robot of its name.

    Raises:
        RobotError: the file names one that is not there.
    """
    folder = document.path.parent
    if file.srdf is not None:
        place = resolve(file.srdf, folder, "srdf")
        if not is_file(place):
            raise RobotError(("srdf",), f"srdf {file.srdf} of {file.name} is not there", f"put it at {place}")
        return place
    name = document.root.get("name") if document.mjcf is None else None
    beside = sorted((*folder.glob("*.srdf"), *(folder.parent / "srdf").glob("*.srdf")))
    roots = {place: root_of(place, SRDF) for place in beside} if name else {}
    named = [place for place, found in roots.items() if found is not None and found.get("name") == name]
    return named[0] if len(named) == 1 else None
