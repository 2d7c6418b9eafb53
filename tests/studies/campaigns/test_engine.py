"""Runs several at once: each once, written down at once, gone on with, whatever dies."""

import json
import os
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field

import pytest

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.many.engine import LocalWorker, perform
from surefoot.scenarios.many.journal import CHANGED, JOURNAL, LOGS, SCRATCH, Journal, MadeOf, outcome_of
from surefoot.scenarios.many.points import Base, Point, Record, Single, facts
from surefoot.scenarios.many.slots import InterruptedRunsError, run_cells
from surefoot.scenarios.setup.load import written

pytestmark = pytest.mark.unit

SHORT = {"fidelity": "pendulum", "gait.steps": 1, "gait.single_support": 0.6, "gait.initial_stand": 0.2,
         "rates.control": 100}  # fmt: skip
BASE = Base("paper-walk", written("paper-walk"))


def point(seed=0, **settings):
    return Point(BASE, {**SHORT, **settings, "seed": seed}, {"seed": seed}, f"run-{seed}")


POINTS = tuple(point(seed) for seed in range(6))
CELLS = tuple(map(Single, POINTS))


@dataclass
class Counting:
    """A worker that runs nothing, and says what it was asked for."""

    asked: list
    status: str = "pass"
    made_of: MadeOf = field(default_factory=MadeOf)

    def __call__(self, one):
        self.asked.append(one.settings["seed"])
        return Record(one.id, self.status, made_by=self.made_of.of(one), metrics={"steps_taken": one.settings["seed"]})

    def close(self):
        pass


class Other(Counting):
    """Makes runs of another robot."""

    def __call__(self, one):
        return Record(one.id, "pass", made_by="another robot")


@pytest.mark.parametrize("jobs", [1, 2, 9])
def test_every_run_has_its_result_once(tmp_path, jobs):
    asked, told, cells = [], [], []
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked) for _ in range(jobs)], told.append, lambda: cells.append(1))
        outcomes = [outcome_of(cell, journal) for cell in CELLS]
    assert sorted(asked) == list(range(6))
    assert len(told) == len(cells) == 6
    assert [run[1].metrics["steps_taken"] for outcome in outcomes for run in outcome.runs] == list(range(6))
    assert all(outcome.complete for outcome in outcomes)


def test_a_second_time_nothing_is_run(tmp_path):
    for _ in range(2):
        asked = []
        with Journal(tmp_path) as journal:
            run_cells(CELLS, journal, [Counting(asked)])
    assert asked == []


def test_what_was_broken_is_tried_again_and_is_no_answer(tmp_path):
    asked = []
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked, "broken")])
        assert not outcome_of(CELLS[0], journal).complete
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked)])
        assert outcome_of(CELLS[0], journal).complete
    assert len(asked) == 12


def test_a_line_that_was_not_finished_is_done_again(tmp_path):
    asked = []
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked)])
    path = tmp_path / JOURNAL
    path.write_bytes(path.read_bytes()[:-20])
    asked.clear()
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked)])
    assert len(asked) == 1
    assert [json.loads(line)["status"] for line in path.read_text().splitlines()] == ["pass"] * 6


def test_results_of_other_code_are_made_anew(tmp_path):
    asked = []
    with Journal(tmp_path) as journal:
        run_cells(CELLS, journal, [Counting(asked)])
    other = MadeOf(lambda: {"numpy": "other"})
    with Journal(tmp_path, made_of=other) as journal:
        assert not outcome_of(CELLS[0], journal).runs
        run_cells(CELLS, journal, [Counting(asked, made_of=other)])
        assert journal.stale == 6
    assert len(asked) == 12


def test_what_changes_while_the_campaign_goes_on_gives_no_result(tmp_path):
    with Journal(tmp_path) as journal:
        run_cells(CELLS[:3], journal, [Counting([])])
        run_cells(CELLS, journal, [Other([])])
        outcomes = [outcome_of(cell, journal) for cell in CELLS]
    assert [outcome.complete for outcome in outcomes] == [True] * 3 + [False] * 3
    assert outcomes[3].runs[0][1].reasons == (CHANGED,)
    with Journal(tmp_path) as journal:
        assert [journal.get(one) is not None for one in POINTS] == [True] * 3 + [False] * 3


