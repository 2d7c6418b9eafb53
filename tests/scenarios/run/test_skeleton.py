"""The loop of a run around a walker that does nothing: when pushes are given, when it ends, and where its time goes."""

import time
from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.forces import Push
from surefoot.planner.types import PhaseInfo, PhaseKind
from surefoot.scenarios.record.provenance import AFTER_FALL
from surefoot.scenarios.run.skeleton import ClosedLoop, run_loop
from surefoot.scenarios.run.tick import Spent
from surefoot.scenarios.setup.groups.gait import PushPoint

pytestmark = pytest.mark.unit

RATE = 100
SPENT = Spent(0.25, 0.5, 2.0, 4.0)


class Idle:
    """A walker in the double support before its first step, which lasts for a second; it falls at a tick, or never."""

    planning = None

    def __init__(self, falls=-1):
        self.pushed, self._falls, self._now = [], falls, 0.0

    @property
    def gait(self):
        return self._now, PhaseInfo(PhaseKind.DOUBLE, None, 0, self._now, 1.0, 1, 1.0 - self._now)

    def sense(self, tick, now):
        self._now, self._tick = now, tick
        return tick

    def control(self, tick, now):
        return None, SPENT

    def fallen(self, sample):
        return self._tick == self._falls

    def push(self, push):
        self.pushed.append((self._tick, push))

    def nothing(self, *_):
        return None

    record = draw = advance = nothing


def loop(walker, pushes=(), duration=1.0):
    """The loop, and what is recorded of it: the timing of each tick, and pushes that began."""
    timing, begun = [], []
    recorder = SimpleNamespace(
        timing=lambda now_ns, took: timing.append(took), begun=lambda push, live: begun.append(push)
    )
    return ClosedLoop(walker, recorder, RATE, duration, pushes), timing, begun


def at(fraction, lasts=0.1):
    """A push at a share of that double support, which is promised to act to its end."""
    return PushPoint(1, PhaseKind.DOUBLE, fraction), Push(0.0, lasts, np.array([50.0, 0.0, 0.0]))


@pytest.mark.parametrize(
    ("fraction", "tick", "begins"),
    [(0.0, 0, 0.0), (0.5, 49, 0.5), (0.507, 50, 0.507), (0.5 + 1e-9, 49, 0.5), (0.51, 50, 0.51)],
)
def test_a_push_is_given_in_the_tick_that_ends_where_it_begins_or_in_which_it_does(fraction, tick, begins):
    walker = Idle()
    one, _, begun = loop(walker, [at(fraction)])
    run_loop(one, lambda progress: None)
    ((given, push),) = walker.pushed
    assert given == tick
    assert push.time == pytest.approx(begins, abs=1e-8)
    assert begun == [push]
    assert one.end.kind == "completed"


@pytest.mark.parametrize(("lasts", "kind"), [(0.2, "completed"), (0.7, "completed"), (0.7001, "fault"), (0.8, "fault")])
def test_a_run_is_no_pass_whose_push_would_have_lasted_beyond_its_end(lasts, kind):
    one, _, _ = loop(Idle(), [at(0.3, lasts)])
    end = run_loop(one, lambda progress: None)
    assert (end.kind, end.time) == (kind, 1.0)
    assert ("cut off" in end.reason) is (kind == "fault")


def test_a_run_goes_on_for_a_while_after_a_fall_within_its_time():
    for falls, ticks in ((10, 10 + round(AFTER_FALL * RATE)), (290, 300)):
        one, _, _ = loop(Idle(falls), duration=3.0)
        end = run_loop(one, lambda progress: None)
        assert (end.kind, end.time) == ("fall", falls / RATE)
        assert one.tick == ticks


def test_the_time_of_a_tick_is_shared_out_among_what_it_went_to(monkeypatch):
    """The clock is a second later whenever it is looked at."""
    looks = iter(range(1, 1000))
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(looks)))
    monkeypatch.setattr(time, "thread_time_ns", lambda: 1_000_000_000 * next(looks))
    one, timing, _ = loop(Idle())
    for _ in range(3):
        one.step()
    for state, build, solve, plan, simulated, logged, whole, busy in timing:
        assert (plan, build, solve) == SPENT[1:]
        assert state == SPENT.state + 2.0
        assert busy == 2.0
        assert (simulated, logged, whole) == (1.0, 1.0, 6.0)


def test_progress_tells_how_many_times_as_fast_as_the_clock_on_the_wall_it_is(monkeypatch):
    clock = SimpleNamespace(now=100.0)
    monkeypatch.setattr(time, "perf_counter", lambda: clock.now)
    one, _, _ = loop(Idle())
    one.walker.advance = lambda now: setattr(clock, "now", clock.now + 0.5 / RATE)
    told = []
    run_loop(one, told.append)
    assert [progress.time for progress in told] == pytest.approx(np.arange(1, 11) / 10)
    assert [progress.real_time_factor for progress in told] == pytest.approx([2.0] * 10)
    assert {progress.phase for progress in told} == {"double support"}
