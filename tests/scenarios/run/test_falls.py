"""A fall is known before it comes, and the robot gives way: torques and joints keep to their limits on the way down."""

from dataclasses import replace

import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES

pytestmark = pytest.mark.physics

KEYS = {
    "gait.steps": 5, "gait.step_length": 0.36, "gait.single_support": 0.5, "gait.double_support": 0.12,
    "gait.com_height": 0.95, "gait.initial_stand": 0.4,
    "pushes": [{"step": 3, "phase": "single", "fraction": 0.5, "duration": 0.1, "impulse": 2.6, "direction": 0.3}],
}  # fmt: skip


SEEDS = range(3)


def fallen(out, seed, profile=PROFILES["default"]):
    return surefoot.run(surefoot.load("walk-level", {**KEYS, "seed": seed}), out=out, planner=profile).verdict.metrics


def test_who_is_pushed_over_gives_way(tmp_path):
    """Torques are spared, and joints go to their stops no faster or farther, in the mean over seeds of the sensors."""
    profile = PROFILES["default"]
    deaf = replace(profile.parameters.recovery, fall_margin=1e9)
    rigid = replace(profile, parameters=replace(profile.parameters, recovery=deaf))
    fast, far = [], []
    for seed in SEEDS:
        given, stiff = fallen(tmp_path / "given", seed), fallen(tmp_path / "stiff", seed, rigid)
        assert given["fell"]
        assert given["fall_warning"] > 0.2
        assert given["capture_margin_min"] < 0.0
        assert stiff["fell"]
        assert stiff["fall_warning"] is None
        assert given["torque_at_limit_fraction"] < 0.2 * stiff["torque_at_limit_fraction"]
        fast.append(given["joint_speed_ratio_max"] - stiff["joint_speed_ratio_max"])
        far.append(given["joint_limit_margin_min"] - 0.6 * stiff["joint_limit_margin_min"])
    assert sum(fast) / len(fast) < -0.1
    assert sum(far) / len(far) > 0.0