def test_a_directory_belongs_to_one_process_and_to_campaigns(tmp_path):
    with Journal(tmp_path / "a"), pytest.raises(LogError, match="another process works on this campaign"):
        Journal(tmp_path / "a")
    Journal(tmp_path / "a").close()
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "thesis.tex").touch()
    with pytest.raises(LogError, match="holds something else"):
        Journal(tmp_path / "b")
    assert [path.name for path in (tmp_path / "b").iterdir()] == ["thesis.tex"]


def test_a_run_and_its_log(tmp_path):
    record = perform(point(), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=False)
    assert (record.status, record.reasons, record.log) == ("pass", (), "")
    assert record.metrics["steps_taken"] == 1
    assert not list(tmp_path.rglob("*.mcap"))
    kept = perform(point(), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=True)
    assert (tmp_path / kept.log).stat().st_size == kept.metrics["log_bytes"]
    failed = perform(point(1, criteria={"speed_mean": {"min": 9}}), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=False)
    assert failed.status == "fail"
    assert failed.reasons[0].startswith("speed_mean")
    assert (tmp_path / failed.log).is_file()
    assert not any((tmp_path / SCRATCH).iterdir())


@pytest.mark.parametrize(("noise", "count"), [(0.0, 1), (0.001, 3)])
def test_runs_are_the_same_whatever_the_seed_where_nothing_is_random(tmp_path, noise, count):
    points = [point(seed, **{"start.position_noise": noise}) for seed in range(3)]
    runs = [(one, perform(one, tmp_path / SCRATCH, tmp_path / LOGS, keep_all=False)) for one in points]
    assert len(facts(runs)) == count


@pytest.mark.parametrize("lost", ["nothing", "its end", "all"])
def test_a_log_that_is_gone_or_cut_is_made_again(tmp_path, lost):
    with Journal(tmp_path, keep_all=True) as journal:
        record = perform(point(), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=True)
        journal.add(point(), record)
    if lost == "its end":
        os.truncate(tmp_path / record.log, 100)
    elif lost == "all":
        (tmp_path / record.log).unlink()
    with Journal(tmp_path, keep_all=True) as journal:
        assert (journal.get(point()) == record) == (lost == "nothing")


@pytest.mark.parametrize(
    ("settings", "status", "reason"),
    [({"gait.steps": "many"}, "refused", "gait.steps"), ({"gait.step_length": 3.0}, "refused", "gait.step_length")],
)
def test_what_cannot_be_run_is_refused(tmp_path, settings, status, reason):
    record = perform(point(0, **settings), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=True)
    assert record.status == status
    assert reason in record.reasons[0]
    assert "\n" not in record.reasons[0]


def test_a_defect_is_told_and_is_no_result(tmp_path):
    record = perform(point(), tmp_path / SCRATCH, tmp_path / LOGS, keep_all=True, run=lambda *_: 1 / 0)
    assert (record.status, record.reasons) == ("broken", ("internal error, ZeroDivisionError: division by zero",))


def test_a_process_that_dies_is_replaced_and_its_run_begun_again(tmp_path):
    made = []

    class Dying(ThreadPoolExecutor):
        def submit(self, function, *arguments):
            if arguments and len(made) == 1:
                raise BrokenProcessPool
            return super().submit(function, *arguments)

    def make():
        made.append(Dying(1))
        return made[-1]

    worker = LocalWorker(tmp_path, False, make)
    assert worker(point()).status == "pass"
    assert len(made) == 2


def end_process(*_):
    os._exit(1)


def test_a_run_that_kills_every_process_is_broken(tmp_path):
    worker = LocalWorker(tmp_path, False, work=end_process)
    record = worker(point())
    worker.close()
    assert record.status == "broken"
    assert record.reasons[0].startswith("its process ended unexpectedly")


def test_ctrl_c_lets_runs_under_way_end_and_begins_no_other(tmp_path):
    asked = []

    def interrupt(_):
        raise KeyboardInterrupt

    cells = [Single(point(seed)) for seed in range(1000)]
    with Journal(tmp_path) as journal:
        with pytest.raises(InterruptedRunsError):
            run_cells(cells, journal, [Counting(asked)], interrupt)
        assert 0 < len(asked) < 1000
        assert all(journal.get(one.point) for one in cells[: len(asked)])


def test_a_full_disk_ends_the_campaign(tmp_path):
    class Full(Journal):
        def add(self, *_):
            raise LogError("no room")

    with Full(tmp_path) as journal, pytest.raises(LogError, match="no room"):
        run_cells(CELLS, journal, [Counting([])])
