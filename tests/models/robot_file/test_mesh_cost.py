"""The cost of an MJCF of very many triangles: the time of a process of its own, and its memory."""

import os
import subprocess
import sys

import pytest
from mjcf_biped import DRAWN, meshed

pytestmark = pytest.mark.long

COST = """
import resource, sys, time
from surefoot.models import explain
explain(sys.argv[1])
print(time.process_time(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


@pytest.mark.parametrize(("kind", "rings", "count"), [("stl", 500, 1), ("stl", 500, 100), ("obj", 440, 1)])
def test_dense_meshes_of_an_mjcf_cost_seconds_and_less_than_a_gigabyte(tmp_path, kind, rings, count) -> None:
    """A million triangles that are all on their hull took 1.4 GB."""
    file = meshed(tmp_path, rings, *[DRAWN, 'mass="0"'] * count, kind=kind)
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    run = subprocess.run(
        [sys.executable, "-c", COST, file], env=environment, capture_output=True, text=True, check=True
    )
    seconds, megabytes = map(float, run.stdout.split())
    assert seconds < 10.0
    assert megabytes < 1000.0
