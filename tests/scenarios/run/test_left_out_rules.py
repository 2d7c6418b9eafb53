"""Rules of recovery that a scenario leaves out: a pushed walk falls without them, and its log falls when run again."""

import pytest

import surefoot
from surefoot.scenarios.log import read

pytestmark = pytest.mark.physics

PUSHED = {
    "humanoid100": {"impulse": 0.35, "direction": 1.571},
    "g1": {"impulse": 0.45, "direction": 1.571},
}


def walked(robot, out, *left_out):
    push = {"step": 3, "phase": "single", "fraction": 0.5, "duration": 0.1, **PUSHED[robot]}
    keys = {"robot": robot, "gait.steps": 6, "pushes": [push], "sensing.source": "truth", "criteria": {"fell": False}}
    return surefoot.run(surefoot.load("walk-level", {**keys, "planner.without": list(left_out)}), out=out)


@pytest.mark.parametrize("robot", PUSHED)
def test_without_steps_that_are_adjusted_a_pushed_walk_falls_and_so_it_does_again(robot, tmp_path):
    assert walked(robot, tmp_path / "all").verdict.passed
    fallen = walked(robot, tmp_path / "some", "adjusts", "goes_again")
    assert not fallen.verdict.passed
    again = surefoot.run(str(fallen.log), out=tmp_path / "again")
    one, other = read(fallen.log), read(again.log)
    for topic in ("/truth", "/plan"):
        assert one[topic].content() == other[topic].content()
