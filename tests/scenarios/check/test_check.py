"""A run against its baseline: the same is the same, what moved is named with its direction."""

import os
from dataclasses import replace
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
import yaml

from surefoot.scenarios.check import check as checking
from surefoot.scenarios.check import report
from surefoot.scenarios.check.baseline import Baseline, read_baseline, write_baseline
from surefoot.scenarios.check.check import cases, compared, exit_code, run_case, updated
from surefoot.scenarios.check.pictures import Gallery
from surefoot.scenarios.check.requirements import Requirements
from surefoot.scenarios.check.signs import COLUMNS, SIGNS, Trace
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.metrics import METRICS, OWN, known, register
from surefoot.scenarios.show.figures.page import FIGURES
from surefoot.scenarios.show.moment import Moment

pytestmark = pytest.mark.unit

WALK = """
name: stroll
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.5, double_support: 0.1, initial_stand: 0.2}
duration: 2.2
rates: {control: 100}
criteria: {fell: false, zmp_error_rms: {max: 0.05}, speed_mean: {min: 0.01}}
"""


@pytest.fixture
def case(tmp_path):
    (tmp_path / "stroll.yaml").write_text(WALK)
    (found,) = cases([str(tmp_path / "stroll.yaml")])
    return found


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """The first run of the case, which has no baseline."""
    folder = tmp_path_factory.mktemp("first")
    (folder / "stroll.yaml").write_text(WALK)
    return run_case(*cases([str(folder / "stroll.yaml")]), folder / "runs")


@pytest.fixture
def kept(case, first):
    """The case with its baseline written, and what was written."""
    assert first.status == "without baseline"
    assert updated(replace(first, case=case)).status == "written"
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
    assert (again.status, again.moves, again.partings) == ("same", (), ())
    assert updated(again) is again


