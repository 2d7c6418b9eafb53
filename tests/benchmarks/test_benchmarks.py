"""The benchmark scripts run; what they measure is for people to read."""

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.physics

FOLDER = Path(__file__).parents[2] / "benchmarks"
SHORT = ["--scenario", "stand", "--set", "duration=0.5"]


@pytest.mark.parametrize(
    ("script", "arguments", "told"),
    [
        ("control_tick.py", SHORT, "real-time factor"),
        ("qp_solvers.py", SHORT, "daqp"),
        ("log_reader.py", ["--tries", "1"], "median"),
        ("planner_tick.py", ["--steps", "1"], "cached"),
        ("recovery_tick.py", ["--tries", "1", "--set", "fidelity=pendulum", "--set", "rates.control=50"], "adapting"),
    ],
)
def test_a_benchmark_runs(script, arguments, told):
    done = subprocess.run([sys.executable, FOLDER / script, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert told in done.stdout
