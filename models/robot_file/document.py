"""Files read with bounds, and XML as a tree whose elements know their lines: whoever wrote them, they cost little."""

import codecs
import re
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import NoReturn
from xml.etree import ElementTree
from xml.parsers import expat

from surefoot.models.types import RobotError
from surefoot.pointers import IS_A_POINTER, is_pointer

MOST_ELEMENTS = 20_000
"""Most elements of a model with all that it includes."""

DEEPEST = 200
"""Elements inside each other."""

LONGEST_NAME = 200
"""Characters of a name."""


@dataclass(frozen=True, slots=True)
class Kind:
    """The purpose of a file.

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


def raw(path: Path, kind: Kind) -> bytes:
    """Read a file, whatever is in it.

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


def content(path: Path, kind: Kind) -> bytes:
    """Read a file that is there, and in whose place nothing else stands.

    Raises:
        RobotError: as `raw`, or it is a Git LFS pointer.
    """
    data = raw(path, kind)
    if is_pointer(data):
        what, _, right = IS_A_POINTER.partition("; ")
        raise RobotError(kind.key, f"{kind.noun}{path}: {what}", right)
    return data


def text_of(path: Path, kind: Kind) -> str:
    """Text of a file, in the encoding that it names itself, or else in UTF-8.

    Raises:
        RobotError: it cannot be read, or is no text in that encoding.
    """
    return decoded(content(path, kind), path, kind)


_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF32_LE: "utf-32",
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
    b"<\0?\0": "utf-16-le",
    b"\0<\0?": "utf-16-be",
}
"""Encoding by how a file begins: byte order marks, UTF-32 before UTF-16, and XML without one (XML 1.0, appendix F)."""

_DECLARED = re.compile(rb"""\s*<\?xml\s[^>]*?encoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']""")


_OF_TEXTS = ("ascii", "big5", "cp", "euc", "gb", "iso8859", "koi8", "mac", "shift_jis", "utf-8")
"""Beginnings of the encodings, as Python calls them, that an XML file may name and that are none of programs."""


def decoded(data: bytes, path: Path, kind: Kind) -> str:
    """Bytes of a file as text: in the encoding that they name themselves where they are text in it, or else in UTF-8.

    Raises:
        RobotError: they are no such text.
    """
    for name in (*_named(data), "utf-8"):
        try:
            return data.decode(name)
        except UnicodeDecodeError:
            continue
    encodings = "".join(f"{name} or " for name in _named(data) if name != "utf-8-sig")
    raise RobotError(kind.key, f"{kind.noun}{path}: cannot be read, it is no {encodings}UTF-8 text", kind.right)


def _named(data: bytes) -> tuple[str, ...]:
    """The encoding that bytes name by how they begin, if any; one that its own name contradicts is none."""
    marked = [name for mark, name in _MARKS.items() if data.startswith(mark)]
    if marked or not (declared := _DECLARED.match(data)):
        return tuple(marked[:1])
    try:
        name = codecs.lookup(declared[1].decode()).name
    except LookupError:
        return ()
    return (name,) if name.startswith(_OF_TEXTS) else ()


def signature(path: Path) -> tuple[int, ...]:
    """Signature of a file that changes when it does; empty where there is none."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return ()
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


class UnexpandedError(RobotError):
    """A file is a xacro that has to be expanded before it is a model."""


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

    def child(self, tag: str) -> "Node":
        """A new child at its place."""
        node = Node(tag)
        node.file, node.line = self.file, self.line
        self.append(node)
        return node

    def elements(self) -> "Iterator[Node]":
        """Itself and all below it."""
        yield from (node for node in self.iter() if isinstance(node, Node))


def refuse(node: Node, what: str, right: str, key: str = "model") -> NoReturn:
    """Refuse an element in one sentence that says its place."""
    raise RobotError((key,), f"{node.place}: {what}", right)


def read_xml(path: Path, kind: Kind = MODEL) -> Node:
    """The root of an XML file, without text between elements.

    Raises:
        UnexpandedError: something of xacro is left in it.
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


_OF_OTHERS = ("gazebo", "ros2_control", "transmission")
"""Groups of a URDF that other programs read, with places that those fill in."""

_WITHOUT_PREFIX = ("include", "macro", "property", "insert_block", "if", "unless")
"""Elements of a robot that xacro took for its own when it had no name space, and that no URDF has."""

_FILLED_IN = re.compile(r"\$\{[^}]*\}?|\$\((?:find|arg|eval|env|optenv|dirname|anon)\b[^)]*\)?")
"""Parts of a value that xacro computes or looks up (http://wiki.ros.org/xacro)."""


class _Builder:
    """Builds the tree while expat reads, and stops where a bound is passed."""

    def __init__(self, path: Path, kind: Kind, first: bool = False) -> None:
        self._path, self._kind, self._first = path, kind, first
        self._open: list[Node] = []
        self._count = 0
        self._prefixes = {"xacro"}
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
        self._require_expanded(tag, attributes)
        if self._open:
            self._open[-1].append(node)
        else:
            self.root = node
        self._open.append(node)

    def _require_expanded(self, tag: str, attributes: dict[str, str]) -> None:
        """Refuse an element of xacro, and an attribute that xacro would fill in.

        Raises:
            UnexpandedError: says which.
        """
        spaces = (name for name, value in attributes.items() if name.startswith("xmlns:") and "xacro" in value)
        self._prefixes |= {name.removeprefix("xmlns:") for name in spaces}
        prefixed = ":" in tag and tag.partition(":")[0] in self._prefixes
        left = tag if prefixed or (tag in _WITHOUT_PREFIX and [node.tag for node in self._open] == ["robot"]) else ""
        if not left and not any(node.tag in _OF_OTHERS for node in self._open) and tag not in _OF_OTHERS:
            found = (match for value in attributes.values() if (match := _FILLED_IN.search(value)))
            left = next((match[0][:40] for match in found), "")
        if left:
            what = f"{self._path}:{self.parser.CurrentLineNumber}: has xacro's '{left}' left in it"
            raise UnexpandedError(self._kind.key, what, f"expand it: xacro {quote(str(self._path))} > robot.urdf")

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