@pytest.mark.parametrize(
    ("name", "factor", "direction", "status"),
    [
        ("speed_mean", 1.5, "worse", "moved"),
        ("speed_mean", 0.9, "better", "better"),
        ("speed_mean", 0.4, "better", "moved"),
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


def test_scenarios_of_a_folder_are_found_in_great_letters_too(tmp_path):
    for name in ("one.yaml", "two.YAML", "three.baseline.yaml", "four.txt"):
        (tmp_path / name).write_text(WALK.replace("stroll", name.partition(".")[0]))
    assert [case.scenario.name for case in cases([str(tmp_path)])] == ["one", "two"]


def test_a_tolerance_is_the_metrics_own_or_of_its_unit_and_counts_may_not_differ_at_all():
    assert known("steps_taken").allowed(20) == 0.0
    assert known("fell").allowed(False) == 0.0
    assert known("foot_slip_max").allowed(0.004) == pytest.approx(2e-4 + 0.05 * 0.004)
    assert known("displacement").allowed(-5.7) == pytest.approx(0.003 + 0.001 * 5.7)


def test_no_tolerance_is_so_wide_that_a_count_or_a_centimetre_of_the_walk_gets_lost():
    for name, own in OWN.items():
        if own.repeatable and own.unit == "m":
            assert own.allowed(0.1) <= 0.0055, name
        assert own.allowed(3) == 0.0 or own.tolerance is not None


def moved(trace, column, stage, by):
    """A trace with one of its numbers moved."""
    values = {name: samples.copy() for name, samples in trace.values.items()}
    values[column][stage] += by
    return replace(trace, values=values)


def test_a_run_whose_trace_parts_has_moved_and_is_told_where_first_and_most(kept, tmp_path):
    case, baseline = kept
    trace = moved(moved(baseline.trace, "com_y", 2, 0.004), "sole_x", 3, -0.1)
    write_baseline(case.baseline, replace(baseline, trace=trace))
    found = run_case(case, tmp_path / "again")
    assert (found.status, found.moves) == ("moved", ())
    assert [one.text for one in found.partings] == [
        "CoM at the end of step 1: 4.0 mm to the right of the baseline",
        "right sole at touchdown of step 2: 100.0 mm ahead of the baseline",
    ]
    lines = report.lines_of(found)
    assert f"parts first: {found.partings[0].text}" in lines
    begin, end = baseline.trace.values["time"][2:4]
    assert f"look at: surefoot plot {found.log} --what balance --from {begin:g} --to {end:g}" in lines
    assert f"look at: surefoot plot {found.log} --what soles --from {end:g}" in lines
    assert f"look at: {Moment(found.log, found.partings[0].begin).command}" in lines


def test_a_metric_of_a_package_that_is_not_here_is_not_compared_unless_a_criterion_names_it(kept, tmp_path):
    case, baseline = kept
    changed(case, baseline, com_sway=0.1)
    found = run_case(case, tmp_path / "again")
    assert (found.status, found.moves, found.reasons) == ("same", (), ())
    asked = replace(case, scenario=case.scenario.model_copy(update={"criteria": {"com_sway": Bound(max=1.0)}}))
    held = compared(asked, read_baseline(case.baseline), found.now)
    assert held.status == "incomplete baseline"
    assert held.reasons == ("com_sway of the baseline is not known here; install the package that has this metric",)


def test_a_package_of_metrics_gets_into_no_baseline_unless_a_criterion_names_it(kept, tmp_path, request):
    case, baseline = kept

    @metric(unit="m", reads={"/truth": ("com",)})
    def com_sway(run):
        """Sway of the CoM [m]."""
        return float(np.std(run.field("/truth", "com")[:, 1]))

    register(com_sway)
    request.addfinalizer(lambda: METRICS.discard("com_sway"))
    here = run_case(case, tmp_path / "here")
    assert here.status == "same"
    assert "com_sway" not in here.now.metrics
    # Of a baseline that has it from such an environment it is not compared either.
    changed(case, baseline, com_sway=7.0)
    assert run_case(case, tmp_path / "with").status == "same"
    asked = replace(case, scenario=case.scenario.model_copy(update={"criteria": {"com_sway": Bound(max=1.0)}}))
    assert run_case(asked, tmp_path / "asked").now.metrics["com_sway"] < 1.0
    assert [move.name for move in run_case(asked, tmp_path / "moved").moves] == ["com_sway"]


def test_each_figure_that_is_pointed_to_is_there():
    assert {sign.figure for sign in SIGNS} <= set(FIGURES)


def test_a_run_of_fewer_steps_parts_at_the_one_that_is_not_there(kept):
    _, baseline = kept
    short = Trace(
        baseline.trace.labels[:-1],
        baseline.trace.feet[:-1],
        {name: samples[:-1] for name, samples in baseline.trace.values.items()},
    )
    assert [one.text for one in baseline.trace.partings(short)] == ["step 2 is not there"]
    assert [one.text for one in short.partings(baseline.trace)] == ["step 2 is one too many"]
    feet = replace(baseline.trace, feet=("both", "both", "right", "left"))
    assert (
        baseline.trace.partings(feet)[0].text
        == "step 1 with the foot right is in the baseline step 1 with the foot left"
    )


def test_what_cannot_be_told_any_more_parts_and_a_turn_beyond_half_a_circle_does_not(kept):
    _, baseline = kept
    (lost,) = baseline.trace.partings(moved(baseline.trace, "zmp", 2, np.nan))
    assert lost.text == "largest distance of the ZMP from its reference in step 1 cannot be told any more"
    assert baseline.trace.partings(moved(baseline.trace, "sole_yaw", 2, 2.0 * np.pi)) == []
    (turned,) = baseline.trace.partings(moved(baseline.trace, "sole_yaw", 2, -0.1))
    assert turned.text.startswith("heading of the left sole at touchdown of step 1: -5.73 deg, ")


def test_a_missed_criterion_fails_whatever_the_baseline_says_and_is_no_baseline(kept, tmp_path):
    case, _ = kept
    strict = {**case.scenario.criteria, "speed_mean": Bound(min=9.0)}
    worse = replace(case, scenario=case.scenario.model_copy(update={"criteria": strict}))
    found = run_case(worse, tmp_path / "again")
    assert found.status == "failed"
    assert not found.passed
    before = case.baseline.read_text()
    assert updated(found) is found
    assert case.baseline.read_text() == before


def test_a_baseline_of_other_settings_is_told_and_compared_all_the_same(kept, tmp_path):
    case, baseline = kept
    assert yaml.safe_load(baseline.settings)["gait"]["steps"] == 2
    other = baseline.settings.replace("steps: 2", "steps: 3").replace("  double_support: 0.1\n", "") + "seed: 4\n"
    settings = (
        "gait.steps is 2, 3 in the baseline",
        "seed is the default, 4 in the baseline",
        "gait.double_support is 0.1, the default in the baseline",
    )
    write_baseline(case.baseline, replace(baseline, settings=other))
    found = run_case(case, tmp_path / "again")
    assert (found.status, found.moves, found.partings) == ("other scenario", (), ())
    assert found.reasons == (*settings, checking.UNMOVED)
    metrics = {**baseline.metrics, "speed_mean": 2.0 * baseline.metrics["speed_mean"]}
    trace = moved(baseline.trace, "com_y", 2, 0.004)
    write_baseline(case.baseline, replace(baseline, settings=other, metrics=metrics, trace=trace))
    found = run_case(case, tmp_path / "moved")
    assert (found.status, found.reasons) == ("other scenario", settings)
    assert [(move.name, move.direction) for move in found.moves] == [("speed_mean", "worse")]
    assert [one.text for one in found.partings] == ["CoM at the end of step 1: 4.0 mm to the right of the baseline"]
    assert any(line.startswith("look at: surefoot plot") for line in report.lines_of(found))


def test_update_adds_what_a_baseline_lacks_and_keeps_what_it_says(kept, tmp_path):
    """A metric, a column and an option that are new get into it; a number within its tolerance stays."""
    case, baseline = kept
    metrics = {name: value for name, value in baseline.metrics.items() if name != "zmp_error_rms"}
    metrics["speed_mean"] += 0.5 * known("speed_mean").allowed(metrics["speed_mean"])
    columns = {name: values for name, values in baseline.trace.values.items() if name != "com_y"}
    world = {name: value for name, value in baseline.world.items() if name != "timestep"}
    little = replace(baseline, metrics=metrics, world=world, trace=replace(baseline.trace, values=columns))
    write_baseline(case.baseline, little)
    found = run_case(case, tmp_path / "again")
    assert (found.status, found.moves) == ("incomplete baseline", ())
    assert updated(found).status == "written"
    filled = read_baseline(case.baseline)
    assert (
        filled.metrics["speed_mean"] == pytest.approx(metrics["speed_mean"], rel=1e-5) != baseline.metrics["speed_mean"]
    )
    assert filled.metrics.keys() == baseline.metrics.keys()
    assert filled.trace.values.keys() == baseline.trace.values.keys()
    assert filled.world == baseline.world
    assert run_case(case, tmp_path / "third").status == "same"


@pytest.mark.parametrize(
    ("statuses", "code"),
    [
        (["same", "better", "written"], 0),
        (["same", "moved"], 1),
        (["without baseline", "other scenario"], 1),
        (["incomplete baseline", "same"], 1),
        (["failed", "written"], 1),
        (["unreadable baseline", "moved"], 2),
        (["could not run", "failed"], 2),
        (["could not write", "failed"], 2),
    ],
)
def test_the_exit_code_tells_what_is_worse_from_what_could_not_be_held_against_anything(first, statuses, code):
    assert exit_code([replace(first, status=status) for status in statuses]) == code


def test_what_cannot_run_and_what_is_no_baseline_is_told(case, tmp_path):
    case.baseline.parent.mkdir()
    case.baseline.write_text("scenario: 5\n")
    found = run_case(case, tmp_path / "again")
    assert found.status == "unreadable baseline"
    assert "it has no settings, so it is no baseline; write it anew with `surefoot check" in found.reasons[0]
    assert updated(found).status == "written"
    assert run_case(case, tmp_path / "third").status == "same"
    assert run_case(case, tmp_path / "stroll.yaml").status == "could not run"


def test_what_update_wrote_it_says_it_wrote(case, tmp_path):
    told = []
    (found,) = checking.check([case], tmp_path / "runs", 1, told.append, update=True)
    assert [one.status for one in told] == ["without baseline", "written"]
    assert (found.status, found.passed) == ("written", True)
    assert report.lines_of(found) == ["was: without baseline", f"written: {case.baseline}"]
    assert report.summary([found]) == "1 scenario: 1 written"


DEEP = "[" * 100_000
ALIASES = "".join(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 10)}]\n" for i in range(8))


