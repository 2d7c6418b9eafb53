"""A log is run again unless it is whole and of the same scenario and code; what it holds is what is said of it."""

import pytest

from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.loop.skeleton import End
from surefoot.scenarios.paper import results as module
from surefoot.scenarios.paper.results import execute, is_done
from surefoot.scenarios.paper.studies import Experiment, Study, experiments
from surefoot.scenarios.record.provenance import source_digest
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import scenario_yaml

pytestmark = pytest.mark.unit

SHORT = ("gait.steps=1", "gait.single_support=0.6", "gait.initial_stand=0.2", "rates.control=100")
SHORT_WALK = Experiment(Study("short", "Short walk", "paper-walk", SHORT, ""), "default", "pendulum", 3)


def test_metrics_are_those_of_the_log_and_a_second_time_nothing_is_run(tmp_path, monkeypatch):
    first = execute(SHORT_WALK, tmp_path)
    assert first.failure == ""
    assert first.log == tmp_path / "short.default.pendulum-3" / "log.mcap"
    assert first.metrics == judge(read(first.log)).metrics
    assert first.versions["source_digest"]
    monkeypatch.setattr(module, "run_scenario", lambda *_: pytest.fail("it was run again"))
    assert execute(SHORT_WALK, tmp_path) == first


@pytest.fixture
def logged(tmp_path, robot, motion, two_steps):
    def make(loop=None):
        return run_scenario(two_steps, tmp_path, None, loop or motion(duration=0.2), robot).log

    return make


def test_a_whole_log_of_the_same_scenario_and_code_is_done(logged, two_steps, monkeypatch):
    log = logged()
    assert is_done(log, scenario_yaml(two_steps))
    made = {**module.versions(), "git_revision": "another commit, the same code"}
    monkeypatch.setattr(module, "versions", lambda: made)
    assert is_done(log, scenario_yaml(two_steps))


def test_a_fall_is_a_result(logged, motion, two_steps):
    assert is_done(logged(motion(duration=0.2, end=End("fall", 0.1, "it fell"))), scenario_yaml(two_steps))


@pytest.mark.parametrize("kind", ["interrupted", "fault"])
def test_a_run_that_did_not_end_is_run_again(logged, motion, two_steps, kind):
    assert not is_done(logged(motion(duration=0.2, end=End(kind, 0.1, "why"))), scenario_yaml(two_steps))


def test_other_scenarios_versions_and_code_are_run_again(logged, two_steps, tmp_path, monkeypatch):
    log = logged()
    assert not is_done(log, scenario_yaml(two_steps.model_copy(update={"seed": 1})))
    assert not is_done(tmp_path / "absent.mcap", scenario_yaml(two_steps))
    for name in ("source_digest", "numpy"):
        made = {**module.versions(), name: "other"}
        with monkeypatch.context() as patch:
            patch.setattr(module, "versions", lambda made=made: made)
            assert not is_done(log, scenario_yaml(two_steps))


def test_a_half_written_log_is_run_again(logged, two_steps):
    log = logged()
    log.write_bytes(log.read_bytes()[:-200])
    assert not is_done(log, scenario_yaml(two_steps))


def test_a_scenario_that_is_refused_is_a_failure_with_its_reason(tmp_path):
    study = Study("bad", "Bad", "paper-walk", ("gait.steps=many",), "")
    found = execute(Experiment(study, "default", "pendulum"), tmp_path)
    assert "gait.steps" in found.failure
    assert "\n" not in found.failure
    assert found.metrics == {}


def test_an_internal_error_is_a_failure(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "load_scenario", lambda *_: 1 / 0)
    assert execute(SHORT_WALK, tmp_path).failure == "internal error, ZeroDivisionError: division by zero"


def test_every_experiment_of_the_page_is_a_scenario_that_can_run():
    every = experiments()
    assert len({experiment.folder for experiment in every}) == len(every) > 200
    for experiment in {(e.study, e.profile, e.world): e for e in every}.values():
        scenario = load_scenario(experiment.base, experiment.overrides)
        assert f"{scenario.name}-{scenario.seed}" == experiment.folder


def test_digest_tells_code_apart_but_not_what_only_reads_logs(tmp_path):
    for name in ("planner/a.py", "scenarios/show/b.py"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text("1")
    first = source_digest(tmp_path)
    (tmp_path / "scenarios/show/b.py").write_text("2")
    assert source_digest(tmp_path) == first
    (tmp_path / "planner/a.py").write_text("2")
    assert source_digest(tmp_path) != first
