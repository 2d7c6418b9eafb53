"""A criterion that no run could miss, or that compares what cannot be compared, is refused before the run."""

import pytest
import yaml

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.metrics import METRICS, OWN, register
from surefoot.scenarios.judge.verdict import missed
from surefoot.scenarios.setup.checks.criteria import criteria_problems
from surefoot.scenarios.setup.load import load, read_scenario

pytestmark = pytest.mark.unit

REFUSED = {
    "{foot_slip_max: foot_slip_max}": "criteria.foot_slip_max compares the metric with itself",
    "{steps_taken: {equals: steps_taken}}": "criteria.steps_taken compares the metric with itself",
    "{foot_slip_max: footstep_error_max}": "criteria.foot_slip_max cannot be compared with 'footstep_error_max'",
    "{steps_taken: steps_plannd}": "cannot be compared with 'steps_plannd'; did you mean 'steps_planned'?",
    "{steps_taken: duration}": "cannot be compared with 'duration'; valid are commands_limited, commands_missed",
    "{planner_time.p99: wbc_time.p99}": "cannot be compared with 'wbc_time.p99'; give a bound",
    "{fell: steps_taken}": "cannot be compared with 'steps_taken'; write 'fell: false' or 'fell: true'",
    "{fell: 'no'}": "criteria.fell cannot be compared with 'no'; write 'fell: false' or 'fell: true'",
    "{fell: {max: 1}}": "criteria.fell bounds what is true or false; write 'fell: false' or 'fell: true'",
    "{fell: 0}": "criteria.fell is true or false, never 0; write for example 'fell: false'",
    "{steps_taken: true}": "criteria.steps_taken is a number, never true; write for example 'steps_taken: {max: 1}'",
    "{zmp_error_rms: 0.1}": "criteria.zmp_error_rms has 2 elements, which equal no one value; give min and max",
    "{fell: }": "criteria.fell is null; give a group of keys",
    "{duration: {}}": "criteria.duration: a criterion without a bound; give min, max or equals",
    "{duration: {min: null}}": "criteria.duration: min is null; give its value, or leave it out",
    "{duration: {min: null, max: 3}}": "criteria.duration: min is null; give its value, or leave it out",
    "{duration: {min: []}}": "criteria.duration.min has 0 elements; give one number",
    "{zmp_error_rms: {max: []}}": "criteria.zmp_error_rms.max has 0 elements; give one number, or 2 of them",
    "{duration: {min: 2, max: 1}}": "criteria.duration: min 2.0 exceeds max 1.0; swap them",
    "{zmp_error_rms: {min: [0.1, 0.3], max: 0.2}}": "criteria.zmp_error_rms: min 0.3 exceeds max 0.2; swap them",
    "{cop_ratio_max: {min: 0}}": "criteria.cop_ratio_max checks nothing, since the metric is always at least 0; give a",
    "{zmp_inside_fraction: {max: 1}}": "checks nothing, since the metric is always at least 0 and at most 1",
    "{zmp_inside_fraction: {min: 0, max: 1}}": "criteria.zmp_inside_fraction checks nothing",
    "{zmp_error_rms: {min: [0, -1]}}": "criteria.zmp_error_rms checks nothing",
    "{wbc_time.p99: {min: -1}}": "criteria.wbc_time.p99 checks nothing",
    "{cop_ratio_max: {max: .nan}}": "criteria.cop_ratio_max.max is nan; give a finite number",
    "{cop_ratio_max: {max: .inf}}": "criteria.cop_ratio_max.max is inf; give a finite number",
    "{cop_ratio_max: {max: 1e400}}": "criteria.cop_ratio_max.max is inf; give a finite number",
    "{cop_ratio_max: {max: true}}": "criteria.cop_ratio_max.max is true; give a number",
    "{cop_ratio_max: .nan}": "criteria.cop_ratio_max",
}


@pytest.mark.parametrize("criteria", REFUSED)
def test_one_that_checks_nothing_is_refused_with_its_place(robots, criteria):
    with pytest.raises(ScenarioError) as caught:
        read_scenario(f"name: a\ncriteria: {criteria}", "f.yaml", "f", (), robots)
    (found,) = caught.value.problems
    assert found.startswith("f.yaml:2:")
    assert REFUSED[criteria] in found


@pytest.mark.parametrize(
    "criteria",
    [
        "{steps_taken: steps_planned}",
        "{steps_taken: 3, wbc_fallbacks: {equals: 0}}",
        "{zmp_error_rms: {min: 0, max: [0.1, 0.2]}}",
        "{stair_edge_margin_min: {min: 0}}",
        "{heading_change: {min: -0.02, max: 0.02}}",
        "{qp_failures: wbc_fallbacks}",
    ],
)
def test_one_that_a_run_can_miss_is_not(robots, criteria):
    asked = read_scenario(f"criteria: {criteria}", "f.yaml", "f", (), robots).criteria
    assert yaml.safe_load(criteria).keys() <= dict(asked).keys()


@pytest.mark.parametrize("name", catalogue.names())
def test_the_catalogue_checks_something(name):
    assert criteria_problems(load(name).criteria, "full") == []


def test_a_pendulum_is_not_passed_by_what_it_has_not_got(robots):
    text = "fidelity: pendulum\ncriteria: {%s foot_slip_max: {max: 0.01}, wbc_time.p99: {max: 1}}"
    with pytest.raises(ScenarioError, match=r"f.yaml:2:11: none of these criteria can be measured on a pendulum"):
        read_scenario(text % "", "f.yaml", "f", (), robots)
    assert read_scenario(text % "steps_taken: steps_planned,", "f.yaml", "f", (), robots)


def test_metrics_of_other_packages_likewise(robots):
    @metric(unit="m", least=0.0)
    def reach(run) -> float | None:
        """Reach of a hand [m]."""

    @metric()
    def touched(run) -> bool:
        """True if a wall was touched."""

    @metric()
    def unsaid(run):
        """A metric of a kind that its function does not say."""

    brought = (reach, touched, unsaid)
    for one in brought:
        register(one)
    try:
        for criteria in ("reach: {min: 0}", "reach: reach", "reach: foot_slip_max", "touched: {max: 0}", "touched: 1"):
            with pytest.raises(ScenarioError, match=r"^f:1:\d+: criteria\."):
                read_scenario(f"criteria: {{{criteria}}}", "f", "f", (), robots)
        read_scenario("criteria: {reach: {max: 1}, touched: false, unsaid: {min: 0}}", "f", "f", (), robots)
        read_scenario("criteria: {unsaid: true}", "f", "f", (), robots)
    finally:
        for one in brought:
            METRICS.discard(one.name)


def test_the_kind_of_every_metric_of_ours_is_said():
    assert {made.kind for made in OWN.values()} == {"bool", "int", "float", "list", "dict"}
    assert [name for name, made in OWN.items() if made.kind == "bool"] == ["fell"]


@pytest.mark.parametrize(
    ("bound", "value"),
    [
        ({"max": 1}, None),
        ({"equals": "b"}, None),
        ({"equals": "none"}, None),
        ({"equals": "none"}, 1.0),
        ({"max": 1}, True),
        ({"max": 1}, []),
        ({"max": 1}, [0.5, None]),
        ({"max": (1.0, 1.0)}, [0.5, 0.5, 7.0]),
        ({"equals": 1}, True),
        ({"equals": True}, 1),
        ({"equals": "unheard_of"}, 7),
    ],
)
def test_what_was_not_measured_never_meets_a_bound(bound, value):
    assert len(missed({"a": value, "b": 7, "none": None}, {"a": Bound.model_validate(bound)})) == 1