def trace_of(**columns):
    """A trace of two stages."""
    return Trace(("stand", "step 1"), ("both", "left"), {name: np.array(both) for name, both in columns.items()})


def test_a_place_of_which_the_baseline_tells_a_part_is_not_the_same():
    nan = np.nan
    none = trace_of(sole_x=[nan, 1.0], sole_y=[nan, 1.0], sole_z=[nan, 1.0])
    part = trace_of(sole_x=[nan, 1.0], sole_y=[nan, 1.0], sole_z=[10.0, 1.0])
    for before, now in ((part, none), (none, part)):
        (parting,) = before.partings(now)
        assert "could not be told in the baseline" in parting.text
    assert not none.partings(none)


@pytest.mark.parametrize("column", [sign.columns[0] for sign in SIGNS if sign.peak])
def test_a_peak_that_the_run_stays_far_below_is_not_the_same(column):
    """Else a baseline with a peak without measure would allow anything."""
    now = trace_of(**{column: [0.1, 0.5]})
    (parting,) = trace_of(**{column: [0.1, 2.5]}).partings(now)
    assert parting.excess > 1.0
    assert "at most 2.5 in the baseline" in parting.text
    assert not trace_of(**{column: [0.1, 0.9]}).partings(now)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("metrics:\n", "metrics: [1]\nmore:\n", "it has no metrics"),
        ("trace:", "trace: {a: 1}\nrest:", "it has no trace"),
        ("scenario:", "scenarios:", "it has no scenario"),
        ("speed_mean: ", "speed_mean: fast #", "its speed_mean is not what the metric gives"),
        ("speed_mean: ", "speed_mean: .inf #", "no finite number"),
        ("speed_mean: ", "speed_mean: 1e400 #", "no finite number"),
        ("speed_mean: ", "steps_taken: 2\n  speed_mean: ", "'steps_taken' is given twice"),
        ("first tick,", "", "its trace has rows of other lengths"),
        ("com_x", "com_q", "its trace has columns other than"),
        ("com_x", "com_y", "its trace has columns other than"),
        ("0.000,", ".inf,", "its trace holds what is no finite number"),
        ("0.000,", "true,", "its trace holds what is no finite number"),
        ("  gait:", "  gait: {", "not valid YAML"),
        ("scenario:", f"deep: {DEEP}\nscenario:", "nested deeper than"),
        ("settings: |\n", f"settings: |\n  deep: {DEEP}\n", "nested deeper than"),
        ("metrics:\n", "metrics: &all\n  all: *all\n", "is no baseline"),
        ("scenario:", f"a0: &a0 [1]\n{ALIASES}scenario:", "more than 200000 values"),
    ],
)
def test_a_baseline_that_was_spoilt_is_refused_in_a_sentence(kept, old, new, why):
    case, _ = kept
    text = case.baseline.read_text()
    assert old in text
    case.baseline.write_text(text.replace(old, new, 1))
    with pytest.raises(ScenarioError) as refused:
        read_baseline(case.baseline)
    (problem,) = refused.value.problems
    assert problem.startswith(str(case.baseline))
    assert why in problem
    assert problem.endswith("so it is no baseline; write it anew with `surefoot check --update`")


