"""Mesh files as triangles: an engine's reader gets a copy of the file alone, beside which there is nothing to open."""

import math
import re
import tempfile
from functools import lru_cache
from pathlib import Path
from xml.parsers import expat

import numpy as np

from surefoot.models.robot_file.document import DEEPEST, MESH, MESH_TEXT, content, decoded, number, signature, text_of
from surefoot.models.robot_file.meshes import Triangles
from surefoot.models.robot_file.paths import is_file
from surefoot.models.types import Array, RobotError

_STL_HEAD = 84
_STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
MOST_WORDS = 8_000_000
"""Spaces and ends of lines of a mesh that is text: what a reader needs grows with its words more than its bytes."""

_ENDINGS = (".stl", ".obj", ".dae")


def read_mesh(path: Path) -> Triangles:
    """Vertices and faces of a mesh file, as written.

    Raises:
        RobotError: it cannot be read.
    """
    return _read(path, signature(path))


@lru_cache(maxsize=64)
def _read(path: Path, _unchanged: tuple[int, ...]) -> Triangles:
    ending = path.suffix.lower()
    return triangles(path, ending, mesh_content(path, ending))


def mesh_content(path: Path, ending: str) -> bytes:
    """Read a mesh file, of text less than of bytes.

    Raises:
        RobotError: it is too long, or cannot be read.
    """
    return content(path, MESH_TEXT if ending in (".obj", ".dae") else MESH)


def triangles(path: Path, ending: str, data: bytes) -> Triangles:
    """Vertices and faces of what is in a mesh file.

    Args:
        path: of the file, for messages.
        ending: of its kind, in small letters.
        data: what is in it.

    Raises:
        RobotError: it cannot be read.
    """
    if ending not in _ENDINGS:
        raise _unread(path, f"it ends in '{path.suffix}'")
    if ending == ".stl" and is_binary_stl(data):
        corners = np.frombuffer(data, _STL, -1, _STL_HEAD)["corners"].reshape(-1, 3)
        vertices, faces = _welded(_finite(path, corners))
    else:
        vertices, faces = _loaded(path, ending, data)
    if not len(faces):
        raise _unread(path, "it has no triangles")
    return _finite(path, vertices), faces


def is_binary_stl(data: bytes) -> bool:
    """Return true if bytes are as long as a binary STL says in its head."""
    count = int.from_bytes(data[80:_STL_HEAD], "little")
    return len(data) == _STL_HEAD + count * _STL.itemsize


def is_sound_stl(data: bytes) -> bool:
    """Return true if bytes are a binary STL of some triangles, all finite."""
    if not is_binary_stl(data) or len(data) == _STL_HEAD:
        return False
    return bool(np.isfinite(np.frombuffer(data, _STL, -1, _STL_HEAD)["corners"]).all())


def _finite(path: Path, points: Array) -> Array:
    """The same points.

    Raises:
        RobotError: one is not finite.
    """
    if not np.isfinite(points).all():
        raise _unread(path, "a vertex is not finite")
    return points


