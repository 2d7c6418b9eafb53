"""A log alone can be run again, and is never replaced by its repetition."""

import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=1", "gait.single_support=0.5", "gait.initial_stand=0.1", "duration=0.5")


@pytest.fixture(scope="module")
def original():
    return load_scenario("diagonal-walk", (*SHORT, "pushes=[{time: 0.1, force: [5, 0, 0]}]", "seed=3"))


@pytest.fixture(scope="module")
def log(original, tmp_path_factory):
    return run_scenario(original, tmp_path_factory.mktemp("runs")).log


def test_the_scenario_comes_back_whole(log, original):
    assert load_scenario(str(log)) == original


def test_settings_still_apply(log):
    again = load_scenario(str(log), ("gait.steps=2", "seed=9"))
    assert (again.gait.steps, again.seed, again.name) == (2, 9, "diagonal-walk")


def test_a_wrong_setting_is_answered_as_for_a_file(log):
    with pytest.raises(ScenarioError, match=r"--set gait\.step: unknown key 'step'"):
        load_scenario(str(log), ("gait.step=2",))


def test_a_log_that_carries_no_scenario(tmp_path):
    path = tmp_path / "bare.mcap"
    with LogWriter(path, {}):
        pass
    with pytest.raises(ScenarioError, match=r"bare.mcap: carries no readable scenario.yaml, so it cannot be run again"):
        load_scenario(str(path))
    with pytest.raises(ScenarioError, match="no such file"):
        load_scenario(str(tmp_path / "none.mcap"))
    (tmp_path / "text.mcap").write_text("hello")
    with pytest.raises(ScenarioError, match="not an MCAP file"):
        load_scenario(str(tmp_path / "text.mcap"))


def test_a_truncated_log_runs_again(log, tmp_path, original):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    assert load_scenario(str(cut)) == original


def test_the_repeated_log_stays(log, original):
    before = log.read_bytes()
    again = run_scenario(load_scenario(str(log)), log.parent.parent).log
    assert again.parent.name == f"{log.parent.name}-2"
    assert log.read_bytes() == before
