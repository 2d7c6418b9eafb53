"""The Python of the README does what it says."""

import importlib.util
import re
from pathlib import Path

import pytest

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
    shown = re.search(r"(?s)<!-- sample: diagonal-walk -->\n```\n(.*?)```", TEXT)[1]
    run = shown.replace("5 to 7 ", "4.21   ")
    assert run != shown
    assert readme.without_clock(run) == shown
    assert readme.updated(TEXT, run) == TEXT.replace(shown, run)
    assert "5 to 7 times real time" in TEXT, "the range of the sample is that of the text"


@pytest.mark.unit
def test_the_examples_are_there_and_on_the_page():
    names = {path.stem for path in (Path(__file__).parents[2] / "examples").glob("*.py")}
    told = re.search(r"(?s)\[examples/\]\(examples\) has short programs.*?\n\n", TEXT)[0]
    assert set(re.findall(r"`(\w+)`", told)) == names
    assert len(names) == 12
