"""Criteria against metrics, and runs that did not come to their end."""

import json

import pytest

from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.verdict import judge, missed
from surefoot.scenarios.log import read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.loop.skeleton import End

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("name", "bound", "value", "reason"),
    [
        ("a", {"max": 0.6}, 0.71, "a is 0.71, bound is at most 0.6"),
        ("a", {"max": 0.6}, 0.6, None),
        ("a", {"min": 1}, 0.5, "a is 0.5, bound is at least 1"),
        ("a", {"min": 1, "max": 2}, 1.5, None),
        ("a", {"max": 0.003}, [0.001, 0.004], "a[1] is 0.004, bound is at most 0.003"),
        ("a", {"max": [0.003, 0.005]}, [0.001, 0.004], None),
        ("a", {"max": 1}, None, "a is not available, so its bound cannot be checked"),
        ("a", False, True, "a is true, must be false"),
        ("a", False, False, None),
        ("a", 5, 5, None),
        ("a", "b", 6, "a is 6, must be 7"),
        ("a.p99", {"max": 1e-3}, {"median": 1.0, "p99": 2e-3}, "a.p99 is 0.002, bound is at most 0.001"),
    ],
)
def test_reasons_are_readable(name, bound, value, reason):
    found = missed({"a": value, "b": 7}, {name: Bound.model_validate(bound)})
    assert found == ([reason] if reason else [])


def judged(tmp_path, robot, motion, **keys):
    scenario = Scenario.model_validate({"name": "two-steps", "gait": {"steps": 2}, **keys})
    return run_scenario(scenario, tmp_path, None, motion, robot).verdict


def test_a_run_that_meets_its_criteria_passes(tmp_path, robot, motion):
    verdict = judged(tmp_path, robot, motion())
    assert verdict.passed
    assert verdict.reasons == ()


def test_every_missed_criterion_is_a_reason(tmp_path, robot, motion):
    criteria = {"cop_ratio_p99": {"max": 0.3}, "fell": False, "torque_ratio_max": {"max": 0.5}}
    verdict = judged(tmp_path, robot, motion(), criteria=criteria)
    assert not verdict.passed
    assert verdict.reasons == ("cop_ratio_p99 is 0.4, bound is at most 0.3",)


def test_a_fall_fails(tmp_path, robot, motion):
    verdict = judged(tmp_path, robot, motion(fall_at=1.2, end=End("fall", 1.2, "the robot fell")))
    assert not verdict.passed
    assert "fell is true at 1.200 s, must be false" in verdict.reasons


def test_a_fall_that_is_asked_for_passes(tmp_path, robot, motion):
    falling = motion(fall_at=1.2, end=End("fall", 1.2, "the robot fell"))
    assert judged(tmp_path, robot, falling, criteria={"fell": True}).passed


def test_a_fault_is_the_first_reason(tmp_path, robot, motion):
    broken = motion(end=End("fault", 1.5, "NaN in the simulator's state"))
    verdict = judged(tmp_path, robot, broken)
    assert not verdict.passed
    assert verdict.reasons[0] == "the run ended at 1.500000 s: NaN in the simulator's state"


def test_a_truncated_log_is_no_pass(tmp_path, robot, motion):
    judged(tmp_path, robot, motion())
    path = tmp_path / "two-steps-0" / "log.mcap"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    verdict = judge(read(path))
    assert not verdict.passed
    assert "the run was cut off; its log ends at" in verdict.reasons[0]
    json.dumps(verdict.to_json(), allow_nan=False)
