"""Shapes that are only drawn never stop physics: a look that no engine makes is left out, and told."""

import biped
import mujoco
import numpy as np
import pytest
from test_meshes import ball

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.mjcf import without_looks
from surefoot.models.robot_file.engine_mesh import compiled, taken
from surefoot.models.robot_file.mesh_file import binary_stl

pytestmark = pytest.mark.unit

CAP = '<link name="cap"><visual><geometry><mesh filename="cap.stl"/></geometry></visual></link>'
CAP += '<joint name="cap" type="fixed"><parent link="base"/><child link="cap"/><origin xyz="0 0 0.2"/></joint>'
SQUARE = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]])
TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]])
CORNERS = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]


LOST = {
    "one triangle": (SQUARE[:3], [[0, 1, 2]]),
    "a line": (SQUARE[:3] * [1.0, 0.0, 0.0], [[0, 1, 2]]),
    "the same triangle twice": (SQUARE[:3], [[0, 1, 2], [0, 1, 2]]),
    "triangles in a line": (np.array([[0.1 * i, 0.0, 0.0] for i in range(6)]), [[0, 1, 2], [3, 4, 5], [1, 2, 5]]),
}
DRAWN = {
    "a square": (SQUARE, [[0, 1, 2], [0, 2, 3]]),
    "a tetrahedron": (TETRAHEDRON, CORNERS),
    "a tetrahedron inside out": (TETRAHEDRON, [row[::-1] for row in CORNERS]),
    "a sphere": ball(0.1, 30),
}


def capped(folder, vertices, faces):
    """A robot with a mesh on its base that is only drawn."""
    (folder / "cap.stl").write_bytes(binary_stl((np.asarray(vertices), np.asarray(faces))))
    return str(biped.write(folder, biped.Biped(extra=CAP)))


@pytest.mark.parametrize("case", [*LOST, *DRAWN])
def test_a_look_is_drawn_or_told_and_the_robot_is_the_same(tmp_path, case) -> None:
    found = explain(capped(tmp_path, *(LOST | DRAWN)[case]))
    mujoco.MjModel.from_xml_string(found.description.mjcf)
    told = [note for note in found.notes if "too few triangles" in note]
    assert bool(told) == (case in LOST), found.notes
    assert all("cap" in note for note in told)
    plain = describe(str(biped.write(tmp_path, biped.Biped())), RobotOptions())
    assert without_looks(found.description.mjcf) == without_looks(plain.mjcf)


def test_one_look_that_cannot_be_made_takes_no_other_with_it() -> None:
    parts = [ball(0.1, 8), (SQUARE[:3], np.array([[0, 1, 2]])), (TETRAHEDRON, np.array(CORNERS))]
    assert taken(parts, drawn=True) == [True, False, True]
    assert taken([(SQUARE, np.array([[0, 1, 2], [0, 2, 3]]))], drawn=False) == [False]
    assert taken([], drawn=True) == []


def test_what_the_engine_does_not_take_is_refused_in_a_sentence() -> None:
    flat = (
        '<mujoco><worldbody><body><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 9"/></body></worldbody>'
    )
    with pytest.raises(RobotError, match=r"MuJoCo does not take .*; leave that part out") as refusal:
        compiled(f"{flat}</mujoco>")
    assert "\n" not in str(refusal.value)


def test_a_picture_that_is_coarse_loses_parts_and_no_walk(tmp_path) -> None:
    """A small mesh beside a large one comes to a triangle or none, which may be all that is drawn of its link."""
    vertices, faces = ball(0.0005, 12)
    large = ball(2.0, 200)
    (tmp_path / "large.stl").write_bytes(binary_stl(large))
    more = CAP.replace("cap.stl", "large.stl").replace('"cap"', '"large"')
    (tmp_path / "cap.stl").write_bytes(binary_stl((vertices, faces)))
    found = explain(str(biped.write(tmp_path, biped.Biped(extra=CAP + more))))
    mujoco.MjModel.from_xml_string(found.description.mjcf)
    assert any("what is drawn of cap, which comes to too few triangles" in note for note in found.notes), found.notes
