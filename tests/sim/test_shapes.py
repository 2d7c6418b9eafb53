"""Drawn shapes: where MuJoCo has its geoms, in their colours, and nothing that is not shown."""

import mujoco
import numpy as np
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.sim import World
from surefoot.sim.shapes import HIDDEN_GROUP, drawn_shapes

pytestmark = pytest.mark.unit

ALL_KINDS = """<mujoco>
  <asset>
    <material name="red" rgba="1 0 0 0.5"/>
    <mesh name="corner" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <geom type="box" size="0.1 0.2 0.3" rgba="0 1 0 1"/>
    <body name="part" pos="1 2 3" euler="10 20 30">
      <geom type="sphere" size="0.1" mass="1" material="red" rgba="0 1 0 1"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3" pos="0 0 1" euler="0 90 0"/>
      <geom type="cylinder" size="0.1 0.3"/>
      <geom type="capsule" size="0.1" fromto="0 0 0  0.4 0 0"/>
      <geom type="mesh" mesh="corner"/>
      <geom type="sphere" size="0.7" group="3"/>
    </body>
  </worldbody>
</mujoco>"""


def model_of(text):
    return mujoco.MjModel.from_xml_string(text)


def test_kinds_sizes_colours_and_bodies() -> None:
    shapes = list(drawn_shapes(model_of(ALL_KINDS)))
    assert [shape.kind for shape in shapes] == ["box", "ellipsoid", "ellipsoid", "cylinder", "capsule", "mesh"]
    assert [(shape.body, shape.body_name) for shape in shapes] == [(0, "world"), *5 * [(1, "part")]]
    expected = ([0.1, 0.2, 0.3], [0.1] * 3, [0.1, 0.2, 0.3], [0.1, 0.1, 0.3], [0.1, 0.1, 0.2])
    np.testing.assert_allclose([shape.half_size for shape in shapes[:-1]], expected)
    assert [shape.color for shape in shapes[:3]] == [(0, 1, 0, 1), (1, 0, 0, 0.5), (0.5, 0.5, 0.5, 1)]


def test_a_capsule_ends_where_its_description_says() -> None:
    (capsule,) = (shape for shape in drawn_shapes(model_of(ALL_KINDS)) if shape.kind == "capsule")
    ends = sorted(end.tolist() for end in capsule.ends)
    np.testing.assert_allclose(ends, [[0.0, 0.0, 0.0], [0.4, 0.0, 0.0]], atol=1e-12)


def test_a_mesh_has_its_corners_in_the_frame_of_its_body() -> None:
    *others, shape = drawn_shapes(model_of(ALL_KINDS))
    corners = shape.mesh.vertices @ shape.rotation.T + shape.position
    np.testing.assert_allclose(sorted(corners.round(6).tolist()), [[0, 0, 0], [0, 0, 1], [0, 1, 0], [1, 0, 0]])
    assert not any(other.mesh for other in others)


def test_shapes_of_a_world_stand_where_the_engine_has_its_geoms() -> None:
    terrain = Terrain((Box(np.array([0.5, 0.2, 0.05]), np.array([0.3, 0.2, 0.05]), np.eye(3)),))
    model = model_of(World(describe("humanoid100", RobotOptions()), terrain, 1000).mjcf())
    data = mujoco.MjData(model)
    data.qpos[7:] = np.random.default_rng(3).normal(size=25)
    mujoco.mj_forward(model, data)
    shapes = list(drawn_shapes(model))
    shown = [geom for geom in range(1, model.ngeom) if model.geom_group[geom] < HIDDEN_GROUP]  # 0 is the ground
    assert len(shapes) == len(shown) > 50
    for shape, geom in zip(shapes, shown, strict=True):
        body = data.body(shape.body)
        assert body.name == shape.body_name
        R = body.xmat.reshape(3, 3)
        np.testing.assert_allclose(R @ shape.position + body.xpos, data.geom_xpos[geom], atol=1e-12)
        np.testing.assert_allclose(R @ shape.rotation, data.geom_xmat[geom].reshape(3, 3), atol=1e-12)
