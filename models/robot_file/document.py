"""Files read with bounds, and XML as a tree whose elements know their lines: whoever wrote them, they cost little."""

import re
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn
from xml.etree import ElementTree
from xml.parsers import expat

from surefoot.models.types import RobotError
from surefoot.values import dataclass

MOST_ELEMENTS = 20_000
"""Of a model with all that it includes."""

DEEPEST = 200
"""Elements inside each other."""

LONGEST_NAME = 200
"""Characters of a name."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What a file is for.

    Attributes:
        key: of the robot file that names it, for messages.
        noun: what it is called.
        most: bytes that it may have.
        right: what to do where it cannot be read.
    """

    key: tuple[str, ...]
    noun: str
    most: int
    right: str


ROBOT_FILE = Kind((), "", 100_000, "give a readable robot file")
MODEL = Kind(("model",), "", 16 << 20, "give the path of a URDF or MJCF")
SRDF = Kind(("srdf",), "", 4 << 20, "give the path of an SRDF")
MESH = Kind(("model",), "mesh ", 64 << 20, "give STL, DAE or OBJ")
MESH_TEXT = Kind(("model",), "mesh ", 32 << 20, "give at most 32 MiB of DAE or OBJ, or binary STL")


def content(path: Path, kind: Kind) -> bytes:
    """What is in a file.

    Raises:
        RobotError: it is no regular file, larger than one of its kind may be, or cannot be read.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            reason = "cannot be read, it is no regular file"
        elif status.st_size > kind.most:
            reason = f"has {status.st_size} bytes, more than {kind.most}"
        else:
            with path.open("rb") as file:
                return file.read(kind.most)
    except (OSError, ValueError) as error:
        reason = f"cannot be read, {getattr(error, 'strerror', None) or 'no file has such a name'}"
    raise RobotError(kind.key, f"{kind.noun}{path}: {reason}", kind.right)


def text_of(path: Path, kind: Kind) -> str:
    """Text of a file.

    Raises:
        RobotError: it cannot be read, or is no UTF-8.
    """
    try:
        return content(path, kind).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise RobotError(kind.key, f"{kind.noun}{path}: cannot be read, it is no UTF-8 text", kind.right) from None


def signature(path: Path) -> tuple[int, ...]:
    """What changes when a file does; nothing where there is none."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return ()
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


class Node(ElementTree.Element):
    """An element that knows where it stands."""

    file: Path
    line: int

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.file}:{self.line}"

    @property
    def nodes(self) -> "list[Node]":
        """Its children."""
        return [child for child in self if isinstance(child, Node)]

    def elements(self) -> "Iterator[Node]":
        """Itself and all below it."""
        yield from (node for node in self.iter() if isinstance(node, Node))


def refuse(node: Node, what: str, right: str, key: str = "model") -> NoReturn:
    """Refuse an element in one sentence that says its place."""
    raise RobotError((key,), f"{node.place}: {what}", right)


def read_xml(path: Path, kind: Kind = MODEL) -> Node:
    """The root of an XML file, without text between elements.

    Raises:
        RobotError: it cannot be read, is no XML, has entities of its own, or is too large or too deep.
    """
    text = _without_comments(text_of(path, kind))
    builder = _Builder(path, kind)
    try:
        builder.parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        what = f"{path}:{error.lineno}: no XML, {expat.errors.messages[error.code]}"
        raise RobotError(kind.key, what, "mend it; xacro files have to be expanded") from None
    return builder.root


def root_of(path: Path, kind: Kind) -> Node | None:
    """The root of an XML file without what is in it; None where there is none that can be read."""
    try:
        text = _without_comments(text_of(path, kind))
        builder = _Builder(path, kind, first=True)
        builder.parser.Parse(text.encode(), True)
    except (RobotError, expat.ExpatError):
        return None
    except _FoundError as found:
        return found.root
    return None


class _FoundError(Exception):
    """Ends reading at the root."""

    def __init__(self, root: Node) -> None:
        super().__init__()
        self.root = root


class _Builder:
    """Builds the tree while expat reads, and stops where a bound is passed."""

    def __init__(self, path: Path, kind: Kind, first: bool = False) -> None:
        self._path, self._kind, self._first = path, kind, first
        self._open: list[Node] = []
        self._count = 0
        self.parser = expat.ParserCreate("utf-8")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = lambda _tag: self._open.pop()
        self.parser.EntityDeclHandler = lambda *_: self._refuse("has an entity of its own", "write what it stands for")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        node = Node(tag, attributes)
        node.file, node.line = self._path, self.parser.CurrentLineNumber
        if self._first:
            raise _FoundError(node)
        self._count += 1
        if self._count > MOST_ELEMENTS:
            self._refuse(f"has more than {MOST_ELEMENTS} elements", "give the model of one robot")
        if len(self._open) == DEEPEST:
            self._refuse(f"nests more than {DEEPEST} elements", "give it flatter")
        name = attributes.get("name", "")
        if len(name) > LONGEST_NAME or not name.isprintable():
            self._refuse(f"{tag} has the name '{name[:20]}...'", f"give at most {LONGEST_NAME} printable characters")
        if self._open:
            self._open[-1].append(node)
        else:
            self.root = node
        self._open.append(node)

    def _refuse(self, what: str, right: str) -> NoReturn:
        raise RobotError(self._kind.key, f"{self._path}:{self.parser.CurrentLineNumber}: {what}", right)


def _without_comments(text: str) -> str:
    """The text with as many lines and without comments, in which engines allow what XML does not."""
    parts, at = [], 0
    while (begin := text.find("<!--", at)) >= 0 and (end := text.find("-->", begin + 4)) >= 0:
        parts += [text[at:begin], "\n" * text.count("\n", begin, end)]
        at = end + 3
    return "".join((*parts, text[at:]))


_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def number(token: str) -> float | None:
    """A decimal number as both engines read it; None for anything else."""
    return float(token) if _NUMBER.fullmatch(token) else None
