"""A force or moment that the controller counts with is a ghost where nothing pushes, and none where something does."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge.sensed import PUSH_LASTS, ghost_force_max, ghost_moment_max

pytestmark = pytest.mark.unit

RATE, TICKS = 100, 300


def view(believed, pushed):
    """A run of three seconds with a force that is believed, a moment twice as large, and a force that pushes."""
    fields = {
        ("/estimate", "external_force"): believed,
        ("/estimate", "external_moment"): 2.0 * believed,
        ("/measurement", "external_force"): pushed,
    }
    constants = SimpleNamespace(similarity=SimpleNamespace(time=1.0), control_rate=RATE)
    return SimpleNamespace(ticks=TICKS, constants=constants, field=lambda *of: fields[of])


@pytest.mark.parametrize(("ghost", "times"), [(ghost_force_max, 1.0), (ghost_moment_max, 2.0)])
def test_what_nobody_exerts_is_told_and_what_a_push_does_is_not(ghost, times):
    believed, pushed = np.zeros((TICKS, 3)), np.zeros((TICKS, 3))
    assert ghost(view(believed, pushed)) == 0.0
    believed[100] = 3.0, 4.0, 0.0
    assert ghost(view(believed, pushed)) == pytest.approx(5.0 * times)
    pushed[90:95, 0] = 80.0
    assert ghost(view(believed, pushed)) == 0.0
    # What is left of it long after the push is a ghost again.
    believed[94 + round(PUSH_LASTS * RATE)] = 2.0, 0.0, 0.0
    assert ghost(view(believed, pushed)) == pytest.approx(2.0 * times)


def test_where_something_always_pushes_there_is_no_ghost():
    assert ghost_force_max(view(np.full((TICKS, 3), 9.0), np.ones((TICKS, 3)))) == 0.0
