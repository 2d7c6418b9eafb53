"""Robots whose mass is elsewhere than believed, in both engines."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.belief import (
    with_com_raised,
    with_joint_losses,
    with_load,
    with_mass_scaled,
    with_masses_scattered,
    with_torso_com_moved,
    with_torso_mass_scaled,
)
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


def scattered(seed, half_range=0.3):
    return with_masses_scattered(ROBOT, half_range, np.random.default_rng(seed))


def test_every_mass_has_an_error_of_its_own_and_its_inertia_the_same():
    before, (com, believed, after) = standing(ROBOT)[2], standing(scattered(1))
    masses, moments = after.body_mass[1:] / before.body_mass[1:], after.body_inertia[1:] / before.body_inertia[1:]
    assert len(set(masses)) == len(masses)
    assert np.abs(masses - 1.0).max() <= 0.3
    assert masses.min() < 0.9 and masses.max() > 1.1
    np.testing.assert_allclose(moments, np.repeat(masses[:, None], 3, axis=1))
    np.testing.assert_array_equal(after.body_ipos, before.body_ipos)
    assert scattered(1).mass == pytest.approx(after.body_mass.sum(), rel=1e-14)
    np.testing.assert_allclose(com, believed, atol=1e-12)


def test_masses_are_drawn_from_the_seed_and_grow_with_the_half_range():
    assert scattered(1).mjcf == scattered(1).mjcf != scattered(2).mjcf
    one, half = standing(scattered(1))[2].body_mass, standing(scattered(1, 0.15))[2].body_mass
    before = standing(ROBOT)[2].body_mass
    np.testing.assert_allclose(one - before, 2.0 * (half - before), atol=1e-12)
    np.testing.assert_array_equal(standing(scattered(1, 0.0))[2].body_mass, before)


def test_whole_com_moves_by_the_torsos_share_of_the_mass():
    offset = np.array([0.03, -0.02, 0.01])
    _, _, model = standing(ROBOT)
    before, after = standing(ROBOT), standing(with_torso_com_moved(ROBOT, offset))
    share = model.body("torso").mass[0] / ROBOT.mass  # 5 kg of it are its load
    for engine in (0, 1):  # waist and base are at zero, so that the torso has the axes of the world
        np.testing.assert_allclose(after[engine] - before[engine], share * offset, atol=1e-12)
    moved = {model.body(k).name for k in np.flatnonzero((after[2].body_ipos != model.body_ipos).any(axis=1))}
    assert moved == {"torso"}
    for name in ("body_mass", "body_inertia"):
        np.testing.assert_array_equal(getattr(after[2], name), getattr(model, name))


@pytest.mark.parametrize("body", [None, "left_shank"])
def test_a_load_is_the_payload_that_a_robot_may_be_built_with(body):
    """The same as the option, which is applied to the tree before there is a text."""
    built = describe("humanoid100", RobotOptions(payload_mass=5.0, payload_body=body))
    loaded = with_load(describe("humanoid100", RobotOptions()), 5.0, body)
    assert loaded.mass == built.mass
    for name in ("body_mass", "body_ipos", "body_inertia"):
        np.testing.assert_array_equal(getattr(standing(loaded)[2], name), getattr(standing(built)[2], name))


def test_engines_agree_about_the_changed_robots():
    rng = np.random.default_rng(5)
    changes = (
        *(with_com_raised(ROBOT, -0.2), with_mass_scaled(ROBOT, 1.3), scattered(3)),
        *(with_torso_com_moved(ROBOT, np.array([0.03, 0.02, -0.01])), with_load(ROBOT, 4.0, "left_shank")),
    )
    for changed in changes:
        pair = EnginePair(changed)
        assert max(pair.difference(*pair.random_state(rng)).largest for _ in range(5)) < 1e-9


@pytest.mark.parametrize(
    ("change", "values"),
    [
        (with_com_raised, (np.nan,)),
        (with_mass_scaled, (0.0,)),
        (with_masses_scattered, (1.0, np.random.default_rng(0))),
        (with_torso_com_moved, (np.array([0.0, np.inf, 0.0]),)),
        (with_load, (-1.0,)),
    ],
)
def test_impossible_changes_are_refused(change, values):
    with pytest.raises(RobotError, match="humanoid100 shall"):
        change(ROBOT, *values)


def test_a_load_on_no_body_is_refused_with_the_nearest_one():
    with pytest.raises(RobotError, match="'torzo' is no body of humanoid100; did you mean 'torso'"):
        with_load(ROBOT, 1.0, "torzo")


def test_a_heavier_torso_is_in_both_engines_and_nothing_else_is():
    _, _, before = standing(ROBOT)
    heavy = with_torso_mass_scaled(ROBOT, 1.5)
    com, believed, after = standing(heavy)
    np.testing.assert_allclose(com, believed, atol=1e-12)
    torso = before.body(ROBOT.torso_body).id
    assert after.body_mass[torso] == pytest.approx(1.5 * before.body_mass[torso])
    np.testing.assert_allclose(after.body_inertia[torso], 1.5 * before.body_inertia[torso])
    others = np.arange(before.nbody) != torso
    np.testing.assert_array_equal(after.body_mass[others], before.body_mass[others])
    assert heavy.mass == pytest.approx(after.body_mass.sum())


def test_losses_are_of_every_joint_and_change_no_dynamics_of_the_engines():
    lossy = with_joint_losses(ROBOT, 2.0, 0.5)
    model = mujoco.MjModel.from_xml_string(lossy.mjcf)
    np.testing.assert_array_equal(model.dof_damping[6:], 2.0)
    np.testing.assert_array_equal(model.dof_frictionloss[6:], 0.5)
    assert not model.dof_damping[:6].any()
    assert not model.dof_frictionloss[:6].any()
    one, other, q = (
        pinocchio_model(ROBOT),
        pinocchio_model(lossy),
        np.r_[np.zeros(6), 1.0, ROBOT.nominal_joint_positions],
    )
    np.testing.assert_array_equal(pin.crba(one, one.createData(), q), pin.crba(other, other.createData(), q))


@pytest.mark.parametrize(
    "make", [lambda: with_torso_mass_scaled(ROBOT, 0.0), lambda: with_joint_losses(ROBOT, -1.0, 0.0)]
)
def test_no_robot_has_such_torsos_or_joints(make):
    with pytest.raises(RobotError):
        make()
