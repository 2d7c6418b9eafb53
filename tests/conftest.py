"""A robot with meshes for the tests of every folder."""

import gc
import signal
from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import settings
from needs import BROWSER
from sensed_catalogue import from_sensors, pytest_addoption, pytest_configure
from skips import pytest_sessionfinish, pytest_terminal_summary

import surefoot.engines.windowless  # noqa: F401  before a test imports MuJoCo, which a wrong MUJOCO_GL in the shell would end
from surefoot.models import RobotDescription, RobotOptions, describe

__all__ = ["from_sensors", "pytest_addoption", "pytest_configure", "pytest_sessionfinish", "pytest_terminal_summary"]


settings.register_profile("untimed", deadline=None)  # a slow machine finds no fault
settings.load_profile("untimed")


def pytest_collection_finish() -> None:
    """Leave thousands of tests out of what is looked through for garbage again and again."""
    gc.freeze()


def _heeding() -> Iterator[None]:
    """Signals act, here and in processes that are started, also where the shell of the tests ignores them."""
    defaults = {
        signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL, signal.SIGHUP: signal.SIG_DFL
    }  # fmt: skip
    before = {number: signal.signal(number, handler) for number, handler in defaults.items()}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture(scope="session")
def with_a_browser() -> None:
    """Skips a test where no browser opens a page; it is tried once, when the first test asks."""
    BROWSER.or_skip()


heeding = pytest.fixture(_heeding, name="heeding")
heeding_throughout = pytest.fixture(_heeding, name="heeding_throughout", scope="module")


@dataclass(frozen=True)
class Meshed:
    """humanoid100 with inline meshes.

    Attributes:
        robot: its description.
        looks: what is drawn of each body in its frame: vertices of triangles, shape (n, 3, 3) [m], and material.
        hulls: corners of the contact shapes that are meshes, by name, in the frames of their bodies, shape (n, 3) [m].
    """

    robot: RobotDescription
    looks: dict[str, list[tuple[np.ndarray, str]]]
    hulls: dict[str, np.ndarray]


@pytest.fixture(scope="session")
def meshed() -> Meshed:
    """Ellipsoids become lopsided octahedra, the capsules of limbs that are kept apart become hulls of random points."""
    from surefoot.models.mjcf import numbers
    from surefoot.models.robot_file.meshes import hull

    robot = describe("humanoid100", RobotOptions())
    root = ElementTree.fromstring(robot.mjcf)
    rng, looks, hulls = np.random.default_rng(12), {}, {}

    def put(geom: ElementTree.Element, name: str, vertices: np.ndarray, faces: np.ndarray, **more: str) -> None:
        corners = {"vertex": numbers(vertices.ravel()), "face": " ".join(map(str, faces.ravel().tolist()))}
        ElementTree.SubElement(root.find("asset"), "mesh", corners, name=name, **more)
        for unused in ("size", "pos", "quat", "fromto"):
            geom.attrib.pop(unused, None)
        geom.attrib |= {"type": "mesh", "mesh": name}

    for body in root.iter("body"):
        for index, geom in enumerate(body.findall("geom")):
            name, kind = geom.get("name", f"{body.get('name')}_{index}"), geom.get("type")
            if kind == "ellipsoid":
                axes, centre = (np.fromstring(geom.get(key), sep=" ") for key in ("size", "pos"))
                vertices = (centre + axes * OCTAHEDRON * [[1.0], [0.6], [1.0], [0.9], [1.0], [0.8]]).round(4)
                put(geom, name, vertices, SIDES, inertia="shell")
                looks.setdefault(body.get("name"), []).append((vertices[SIDES], geom.get("material")))
            elif kind == "capsule" and name in {shape for pair in robot.kept_apart for shape in pair}:
                ends = np.fromstring(geom.get("fromto"), sep=" ").reshape(2, 3)
                share = rng.random((300, 1))
                points = share * ends[0] + (1.0 - share) * ends[1] + 0.02 * rng.normal(size=(300, 3))
                hulls[name], faces = hull(points, 40)
                put(geom, name, hulls[name], faces)
    return Meshed(replace(robot, mjcf=ElementTree.tostring(root, encoding="unicode")), looks, hulls)


OCTAHEDRON = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
SIDES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
