"""Health checks: quiet on a sound walk, and each finds its own fault."""

import numpy as np
import pytest

from surefoot.scenarios.judge.health import findings
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.judge.metrics import digest
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit


@pytest.fixture
def health(tmp_path, motion, two_steps, robot):
    """Findings by name after changes of the motion."""

    def check(changes=None, **how):
        path = run_scenario(two_steps, tmp_path, simulate=motion(changes=changes, **how), robot=robot).log
        return {finding.check: finding for finding in findings(digest(read(path)))}

    return check


def weight(time, force):
    return np.full(2, 100 * 9.81 / 2)


SOUND = {
    ("/contact", 1): weight,
    ("/truth", 3): lambda time, v: 0 * v,
    ("/truth", 5): lambda time, pose: pose * [0, 1, 1, 1, 1, 1, 1],
    ("/truth", 6): lambda time, pose: pose * [0, 1, 1, 1, 1, 1, 1],
}


def test_a_sound_walk_has_no_warning(health):
    found = health(SOUND)
    assert {name for name, finding in found.items() if finding.status != "ok"} == set()
    assert set(found) == {
        *("finite_values", "contact_forces", "foot_slip", "touchdowns", "zmp_margin", "torque_limits"),
        *("joint_stops", "joint_speeds"),
        *("estimator", "controller_solver", "planner_solver", "overruns"),
    }
    assert all(finding.cause == "" for finding in found.values())


FAULTS = {
    "contact_forces": ({("/contact", 1): lambda t, f: weight(t, f) * (0.8 if t > 2 else 1)}, -0.2, "too little"),
    "foot_slip": (
        {("/truth", 5): lambda t, p: np.array([0.02 * (t > 2.5), 0.1, 0, 0, 0, 0, 1])}, 0.02,
        "the left foot slips by up to 20 mm",
    ),
    "touchdowns": ({("/reference", 13): lambda t, d: 0.5 - 0.1 * (t >= 1)}, 0.1, "late, the worst by 100 ms"),
    "zmp_margin": ({("/contact", 0): lambda t, z: z + np.array([0.2 * (t > 3), 0, 0])}, 0.25, "the plan asks for it"),
    "torque_limits": ({("/torque", 0): lambda t, u: u + np.array([0, 0, 95.0 * (t == 2), 0])}, 1.0, "right_hip is at"),
    "joint_stops": (
        {("/measurement", 0): lambda t, q: q - np.array([0, 0, 0, 0.2 * (t == 2)])}, -0.1,
        "right_knee is past its stop by up to 5.7 deg",
    ),
    "joint_speeds": (
        {("/measurement", 1): lambda t, v: v + np.array([0, 12.0 * (t == 2), 0, 0])}, 1.25,
        "left_knee turns faster than its no-load speed at up to 125 %",
    ),
    "estimator": ({("/estimate", 0): lambda t, c: c + np.array([0.02 * t, 0, 0])}, 0.08, "the base drifts"),
    "controller_solver": ({("/wbc", 3): lambda t, f: float(t in (2, 3))}, 2.0, "no solution in 2 ticks"),
    "planner_solver": ({("/plan", 8): lambda t, f: float(t == 2)}, 1.0, "1 plans were held"),
    "overruns": ({("/timing", 6): lambda t, u: 3000.0, ("/timing", 3): lambda t, u: 2500.0}, 1.0, "part 'planner'"),
    "finite_values": ({("/estimate", 0): lambda t, c: c * (np.nan if t == 1 else 1)}, 1.0, "first in /estimate"),
}  # fmt: skip


BEGINS = {
    "contact_forces": 2.128,  # just over a quarter of half a second, at a fifth of the weight
    "foot_slip": 2.502,
    "touchdowns": 1.43,
    "zmp_margin": 3.002,
    "torque_limits": 2.0,
    "joint_stops": 2.0,
    "joint_speeds": 2.0,
    "estimator": 0.45,  # of a robot 0.9 as tall
    "controller_solver": 2.0,
    "planner_solver": 2.0,
    "overruns": None,
    "finite_values": 1.0,
}
"""Time of the first evidence of each fault [s]; no walk in simulation hangs on the time of a tick."""


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found_by_its_check_and_by_no_other(health, name):
    changes, value, words = FAULTS[name]
    found = health({**SOUND, **changes})
    warned = {check for check, finding in found.items() if finding.status == "warning"}
    assert warned == {name}
    assert found[name].value == pytest.approx(value, rel=0.02)
    assert words in found[name].cause
    begins = BEGINS[name]
    assert found[name].time == (None if begins is None else pytest.approx(begins, abs=0.0021))


def test_the_time_is_that_of_the_first_evidence_and_the_value_the_strongest(health):
    def past(time, q):
        return np.where([0, time == 1, 0, time == 2], [0, -0.61, 0, -0.7], q)  # the stop is at -0.6

    stops = health({**SOUND, ("/measurement", 0): past})["joint_stops"]
    assert stops.time == 1.0
    assert stops.value == pytest.approx(-0.1, rel=0.02)
    assert "left_knee is past its stop, right_knee by up to 5.7 deg" in stops.cause


def test_warnings_stand_in_the_order_of_their_first_evidence(health):
    joints = {("/torque", 0): lambda t, u: u + np.array([0, 0, 95.0 * (t == 3), 0])}
    late = FAULTS["controller_solver"][0] | FAULTS["overruns"][0]
    slips = {("/truth", 5): lambda t, p: np.array([0.006 * (t > 0.5) + 0.02 * (t > 3.5), 0.1, 0, 0, 0, 0, 1])}
    found = health({**SOUND, **late, **joints, **slips})
    assert list(found)[:4] == ["foot_slip", "controller_solver", "torque_limits", "overruns"]
    assert [finding.status for finding in found.values()] == ["warning"] * 4 + ["ok"] * (len(found) - 4)


def test_a_push_is_named_as_the_cause(health):
    changes = {("/contact", 0): FAULTS["zmp_margin"][0]["/contact", 0], ("/measurement", 7): lambda t, f: f + (t > 2.9)}
    assert "a push moves it" in health({**SOUND, **changes})["zmp_margin"].cause


def test_inspection_lists_the_file_first(tmp_path, motion, two_steps, robot):
    path = run_scenario(two_steps, tmp_path, simulate=motion(), robot=robot).log
    found = inspect(read(path)).to_json()["health"]
    assert found[0] == {"check": "file", "status": "ok", "time": None, "value": None, "relation": None, "cause": ""}
    path.write_bytes(path.read_bytes()[:-5000])
    found = inspect(read(path)).to_json()["health"]
    assert found[0]["status"] == "warning"
    assert "truncated" in found[0]["cause"]
