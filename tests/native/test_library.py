"""The library: built from its sources, known by them, laid out as its header says, and never needed."""

import os
import platform
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from needs import COMPILER

from surefoot.native.build import BASELINE, FLAGS, FOLDER, LIBRARY
from surefoot.native.library import VARIABLE, library

pytestmark = pytest.mark.unit


@pytest.fixture
def checkout(tmp_path):
    """A checkout with the sources alone."""
    shutil.copytree(FOLDER, tmp_path / "surefoot" / "native", ignore=shutil.ignore_patterns(LIBRARY.name, "__*__"))
    for name in ("__init__.py", "__main__.py"):
        shutil.copy(FOLDER / name, tmp_path / "surefoot" / "native")
    shutil.copy(FOLDER.parent / "values.py", tmp_path / "surefoot")
    (tmp_path / "surefoot" / "__init__.py").touch()
    (tmp_path / "pyproject.toml").touch()
    return tmp_path


def say(folder: Path, **changed: str) -> tuple[str, str]:
    """What ``python -m surefoot.native`` says there, on its two outputs."""
    environment = {**os.environ, "PYTHONPATH": str(folder), VARIABLE: "1", **changed}
    command = [sys.executable, "-m", "surefoot.native"]
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0
    return done.stdout, done.stderr


def test_a_checkout_builds_its_library_and_rebuilds_a_stale_one(checkout):
    COMPILER.or_skip()
    built, source = checkout / "surefoot" / "native" / LIBRARY.name, checkout / "surefoot" / "native" / "rows.c"
    assert say(checkout) == (f"compiled kernels: {built}\n", "")
    first = built.read_bytes()
    assert say(checkout, CC="false") == (f"compiled kernels: {built}\n", "")
    source.write_text(source.read_text() + "/* A change. */\n")
    assert say(checkout) == (f"compiled kernels: {built}\n", "")
    assert built.read_bytes() != first


@pytest.mark.parametrize("flags", ["", "-O1 -DODD='a b'"])
def test_a_library_says_how_it_was_made(checkout, flags):
    """By which compiler and with which flags, also those of ``CC``: other ones give other bits."""
    COMPILER.or_skip()
    say(checkout, CC=f"cc {flags}")
    tell = "from surefoot.native.library import library; print(library().made)"
    environment = {**os.environ, "PYTHONPATH": str(checkout), VARIABLE: "1"}
    done = subprocess.run(
        [sys.executable, "-c", tell], env=environment, cwd=checkout, capture_output=True, text=True, check=True
    )
    compiler, version, *told = shlex.split(done.stdout)
    assert compiler in ("gcc", "clang")
    assert version[0].isdigit()
    assert " ".join(told).endswith(" ".join((*shlex.split(flags), *FLAGS, *BASELINE.get(platform.machine(), ()))))


def test_a_stale_library_that_cannot_be_rebuilt_is_told_once_and_not_used(kernels, checkout):
    shutil.copy(LIBRARY, checkout / "surefoot" / "native")
    assert LIBRARY.name in say(checkout, CC="false")[0]
    (checkout / "surefoot" / "native" / "rows.c").open("a").write("\n")
    out, err = say(checkout, CC="false")
    assert out == "plain Python, slower, since there is no library: 'false' fails\n"
    assert err == f"{LIBRARY.name} is of other sources and is not used: there is no library: 'false' fails\n"


@pytest.mark.parametrize("compiler", ["false", "no-such-compiler", ""])
def test_without_a_compiler_plain_python_runs_without_a_warning(checkout, compiler):
    out, err = say(checkout, CC=compiler)
    assert out.startswith("plain Python, slower, since there is no ")
    assert err == ""
    assert not (checkout / "surefoot" / "native" / LIBRARY.name).exists()


def test_plain_python_can_be_asked_for(checkout, monkeypatch):
    assert say(checkout, **{VARIABLE: "0"}) == (f"plain Python, since {VARIABLE} is 0\n", "")
    monkeypatch.setenv(VARIABLE, "0")
    assert library() is None
