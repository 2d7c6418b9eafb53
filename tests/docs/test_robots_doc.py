"""The tutorial of docs/robots.md is walked as it stands, in a folder that is no clone."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"(?s)```sh\n(.*?)\n```", TEXT)


@pytest.mark.unit
def test_the_tutorial_goes_from_a_model_to_a_push_map():
    words = [line.split()[1] for block in COMMANDS for line in block.splitlines()]
    assert words[:2] == ["robot", "robot"] and {"run", "replay", "inspect"} <= set(words)
    assert words[-1] == "sweep"


@pytest.mark.physics
def test_every_command_of_the_tutorial_does_what_it_says(tmp_path):
    """As a shell gives them, one after another; the program is the one under test, whatever is installed."""
    folder = tmp_path / "bin"
    folder.mkdir()
    program = folder / "surefoot"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -P -m surefoot "$@"\n')
    program.chmod(0o755)
    environment = {
        **os.environ,
        "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
    }
    place = tmp_path / "mine"
    place.mkdir()
    for block in COMMANDS:
        done = subprocess.run(
            ["sh", "-e", "-c", block], cwd=place, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"
    verdicts = [json.loads(path.read_text()) for path in sorted(place.glob("runs/walk-*/verdict.json"))]
    assert len(verdicts) == 3 and all(verdict["verdict"] == "pass" for verdict in verdicts)
    assert "</html>" in (place / "walk.html").read_text(encoding="utf-8")[-200:]
    assert (place / "runs" / "push-map" / "report.html").exists()