def test_a_baseline_is_a_regular_file_of_bounded_size(kept, tmp_path):
    case, baseline = kept
    case.baseline.unlink()
    os.mkfifo(case.baseline)
    with pytest.raises(ScenarioError, match="it is no regular file, so it is no baseline"):
        read_baseline(case.baseline)
    with pytest.raises(LogError, match="is no regular file; remove it"):
        write_baseline(case.baseline, baseline)
    case.baseline.unlink()
    case.baseline.symlink_to("/dev/zero")
    with pytest.raises(ScenarioError, match="it is no regular file"):
        read_baseline(case.baseline)
    case.baseline.unlink()
    case.baseline.touch()
    os.truncate(case.baseline, 2**33)
    with pytest.raises(ScenarioError, match="larger than 2000000 bytes, so it is no baseline"):
        read_baseline(case.baseline)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (
            lambda one: {"metrics": {"fell": False}},
            "says nothing of fall_time, fall_warning, duration, ",
        ),
        (lambda one: {"metrics": without(one.metrics, "zmp_error_rms")}, "says nothing of zmp_error_rms"),
        (
            lambda one: {"trace": replace(one.trace, values=without(one.trace.values, "zmp"))},
            "says nothing of the trace's zmp",
        ),
        (lambda one: {"trace": replace(one.trace, values={})}, "says nothing of the trace's time, "),
    ],
)
def test_a_baseline_that_says_nothing_of_something_is_not_the_same(kept, first, changed, said):
    case, baseline = kept
    write_baseline(case.baseline, replace(baseline, **changed(baseline)))
    found = compared(case, read_baseline(case.baseline), first.now)
    assert (found.status, found.passed) == ("incomplete baseline", False)
    assert said in found.reasons[0]
    assert updated(replace(found, now=first.now)).status == "written"
    assert compared(case, read_baseline(case.baseline), first.now).status == "same"


