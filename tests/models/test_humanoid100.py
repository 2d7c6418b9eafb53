from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import RobotDescription, RobotOptions

pytestmark = pytest.mark.unit

HUMAN_FEET = RobotOptions(foot_length=0.22, foot_width=0.11)


def _standing(description: RobotDescription, joints: np.ndarray | None = None) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(description.mjcf)
    data = mujoco.MjData(model)
    if joints is not None:
        data.qpos[7:] = joints
    mujoco.mj_forward(model, data)
    return model, data


def test_baked_inertials_sum_to_100_kg() -> None:
    description = describe("humanoid100", RobotOptions())
    masses = [float(e.attrib["mass"]) for e in ElementTree.fromstring(description.mjcf).iter("inertial")]
    assert sum(masses) == pytest.approx(100.0, abs=1e-9)
    assert description.mass == pytest.approx(100.0, abs=1e-9)
    assert len(masses) == len(description.bodies)


@pytest.mark.parametrize("body", [None, "head", "left_foot"])
def test_payload_adds_its_mass_and_moves_no_body_com(body: str | None) -> None:
    plain, _ = _standing(describe("humanoid100", RobotOptions()))
    loaded, _ = _standing(describe("humanoid100", RobotOptions(payload_mass=7.5, payload_body=body)))
    added = loaded.body_mass - plain.body_mass
    assert added.sum() == pytest.approx(7.5, abs=1e-9)
    assert added[plain.body(body or "torso").id] == pytest.approx(7.5, abs=1e-9)
    np.testing.assert_array_equal(loaded.body_ipos, plain.body_ipos)


def test_inertias_are_physical() -> None:
    model, _ = _standing(describe("humanoid100", RobotOptions()))
    moments = model.body_inertia[1:]
    assert (moments > 0).all()
    assert (2 * moments.max(axis=1) <= moments.sum(axis=1) * (1 + 1e-12)).all()


def test_stands_on_z_zero_with_the_com_of_a_tall_person() -> None:
    description = describe("humanoid100", RobotOptions())
    _, data = _standing(description)
    for site in description.sole_sites:
        assert data.site(site).xpos[2] == pytest.approx(0.0, abs=1e-12)
    assert 1.035 < data.subtree_com[1][2] < 1.05
    assert data.body("left_thigh").xpos[2] == pytest.approx(description.leg_length)


@pytest.mark.parametrize("options", [RobotOptions(), HUMAN_FEET])
def test_nominal_crouch_is_at_the_nominal_com_height_over_level_soles(options: RobotOptions) -> None:
    description = describe("humanoid100", options)
    _, data = _standing(description, description.nominal_joint_positions)
    soles = np.array([data.site(site).xpos for site in description.sole_sites])
    np.testing.assert_allclose(data.subtree_com[1][2] - soles[:, 2], description.com_height, atol=0.002)
    for site in description.sole_sites:
        np.testing.assert_allclose(data.site(site).xmat.reshape(3, 3), np.eye(3), atol=1e-12)


def test_left_and_right_mirror() -> None:
    d = describe("humanoid100", RobotOptions())
    sign = np.array([1.0 if "pitch" in n or "knee" in n or "elbow" in n else -1.0 for n in d.joint_names])
    swap = [
        d.joint_names.index(n.replace("left", "x").replace("right", "left").replace("x", "right"))
        for n in d.joint_names
    ]
    mirrored_lower = np.where(sign > 0, d.position_lower[swap], -d.position_upper[swap])
    np.testing.assert_allclose(mirrored_lower, d.position_lower)
    np.testing.assert_allclose(sign * d.nominal_joint_positions[swap], d.nominal_joint_positions)
    np.testing.assert_allclose(d.torque_limit[swap], d.torque_limit)


def test_joint_order_limits_and_motors_are_those_of_the_text() -> None:
    d = describe("humanoid100", RobotOptions())
    model, _ = _standing(d)
    assert tuple(model.joint(i).name for i in range(1, model.njnt)) == d.joint_names
    assert tuple(model.actuator(i).name for i in range(model.nu)) == d.joint_names
    np.testing.assert_array_equal(model.jnt_range[1:], np.column_stack((d.position_lower, d.position_upper)))
    np.testing.assert_array_equal(model.actuator_forcerange[:, 1], d.torque_limit)
    assert not model.dof_damping.any()
    assert not model.dof_frictionloss.any()
    assert not model.jnt_stiffness.any()
    assert ((d.nominal_joint_positions >= d.position_lower) & (d.nominal_joint_positions <= d.position_upper)).all()


@pytest.mark.parametrize("options", [RobotOptions(), HUMAN_FEET])
def test_sole_site_is_the_centre_of_the_sole_bottom(options: RobotOptions) -> None:
    d = describe("humanoid100", options)
    model, data = _standing(d)
    for side, site in zip(("left", "right"), d.sole_sites, strict=True):
        box = model.geom(f"{side}_sole_box")
        np.testing.assert_allclose(2 * box.size[:2], (d.sole_length, d.sole_width))
        bottom = data.geom(f"{side}_sole_box").xpos - (0.0, 0.0, box.size[2])
        np.testing.assert_allclose(data.site(site).xpos, bottom, atol=1e-12)
        ahead = data.site(site).xpos - data.body(f"{side}_foot").xpos
        assert 0.0 <= ahead[0] <= 0.03


def test_only_soles_and_coarse_shapes_touch() -> None:
    model, _ = _standing(describe("humanoid100", RobotOptions()))
    drawn_only = model.geom_group == 1
    assert drawn_only.sum() > 40
    for mask in (model.geom_contype, model.geom_conaffinity):
        assert not mask[drawn_only].any()
        assert mask[~drawn_only].all()
