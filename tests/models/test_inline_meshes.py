"""One text with meshes in it, two engines: the same robot, and the same shapes at the same places."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.consistency import EnginePair
from surefoot.models.mjcf import without_looks
from surefoot.models.pinocchio import limb_shapes

pytestmark = pytest.mark.unit

SINGLE = 1e-7
"""MuJoCo keeps the vertices of meshes in single precision [m]."""


def test_engines_agree_on_a_robot_with_meshes(meshed) -> None:
    pair, rng = EnginePair(meshed.robot), np.random.default_rng(7)
    assert max(pair.difference(*pair.random_state(rng)).largest for _ in range(10)) < 1e-9
    assert pair.mj_model.nmesh == len(meshed.hulls) + sum(map(len, meshed.looks.values())) > 20


def test_pinocchio_has_the_corners_of_the_text(meshed) -> None:
    shapes = limb_shapes(meshed.robot)
    for name, corners in meshed.hulls.items():
        shape = shapes.geometryObjects[shapes.getGeometryId(name)]
        found = shape.geometry.points() @ shape.placement.rotation.T + shape.placement.translation
        np.testing.assert_allclose(sorted(found.tolist()), sorted(corners.tolist()), atol=1e-12)


def test_engines_agree_on_the_distances_of_hulls(meshed) -> None:
    pair, rng = EnginePair(meshed.robot), np.random.default_rng(3)
    shapes, data = limb_shapes(meshed.robot), mujoco.MjData(pair.mj_model)
    placed, seen = shapes.createData(), 0
    for _ in range(10):
        q, v = pair.random_state(rng)
        pair.difference(q, v)
        data.qpos[:] = np.concatenate((q[:3], q[[6, 3, 4, 5]], q[7:]))
        mujoco.mj_kinematics(pair.mj_model, data)
        pin.computeDistances(pair.pin_model, pair.pin_model.createData(), shapes, placed, q)
        for (one, other), result in zip(meshed.robot.kept_apart, placed.distanceResults, strict=True):
            if {one, other} <= set(meshed.hulls) and result.min_distance > 1e-3:
                ids = (pair.mj_model.geom(name).id for name in (one, other))
                expected = mujoco.mj_geomDistance(pair.mj_model, data, *ids, 10.0, None)
                assert result.min_distance == pytest.approx(expected, abs=3e-7)
                seen += 1
    assert seen > 10


def test_drawn_meshes_are_where_the_text_has_them(meshed) -> None:
    from surefoot.sim.shapes import drawn_shapes

    model = mujoco.MjModel.from_xml_string(meshed.robot.mjcf)
    found = {}
    for shape in drawn_shapes(model):
        if shape.mesh is not None:
            corners = (shape.mesh.vertices @ shape.rotation.T + shape.position)[shape.mesh.faces]
            found.setdefault(shape.body_name, []).append((corners, shape.color))
    assert found.keys() == meshed.looks.keys()
    for body, looks in meshed.looks.items():
        for (corners, color), (expected, material) in zip(found[body], looks, strict=True):
            np.testing.assert_allclose(corners, expected, atol=SINGLE)
            np.testing.assert_allclose(color, model.material(material).rgba, atol=1e-12)


def test_a_text_without_looks_is_the_same_robot(meshed) -> None:
    bare = mujoco.MjModel.from_xml_string(without_looks(meshed.robot.mjcf))
    whole = mujoco.MjModel.from_xml_string(meshed.robot.mjcf)
    assert bare.nmesh == len(meshed.hulls)
    assert bare.ngeom == whole.ngeom - sum(map(len, meshed.looks.values()))
    for name in ("body_mass", "body_inertia", "body_ipos", "jnt_range", "mat_rgba"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(whole, name))
    plain = without_looks(meshed.robot.mjcf)
    assert without_looks(plain) is plain
