"""What another package brings: found by its entry point alone, and as good as our own."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

WALK = ["diagonal-walk", "--set", "gait.steps=2", "--json"]


@pytest.fixture
def surefoot(tmp_path):
    """The command line of a user who has installed a package with a robot in it."""
    site = tmp_path / "site"
    metadata = site / "disguised-1.0.dist-info"
    metadata.mkdir(parents=True)
    shutil.copy(Path(__file__).with_name("disguised.py"), site)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: disguised\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text("[surefoot.robots]\ndisguised = disguised:DISGUISED\n")
    path = os.pathsep.join([str(site), *filter(None, [os.environ.get("PYTHONPATH")])])

    def run(*arguments):
        command = [sys.executable, "-m", "surefoot", *arguments]
        environment = {**os.environ, "PYTHONPATH": path}
        return subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=120)

    return run


@pytest.mark.unit
def test_a_robot_is_listed_beside_ours(surefoot):
    listed = surefoot("list").stdout.splitlines()
    assert listed[-2:] == ["robot     humanoid100", "robot     disguised"]


@pytest.mark.physics
def test_a_robot_whose_names_tell_nothing_walks_by_its_roles(surefoot):
    done = surefoot("run", *WALK, "--set", "robot=disguised")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["verdict"], found["steps_taken"]) == ("pass", 2)
