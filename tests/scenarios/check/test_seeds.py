"""Checks over seeds: they stop when they are decided, go on where they were interrupted, and say what they compared."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from fake_walks import alone, with_worker
from typer.testing import CliRunner

from surefoot.scenarios.check import check as checking
from surefoot.scenarios.check import report, seeds
from surefoot.scenarios.check.annotations import annotations
from surefoot.scenarios.check.baseline import read_baseline, write_baseline
from surefoot.scenarios.check.check import cases
from surefoot.scenarios.check.findings import RATE
from surefoot.scenarios.check.record import to_json
from surefoot.scenarios.check.requirements import Requirements
from surefoot.scenarios.check.seeds import Running, seeds_of
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many import slots
from surefoot.scenarios.many.engine import perform
from surefoot.scenarios.many.journal import LOGS, SCRATCH
from surefoot.scenarios.many.points import Record
from surefoot.scenarios.many.slots import InterruptedRunsError

pytestmark = pytest.mark.unit

WALK = """
name: stroll
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.4, double_support: 0.1}
duration: 3.4
rates: {control: 250}
sensing: {com_noise: 0.003}
criteria: {fell: false, zmp_error_rms: {max: 0.05}, speed_mean: {min: 0.01}}
"""

PUSHED = """
name: pushed
fidelity: pendulum
gait: {steps: 2, step_length: 0.2, single_support: 0.5, double_support: 0.1, initial_stand: 0.5}
duration: 2.4
rates: {control: 100}
sensing: {com_noise: 0.003}
planner: {step_adaptation: none}
pushes: [{time: 1.2, duration: 0.1, impulse: 0.05, direction: 1.5}]
margins: {push: {key: pushes.0.impulse, low: 0.02, high: 1.0, tolerance: 0.1}}
criteria: {fell: false}
"""


class Here:
    """A worker in this process, which counts what it makes."""

    made, breaks = (), False

    def __init__(self, folder, keep_all):
        self._folder, self._keep_all = folder, keep_all

    def __call__(self, point):
        Here.made = (*Here.made, point)
        if Here.breaks:
            return Record(point.id, "broken", ("its process ended",))
        return perform(point, self._folder / SCRATCH, self._folder / LOGS, self._keep_all)

    def close(self):
        pass


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch, tmp_path):
    """Runs without processes beside this one, in an empty directory."""
    monkeypatch.chdir(tmp_path)
    Here.breaks = False
    in_one_process(monkeypatch)


def in_one_process(patch):
    """Run everything in this process, and make the folder of the scenarios."""
    with_worker(patch, Here)
    alone(patch, checking)
    Path("walks").mkdir()


def written(text=WALK):
    Path("walks/stroll.yaml").write_text(text)
    return "walks/stroll.yaml"


def checked(reference="walks/stroll.yaml", count=None, update=False, overrides=()):
    """A check of one scenario, and the number of runs that it made beside that of its own seed."""
    Here.made = ()
    (found,) = seeds.check(cases([reference], None, overrides), Running(Path("runs"), 1, count, update=update))
    return found, len(Here.made)


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """Text of a baseline of twelve seeds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("first"))
        in_one_process(patch)
        found, runs = checked(written(), 12, update=True)
        assert (found.status, runs) == ("written", 11)
        return Path(found.case.baseline).read_text()


@pytest.fixture
def kept(first):
    """A scenario with a baseline of twelve seeds."""
    Path(written()).parent.joinpath("baselines").mkdir()
    path = Path("walks/baselines/stroll.baseline.yaml")
    path.write_text(first)
    return read_baseline(path)


def of(name, found):
    return next(one for one in found.sampled.findings if one.name == name)


def test_a_baseline_holds_the_sample_and_says_how_many_seeds_the_next_check_takes(kept):
    assert kept.sample.seeds == tuple(range(12))
    assert all(kept.sample.passed)
    assert kept.sample.values["speed_mean"][0] == pytest.approx(kept.metrics["speed_mean"])
    assert "real_time_factor" not in kept.sample.values
    (case,) = cases(["walks/stroll.yaml"])
    assert (seeds_of(case), seeds_of(case, 30), seeds_of(case, 1)) == (12, 30, 1)
    found, runs = checked()
    assert (found.status, runs, found.sampled.asked) == ("same", 5, 12)  # decided by the first six
    assert {one.verdict for one in found.sampled.findings} == {"same"}
    assert "6 of 6 seeds met their criteria" in report.lines_of(found)[0]
    assert "decided before all 12" in report.lines_of(found)[0]


