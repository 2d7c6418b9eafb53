"""Work of a tick and of a plan in counts, which no busy machine changes; the limits are in `benchmarks/limits.json`."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from needs import KERNELS

from surefoot.native.library import VARIABLE

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
LIMITS = json.loads((ROOT / "benchmarks" / "limits.json").read_text())
LEAST = 0.5
"""Share of a limit below which a count is that of something else, or the limit one that holds nothing."""


@pytest.mark.parametrize("made", ["compiled kernels", "plain Python"])
def test_a_tick_and_a_plan_do_no_more_than_before(made, tmp_path):
    if made == "compiled kernels":
        KERNELS.or_skip()
    told = tmp_path / "counts.json"
    environment = {**os.environ, VARIABLE: "1" if made == "compiled kernels" else "0"}
    command = [sys.executable, "-m", "benchmarks", "counts", "--json", str(told)]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    section = json.loads(told.read_text())["sections"]["counts"]
    assert made in section["note"]
    found, limits = dict(section["rows"]), LIMITS[f"diagonal-walk, {made}"]
    assert set(found) == set(limits)
    assert {name: count for name, count in found.items() if not LEAST * limits[name] < count <= limits[name]} == {}
