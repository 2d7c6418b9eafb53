"""A scenario file in a folder of tests is a test of pytest."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.unit

GOOD = "fidelity: pendulum\ngait: {steps: 0}\nduration: 0.5\ncriteria: {fell: false}\n"


def pytest_in(folder, *arguments):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_it_passes_fails_with_what_was_missed_and_keeps_the_log_of_the_failure(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "good.scenario.yaml").write_text(GOOD)
    (tmp_path / "bad.scenario.yaml").write_text(GOOD.replace("fell: false", "speed_mean: {min: 1.0}"))
    (tmp_path / "ugly.scenario.yaml").write_text("gait: {stepps: 3}\n")
    done = pytest_in(tmp_path)
    assert done.returncode == 1
    assert "2 failed, 1 passed" in done.stdout
    assert "speed_mean is not available, so its bound cannot be checked" in done.stdout
    assert "unknown key 'stepps'" in done.stdout
    assert "Traceback" not in done.stdout
    kept = [path.parent.name for path in (tmp_path / "runs" / "pytest").glob("*/log.mcap")]
    assert kept == ["bad.scenario-0"]


def test_a_baseline_whose_name_matches_no_scenario_fails_the_one_that_has_none(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "good.scenario.yaml").write_text(GOOD)
    (tmp_path / "baselines").mkdir()
    astray = tmp_path / "baselines" / "godo.scenario.baseline.yaml"
    astray.write_text("scenario: godo.scenario\n")
    done = pytest_in(tmp_path)
    assert done.returncode == 1
    assert f"{astray}: is of no scenario beside it; name it good.scenario.baseline.yaml, or remove it" in done.stdout
    (tmp_path / "godo.scenario.yaml").write_text(GOOD)
    assert "1 failed, 1 passed" in pytest_in(tmp_path).stdout
