"""A scenario file in a folder of tests is a test of pytest."""

import subprocess
import sys

import pytest

from surefoot.scenarios.check.baseline import read_trace
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.source import parse

pytestmark = pytest.mark.unit

GOOD = "fidelity: pendulum\ngait: {steps: 0}\nduration: 0.5\ncriteria: {fell: false}\n"


def pytest_in(folder, *arguments):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *arguments]
    command += [] if "xdist" in arguments else ["-p", "no:xdist"]
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


def test_a_scenario_with_seeds_passes_when_each_of_them_meets_its_criteria(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    noisy = f"{GOOD.replace('steps: 0', 'steps: 1')}sensing: {{com_noise: 0.003}}\nseeds: 3\n"
    (tmp_path / "good.scenario.yaml").write_text(noisy)
    (tmp_path / "bad.scenario.yaml").write_text(noisy.replace("fell: false", "zmp_error_rms: {max: 0.0001}"))
    done = pytest_in(tmp_path)
    assert "1 failed, 1 passed" in done.stdout
    assert "0 of 3 seeds met their criteria" in done.stdout
    assert "seed 2 missed its criteria: zmp_error_rms[0] is" in done.stdout
    assert "Traceback" not in done.stdout


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


def test_a_baseline_with_a_mistyped_ending_and_one_in_place_of_the_folder_are_no_pass(tmp_path):
    from surefoot.scenarios.check.check import cases, strays

    file = tmp_path / "good.scenario.yaml"
    file.write_text(GOOD)
    folder = tmp_path / "baselines"
    (case,) = cases([str(file)])
    assert strays(case) == ()
    folder.symlink_to("nowhere")
    assert strays(case) == (folder,)
    done = pytest_in(tmp_path)
    assert done.returncode == 1
    assert f"{folder}: is no folder of baselines; make it one, or remove it" in done.stdout
    folder.unlink()
    folder.mkdir()
    (folder / "README.md").write_text("what they are")
    assert strays(case) == ()
    (folder / "old").mkdir()
    named = ("good.scenario.baseline.yml", "good.scenario.baseline.YAML", "good.scenario.baseline.json")
    for name in (*named, "old/good.scenario.baseline.yaml"):
        (folder / name).write_text("scenario: good.scenario")
        assert strays(case) == (folder / name,)
        (folder / name).unlink()


def test_an_ending_in_great_letters_or_a_short_one_is_collected_too(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    for name in ("one.scenario.YAML", "Two.Scenario.Yaml", "three.scenario.yml"):
        (tmp_path / name).write_text(GOOD)
    assert "3 passed" in pytest_in(tmp_path).stdout


def test_what_is_named_as_a_scenario_and_is_no_file_fails(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    inner = tmp_path / "inner"
    (inner / "folder.scenario.yaml").mkdir(parents=True)
    (inner / "__init__.py").write_text("")
    (inner / "folder.scenario.yaml" / "test_in.py").write_text("def test_it():\n    pass\n")
    (tmp_path / "dangling.scenario.yaml").symlink_to("nowhere")
    (tmp_path / "good.scenario.yaml").write_text(GOOD)
    (tmp_path / "linked.scenario.yaml").symlink_to("good.scenario.yaml")
    done = pytest_in(tmp_path)
    assert "2 failed, 3 passed" in done.stdout
    assert f"{tmp_path / 'dangling.scenario.yaml'}: is named as a scenario and is a link to nothing" in done.stdout
    assert f"{inner / 'folder.scenario.yaml'}: is named as a scenario and is no regular file" in done.stdout
    assert "Traceback" not in done.stdout
    assert "1 failed, 1 passed" in pytest_in(tmp_path, "inner").stdout


def test_requirements_are_told_in_junit_and_in_a_table_and_what_is_left_out_is_not_run(tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "good.scenario.yaml").write_text(f"{GOOD}requirements: [REQ-7, REQ-8]\n")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "other.scenario.yaml").write_text(f"{GOOD}requirements: [REQ-7]\n")
    done = pytest_in(tmp_path, "--junitxml=found.xml")
    assert "REQ-7  pass: good.scenario (without baseline), other.scenario (without baseline)" in done.stdout
    assert '<property name="requirement" value="REQ-8" />' in (tmp_path / "found.xml").read_text()
    done = pytest_in(tmp_path, "-k", "good")
    assert "1 passed, 1 deselected" in done.stdout
    assert "REQ-7  not run: other.scenario (not run), good.scenario (without baseline)" in done.stdout
    assert "REQ-8  pass: good.scenario (without baseline)" in done.stdout
    done = pytest_in(tmp_path, "-k", "good", "-p", "xdist", "-n", "1")
    assert "REQ-7  not run: other.scenario (not run), good.scenario (without baseline)" in done.stdout


def test_more_values_than_a_file_may_hold_are_refused_before_they_are_composed():
    with pytest.raises(ScenarioError, match=r"^x:1:302: .*more than 100 values"):
        parse("a: [" + 9000 * "1, " + "]", "x", most_values=100)


@pytest.mark.parametrize("name", [[], {}, None, 1.0])
def test_a_trace_whose_column_has_no_word_for_a_name_is_refused(name):
    with pytest.raises(ValueError, match="its trace has columns other than"):
        read_trace([["stage", "foot", name], ["stand", "both", 0.0]])
