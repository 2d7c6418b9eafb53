"""Each key of the schema goes through pickle, a process of its own, ``run``, ``check`` and ``sweep``."""

import pickle

import pytest
import yaml
from every_key import NOT_YET, SCENARIOS, given, keys

from surefoot.scenarios.check.check import cases, check, run_case
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.log import read
from surefoot.scenarios.many.engine import local_workers
from surefoot.scenarios.many.journal import Journal, outcome_of
from surefoot.scenarios.many.points import Base, Point, Single
from surefoot.scenarios.many.slots import run_cells
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.setup.load import load, written


@pytest.fixture
def files(tmp_path):
    """A file of every scenario."""
    found = [tmp_path / f"{name}.yaml" for name in SCENARIOS]
    for path, values in zip(found, SCENARIOS.values(), strict=True):
        path.write_text(yaml.safe_dump(values))
    return [str(path) for path in found]


def dumped(scenario):
    return type(scenario).__name__, scenario.model_dump()


@pytest.mark.unit
def test_they_give_every_key_there_is():
    wanted = {key for key in keys(Scenario) if key not in NOT_YET} - {"name"}
    assert {key for values in SCENARIOS.values() for key in given(values)} == wanted


@pytest.mark.unit
def test_each_is_itself_after_a_way_between_processes(files):
    scenarios = [load(file) for file in files]
    assert [pickle.loads(pickle.dumps(scenario)) for scenario in scenarios] == scenarios
    with processes() as pool:
        assert list(pool.map(dumped, scenarios)) == [dumped(scenario) for scenario in scenarios]


@pytest.mark.physics
def test_each_is_run_checked_and_swept_to_a_verdict(files, tmp_path):
    chosen = cases(files)
    here = [run_case(case, tmp_path / "run") for case in chosen]
    verdicts = {"without baseline", "failed"}
    assert {one.case.reference: one.reasons for one in here if one.status not in verdicts} == {}
    for one in here:
        assert scenario_of(read(one.log)).model_dump() == one.case.scenario.model_dump()

    checked = check(chosen, tmp_path / "check", jobs=2)
    assert [(one.status, one.reasons) for one in checked] == [(one.status, one.reasons) for one in here]

    points = [Point(Base(file, written(file)), {"seed": 1}, {}, f"run-{n}") for n, file in enumerate(files)]
    with Journal(tmp_path / "sweep") as journal:
        run_cells(map(Single, points), journal, local_workers(tmp_path / "sweep", 2, keep_all=False))
        runs = [outcome_of(Single(point), journal).runs for point in points]
    assert {record.status for ((_, record),) in runs} <= {"pass", "fail"}, runs
