"""Skips are counted, and an unexpected one fails the session, in one process and in several."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

TESTS = """
import pytest

def test_that_passes(): ...
@pytest.mark.skip(reason="needs a browser: no chromium and no chromedriver")
def test_a(): ...
@pytest.mark.skip(reason="needs a browser: no chromium and no chromedriver")
def test_b(): ...
"""
OTHERS = {
    "by hand": "def test_c():\n    pytest.skip('not today')\n",
    "no package": "def test_c():\n    pytest.importorskip('no_such_package')\n",
    "nothing to try": "@pytest.mark.parametrize('x', [])\ndef test_c(x): ...\n",
}


def session(folder, text, *options):
    """Exit code and output of a session with the hooks of this folder."""
    (folder / "test_some.py").write_text(text)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "xdist.plugin",
        "-p",
        "skips",
        "-p",
        "no:cacheprovider",
        *options,
        "test_some.py",
    ]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.parametrize("options", [(), ("-n", "2")], ids=["one process", "two"])
def test_skips_that_are_expected_are_counted(tmp_path, options):
    code, out = session(tmp_path, TESTS, *options)
    assert code == 0
    assert "2 skipped" in out
    assert "2 x needs a browser: " in out
    assert "unexpected" not in out


@pytest.mark.parametrize("other", OTHERS)
def test_another_skip_fails_the_session(tmp_path, other):
    code, out = session(tmp_path, TESTS + OTHERS[other])
    assert code == 1
    assert "3 skipped" in out
    assert out.count("unexpected skip: ") == 1


def test_another_skip_fails_a_session_of_several_processes(tmp_path):
    assert session(tmp_path, TESTS + OTHERS["by hand"], "-n", "2")[0] == 1