def test_one_seed_is_a_check_as_ever_whatever_the_baseline_holds(kept):
    found, runs = checked(count=1)
    assert (found.status, runs, found.sampled) == ("same", 0, None)


def test_the_file_may_say_how_many_seeds(kept):
    (case,) = cases([written(f"{WALK}seeds: 7\n")])
    assert seeds_of(case) == 7
    assert "seeds" not in case.settings
    found, _ = checked()
    assert (found.status, found.sampled.asked) == ("same", 7)


def test_more_noise_is_worse_and_is_told_with_its_interval_beside_the_setting(kept):
    found, runs = checked(overrides=("sensing.com_noise=0.009",))
    assert (found.status, runs) == ("other scenario", 5)
    assert found.reasons == ("sensing.com_noise is 0.009, 0.003 in the baseline",)
    worse = of("zmp_error_rms[1]", found)
    assert (worse.verdict, worse.pairs) == ("worse", 6)
    lines = report.lines_of(found)
    assert any(line.startswith("worse: zmp_error_rms[1]: ") and "6 pairs" in line for line in lines)
    assert "worse: zmp_error_rms" in next(annotations([found]))
    # Of a program that changed, not its settings, the check says it by its status.
    write_baseline(found.case.baseline, replace(kept, settings=found.now.settings))
    found, _ = checked(overrides=("sensing.com_noise=0.009",))
    assert (found.status, found.passed, found.moves) == ("worse", False, ())


def test_fresh_seeds_are_held_against_others_without_pairs(kept):
    found, runs = checked(overrides=("seed=100",))
    assert (found.sampled.sample.seeds[0], runs) == (100, 11)
    assert (found.status, found.passed, of(RATE, found).pairs) == ("not decided", True, 0)
    (line,) = (line for line in report.lines_of(found) if line.startswith("not decided: pass rate"))
    assert "no seeds in common" in line
    assert "runs more, and as many in the baseline" in line


def test_a_check_that_was_interrupted_goes_on_where_it_was(kept, monkeypatch):

    def interrupt(bar, record):
        if len(Here.made) == 3:
            raise KeyboardInterrupt

    with monkeypatch.context() as pressed, pytest.raises(InterruptedRunsError):
        pressed.setattr(slots.CampaignBar, "run", interrupt)
        checked()
    assert 3 <= len(Here.made) <= 4
    found, runs = checked()
    assert (found.status, 1 <= runs <= 2) == ("same", True)  # one may have been under way


def test_what_seeds_do_nothing_to_is_said_and_held_as_one_run():
    text = WALK.replace("sensing: {com_noise: 0.003}", "")
    found, runs = checked(written(text), 8, update=True)
    assert (found.status, runs) == ("written", 7)
    assert read_baseline(found.case.baseline).sample is None
    found, runs = checked(count=8)
    assert (found.status, found.sampled.random) == ("same", False)
    assert len(found.sampled.sample.seeds) == 6
    assert "nothing in them is random" in report.lines_of(found)[0]


def test_without_a_sample_each_seed_must_meet_its_criteria_and_the_baseline_is_incomplete(kept):
    (case,) = cases(["walks/stroll.yaml"])
    write_baseline(case.baseline, replace(kept, sample=None))
    found, _ = checked(count=6)
    assert (found.status, found.reasons) == ("incomplete baseline", (seeds.NO_SAMPLE,))
    limit = sum(sorted(kept.sample.values["zmp_error_rms[0]"][:6])[-2:]) / 2.0
    strict = WALK.replace("{max: 0.05}", f"{{max: [{limit}, 0.05]}}")
    found, _ = checked(written(strict), 6)
    assert (found.status, len(found.sampled.reasons)) == ("failed", 1)
    assert "5 of 6 seeds met their criteria: 83.3 % (95 % interval" in report.lines_of(found)[0]


def test_a_pass_rate_below_one_is_held_against_that_of_the_baseline(kept):
    """A seed that misses its criteria is no news where it missed them before."""
    limit = sum(sorted(kept.sample.values["zmp_error_rms[0]"])[-2:]) / 2.0
    strict = WALK.replace("{max: 0.05}", f"{{max: [{limit}, 0.05]}}")
    first, runs = checked(written(strict), 12, update=True)
    assert (first.status, runs) == ("written", 11)
    assert read_baseline(first.case.baseline).sample.passed.count(False) == 1
    again, _ = checked()
    assert (again.status, again.passed) == ("same", True)
    worse = WALK.replace("{max: 0.05}", "{max: [0.0001, 0.05]}")
    found, _ = checked(written(worse))
    assert (found.status, of(RATE, found).verdict) == ("worse", "worse")


