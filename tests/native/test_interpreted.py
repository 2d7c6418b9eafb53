"""Whole runs: the same modules walk the same way compiled and interpreted."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from needs import COMPILED

from surefoot.native import modules

pytestmark = pytest.mark.physics

WALK = """
import json, sys
import numpy as np
import surefoot
from surefoot.native import modules
keys, file = json.loads(sys.argv[1]), sys.argv[2]
found = []
with surefoot.Simulation(surefoot.load("walk-level", {"gait.initial_stand": 0.2, **keys})) as simulation:
    while simulation.time < 1.4:
        simulation.advance()
        state = simulation.look().state
        found.append(np.concatenate((state.q, state.v)))
np.save(file, found)
print(modules.missing() and "interpreted", surefoot.planner.recovery.capture_margin.__file__)
"""


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """The package without its extension modules."""
    folder = tmp_path_factory.mktemp("interpreted")
    ignored = shutil.ignore_patterns("*.so", "*.pyd", "built*", "__pycache__")
    shutil.copytree(modules.ROOT / "surefoot", folder / "surefoot", ignore=ignored)
    return folder


def walked(folder, tmp_path, keys="{}"):
    """Positions and velocities of a walk from its sensors, tick by tick, and how it was made."""
    file = tmp_path / f"{folder.name}.npy"
    environment = {**os.environ, "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", WALK, keys, str(file)]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return np.load(file), done.stdout.split()


def test_states_of_both_agree_for_more_than_a_second_of_walking(tree, tmp_path):
    COMPILED.or_skip()
    one, (*how, file) = walked(tree, tmp_path)
    assert how == ["interpreted"] and file.endswith(".py")
    other, (*how, file) = walked(modules.ROOT, tmp_path)
    assert how == [] and file.endswith(modules.SUFFIX)
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9)


def test_a_reading_that_is_rounded_shows_no_difference_below_a_bit_and_so_lets_it_grow(tree, tmp_path):
    """A preset's noise has the rounding of its encoders in it: a walk is then the same on every machine."""
    COMPILED.or_skip()
    keys = '{"sensing.encoder_bits": 19, "sensing.encoder_noise": 1e-5}'
    (one, _), (other, _) = walked(tree, tmp_path, keys), walked(modules.ROOT, tmp_path, keys)
    apart = np.abs(one - other).max(axis=1)
    assert apart[100:200].max() < 1e-8
    assert apart[-200:].max() > 1e-6
