"""In full physics a similar robot of another size walks with the same share of its torques."""

from dataclasses import replace

import pytest

from surefoot import Parts, run
from surefoot.models.humanoid100 import HUMANOID100
from surefoot.models.registry import ROBOTS
from surefoot.models.similar import scaled
from surefoot.models.types import Robot, RobotOptions
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load
from surefoot.wbc import WholeBodyController
from surefoot.wbc.parameters import WbcParameters

pytestmark = pytest.mark.physics

SHORT = ("gait.steps=2", "criteria={fell: false, steps_taken: steps_planned, wbc_fallbacks: {max: 0}}")
SIMILAR = ("torque_ratio_max", "joint_speed_ratio_max", "zmp_inside_fraction")
"""Metrics without a unit, which are the same at every size."""


def _quarter(options):
    own = RobotOptions(options.foot_length or 0.22, options.foot_width or 0.11)
    return replace(scaled(HUMANOID100.build(own), 0.25), name="quarter")


@pytest.fixture(autouse=True)
def quarter():
    ROBOTS.add("quarter", Robot("quarter", _quarter))
    yield
    ROBOTS.discard("quarter")


def walked(tmp_path, robot, *keys):
    return run_scenario(load("walk-level", (*SHORT, f"robot={robot}", *keys)), tmp_path).verdict


def test_a_quarter_of_the_size_takes_the_same_share_of_torques_and_speeds(tmp_path):
    full, small = (walked(tmp_path / robot, robot) for robot in ("humanoid100", "quarter"))
    assert full.passed and small.passed, (full.reasons, small.reasons)
    for name in SIMILAR:
        assert small.metrics[name] == pytest.approx(full.metrics[name], rel=0.1), name
    assert small.metrics["swing_clearance_min"] == pytest.approx(0.25 * full.metrics["swing_clearance_min"], rel=0.1)
    assert small.metrics["speed_mean"] == pytest.approx(0.5 * full.metrics["speed_mean"], rel=0.02)


def test_with_the_gains_of_full_size_its_zmp_leaves_the_soles(tmp_path):
    """On the true state, so that no error of an estimate counts."""

    def unscaled(parameters, **rest):
        return WholeBodyController(parameters=WbcParameters(), **rest)

    scenario = load("walk-level", (*SHORT, "gait.steps=6", "robot=quarter", "sensing.source=truth"))
    scaled = run(scenario, out=tmp_path / "scaled").verdict
    assert scaled.passed
    full = run(scenario, out=tmp_path, parts=Parts(controller=unscaled)).verdict
    assert full.metrics["zmp_inside_fraction"] < 0.95 < 0.98 < scaled.metrics["zmp_inside_fraction"]
