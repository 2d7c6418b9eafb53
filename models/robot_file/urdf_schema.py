"""The elements of URDF and the fate of each: used, left out with a word, or refused.

Unlike MJCF, URDF is open: an element that is not here is of some other program, and is left out with a word.
"""

from collections.abc import Iterator

from surefoot.models.robot_file.document import Node, number, refuse
from surefoot.models.robot_file.mjcf_schema import FOLLOWING, STILL, TOUCH, Elements, Fate
from surefoot.models.robot_file.sift import Absent

_OTHERS = "other programs read it"
_LOOP = "give a serial model without it, whose joints have the limits that the linkage leaves them"

URDF_ELEMENTS = (
    Elements(Fate.KEPT, "", "link", attributes="name type"),
    Elements(Fate.KEPT, "link", "inertial visual collision"),
    Elements(Fate.LEFT_OUT, "link", "contact", TOUCH),
    Elements(Fate.LEFT_OUT, "link", "self_collision_checking verbose", _OTHERS),
    Elements(Fate.KEPT, "", "joint", attributes="name type"),
    Elements(Fate.KEPT, "joint", "parent child origin axis"),
    Elements(Fate.KEPT, "joint", "limit", attributes="lower upper effort velocity"),
    Elements(Fate.COUPLING, "joint", "mimic", FOLLOWING),
    Elements(
        Fate.LEFT_OUT,
        "joint",
        "dynamics",
        "a scenario's motors.damping and motors.friction_loss have them; joints have no springs",
    ),
    Elements(Fate.LEFT_OUT, "joint", "safety_controller", "the controller keeps to the limits of the joint"),
    Elements(Fate.LEFT_OUT, "joint", "calibration", STILL),
    Elements(Fate.KEPT, "", "material"),
    Elements(Fate.KEPT, "material", "color"),
    Elements(Fate.LEFT_OUT, "material", "texture", STILL),
    Elements(Fate.LEFT_OUT, "", "transmission", "each joint has one motor, within the joint's own limits"),
    Elements(Fate.LEFT_OUT, "", "gazebo ros2_control mujoco sensor", _OTHERS),
    Elements(Fate.REFUSED, "gazebo", "joint", _LOOP),
    Elements(Fate.REFUSED, "", "loop_joint drake:linear_bushing_rpy drake:ball_constraint tendon", _LOOP),
)
"""Elements in links, joints and materials; parts of inertials and shapes are read as the specification has them."""

_BY_PATH = {path: group for group in URDF_ELEMENTS for path in group.paths}
_WITHIN = ("link", "joint", "material", "gazebo")
"""Elements whose parts have a fate of their own."""


def absent_of(root: Node) -> Iterator[Absent]:
    """Elements of a URDF that the robot has not.

    Raises:
        RobotError: one is refused.
    """
    for part in root.nodes:
        yield from _absent(part, part.tag)
        for inner in part.nodes if part.tag in _WITHIN else ():
            yield from _absent(inner, f"{part.tag}/{inner.tag}")


def _absent(node: Node, path: str) -> Iterator[Absent]:
    group = _BY_PATH.get(path)
    if group is None:
        if path.partition("/")[0] == "gazebo" or _says_nothing(node):
            return
        yield Absent(_called(path), _OTHERS)
    elif group.fate is Fate.REFUSED:
        name = f" '{node.get('name')}'" if node.get("name") else ""
        refuse(node, f"{_called(path)}{name} closes a loop or couples joints", group.why)
    elif group.fate is Fate.LEFT_OUT and not _says_nothing(node):
        yield Absent(_called(path) + _shared(node), group.why)
    elif group.attributes:
        for name in node.attrib:
            if name not in group.known:
                yield Absent(f"{name} of {_called(path)}", _OTHERS)


def _called(path: str) -> str:
    """An element by its name and the one around it."""
    around, _, tag = path.rpartition("/")
    return f"{tag} of {around}" if around else tag


def _shared(node: Node) -> str:
    """Joints of a transmission that couples several."""
    joints = [child.get("name", "") for child in node.nodes if child.tag == "joint"]
    return f" between {' and '.join(joints)}" if node.tag == "transmission" and len(joints) > 1 else ""


def _says_nothing(node: Node) -> bool:
    """Return true if an element has numbers alone, and all are zero."""
    values = [number(token) for text in node.attrib.values() for token in text.split()]
    return bool(values) and not len(node) and all(value == 0.0 for value in values)
