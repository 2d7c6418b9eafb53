"""Surfaces of a replay: all that MuJoCo shows, in its colours."""

import mujoco
import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.show.replay.extract import surfaces

pytestmark = pytest.mark.unit


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Volume inside triangles that are counter-clockwise from outside, by the divergence theorem."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return float(np.sum(a * np.cross(b, c)) / 6)


def test_all_visible_geoms_of_the_robot_are_there() -> None:
    model = mujoco.MjModel.from_xml_string(describe("humanoid100", RobotOptions()).mjcf)
    found = surfaces(model)
    visible = model.geom_group <= 2
    assert {surface.body for surface in found} == set(model.geom_bodyid[visible].tolist())
    left = next(
        s for s in found if model.body(s.body).name == "left_foot" and s.color == pytest.approx((0.08, 0.08, 0.09))
    )
    sole = model.geom("left_sole_box")
    assert left.vertices.min(axis=0) == pytest.approx(sole.pos - sole.size)
    assert left.vertices.max(axis=0) == pytest.approx(sole.pos + sole.size)


def test_a_mesh_is_taken_as_it_is() -> None:
    text = """<mujoco><asset><mesh name="m" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/></asset>
    <worldbody><body><geom type="mesh" mesh="m" mass="1"/></body></worldbody></mujoco>"""
    (surface,) = surfaces(mujoco.MjModel.from_xml_string(text))
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    found = np.unique(surface.vertices.round(6) + 0.0, axis=0)
    assert found == pytest.approx(np.unique(corners, axis=0), abs=1e-6)
    assert volume(surface.vertices, surface.faces) == pytest.approx(1 / 6)


def test_a_robot_with_meshes_has_them_in_their_colours(meshed) -> None:
    model = mujoco.MjModel.from_xml_string(meshed.robot.mjcf)
    shown = surfaces(model)
    for body, looks in meshed.looks.items():
        for corners, material in looks:
            color = tuple(model.material(material).rgba[:3].tolist())
            (surface,) = (s for s in shown if model.body(s.body).name == body and s.color == color)
            found = surface.vertices[surface.faces].reshape(-1, 9)
            for triangle in corners.reshape(-1, 9):
                assert np.abs(found - triangle).max(axis=1).min() < 1e-6