def test_a_seed_is_lost_that_met_its_criteria_in_the_baseline(kept):
    limit = sum(sorted(kept.sample.values["zmp_error_rms[0]"][:6])[-2:]) / 2.0
    found, _ = checked(written(WALK.replace("{max: 0.05}", f"{{max: [{limit}, 0.05]}}")))
    assert (found.status, of(RATE, found).verdict) == ("worse", "worse")
    assert any("missed its criteria, not so in the baseline: zmp_error_rms[0]" in one for one in report.lines_of(found))


def test_a_threshold_of_a_push_is_a_metric_of_a_check():
    path = written(PUSHED)
    assert [seeds_of(case) for case in cases([path])] == [6]
    found, runs = checked(path, 2, update=True)
    assert (found.status, runs) == ("written", 1 + 2 * 6)
    values = read_baseline(found.case.baseline).sample.values["margins.push"]
    assert all(0.1 < value < 0.35 for value in values)
    again, _ = checked(path)
    assert (again.status, of("margins.push", again).verdict) == ("same", "same")
    longer, _ = checked(path, overrides=("robot_options.foot_width=0.03",))
    one = of("margins.push", longer)
    assert one.now < one.before
    assert one.deciding


def test_a_threshold_beyond_its_range_counts_as_the_end_of_it_and_is_told():
    narrow = PUSHED.replace("low: 0.02, high: 1.0", "low: 0.02, high: 0.1")
    found, _ = checked(written(narrow), 2)
    assert found.sampled.sample.values["margins.push"] == (0.1, 0.1)
    assert any("margins.push is above its range with 2 seeds" in line for line in report.lines_of(found))


def test_the_object_of_a_check_has_the_sample_and_the_findings(kept):
    found, _ = checked(overrides=("sensing.com_noise=0.009",))
    (one,) = json.loads(json.dumps(to_json([found], Requirements.of([found])), allow_nan=False))["scenarios"]
    assert one["seeds"]["seeds"] == [0, 1, 2, 3, 4, 5]
    assert one["seeds"]["rate"]["rate"] == 1.0
    assert len(one["seeds"]["values"]["speed_mean"]) == 6
    (worse,) = (each for each in one["seeds"]["findings"] if each["name"] == "zmp_error_rms[1]")
    assert worse["verdict"] == "worse"
    assert worse["low"] < worse["difference"] < worse["high"]


def test_a_run_that_gives_no_result_is_no_pass(kept):
    Here.breaks = True
    found, _ = checked()
    assert (found.status, found.reasons) == ("could not run", ("seed 1: its process ended",))
    assert not found.passed


def test_scenarios_with_seeds_and_without_stand_in_one_check_in_their_order(kept):
    Path("walks/plain.yaml").write_text(WALK.replace("stroll", "plain").replace("sensing: {com_noise: 0.003}", ""))
    told = []
    found = seeds.check(cases(["walks"]), Running(Path("runs"), 1), told.append)
    assert [(one.case.scenario.name, one.status) for one in found] == [
        ("plain", "without baseline"),
        ("stroll", "same"),
    ]
    assert {one.case.scenario.name for one in told} == {"plain", "stroll"}


@pytest.mark.parametrize(
    ("margins", "why"),
    [
        ("{push: {key: pushes.0.impulse, low: 1.0, high: 0.0, tolerance: 0.1}}", "the range from 1 to 0 is empty"),
        ("{push: {key: pushes.0.impulse, low: 0.0, high: 1.0}}", "needs tolerance"),
        ("{push: {key: pushes.0.impuls, low: 0.0, high: 1.0, tolerance: 0.1}}", "impuls"),
        ("{push: {key: pushes.1.impulse, low: 0.0, high: 1.0, tolerance: 0.1}}", "pushes"),
        ("{push: {key: seed, low: 0.0, high: 1.0, tolerance: 0.1}}", "seed"),
    ],
)
def test_a_search_that_cannot_be_is_refused_before_any_run(margins, why):
    text = PUSHED.replace("{push: {key: pushes.0.impulse, low: 0.02, high: 1.0, tolerance: 0.1}}", margins)
    with pytest.raises(ScenarioError, match=why):
        checked(written(text))
    assert Here.made == ()


def test_a_cluster_is_of_seeds(kept):
    result = CliRunner().invoke(app, ["check", "walks", "--cluster", "tcp://127.0.0.1:1", "--seeds", "6"])
    assert "--cluster tcp://127.0.0.1:1: cannot be reached" in str(result.exception)
    result = CliRunner().invoke(app, ["check", "walks", "--cluster", "tcp://127.0.0.1:1", "--seeds", "1"])
    assert "--cluster is for runs of several seeds" in str(result.exception)
