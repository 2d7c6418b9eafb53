"""The Python of the README does what it says."""

import importlib.util
import math
import re
from pathlib import Path

import pytest
import yaml

from surefoot.models import RobotOptions, describe

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def block(heading):
    """The first Python block below a heading."""
    return re.search(rf"(?s)\n## {heading}\n.*?```python\n(.*?)```", TEXT)[1]


@pytest.mark.physics
def test_from_python_runs_as_it_stands(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, names = block("From Python"), {}
    assert len(code.splitlines()) <= 20
    exec(code, names)
    result, com, tick, sim = (names[name] for name in ("result", "com", "tick", "sim"))
    assert result.verdict.passed
    assert com.shape == (round(tick.time * 500) + 1, 3)
    assert not sim.fell
    assert abs(com[-1] - tick.com).max() > 1e-6, "the push has left no trace"
    assert capsys.readouterr().out.splitlines()[-1].startswith("walked <Tick")


@pytest.fixture(scope="module")
def readme():
    spec = importlib.util.spec_from_file_location("readme", ROOT / "docs" / "readme.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.physics
def test_the_sample_is_what_a_run_prints(readme):
    assert readme.sample() in TEXT, "run python docs/readme.py"


@pytest.mark.unit
def test_only_the_wall_clock_is_left_out_of_the_sample(readme):
    shown = re.search(r"(?s)<!-- sample: walk -->\n```\n(.*?)```", TEXT)[1]
    run = shown.replace("4 to 5 ", "4.21   ")
    assert run != shown
    assert readme.without_clock(run) == shown
    assert readme.updated(TEXT, run) == TEXT.replace(shown, run)
    assert "4 to 5 times real time" in TEXT, "the range of the sample is that of the text"


@pytest.mark.unit
def test_the_examples_are_there_and_on_the_page():
    names = {path.stem for path in (Path(__file__).parents[2] / "examples").glob("*.py")}
    told = re.search(r"(?s)\[examples/\]\(examples\) has short programs.*?\n\n", TEXT)[0]
    assert set(re.findall(r"`(\w+)`", told)) == names
    assert len(names) == 12


def catalogue(name):
    return yaml.safe_load((ROOT / "scenarios" / "catalogue" / f"{name}.yaml").read_text(encoding="utf-8"))


def modules_of(name):
    """A module of tests of runs."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "tests" / "scenarios" / "run" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def numbers_of(rows):
    return {what: [float(one) for one in re.findall(r"\d+(?:\.\d+)?", told)] for what, told in rows.items()}


@pytest.mark.unit
def test_what_walks_has_the_numbers_of_the_scenarios_and_tests():
    part = TEXT.split("## What walks")[1].split("##")[0]
    told = numbers_of(dict(re.findall(r"(?m)^\| ([a-z ]+) \| (.*) \|$", part)))
    lasting = modules_of("test_lasting_forces")
    stairs = (ROOT / "tests" / "scenarios" / "run" / "test_stair_walks.py").read_text(encoding="utf-8")
    small = re.search(r'"single"\), tuple\(product\(\((.*?)\), .*\n\)\ndef test_small_feet', stairs)[1]
    up, tall, blocks = (catalogue(name) for name in ("stairs-up", "stairs-tall", "blocks"))
    step = up["gait"]["single_support"] + up["gait"]["double_support"]
    angles = [math.degrees(one["terrain"]["angle"]) for one in (catalogue("slope"), blocks)]
    assert told["flat ground"] == [catalogue("walk-fast")["criteria"]["speed_mean"]["min"]]
    assert told["stairs"] == [2.0]
    assert "def test_treads_two_centimetres_off_are_found" in stairs
    feet = 100.0 * catalogue("stair-climbing")["robot_options"]["foot_length"]
    assert told["risers"] == pytest.approx(
        [float(small.split()[-1]), feet, up["terrain"]["riser"], step, *told["risers"][-2:]]
    )
    assert told["risers"][-2:] == [tall["terrain"]["riser"], tall["terrain"]["tread"]]
    assert told["rough ground"] == pytest.approx([angles[0], 100.0 * blocks["terrain"]["riser"], angles[1]], abs=0.03)
    noise, height = catalogue("paper-noise")["sensing"]["zmp_noise"], catalogue("paper-height-error")["errors"]
    assert told["wrong beliefs"] == [200.0 * noise, height["com_height"]]
    assert min(lasting.SCALES) == 0.75
    assert told["lasting force"] == [lasting.HELD["natural gait"]]
    assert lasting.LASTING == 2.0
    natural = modules_of("test_push_tables").NATURAL[1]
    speed = natural["gait.step_length"] / (natural["gait.single_support"] + natural["gait.double_support"])
    assert f"in a walk at {speed:.2f} m/s" in TEXT


@pytest.mark.unit
def test_robots_have_the_masses_of_the_gallery():
    gallery = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8").split("## Gallery")[1]
    masses = dict(re.findall(r"(?m)^\| `(\w+)` \| (\d+) kg \|", gallery))
    told = re.findall(r"(?m)^\| ([A-Z][^|]*|`humanoid100`) \| ([\d, ]+) kg \|", TEXT)
    named = {
        re.sub(r"\W", "", name).lower(): mass
        for names, found in told
        for name, mass in zip(names.split(", "), found.split(", "), strict=True)
    }
    assert named.pop("humanoid100") == f"{describe('humanoid100', RobotOptions()).mass:.0f}"
    assert named == masses
