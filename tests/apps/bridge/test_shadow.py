"""A controller in the shadow of a log: the same commands to the bit if nothing has changed, and only then."""

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge.shadow import walk_in_shadow
from surefoot.scenarios.errors import LogError

pytestmark = pytest.mark.physics

ROBOTS = {
    "humanoid100": {},
    "g1 by its sensors": {"robot": "g1", "sized_for": "humanoid100", "sensing.source": "ekf", "sensing.preset": "good"},
}


def shadow(log, out, **changes):
    scenario = surefoot.load(str(log), changes)
    result = walk_in_shadow(log, scenario, out)
    return result, surefoot.read(result.log)


@pytest.mark.parametrize("robot", [pytest.param("humanoid100", marks=pytest.mark.long), "g1 by its sensors"])
def test_a_shadow_commands_what_was_commanded_to_the_bit(tmp_path, robot):
    result = surefoot.run(surefoot.load("walk-level", {"gait.steps": 1, **ROBOTS[robot]}), out=tmp_path)
    same, log = shadow(result.log, tmp_path / "shadow")
    assert same.verdict["shadow_difference"] == {"rms": 0.0, "max": 0.0}
    assert np.array_equal(log["/torque"].field("command"), surefoot.read(result.log)["/torque"].field("command"))
    assert log.metadata["end"]["kind"] == "completed"
    assert result.verdict["shadow_difference"] is None


def test_a_change_is_seen_in_the_torques_and_moves_nothing(tmp_path):
    result = surefoot.run(surefoot.load("walk-level", {"gait.steps": 1}), out=tmp_path)
    other, log = shadow(result.log, tmp_path / "shadow", **{"robot_options.payload_mass": 5.0})
    found = other.verdict["shadow_difference"]
    assert found["max"] > found["rms"] > 0.1
    assert np.array_equal(log["/truth"].field("q"), surefoot.read(result.log)["/truth"].field("q"))


def test_what_is_no_log_of_the_robot_is_refused(tmp_path):
    truth = {"sensing.source": "truth"}
    result = surefoot.run(surefoot.load("walk-level", {**truth, "gait.steps": 0, "duration": 0.1}), out=tmp_path)
    other = surefoot.load("walk-level", {**truth, "robot": "g1", "sized_for": "humanoid100", "gait.steps": 1})
    with pytest.raises(LogError, match="a log of another robot than g1"):
        walk_in_shadow(result.log, other, tmp_path / "a")
    seeing = surefoot.load("walk-level", {"gait.steps": 1})
    with pytest.raises(LogError, match="has no channel /readings"):
        walk_in_shadow(result.log, seeing, tmp_path / "b")
    point = surefoot.run(surefoot.load("walk-level", {"fidelity": "pendulum", "gait.steps": 1}), out=tmp_path / "c")
    with pytest.raises(LogError, match="holds no walk in full physics"):
        walk_in_shadow(point.log, surefoot.load("walk-level"), tmp_path / "d")
