"""A URDF whose links are a tree and whose numbers are sound, before an engine sees it, and the part that one needs."""

from xml.etree import ElementTree

from surefoot.models.robot_file.document import Node, number, refuse
from surefoot.models.robot_file.quantities import HOLDS, REQUIRED, URDF, check_numbers, of_urdf
from surefoot.models.types import nearest

MOST_LINKS, MOST_SHAPES = 1_000, 2_000

_LEAST = 1e-6
"""Smallest part of an axis that counts, over the largest one [-]."""

_PARTS = ("inertial", "visual", "collision", "origin", "axis", "limit", "color")
"""Parts of links, joints and materials of which numbers are read; others are for other programs."""

_JOINTS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def check_urdf(root: Node) -> None:
    """Refuse what is no tree of links, or has numbers that no robot has.

    Raises:
        RobotError: says file, line and the link or joint at fault.
    """
    for part in root.nodes:
        if part.tag in ("link", "joint", "material"):
            for element in (node for node in part.nodes if node.tag in _PARTS):
                check_numbers(element, of_urdf, f" of {part.tag} '{part.get('name', '')}'")
                _require(part, element)
    links, joints = _named(root, "link"), _named(root, "joint")
    for tag, found, most in (("links", list(links.values()), MOST_LINKS), ("shapes", _shapes(root), MOST_SHAPES)):
        if len(found) > most:
            refuse(found[most], f"has {len(found)} {tag}", f"give a model of at most {most}")
    _check_tree(root, links, joints)


def _require(part: Node, within: Node) -> None:
    for element in within.elements():
        has = {*element.attrib, *(child.tag for child in element)}
        for name in (*REQUIRED.get(element.tag, ()), *HOLDS.get(element.tag, ())):
            if name not in has:
                what = f"{element.tag} of {part.tag} '{part.get('name', '')}' lacks {name}"
                refuse(element, what, f"give {name}")


def _named(root: Node, tag: str) -> dict[str, Node]:
    """Links or joints by name."""
    found: dict[str, Node] = {}
    for element in (node for node in root.nodes if node.tag == tag):
        name = element.get("name", "")
        if not name or name in found:
            what = f"the {tag} '{name}' is there twice" if name else f"a {tag} has no name"
            refuse(element, what, "give each one of its own")
        found[name] = element
    return found


def _shapes(root: Node) -> list[Node]:
    return [shape for shape in root.elements() if shape.tag in ("visual", "collision")]


def _check_tree(root: Node, links: dict[str, Node], joints: dict[str, Node]) -> None:
    """Refuse joints without links, links with two joints above, and loops.

    Raises:
        RobotError: the links are no tree.
    """
    above: dict[str, str] = {}
    for name, joint in joints.items():
        if joint.get("type") not in _JOINTS:
            refuse(joint, f"joint '{name}' has the type '{joint.get('type', '')}'", f"choose from {', '.join(_JOINTS)}")
        parent, child = (_end(joint, name, end, links) for end in ("parent", "child"))
        if child in above:
            refuse(joint, f"link '{child}' hangs on two joints, the second is '{name}'", "give it one")
        above[child] = parent
        axis = joint.find("axis")
        moves = joint.get("type") in ("revolute", "continuous", "prismatic")
        if (
            moves
            and axis is not None
            and not any(abs(number(token) or 0.0) > _LEAST for token in axis.get("xyz", "1").split())
        ):
            refuse(joint, f"axis of joint '{name}' has no direction", "give a vector that is not zero")
    roots = [name for name in links if name not in above]
    if len(roots) != 1:
        what = f"{len(roots)} links hang on no joint{': ' if roots else ''}{', '.join(roots[:5])}"
        refuse(root, what, "join all links to one tree")
    for name in links:
        _check_chain(links, above, name)


def _end(joint: Node, name: str, end: str, links: dict[str, Node]) -> str:
    element = joint.find(end)
    link = "" if element is None else element.get("link", "")
    if link not in links:
        refuse(joint, f"{end} of joint '{name}' is '{link}', which is no link", nearest(link, tuple(links)[:20]))
    return link


def _check_chain(links: dict[str, Node], above: dict[str, str], name: str) -> None:
    """Refuse a link from which the way up comes back to it."""
    at = name
    for _ in range(len(above) + 1):
        if (at := above.get(at, "")) in ("", name):
            break
    if at:
        refuse(links[name], f"link '{name}' hangs on itself", "join all links to one tree")


def kinematics(root: Node) -> str:
    """Links with their inertias and joints, all that an engine has to read."""
    robot = ElementTree.Element("robot", name="robot")
    for part in root.nodes:
        if part.tag in ("link", "joint"):
            _copy(robot, part, ("name", "type"))
    return ElementTree.tostring(robot, encoding="unicode")


_READ = ("inertial", "parent", "child", "origin", "axis", "limit", "mass", "inertia")


def _copy(into: ElementTree.Element, part: Node, names: tuple[str, ...]) -> None:
    """An element with those of its attributes and parts that are read."""
    copy = ElementTree.SubElement(into, part.tag, {name: part.get(name, "") for name in names if name in part.attrib})
    for tag in _READ:
        child = next((child for child in part.nodes if child.tag == tag), None)
        if child is not None:
            _copy(copy, child, ("link", *URDF.get(tag, {})))
