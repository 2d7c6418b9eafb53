"""An MJCF without the elements that a robot does without, and those elements by name; others are refused."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from surefoot.models.robot_file.document import Node, refuse
from surefoot.models.robot_file.mjcf_schema import Elements, Fate, by_path, path_of
from surefoot.models.types import nearest


@dataclass(frozen=True, slots=True)
class Absent:
    """An element of a document that the robot has not.

    Attributes:
        name: its tag, with its parts where it is a section.
        why: the reason.
    """

    name: str
    why: str


def sift(root: Node) -> tuple[Absent, ...]:
    """Leave away what a robot does without, in place, and say what that was.

    Raises:
        RobotError: an element or an attribute is refused, or unknown here.
    """
    return tuple(_sifted(root, "", False))


def absent_notes(absent: Iterable[Absent]) -> Iterator[str]:
    """A line for each reason, with all elements that go for it."""
    reasons: dict[str, dict[str, None]] = {}
    for one in absent:
        reasons.setdefault(one.why, {})[one.name] = None
    for why, names in reasons.items():
        yield f"left out: {', '.join(names)}: {why}"


def _sifted(node: Node, at: str, quiet: bool) -> Iterator[Absent]:
    """The absent elements below a node of a path.

    Default classes are quiet, since the elements that are of them tell it, and so is what is part of an absent element.
    """
    kept: list[Node] = []
    for child in node.nodes:
        path = path_of(at, child.tag)
        group, name = _checked(child, node, path), _name(child, path)
        absent = group.fate is Fate.LEFT_OUT
        below = list(_sifted(child, path, quiet or absent or child.tag == "default"))
        if absent and not quiet:
            yield Absent(name, group.why)
        if not _is_field(child) and (group.stays or not absent):
            kept.append(child)
            yield from below
    node[:] = kept
    if at == "asset/material":
        node.attrib.pop("texture", None)


def _is_field(node: Node) -> bool:
    return node.tag == "geom" and ("hfield" in node.attrib or node.get("type") == "hfield")


def _checked(node: Node, parent: Node, path: str) -> Elements:
    """The group of an element.

    Raises:
        RobotError: it is refused, or it or one of its attributes is unknown here.
    """
    group = by_path().get(path)
    if group is None:
        what = f"{parent.tag} has a {node.tag}, which is no element of an MJCF that is known here"
        refuse(node, what, "correct its name, or leave it out")
    if group.fate is Fate.REFUSED:
        refuse(node, f"{parent.tag} has a {node.tag}", group.why)
    unknown = sorted({*node.attrib} - group.known) if group.fate is Fate.KEPT else []
    if unknown:
        what = f"{node.tag} has the attribute '{unknown[0]}', which is none of it that is known here"
        close = nearest(unknown[0], tuple(sorted(group.known)))
        refuse(node, what, close if close.startswith("did") else "correct its name, or leave it out")
    return group


def _name(node: Node, path: str) -> str:
    """Tag of an element; of a section with the tags in it, or else its attributes, since none of it is read."""
    parts = dict.fromkeys(child.tag for child in node.iter() if child is not node) or node.attrib
    if path.startswith("tendon"):
        return f"{node.tag} tendon"
    return f"{node.tag} ({', '.join(parts)})" if "/" not in path and parts else node.tag