def burden(ending: str, data: bytes) -> int:
    """Cost of compiling a mesh: its triangles, vertices, or triangles of an STL as long, whichever are most."""
    counts = {"f": 0, "v": 0}
    for line in re.finditer(rb"^[ \t]*([fv])[ \t][^\n]*", data, re.MULTILINE) if ending == ".obj" else ():
        counts[line[1].decode()] += len(line[0].split()) - 3
    return max(*counts.values(), (len(data) - _STL_HEAD) // _STL.itemsize)


def binary_stl(mesh: Triangles) -> bytes:
    """The bytes of a mesh file of these triangles."""
    vertices, faces = mesh
    rows = np.zeros(len(faces), _STL)
    rows["corners"] = vertices[faces]
    return bytes(_STL_HEAD - 4) + len(faces).to_bytes(4, "little") + rows.tobytes()


def _unread(path: Path, reason: str) -> RobotError:
    return RobotError(MESH.key, f"mesh {path}: cannot be read, {reason}", MESH.right)


_NOT_FINITE = rb"(?:nan|inf|e\+?0*(?:39|[4-9][0-9]|[1-9][0-9]{2,}))"
"""Numbers in a row that single precision does not hold; readers find nothing wrong in them."""

_ROWS = {
    ".obj": rb"(?im)^[ \t]*v[ \t][^\n]*",
    ".stl": rb"(?im)^[ \t]*vertex[^\n]*",
    ".dae": rb"(?i)<float_array[^>]*>[^<]*",
}
"""Beginning of the rows of vertices, by ending of a file."""


def _loaded(path: Path, ending: str, data: bytes) -> Triangles:
    """The triangles that Coal finds, without materials, which stand in other files."""
    import coal

    if ending == ".stl" and not data.lstrip().startswith(b"solid"):
        raise _unread(path, f"a binary STL of {int.from_bytes(data[80:_STL_HEAD], 'little')} triangles is not as long")
    words = int(np.count_nonzero(np.frombuffer(data, np.uint8) <= ord(" ")))
    if words > MOST_WORDS:
        raise _unread(path, f"it has {words} spaces and ends of lines, more than {MOST_WORDS}")
    metres = 1.0
    if ending == ".dae":
        text = collada_text(path, data)
        metres, data = _Collada(path, text).metres, text.encode()
    if re.search(b"(?i)" + _NOT_FINITE, data) and re.search(_ROWS[ending] + _NOT_FINITE, data):
        raise _unread(path, "a number is not finite")
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / f"mesh{ending}"
        copy.write_bytes(re.sub(rb"(?m)^[ \t]*mtllib[^\n]*", b"", data) if ending == ".obj" else data)
        try:
            read = coal.MeshLoader(coal.NODE_TYPE.BV_OBB).load(str(copy), np.ones(3))
        except Exception as error:
            said = str(error).replace(str(copy), path.name).rpartition("message:")[2]
            reason = " ".join(said.split())[:150]
            raise _unread(path, reason) from None
    corners = (corner[at] for corner in map(read.tri_indices, range(read.num_tris)) for at in range(3))
    faces = np.fromiter(corners, np.int64, 3 * read.num_tris).reshape(-1, 3)
    vertices: Array = metres * np.array(read.vertices(), dtype=np.float64).reshape(-1, 3)
    if faces.size and faces.max() >= len(vertices):
        raise _unread(path, "a triangle has a vertex that is not there")
    return vertices, faces


def collada_text(path: Path, data: bytes) -> str:
    """A Collada file as text, without the line that says how its bytes were encoded.

    Raises:
        RobotError: it is no text in the encoding that it names.
    """
    return re.sub(r"\A\s*<\?xml[^>]*\?>", "", decoded(data, path, MESH_TEXT))


_INDICES = ("p", "ph", "h", "v", "vcount")
"""Elements of Collada that list indices; the reader comes to no end of a list in which there is something else."""


_UNIT = ["COLLADA", "asset", "unit"]


class _Collada:
    """Refuses what no reader of XML should meet, lists without end and arrays longer than their file.

    Attributes:
        metres: length of the file's unit, by its element `unit` [m].
    """

    def __init__(self, path: Path, text: str) -> None:
        data = text.encode()
        self._path, self._size = path, len(data)
        self._open: list[str] = []
        self.metres = 1.0
        parser = expat.ParserCreate("utf-8")
        parser.buffer_text = True
        parser.StartElementHandler, parser.EndElementHandler = self._start, lambda _tag: self._open.pop()
        parser.CharacterDataHandler, parser.EntityDeclHandler = self._text, self._entity
        try:
            parser.Parse(data, True)
        except expat.ExpatError as error:
            reason = f"line {error.lineno} is no XML, {expat.errors.messages[error.code]}"
            raise _unread(path, reason) from None

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._open.append(tag)
        if len(self._open) > DEEPEST:
            raise _unread(self._path, f"it nests more than {DEEPEST} elements")
        if self._open == _UNIT:
            self.metres = self._length(attributes)
        for name in ("count", "stride", "offset"):
            value = attributes.get(name, "0")
            if not re.fullmatch("[0-9]{1,9}", value) or int(value) > self._size:
                raise _unread(self._path, f"{name} of {tag} is '{value[:20]}'")

    def _length(self, unit: dict[str, str]) -> float:
        """Length of the unit [m]: without `meter` one metre (Collada 1.4.1, section 5), unless its name is another.

        Raises:
            RobotError: it has none.
        """
        given = unit.get("meter", "1" if unit.get("name", "meter").lower() in ("meter", "metre", "m") else "")
        metres = number(given.strip())
        if metres is None or not 0.0 < metres < math.inf:
            shown = f"{unit.get('name', '')} {given}".strip()[:40]
            raise _unread(self._path, f"its unit is '{shown}', which has no length in metres")
        return metres

    def _text(self, text: str) -> None:
        if self._open[-1] in _INDICES and (found := re.search(r"[^0-9\s]", text)):
            raise _unread(self._path, f"{self._open[-1]} has '{found[0]}' among its indices")

    def _entity(self, *_: object) -> None:
        raise _unread(self._path, "it has entities of its own")


def _welded(corners: Array) -> Triangles:
    """Corners of separate triangles, those at the same place made one."""
    rows = np.ascontiguousarray(corners, dtype="<f4") + np.float32(0.0)  # minus zero is zero
    keys, places = np.unique(rows.view(np.dtype((np.void, 12))).ravel(), return_inverse=True)
    return keys.view("<f4").reshape(-1, 3).astype(np.float64), places.reshape(-1, 3).astype(np.int64)


def up_axis_in_file(path: Path) -> str:
    """The axis that a Collada file says is up, as it says it; empty for z, for what says nothing and other files."""
    if path.suffix.lower() != ".dae":
        return ""
    found = re.search(r"<up_axis>\s*([XYZ]_UP)\s*</up_axis>", text_of(path, MESH_TEXT))
    return found[1] if found and found[1] != "Z_UP" else ""


def colour_in_file(path: Path) -> tuple[float, float, float] | None:
    """Red, green and blue of the first material of an OBJ or DAE, for shapes to which a URDF gives none."""
    patterns = {".obj": r"(?m)^[ \t]*Kd\s+([^\n]+)", ".dae": r"<diffuse>\s*<color[^>]*>([^<]+)"}
    pattern = patterns.get(path.suffix.lower())
    file = path.with_suffix(".mtl") if path.suffix.lower() == ".obj" else path
    try:
        data = content(file, MESH) if pattern and is_file(file) else b""
        text = collada_text(file, data) if file == path else data.decode("latin-1")
        found = re.search(pattern, text) if pattern else None
        red, green, blue = (min(max(float(part), 0.0), 1.0) for part in (found[1] if found else "").split()[:3])
    except (RobotError, ValueError):  # a colour that cannot be read is none
        return None
    return red, green, blue
