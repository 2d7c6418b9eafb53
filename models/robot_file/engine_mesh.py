"""Meshes that MuJoCo takes in a robot's text: it refuses flat and too small ones, by an error for each kind."""

from collections.abc import Iterable, Sequence
from xml.etree import ElementTree

from surefoot.engines.windowless import mujoco
from surefoot.models.mjcf import numbers
from surefoot.models.robot_file.meshes import Triangles
from surefoot.models.types import RobotError


def add_mesh(asset: ElementTree.Element, name: str, part: Triangles, drawn: bool) -> None:
    """Write a mesh into the assets of a robot's text.

    Args:
        asset: of the text.
        name: of the mesh.
        part: its vertices and faces.
        drawn: whether it is only drawn, so that it needs no volume.
    """
    vertices, faces = part
    mesh = {"vertex": numbers(vertices.ravel()), "face": _integers(faces.ravel().tolist())}
    shell = {"inertia": "shell"} if drawn else {}
    ElementTree.SubElement(asset, "mesh", mesh, name=name, **shell)


def taken(parts: Sequence[Triangles], drawn: bool) -> list[bool]:
    """Mark each of some meshes that MuJoCo takes.

    Args:
        parts: as they stand in the text.
        drawn: whether they are only drawn.
    """
    if all(len(faces) for _, faces in parts) and _compiles(parts, drawn):
        return [True] * len(parts)
    return [len(part[1]) > 0 and _compiles([part], drawn) for part in parts]


def compiled(mjcf: str) -> mujoco.MjModel:
    """MuJoCo's model of a robot's text.

    Raises:
        RobotError: it takes none of it, which no robot file should come to.
    """
    try:
        return mujoco.MjModel.from_xml_string(mjcf)
    except ValueError as error:
        what = f"MuJoCo does not take the robot that is made of the model: {' '.join(str(error).split())}"
        raise RobotError(("model",), what, "leave that part out of the model, or mend it there") from None


def _compiles(parts: Sequence[Triangles], drawn: bool) -> bool:
    root = ElementTree.Element("mujoco")
    asset, world = (ElementTree.SubElement(root, tag) for tag in ("asset", "worldbody"))
    look = {"contype": "0", "conaffinity": "0"} if drawn else {}
    for number, part in enumerate(parts):
        add_mesh(asset, f"mesh{number}", part, drawn)
        ElementTree.SubElement(world, "geom", {"type": "mesh", "mesh": f"mesh{number}", **look})
    try:
        mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    except ValueError:
        return False
    return True


def _integers(values: Iterable[int]) -> str:
    return " ".join(map(str, values))
