"""An experiment is run once; what its log holds is what is said of it."""

import pytest

from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import source_digest
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.skeleton import End
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.studies.paper.results import run_experiments
from surefoot.studies.paper.studies import Experiment, Study, experiments

pytestmark = pytest.mark.unit

SHORT = ("gait.steps=1", "gait.single_support=0.6", "gait.initial_stand=0.2", "rates.control=100")
SHORT_WALK = Experiment(Study("short", "Short walk", "paper-walk", SHORT), "default", "pendulum", 3)


def test_metrics_are_those_of_the_log_and_a_second_time_nothing_is_run(tmp_path, worker):
    (first,) = run_experiments((SHORT_WALK,), tmp_path, [worker(tmp_path)])
    assert first.failure == ""
    assert first.log == tmp_path / "logs" / "short.default.pendulum-3" / "log.mcap"
    assert first.metrics == judge(read(first.log)).metrics
    assert first.versions["source_digest"]
    again = worker(tmp_path, lambda *_: pytest.fail("it was run again"))
    assert run_experiments((SHORT_WALK,), tmp_path, [again]) == (first,)


@pytest.mark.parametrize("kind", ["fall", "interrupted", "fault"])
def test_a_fall_is_a_result_and_a_run_that_did_not_end_is_none(tmp_path, worker, motion, robot, kind):
    """Whatever the fault, the reason is told."""

    def cut(scenario, folder):
        return run_scenario(scenario, folder, None, motion(duration=0.2, end=End(kind, 0.1, "why")), robot)

    (found,) = run_experiments((SHORT_WALK,), tmp_path, [worker(tmp_path, cut)])
    assert (found.failure == "") == (kind == "fall")
    assert kind == "fall" or "why" in found.failure or "interrupted" in found.failure


def test_a_scenario_that_is_refused_is_a_failure_with_its_reason(tmp_path, worker):
    study = Study("bad", "Bad", "paper-walk", ("gait.steps=many",))
    (found,) = run_experiments((Experiment(study, "default", "pendulum"),), tmp_path, [worker(tmp_path)])
    assert "gait.steps" in found.failure
    assert "\n" not in found.failure
    assert found.metrics == {}


def test_an_internal_error_is_a_failure(tmp_path, worker):
    (found,) = run_experiments((SHORT_WALK,), tmp_path, [worker(tmp_path, lambda *_: 1 / 0)])
    assert found.failure == "internal error, ZeroDivisionError: division by zero"


def test_every_experiment_of_the_page_is_a_scenario_that_can_run():
    every = experiments()
    assert len({experiment.folder for experiment in every}) == len(every) > 200
    for experiment in {(e.study, e.profile, e.world): e for e in every}.values():
        scenario = load_scenario(experiment.study.base, experiment.overrides)
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
