"""Robots whose mass is elsewhere than believed, in both engines."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.belief import with_com_raised, with_mass_scaled
from surefoot.models.consistency import EnginePair
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotError, RobotOptions

pytestmark = pytest.mark.unit

ROBOT = describe("humanoid100", RobotOptions(payload_mass=5.0))


def standing(description):
    """CoM in both engines with the believed standing posture, and MuJoCo's model."""
    model = mujoco.MjModel.from_xml_string(description.mjcf)
    data = mujoco.MjData(model)
    data.qpos[7:] = ROBOT.nominal_joint_positions
    mujoco.mj_forward(model, data)
    q = np.concatenate((data.qpos[:3], [0.0, 0.0, 0.0, 1.0], ROBOT.nominal_joint_positions))
    other = pinocchio_model(description)
    return data.subtree_com[0].copy(), pin.centerOfMass(other, other.createData(), q), model


@pytest.mark.parametrize("height", [-0.2, -0.1, 0.1, 0.2])
def test_standing_com_moves_by_exactly_the_wanted_height(height):
    before, raised = standing(ROBOT), standing(with_com_raised(ROBOT, height))
    for engine in (0, 1):
        np.testing.assert_allclose(raised[engine] - before[engine], [0.0, 0.0, height], atol=1e-12)


def test_nothing_but_the_trunks_centres_of_mass_moves():
    _, _, before = standing(ROBOT)
    _, _, after = standing(with_com_raised(ROBOT, 0.2))
    for name in ("body_mass", "body_inertia", "body_pos", "geom_pos", "geom_size", "jnt_pos", "dof_armature"):
        np.testing.assert_array_equal(getattr(before, name), getattr(after, name), err_msg=name)
    moved = {before.body(k).name for k in np.flatnonzero((before.body_ipos != after.body_ipos).any(axis=1))}
    assert moved == {"pelvis", "waist_yaw_link", "waist_roll_link", "torso"}


def test_scaled_mass_is_in_both_engines_and_in_the_description():
    light = with_mass_scaled(ROBOT, 0.8)
    before, _, model = standing(ROBOT)
    after, believed, scaled = standing(light)
    assert light.mass == pytest.approx(84.0)
    np.testing.assert_allclose(scaled.body_mass, 0.8 * model.body_mass)
    np.testing.assert_allclose(scaled.body_inertia, 0.8 * model.body_inertia)
    np.testing.assert_allclose((after, believed), (before, before), atol=1e-12)


def test_engines_agree_about_the_changed_robots():
    rng = np.random.default_rng(5)
    for changed in (with_com_raised(ROBOT, -0.2), with_mass_scaled(ROBOT, 1.3)):
        pair = EnginePair(changed)
        assert max(pair.difference(*pair.random_state(rng)).largest for _ in range(5)) < 1e-9


@pytest.mark.parametrize(("change", "value"), [(with_com_raised, np.nan), (with_mass_scaled, 0.0)])
def test_impossible_changes_are_refused(change, value):
    with pytest.raises(RobotError, match="humanoid100 shall"):
        change(ROBOT, value)
