"""Meshes over formats, units and scales: what is understood is used, all else is refused or told by its link."""

import re

import biped
import mjcf_biped as mjcf
import numpy as np
import pytest
from mesh_files import AT, SIZE, Mesh, meshes

from surefoot.models import RobotError, explain
from surefoot.models.consistency import EnginePair

MESHES = meshes()
QUICK = (
    "dae in inch, Y_UP",
    "stl scaled from mm",
    "text_stl in millimetres",
    "obj of a thousandth",
    "stl of one triangle",
    "pointer as dae",
    "stl with nan",
)
"""One fault of each kind, for every change."""

EVERY = [pytest.param(name, marks=pytest.mark.unit if name in QUICK else pytest.mark.long) for name in MESHES]
THIGH = '<geometry><box size="0.06 0.06 0.2"/></geometry>'
PLACED = f'<origin xyz="0 0 -0.15"/>{THIGH}'


def urdf(folder, mesh: Mesh, *kinds: str) -> str:
    """A biped whose left thigh is drawn or touches by a mesh."""
    (folder / f"thigh.{mesh.ending}").write_bytes(mesh.data)
    geometry = f'<geometry><mesh filename="thigh.{mesh.ending}" scale="{mesh.scale}"/></geometry>'
    text = biped.Biped().urdf()
    for kind in kinds:
        box = f"<{kind}>{PLACED}</{kind}>"
        assert box in text
        text = text.replace(box, f"<{kind}>{geometry}</{kind}>", 1)
    return str(biped.write(folder, text))


def hull_of(robot, body: str) -> np.ndarray:
    """Corners of a body's contact shape in its frame, shape (n, 3) [m]."""
    found = re.search(rf'<mesh vertex="([^"]*)"[^>]*name="{body}_shape"', robot.mjcf)
    return np.fromstring(found[1], sep=" ").reshape(-1, 3)


def is_the_body(points: np.ndarray) -> bool:
    """Return true if points span the body where it is, within a twentieth: it is a polyhedron."""
    low, high = points.min(axis=0), points.max(axis=0)
    return bool((np.abs(high - low - SIZE) < 0.05 * SIZE).all() and (np.abs((low + high) / 2 - AT) < 0.003).all())


@pytest.mark.parametrize("name", EVERY)
def test_a_mesh_that_touches_is_used_as_it_is_or_refused(tmp_path, name, capfd, recwarn) -> None:
    mesh = MESHES[name]
    file = urdf(tmp_path, mesh, "visual", "collision")
    if mesh.sound:
        found = explain(file)
        assert is_the_body(hull_of(found.description, "left_thigh"))
        assert EnginePair(found.description)
    else:
        try:
            found = explain(file)
        except RobotError as error:
            assert re.search(mesh.said, str(error)), error
            assert "\n" not in str(error)
        else:  # what has no volume can be read, and touches nothing: that is told
            told = [line for line in found.notes if line.startswith("left out: contact of") and "left_thigh" in line]
            assert told
            assert told[0] in found.description.left_out
    assert capfd.readouterr() == ("", "")
    assert not recwarn.list


@pytest.mark.parametrize("name", EVERY)
def test_a_mesh_that_is_only_drawn_stops_nothing(tmp_path, name, capfd, recwarn) -> None:
    """The robot is the same in physics; what is not drawn is told."""
    mesh = MESHES[name]
    found, plain = explain(urdf(tmp_path, mesh, "visual")), explain(str(biped.write(tmp_path, None)))
    assert is_the_body(hull_of(found.description, "left_thigh"))
    assert found.description.mass == plain.description.mass
    assert EnginePair(found.description)
    if not mesh.sound:
        looks = re.search(r'name="left_thigh_look', found.description.mjcf)
        told = [line for line in found.description.left_out if re.search("left_thigh", line)]
        assert looks or told, "neither drawn nor told"
    assert capfd.readouterr() == ("", "")
    assert not recwarn.list


def mjcf_text(mesh: Mesh, more: str) -> str:
    asset = f'<asset><mesh name="thigh" file="thigh.{mesh.ending}" scale="{mesh.scale}"/></asset><worldbody>'
    thigh = '<geom type="capsule" fromto="0 0 -0.05 0 0 -0.25" size="0.04" density="900"/>'
    geom = f'<geom type="mesh" mesh="thigh" {more}/>'
    return mjcf.TEXT.replace("<worldbody>", asset, 1).replace(thigh, f"{thigh}{geom}", 1)


OF_MJCF = [
    pytest.param(name, marks=pytest.mark.unit if name in QUICK else pytest.mark.long)
    for name, mesh in MESHES.items()
    if mesh.ending in ("stl", "obj")
]


OF_POINTS = ("obj of points",)
"""Sources of which MuJoCo takes the convex hull."""


@pytest.mark.parametrize("drawn", [True, False], ids=["drawn", "touching"])
@pytest.mark.parametrize("name", OF_MJCF)
def test_a_mesh_of_an_mjcf_is_used_refused_or_told(tmp_path, name, drawn, capfd, recwarn) -> None:
    """A mesh that touches and is not understood is refused, one that is drawn is left out."""
    mesh = MESHES[name]
    (tmp_path / f"thigh.{mesh.ending}").write_bytes(mesh.data)
    inertial = '<inertial pos="0 0 -0.15" mass="1" diaginertia="0.01 0.01 0.002"/><geom type="capsule"'
    text = mjcf_text(mesh, 'contype="0" conaffinity="0"' if drawn else "")
    text = text.replace('<geom type="capsule"', inertial, 1)
    file = biped.FILE.replace("biped.urdf", "biped.xml") + mjcf.LIMITS
    try:
        found = explain(str(biped.write(tmp_path, text, file, "biped.xml")))
    except RobotError as error:
        assert not mesh.sound
        assert not drawn or "scale" in str(error), error
        assert re.search(r"left_thigh|thigh\.|scale of mesh", str(error)), error
        assert "\n" not in str(error)
        assert "ASCII" not in str(error)
    else:
        assert EnginePair(found.description)
        if not mesh.sound and name not in OF_POINTS:
            told = found.description.left_out if drawn else found.notes
            assert [line for line in told if "left_thigh" in line]
    assert capfd.readouterr() == ("", "")
    assert not recwarn.list


@pytest.mark.unit
def test_there_are_sixty_and_more() -> None:
    assert len(MESHES) >= 60
    assert {mesh.ending for mesh in MESHES.values()} >= {"stl", "obj", "dae"}
