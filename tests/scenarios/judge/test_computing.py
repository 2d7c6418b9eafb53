"""Growth of memory is measured after the first minute, against what the process holds by then."""

import resource
from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge.computing import memory_growth
from surefoot.scenarios.record.walk import resident_memory

pytestmark = pytest.mark.unit


def run(memory):
    channel = SimpleNamespace(
        time=np.arange(len(memory), dtype=float), field=lambda name: np.array(memory, dtype=float)
    )
    return SimpleNamespace(log={"/process": channel})


@pytest.mark.parametrize(
    ("memory", "growth"),
    [
        ([1.0] * 60 + [2.0] * 60, 0.0),  # what a run needs once does not count
        ([2.0] * 61 + [2.0, 2.5, 2.2], 0.25),  # the most that it holds does
        ([2.0] * 61, None),
        ([2.0] * 10, None),
        ([2.0] * 61 + [np.nan], None),  # what the system did not tell is not measured
    ],
)
def test_growth(memory, growth):
    assert memory_growth(run(memory)) == growth


def test_memory_is_that_of_this_process():
    """At least what it holds, at most what it ever held; what other tests give back meanwhile does not matter."""
    held = np.ones(100_000_000 // 8)
    assert held.nbytes < resident_memory() <= 1.01 * 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
