"""Hurt robot files end as a robot or in one sentence, soon, in little memory, and never end the program."""

import json
import os
import subprocess
import sys
from pathlib import Path

import needs
import pytest

PROGRAM = Path(__file__).with_name("robots.py")
LONGEST = 2100


def attack(folder, first, count):
    """Outcomes of the robots of some seeds, in a process of their own."""
    command = [sys.executable, PROGRAM, str(first), str(count), folder / "files"]
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}
    told = subprocess.run(command, capture_output=True, text=True, timeout=1200, env=environment)
    found = [json.loads(line) for line in told.stdout.splitlines()]
    after = f"after seed {found[-1]['seed'] if found else None}: {told.stderr[-2000:]}"
    assert (told.returncode, len(found)) == (0, count), after
    for one in found:
        seed, said = one["seed"], one["said"]
        assert one["kind"] != "traceback", f"seed {seed}: {said}"
        assert one["seconds"] < 10.0, f"seed {seed}: {said}"
        assert one["megabytes"] < 1000, f"seed {seed}: {said}"
        if one["kind"] == "refused":
            assert said.isprintable(), f"seed {seed}: {said!r}"
            assert "; " in said[:-3], f"seed {seed} says not what would be right: {said}"
            assert len(said) <= LONGEST, f"seed {seed}: {said}"
    return {one["kind"] for one in found}


@pytest.mark.unit
def test_every_robot_file_of_some_is_a_robot_or_a_sentence(tmp_path):
    assert attack(tmp_path, 0, 40) == {"robot", "refused"}


@pytest.mark.long
@pytest.mark.parametrize("first", range(10_000, 11_000, 100))
def test_every_robot_file_of_many(tmp_path, first):
    assert attack(tmp_path, first, 100) == {"robot", "refused"}


@pytest.mark.unit
@needs.LINUX.mark
def test_the_memory_is_that_of_the_program_alone():
    ask = f"import sys; sys.path.insert(0, {str(PROGRAM.parent)!r}); import robots; print(robots.peak_memory())"
    large = (
        f"import subprocess, sys; held = b'1' * (1 << 29); subprocess.run([sys.executable, '-c', {ask!r}], check=True)"
    )
    told = subprocess.run([sys.executable, "-c", large], capture_output=True, text=True, check=True).stdout
    assert 0 < int(told) < 200
