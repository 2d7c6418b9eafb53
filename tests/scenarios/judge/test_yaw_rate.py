"""The drift of the estimated heading, of a run whose heading is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge.sensed import SETTLED, estimation_yaw_rate

pytestmark = pytest.mark.unit


def view(off, time):
    constants = SimpleNamespace(similarity=SimpleNamespace(time=1.0))
    return SimpleNamespace(time=time, constants=constants, field=lambda topic, name: off)


def test_it_is_the_mean_after_the_estimate_has_settled_whatever_it_is_off_at_first():
    time = np.arange(0.0, 60.5, 0.5)
    rate = np.radians(0.1) / 60.0
    drifted = np.where(time < SETTLED, 1.0, 0.3 - rate * (time - SETTLED))
    assert estimation_yaw_rate(view(drifted, time)) == pytest.approx(rate)
    assert estimation_yaw_rate(view(np.full_like(time, 0.2), time)) == 0.0
    # Past half a turn it goes on.
    turned = (np.pi - 0.01 + 2.0 * rate * time + np.pi) % (2.0 * np.pi) - np.pi
    assert estimation_yaw_rate(view(turned, time)) == pytest.approx(2.0 * rate)


def test_a_run_that_ends_before_that_has_none():
    time = np.array([0.0, 0.4])
    assert estimation_yaw_rate(view(np.zeros(2), time)) is None


def test_a_run_whose_time_stands_still_has_none():
    assert estimation_yaw_rate(view(np.zeros(3), np.full(3, 2.0 * SETTLED))) is None
