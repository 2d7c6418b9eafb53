"""Noise and belief errors in full physics, with the paper's feet."""

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import RunConstants
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.physics

ALIVE = "criteria={fell: false}"
SURVIVED = "criteria={fell: false, steps_taken: steps_planned, wbc_fallbacks: {max: 0}}"


def walk(folder, *overrides):
    return run_scenario(load_scenario("diagonal-walk", (*overrides, SURVIVED)), folder)


def test_noise_with_a_push(tmp_path):
    push = "pushes=[{time: 2.2, duration: 0.01, force: [75, 75, 0]}]"
    verdict = walk(tmp_path, "sensing.zmp_noise=0.01", "sensing.com_noise=0.005", push).verdict
    assert verdict.reasons == ()
    assert max(verdict.metrics["dcm_estimation_error_rms"]) < 0.004


def test_a_com_higher_than_believed(tmp_path, from_sensors):
    # With time for the steps that are added.
    result = walk(tmp_path, "errors.com_height=-0.2", "gait.steps=3", "duration=15.0")
    assert result.verdict.reasons == ()
    log = read(result.log)
    gap = log["/truth"].field("com") - log["/estimate"].field("com")
    # The start posture stands upright to a milliradian; an estimate, by its joints' zeros, to three.
    np.testing.assert_allclose(gap[0], [0.0, 0.0, 0.2], atol=3e-3 if from_sensors else 1e-3)
    assert np.abs(gap[:, :2]).max() < 0.02


def test_a_robot_whose_bodies_weigh_something_else_and_that_carries_a_load_unknown_to_it(tmp_path):
    errors = ("errors.link_mass_noise=0.1", "errors.torso_com=[0.02, -0.01, 0.01]", "errors.payload={mass: 5}")
    result = walk(tmp_path, *errors, "gait.steps=2", "seed=2")
    assert result.verdict.reasons == ()
    log = read(result.log)
    mass = RunConstants.from_metadata(log.metadata, "log").mass
    assert 95.0 < mass < 115.0
    force = log["/contact"].field("normal_force").sum(axis=1)
    assert force[-200:].mean() == pytest.approx(9.81 * mass, rel=0.01)
    gap = log["/truth"].field("com") - log["/estimate"].field("com")
    assert 0.002 < np.abs(gap[0]).max() < 0.05  # the planner is given the CoM of the robot that is believed in


@pytest.mark.parametrize(("direction", "axis", "sign"), [("0", 0, 1.0), ("-90 deg", 1, -1.0)])
def test_a_push_has_the_impulse_per_kilogram_that_it_is_given(direction, axis, sign, tmp_path):
    push = f"pushes=[{{time: 0.5, duration: 0.1, impulse: 0.05, direction: {direction}}}]"
    result = run_scenario(load_scenario("stand", (push, "duration=0.8", "errors.mass_scale=0.8", ALIVE)), tmp_path)
    force = read(result.log)["/measurement"].field("external_force")
    impulse = force.sum(axis=0) / 500.0
    assert impulse[axis] == pytest.approx(sign * 0.05 * 100.0 / 0.8)
    assert np.abs(np.delete(impulse, axis)).max() < 1e-9


def test_a_robot_lighter_and_a_floor_more_slippery_than_believed(tmp_path):
    result = walk(tmp_path, "errors.mass_scale=1.1", "errors.friction=0.3", "terrain.friction=0.5", "gait.steps=1")
    assert result.verdict.reasons == ()
    force = read(result.log)["/contact"].field("normal_force").sum(axis=1)
    assert force[-200:].mean() == pytest.approx(9.81 * 100.0 / 1.1, rel=0.01)
