"""The judge's own control finds a judge whose bounds are wider than they say, and no fault with the true one."""

import pytest

from surefoot.scenarios.check.blunt import blunt
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.verdict import Verdict, missed

pytestmark = pytest.mark.unit

METRICS = {
    "fell": False,
    "steps_taken": 4,
    "steps_planned": 4,
    "foot_slip_max": 0.001,
    "self_contact_time": 0.0,
    "zmp_error_rms": [0.003, -0.002],
    "planner_time": {"p99": 0.01},
    "fall_time": None,
}
CRITERIA = {
    "fell": Bound(equals=False),
    "steps_taken": Bound(equals="steps_planned"),
    "foot_slip_max": Bound(min=0.0, max=0.0015),
    "self_contact_time": Bound(max=0.0),
    "zmp_error_rms": Bound(min=-1.0, max=(0.004, 0.004)),
    "planner_time.p99": Bound(max=0.02),
    "fall_time": Bound(min=0.1),
}


def of(criteria):
    return Verdict(True, (), (), METRICS, criteria)


def test_the_judge_misses_what_a_run_misses_by_a_percent():
    assert blunt(of(CRITERIA)) == []


@pytest.mark.parametrize("share", [0.011, 0.05])
@pytest.mark.parametrize("name", ["foot_slip_max", "zmp_error_rms", "planner_time.p99"])
def test_a_judge_whose_bounds_are_wider_is_named(share, name):
    def wider(values, criteria):
        def moved(limit, sign):
            return limit and (
                tuple(moved(one, sign) for one in limit)
                if isinstance(limit, tuple)
                else limit + sign * share * abs(limit)
            )

        if name in criteria:
            bound = criteria[name]
            criteria = {name: bound.model_copy(update={"min": moved(bound.min, -1), "max": moved(bound.max, 1)})}
        return missed(values, criteria)

    found = blunt(of(CRITERIA), wider)
    assert found
    assert all(f"the judge lets {name} pass with a bound that it misses by 1 %" == said for said in found)


@pytest.mark.parametrize("name", CRITERIA)
def test_a_judge_that_misses_nothing_is_named_by_every_criterion_that_has_a_value(name):
    assert bool(blunt(of({name: CRITERIA[name]}), lambda *_: [])) == (name != "fall_time")
