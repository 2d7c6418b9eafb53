"""Noise and belief errors in full physics, with the paper's feet."""

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.physics

SURVIVED = "criteria={fell: false, steps_taken: steps_planned, wbc_fallbacks: {max: 0}}"


def walk(folder, *overrides):
    return run_scenario(load_scenario("diagonal-walk", (*overrides, SURVIVED)), folder)


def test_noise_with_a_push(tmp_path):
    push = "pushes=[{time: 2.2, duration: 0.01, force: [75, 75, 0]}]"
    verdict = walk(tmp_path, "sensing.zmp_noise=0.01", "sensing.com_noise=0.005", push).verdict
    assert verdict.reasons == ()
    assert max(verdict.metrics["dcm_estimation_error_rms"]) < 0.004


def test_a_com_higher_than_believed(tmp_path):
    result = walk(tmp_path, "errors.com_height=-0.2", "gait.steps=3")
    assert result.verdict.reasons == ()
    log = read(result.log)
    gap = log["/truth"].field("com") - log["/estimate"].field("com")
    np.testing.assert_allclose(gap[0], [0.0, 0.0, 0.2], atol=1e-3)  # the start posture stands upright to a milliradian
    assert np.abs(gap[:, :2]).max() < 0.02


def test_a_robot_lighter_and_a_floor_more_slippery_than_believed(tmp_path):
    result = walk(tmp_path, "errors.mass_scale=1.1", "errors.friction=0.3", "terrain.friction=0.5", "gait.steps=1")
    assert result.verdict.reasons == ()
    force = read(result.log)["/contact"].field("normal_force").sum(axis=1)
    assert force[-200:].mean() == pytest.approx(9.81 * 100.0 / 1.1, rel=0.01)
