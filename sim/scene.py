"""The world as MJCF text: a robot's own text with ground, terrain, light and solver options around it."""

from xml.etree import ElementTree

from surefoot.models.types import RobotDescription
from surefoot.planner.ground.terrain import Terrain
from surefoot.sim.errors import WorldError
from surefoot.sim.terrain import add_terrain
from surefoot.similarity import GRAVITY, REFERENCE_SIZE, Similarity


def world_mjcf(
    description: RobotDescription, terrain: Terrain, timestep: float, size: Similarity = REFERENCE_SIZE
) -> str:
    """The whole world as one MJCF document, every number with all its digits.

    The text is composed and not written by MuJoCo, whose writer rounds to six digits.

    Args:
        description: the robot.
        terrain: the ground.
        timestep: physics step [s].
        size: of the robot, with which the ground's compliance goes.
    """
    ground = ElementTree.Element("worldbody")
    add_terrain(ground, terrain, size)
    return _around(
        description.name,
        description.mjcf,
        description.pelvis_body,
        ElementTree.tostring(ground, encoding="unicode"),
        timestep,
    )


def _around(name: str, robot: str, base: str, ground: str, timestep: float) -> str:
    """See `world_mjcf`."""
    root = ElementTree.fromstring(robot)
    _add_options(root, timestep)
    _add_look(root)
    worldbody = root.find("worldbody")
    asset = root.find("asset")
    if worldbody is None or asset is None:
        what = f"the MJCF of {name} lacks a worldbody or asset element"
        raise WorldError(("description", "mjcf"), what, "it must have both")
    _add_floor_materials(asset)
    worldbody.extend(ElementTree.fromstring(ground))
    _add_sun(worldbody, base)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _add_options(root: ElementTree.Element, timestep: float) -> None:
    """Solver options.

    Euler is exact for this use where joints have no damping, and takes damping implicitly where they have. The elliptic
    cone is Coulomb's. The dense constraint Jacobian and no islands are fastest at this size. An impratio of 20 keeps
    the creep of a standing sole under 0.01 mm/s. A bad state must be reported, not reset away.
    """
    option = ElementTree.SubElement(
        root,
        "option",
        timestep=repr(timestep),
        gravity=f"0 0 {-GRAVITY!r}",
        integrator="Euler",
        cone="elliptic",
        impratio="20",
        jacobian="dense",
        solver="Newton",
    )
    damped = any(float(joint.get("damping", "0")) > 0.0 for joint in root.iter("joint"))
    eulerdamp = "enable" if damped else "disable"
    ElementTree.SubElement(option, "flag", autoreset="disable", eulerdamp=eulerdamp, island="disable")


def _add_look(root: ElementTree.Element) -> None:
    visual = ElementTree.SubElement(root, "visual")
    headlight = {"ambient": "0.30 0.30 0.32", "diffuse": "0.36 0.36 0.36", "specular": "0.2 0.2 0.2"}
    ElementTree.SubElement(visual, "headlight", headlight)
    ElementTree.SubElement(visual, "global", offwidth="1920", offheight="1080")
    ElementTree.SubElement(visual, "quality", shadowsize="4096")
    ElementTree.SubElement(visual, "map", znear="0.02", zfar="40", haze="0.4", shadowclip="8")
    ElementTree.SubElement(visual, "rgba", haze="0.75 0.82 0.90 1")
    ElementTree.SubElement(root, "statistic", extent="2", center="0 0 1")


def _add_sun(worldbody: ElementTree.Element, base: str) -> None:
    """A sun that travels with the robot, since shadows are drawn only around the place of their light."""
    body = next(element for element in worldbody.iter("body") if element.get("name") == base)
    sun = {"pos": "1.2 -1.6 3.2", "dir": "-0.3 0.4 -0.8", "diffuse": "0.75 0.74 0.70", "castshadow": "true"}
    ElementTree.SubElement(body, "light", sun, name="sun", type="directional", mode="track")


def _add_floor_materials(asset: ElementTree.Element) -> None:
    sky = {"type": "skybox", "builtin": "gradient", "rgb1": "0.75 0.82 0.90", "rgb2": "0.25 0.40 0.60"}
    ElementTree.SubElement(asset, "texture", sky, name="sky", width="256", height="1536")
    checker = {"type": "2d", "builtin": "checker", "rgb1": "0.62 0.66 0.70", "rgb2": "0.55 0.59 0.63"}
    ElementTree.SubElement(asset, "texture", checker, name="floor", width="256", height="256")
    ElementTree.SubElement(
        asset, "material", name="floor", texture="floor", texrepeat="1 1", texuniform="true", reflectance="0.05"
    )
    ElementTree.SubElement(asset, "material", name="step", rgba="0.70 0.62 0.52 1")