def without(mapping, name):
    """A mapping with one entry less."""
    return {key: value for key, value in mapping.items() if key != name}


def test_a_metric_that_a_criterion_asks_for_is_not_missing_either(kept):
    _, baseline = kept
    own = replace(baseline, metrics=without(baseline.metrics, "speed_mean"))
    other = replace(baseline, metrics={**baseline.metrics, "com_sway": 0.1})
    assert own.gaps(baseline, {})
    assert baseline.gaps(other, {}) == []
    assert baseline.gaps(other, {"com_sway": Bound(max=1.0)}) == ["the baseline says nothing of com_sway"]


def test_what_the_baseline_could_not_tell_and_the_run_can_parts(kept):
    _, baseline = kept
    (found,) = moved(baseline.trace, "zmp", 2, np.nan).partings(baseline.trace)
    assert found.text == "largest distance of the ZMP from its reference in step 1 could not be told in the baseline"


def test_a_baseline_of_another_name_is_told_and_compared_all_the_same(kept, first):
    case, baseline = kept
    write_baseline(case.baseline, replace(baseline, scenario="1e5"))
    assert read_baseline(case.baseline).scenario == "1e5"
    found = compared(case, read_baseline(case.baseline), first.now)
    assert (found.status, found.reasons) == ("other scenario", ("the baseline is of '1e5'", checking.UNMOVED))


