"""Commands in environments of others: what the shell or the machine has set does not stop them."""

import json
import os
import subprocess
import sys

import pytest

import surefoot

pytestmark = pytest.mark.unit


def said(folder, *words, **environment):
    """Standard output of a command that ends well, with a cache of its own and nothing on standard error."""
    cache = folder / f"cache-{'-'.join(environment.values())}"
    done = subprocess.run(
        [sys.executable, "-m", "surefoot", *map(str, words)],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, "XDG_CACHE_HOME": str(cache), **environment},
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_an_interpreter_without_docstrings_says_the_same(tmp_path):
    for words in (("schema",), ("list", "--json"), ("show", "walk")):
        assert said(tmp_path, *words, PYTHONOPTIMIZE="2") == said(tmp_path, *words)


@pytest.fixture
def stand(tmp_path):
    """A scenario of half a second, in a file."""
    (tmp_path / "stand.yaml").write_text("gait: {steps: 0}\nduration: 0.4\ncriteria: {fell: false}\n")
    return tmp_path


def test_an_interpreter_without_docstrings_runs_and_judges(stand):
    logs = [json.loads(said(stand, "run", "stand.yaml", "--json", PYTHONOPTIMIZE=level))["log"] for level in ("", "2")]
    before, after = (
        {channel.topic: channel.metadata for channel in surefoot.read(stand / log).contents.channels.values()}
        for log in logs
    )
    assert before["/truth"]["doc"]
    assert after == before
    assert said(stand, "inspect", logs[1], PYTHONOPTIMIZE="2") == said(stand, "inspect", logs[1])


@pytest.mark.parametrize("library", ["wrong", "osmesa"])
def test_a_library_that_draws_is_no_matter_of_runs(stand, library):
    assert json.loads(said(stand, "run", "stand.yaml", "--json", MUJOCO_GL=library))["verdict"] == "pass"
