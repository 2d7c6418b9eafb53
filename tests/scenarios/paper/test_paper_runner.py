"""Running experiments: in order, resumed, whatever fails, and stopped by the user."""

import os
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import pytest

from surefoot.scenarios.paper.results import Outcome
from surefoot.scenarios.paper.runner import InterruptedRunsError, process, run_all
from surefoot.scenarios.paper.studies import Experiment, Study

pytestmark = pytest.mark.unit

STUDY = Study("study", "Study", "paper-walk", (), "")
EXPERIMENTS = tuple(Experiment(STUDY, "default", "pendulum", seed) for seed in range(6))


def thread():
    return ThreadPoolExecutor(1)


def run(experiments, jobs=2, on_done=lambda outcome: None, worker=thread, run=lambda e, folder: Outcome(e), out=None):
    return run_all(experiments, out, jobs, on_done, run, worker)


def end_process(experiment, folder):
    os._exit(1)


@pytest.mark.parametrize("jobs", [1, 2, 9])
def test_every_experiment_has_its_outcome_in_order(jobs):
    told = []
    outcomes = run(EXPERIMENTS, jobs, told.append)
    assert [outcome.experiment for outcome in outcomes] == list(EXPERIMENTS)
    assert sorted(told, key=lambda outcome: outcome.experiment.seed) == list(outcomes)


def test_one_that_fails_does_not_stop_the_others():
    def fail_third(experiment, folder):
        if experiment.seed == 2:
            raise RuntimeError("no")
        return Outcome(experiment)

    outcomes = run(EXPERIMENTS, run=fail_third)
    assert [outcome.experiment.seed for outcome in outcomes if outcome.failure] == [2]
    assert outcomes[2].failure == "internal error, RuntimeError: no"


def test_a_worker_that_dies_is_replaced():
    made = []

    class Dying(ThreadPoolExecutor):
        def submit(self, function, *arguments):
            if arguments and arguments[0].seed == 1:
                raise BrokenProcessPool
            return super().submit(function, *arguments)

    def make():
        made.append(Dying(1))
        return made[-1]

    outcomes = run(EXPERIMENTS, 1, worker=make)
    assert [bool(outcome.failure) for outcome in outcomes] == [False, True, False, False, False, False]
    assert len(made) == 2


def test_a_real_process_that_dies():
    (outcome,) = run(EXPERIMENTS[:1], 1, worker=process, run=end_process)
    assert outcome.failure.startswith("its process ended unexpectedly")


def test_ctrl_c_lets_runs_under_way_end_and_begins_no_other():
    ran = []

    def note(experiment, folder):
        ran.append(experiment.seed)
        return Outcome(experiment)

    def interrupt(outcome):
        raise KeyboardInterrupt

    with pytest.raises(InterruptedRunsError):
        run(EXPERIMENTS * 200, 1, interrupt, run=note)
    assert 0 < len(ran) < 1200
