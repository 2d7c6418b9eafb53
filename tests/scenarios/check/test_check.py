"""A run against its baseline: the same is the same, what moved is named with its direction."""

from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
import yaml

from surefoot.scenarios.check import check as checking
from surefoot.scenarios.check import report
from surefoot.scenarios.check.baseline import Baseline, read_baseline, tolerance, write_baseline
from surefoot.scenarios.check.check import cases, run_case, update
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import known

pytestmark = pytest.mark.unit

WALK = """
name: stroll
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.5, double_support: 0.1}
criteria: {fell: false, zmp_error_rms: {max: 0.05}, speed_mean: {min: 0.01}}
"""


@pytest.fixture
def case(tmp_path):
    (tmp_path / "stroll.yaml").write_text(WALK)
    (found,) = cases([str(tmp_path / "stroll.yaml")])
    return found


@pytest.fixture
def kept(case, tmp_path):
    """The case with its baseline written, and what was written."""
    first = run_case(case, tmp_path / "first")
    assert first.status == "without baseline"
    assert update([first]) == (case.baseline,)
    return case, read_baseline(case.baseline)


def changed(case, baseline, **metrics):
    """Write a baseline with other metrics."""
    write_baseline(case.baseline, replace(baseline, metrics={**baseline.metrics, **metrics}))


def test_a_baseline_lies_beside_the_file_and_the_same_run_is_the_same(kept, tmp_path):
    case, baseline = kept
    assert case.baseline == tmp_path / "baselines" / "stroll.baseline.yaml"
    assert "real_time_factor" not in baseline.metrics
    assert baseline.metrics["zmp_error_rms"][0] > 0.0
    again = run_case(case, tmp_path / "again")
    assert (again.status, again.moves, again.parting) == ("same", (), None)
    assert update([again]) == ()


@pytest.mark.parametrize(
    ("name", "factor", "direction", "status"),
    [
        ("speed_mean", 1.5, "worse", "moved"),
        ("speed_mean", 0.5, "better", "better"),
        ("path_length", 1.5, "other", "moved"),
        ("path_length", 1.01, None, "same"),
    ],
)
def test_a_metric_that_moved_is_named_with_its_direction(kept, tmp_path, name, factor, direction, status):
    case, baseline = kept
    changed(case, baseline, **{name: factor * baseline.metrics[name]})
    found = run_case(case, tmp_path / "again")
    assert found.status == status
    assert [(move.name, move.direction) for move in found.moves] == ([(name, direction)] if direction else [])
    assert found.passed == (status in ("same", "better"))


def test_a_list_moves_by_element_and_a_value_that_is_gone_is_worse(kept):
    _, baseline = kept
    x, y = baseline.metrics["zmp_error_rms"]
    bound = {"zmp_error_rms": Bound(max=0.05)}
    (move,) = baseline.moves({**baseline.metrics, "zmp_error_rms": [x, y + 0.01]}, bound)
    assert (move.name, move.direction) == ("zmp_error_rms[1]", "worse")
    (gone,) = baseline.moves({**baseline.metrics, "speed_mean": None}, {})
    assert (gone.name, gone.now, gone.direction) == ("speed_mean", None, "worse")


def test_counts_and_truth_values_may_not_differ_at_all():
    steps = known("steps_taken")
    assert tolerance(steps, 20) == 0.0
    assert tolerance(known("fell"), False) == 0.0
    assert tolerance(known("speed_mean"), 0.4) == pytest.approx(0.022)


def test_it_says_where_a_run_first_parts_from_its_baseline(kept, tmp_path):
    case, baseline = kept
    trace = {name: samples.copy() for name, samples in baseline.trace.items()}
    trace["CoM"][3, 1] += 0.004
    trace["ZMP"][5, 0] += 0.1
    write_baseline(case.baseline, replace(baseline, trace=trace))
    parting = run_case(case, tmp_path / "again").parting
    assert (parting.time, parting.what) == (1.5, "CoM y")
    assert parting.before - parting.now == pytest.approx(0.004, abs=2e-4)