def test_an_option_of_the_world_that_changed_is_named(kept, first):
    case, baseline = kept
    world = {"gravity": [0.0, 0.0, -9.81], "disabled": [], "mass": 100.0}
    known = replace(baseline, world=world)
    assert known.other_world(replace(known, world={**world, "mass": 100.00001})) == []
    assert known.other_world(replace(known, world={**world, "gravity": [0.0, 0.0, -9.7], "disabled": ["mjX"]})) == [
        "the world's gravity is [0.0, 0.0, -9.7], [0.0, 0.0, -9.81] in the baseline",
        "the world's disabled is [mjX], [] in the baseline",
    ]
    (gap,) = baseline.gaps(known, {})
    assert gap.endswith("says nothing of the world's gravity, the world's disabled, the world's mass")
    write_baseline(case.baseline, known)
    assert read_baseline(case.baseline).world == world
    assert compared(case, known, first.now).status == "moved"


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
    assert f"look at: surefoot plot {bad.log}" in text.splitlines()
    page = report.markdown([bad, good], Requirements.of([bad, good]), Gallery())
    assert "2 scenarios: 1 moved, 1 same" in page
    assert "| stroll | ❌ moved |" in page and "| stroll | ✅ same |" in page
    assert f"- look at: `surefoot plot {bad.log}`" in page.splitlines()
    assert page.count("No pictures: `surefoot check --history FOLDER` keeps how runs moved") == 1


def test_junit_has_the_time_on_the_walls_clock(first):
    assert first.took > 0.0
    suite = Xml.fromstring(report.junit([replace(first, took=0.25)]))
    assert suite.find("testcase").get("time") == "0.250"


def test_scenarios_run_side_by_side_in_the_order_in_which_they_were_named(kept, tmp_path):
    assert kept
    (tmp_path / "b.yaml").write_text(WALK.replace("stroll", "ramble"))
    chosen = cases([str(tmp_path / "b.yaml"), str(tmp_path / "stroll.yaml")])
    seen = []
    found = checking.check(chosen, tmp_path / "runs", 2, seen.append)
    assert [one.status for one in found] == ["without baseline", "same"]
    assert {one.case.scenario.name for one in seen} == {"ramble", "stroll"}
    assert [path.parent.name for path in (tmp_path / "runs").glob("*/log.mcap")] == ["ramble-0"]
    assert [one.log is None for one in found] == [False, True]


def test_a_baseline_is_read_as_it_was_written(kept):
    case, baseline = kept
    write_baseline(case.baseline, baseline)
    again = read_baseline(case.baseline)
    assert again.metrics == baseline.metrics
    assert isinstance(again, Baseline)
    assert (again.trace.labels, again.trace.feet) == (("first tick", "stand", "step 1", "step 2"), baseline.trace.feet)
    assert set(again.trace.values) == set(COLUMNS) - {name for sign in SIGNS if sign.body for name in sign.columns}
    for name, samples in baseline.trace.values.items():
        np.testing.assert_array_equal(again.trace.values[name], samples)


def test_a_metric_of_parts_is_read_as_it_was_written(kept):
    """The metrics are of an estimator, which a walk from the truth has not got."""
    case, baseline = kept
    parts = {"com": 1.0, "com_velocity": 2.0, "tilt": 3.0, "sole_height": 4.0}
    write_baseline(case.baseline, replace(baseline, metrics={**baseline.metrics, "estimation_nees": parts}))
    assert list(read_baseline(case.baseline).metrics["estimation_nees"].items()) == list(parts.items())


def test_every_baseline_of_the_catalogue_holds_all_that_is_compared():
    every = [case for case in cases([]) if case.baseline.exists()]
    assert len(every) > 20
    kept = {case.scenario.name: read_baseline(case.baseline) for case in every}
    world = set(kept["walk-level"].world)
    assert len(world) > 40 and "com_error_rms" in kept["walk-level"].metrics
    for name, baseline in kept.items():
        assert set(kept["walk-level"].metrics) == set(baseline.metrics), name
        assert set(COLUMNS) == set(baseline.trace.values), name
        assert set(baseline.world) == world, name
