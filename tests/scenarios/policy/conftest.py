"""A policy that stands, and a scenario that it stands in for a while."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from needs import POLICY
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app

STANDS = {
    "name": "held",
    "robot": "g1",
    "duration": 1.2,
    "gait": {"steps": 0, "com_height": 0.67, "step_width": 0.2, "initial_stand": 0.2},
    "criteria": {"fell": False, "foot_slip_max": {"max": 0.02}},
}


@pytest.fixture
def policies():
    """Writes policies, where a machine can run them."""
    POLICY.or_skip()
    import policies

    return policies


@pytest.fixture
def stander(policies, tmp_path) -> Path:
    """The contract of a policy that stands."""
    return policies.stander(tmp_path / "stander")


@pytest.fixture
def scenario(tmp_path):
    """Writes a scenario that a policy stands in."""

    def write(policy: Path | None, name: str = "held.yaml", /, **more) -> Path:
        values = {**STANDS, **more}
        if policy is not None:
            values["controller"] = {"policy": str(policy)}
        file = tmp_path / name
        file.write_text(yaml.safe_dump(values, sort_keys=False))
        return file

    return write


@pytest.fixture
def command(tmp_path, monkeypatch):
    """Runs a command in this process; its exit code and what it says."""
    monkeypatch.chdir(tmp_path)

    def run(*words: str) -> tuple[int, str]:
        done = CliRunner().invoke(app, words)
        return done.exit_code, done.output

    return run


@pytest.fixture
def spawned(tmp_path):
    """Runs a command in a process of its own; its exit code and what it says."""

    def run(*words: str) -> tuple[int, str]:
        environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
        asked = [sys.executable, "-m", "surefoot", *words]
        done = subprocess.run(asked, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return run