def test_a_shorter_run_parts_where_it_ends(kept, tmp_path):
    case, baseline = kept
    longer = {name: np.vstack((samples, samples[-1:])) for name, samples in baseline.trace.items()}
    write_baseline(case.baseline, replace(baseline, trace=longer))
    assert "the run has ended" in str(run_case(case, tmp_path / "again").parting)


def test_a_missed_criterion_fails_whatever_the_baseline_says_and_is_no_baseline(kept, tmp_path):
    case, _ = kept
    strict = {**case.scenario.criteria, "speed_mean": Bound(min=9.0)}
    worse = replace(case, scenario=case.scenario.model_copy(update={"criteria": strict}))
    found = run_case(worse, tmp_path / "again")
    assert found.status == "failed"
    assert not found.passed
    before = case.baseline.read_text()
    assert update([found]) == ()
    assert case.baseline.read_text() == before


def test_a_baseline_of_other_settings_is_not_compared(kept, tmp_path):
    case, baseline = kept
    assert yaml.safe_load(baseline.settings)["gait"]["steps"] == 2
    write_baseline(case.baseline, replace(baseline, settings=baseline.settings.replace("steps: 2", "steps: 3")))
    assert run_case(case, tmp_path / "again").status == "other scenario"


def test_what_cannot_run_and_what_is_no_baseline_is_told(case, tmp_path):
    case.baseline.parent.mkdir()
    case.baseline.write_text("scenario: 5\n")
    found = run_case(case, tmp_path / "again")
    assert found.status == "could not run"
    assert "is no baseline; write it anew with `surefoot check --update`" in found.reasons[0]


def test_a_folder_is_its_scenarios_and_names_are_not_taken_twice(case, tmp_path):
    (tmp_path / "other.yaml").write_text(WALK.replace("stroll", "ramble"))
    assert [one.scenario.name for one in cases([str(tmp_path)])] == ["ramble", "stroll"]
    (tmp_path / "other.yaml").write_text(WALK)
    with pytest.raises(ScenarioError, match="is named 'stroll' as "):
        cases([str(tmp_path)])
    (tmp_path / "empty").mkdir()
    with pytest.raises(ScenarioError, match=r"holds no scenario; give a folder with \*.yaml files"):
        cases([str(tmp_path / "empty")])


def test_reports_say_what_moved_and_where_to_look(kept, tmp_path):
    case, baseline = kept
    changed(case, baseline, speed_mean=2.0 * baseline.metrics["speed_mean"])
    bad = run_case(case, tmp_path / "again")
    good = replace(bad, status="same", moves=())
    suite = Xml.fromstring(report.junit([bad, good]))
    assert {name: suite.get(name) for name in ("tests", "failures", "errors")} == {
        "tests": "2",
        "failures": "1",
        "errors": "0",
    }
    text = suite.find("testcase/failure").text
    assert "speed_mean: " in text
    assert "worse" in text
    assert f"look at: surefoot plot {bad.log}" in text
    page = report.markdown([bad, good])
    assert "2 scenarios: 1 moved, 1 same" in page
    assert page.count("| stroll |") == 2


def test_scenarios_run_side_by_side_in_the_order_in_which_they_were_named(kept, tmp_path):
    assert kept
    (tmp_path / "b.yaml").write_text(WALK.replace("stroll", "ramble"))
    chosen = cases([str(tmp_path / "b.yaml"), str(tmp_path / "stroll.yaml")])
    seen = []
    found = checking.check(chosen, tmp_path / "runs", 2, seen.append)
    assert [one.status for one in found] == ["without baseline", "same"]
    assert {one.case.scenario.name for one in seen} == {"ramble", "stroll"}


def test_a_baseline_is_read_as_it_was_written(kept):
    case, baseline = kept
    write_baseline(case.baseline, baseline)
    again = read_baseline(case.baseline)
    assert again.metrics == baseline.metrics
    assert isinstance(again, Baseline)
    for name, samples in baseline.trace.items():
        np.testing.assert_array_equal(again.trace[name], samples)
