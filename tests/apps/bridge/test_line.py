"""A line that is late or loses some: by the numbers asked for, the same for each seed, in the plant's time."""

import numpy as np
import pytest

from surefoot.apps.bridge.line import Disturbance, Line
from surefoot.errors import ParameterError
from surefoot.joints import JointCommand

pytestmark = pytest.mark.unit

PERIOD, TICKS = 0.002, 5000


def command(tick):
    return JointCommand(np.full(2, float(tick)))


def passage(**how):
    """Ticks whose states get to the controller, and by tick that which the newest command answers."""
    line, told, answered, newest = Line(Disturbance(**how)), [], [], -1
    for tick in range(TICKS):
        now = tick * PERIOD
        if line.carries_state(now):
            told.append(tick)
            line.send(now, tick, command(tick))
        arrived = line.arrived(now)
        if arrived is not None:
            assert arrived[1].torque[0] == arrived[0]
            newest = max(newest, arrived[0])
        answered.append(newest)
    return np.array(told), np.array(answered)


def test_an_undisturbed_line_is_at_once():
    told, answered = passage()
    assert np.array_equal(told, np.arange(TICKS))
    assert np.array_equal(answered, np.arange(TICKS))


def test_a_delay_is_that_of_every_command():
    _, answered = passage(delay=0.01)
    assert np.array_equal(answered[5:], np.arange(TICKS)[:-5])
    assert (answered[:5] == -1).all()


def test_jitter_comes_on_top_and_what_is_overtaken_counts_no_more():
    _, answered = passage(delay=0.004, jitter=0.006)
    age = np.arange(TICKS) - answered
    assert (np.diff(answered) >= 0).all()
    assert (age[10:].min(), age[10:].max()) == (3, 5)


def test_a_share_gets_lost_both_ways():
    told, answered = passage(drop=0.05)
    assert len(told) / TICKS == pytest.approx(0.95, abs=0.015)
    assert np.unique(answered).size / len(told) == pytest.approx(0.95, abs=0.015)


def test_a_pause_is_once_in_each_second():
    told, _ = passage(pause=0.04)
    gaps = np.diff(told)
    assert (gaps > 1).sum() == TICKS * PERIOD
    assert (gaps[gaps > 1] == 21).all()
    begin = told[:-1][gaps > 1] * PERIOD
    assert np.array_equal(np.floor(begin), np.arange(10))
    assert np.unique(np.round(begin % 1.0, 3)).size == 10


def test_the_seed_is_all_that_chance_follows_from():
    how = {"delay": 0.004, "jitter": 0.005, "drop": 0.1, "pause": 0.02}
    same = [passage(**how, seed=7) for _ in range(2)]
    other = passage(**how, seed=8)
    assert all(np.array_equal(one, again) for one, again in zip(*same, strict=True))
    assert not np.array_equal(same[0][0], other[0])


@pytest.mark.parametrize("how", [{"delay": -1.0}, {"drop": 1.1}, {"pause": 2.0}, {"jitter": float("nan")}])
def test_what_no_line_does_is_refused(how):
    with pytest.raises(ParameterError, match=r"; use 0 to "):
        Disturbance(**how)
