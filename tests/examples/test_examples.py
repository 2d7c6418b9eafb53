"""The examples run as they stand, wherever they are put, and are short enough to be read."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples"
TOLD = {
    "run_and_read": "ZMP error",
    "step_and_push": "stands at",
    "live_commands": "walked again the same: True",
    "planner_alone": "next footsteps",
    "controller_alone": "status SOLVED",
    "weights_and_gains": "of the limit",
    "own_law": "default <Result pass",
    "own_task": "walked with the neck turned",
    "own_metric": "the CoM sways",
    "own_estimator": "estimation error 2.00 mm",
    "own_loop": "walked 0.38 m",
    "own_plant": "<Result pass",
}


@pytest.mark.unit
def test_every_example_is_tested_and_has_at_most_forty_lines():
    lines = {path.stem: len(path.read_text().splitlines()) for path in FOLDER.glob("*.py")}
    assert set(lines) == set(TOLD)
    assert max(lines.values()) <= 40, lines


@pytest.mark.unit
def test_examples_are_typed_as_a_users_script_is():
    command = [sys.executable, "-m", "mypy", "--strict", *sorted(FOLDER.glob("*.py"))]
    done = subprocess.run(command, capture_output=True, text=True, cwd=FOLDER.parent)
    assert done.returncode == 0, done.stdout


SOON = ("run_and_read", "planner_alone", "controller_alone", "own_loop", "own_plant")
"""Examples that run at every change; the others with the long tests."""


@pytest.mark.physics
@pytest.mark.parametrize(
    "name", [name if name in SOON else pytest.param(name, marks=pytest.mark.long) for name in TOLD]
)
def test_an_example_runs_beside_files_named_as_our_parts(name, tmp_path):
    for part in ("models", "sim", "planner", "wbc", "scenarios", "studies", "apps"):
        (tmp_path / f"{part}.py").write_text("raise ImportError('the wrong one')\n")
    script = shutil.copy(FOLDER / f"{name}.py", tmp_path)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd=tmp_path, timeout=120)
    assert done.returncode == 0, done.stderr
    assert TOLD[name] in done.stdout
