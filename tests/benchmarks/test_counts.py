"""Work of a tick and of a plan in counts, which no busy machine changes; the limits are in `benchmarks/limits.json`."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from needs import COMPILED

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
LIMITS = json.loads((ROOT / "benchmarks" / "limits.json").read_text())
LEAST = 0.5
"""Share of a limit below which a count is that of something else, or the limit one that holds nothing."""


def test_a_tick_and_a_plan_do_no_more_than_before(tmp_path):
    COMPILED.or_skip()
    told = tmp_path / "counts.json"
    command = [sys.executable, "-m", "benchmarks", "counts", "--json", str(told)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    section = json.loads(told.read_text())["sections"]["counts"]
    assert "compiled" in section["note"]
    found, limits = dict(section["rows"]), LIMITS["diagonal-walk"]
    assert set(found) == set(limits)
    assert {name: count for name, count in found.items() if not LEAST * limits[name] < count <= limits[name]} == {}
