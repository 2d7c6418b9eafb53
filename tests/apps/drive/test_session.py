"""A session with invented robots on an invented clock: it keeps real time by leaving out pictures, never ticks."""

import itertools
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from surefoot.apps.drive.session import (
    COMMAND_PERIOD,
    PUSH_TIME,
    DriveStatus,
    GaitInput,
    Inputs,
    PaceInput,
    PushInput,
    Reset,
    Session,
)
from surefoot.errors import ParameterError
from surefoot.planner.types import Twist
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.run.skeleton import End

pytestmark = pytest.mark.unit

PERIOD = 0.002


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class DrivenRobot:
    """Each tick takes a time of its own; everything that is done to it is noted with its simulated time."""

    def __init__(self, clock: Clock, cost: float, falls_at: float = 1e9) -> None:
        self._clock, self._cost, self._falls_at = clock, cost, falls_at
        self.ticks, self.told, self.closed = 0, [], False

    @property
    def time(self) -> float:
        return self.ticks * PERIOD

    @property
    def done(self) -> bool:
        return self.time >= self._falls_at

    @property
    def end(self) -> End:
        return End("fall", self.time, "fell") if self.done else End("completed", 1e9)

    def advance(self) -> None:
        assert not self.closed
        if self.done:
            raise RunFault("the run is over")
        self.ticks += 1
        self._clock.now += self._cost

    def look(self) -> Any:
        if not self.ticks:
            raise RunFault("there is no tick to look at yet")
        return SimpleNamespace(time=self.time - PERIOD)

    def push(self, force: Any, duration: float = 0.1, body: str | None = None) -> None:
        if body == "nobody":
            raise ParameterError(("body",), "unknown body 'nobody'", "push another one")
        self.told.append((self.time, "push", tuple(force), duration, body))

    def command(self, **keys: float) -> None:
        if keys.get("single_support", 1.0) < 0.1:
            raise ParameterError(("command", "single_support"), "too short", "take longer")
        self.told.append((self.time, "command", keys))

    def close(self) -> None:
        self.closed = True


class DriveView:
    """Each picture takes a time of its own."""

    def __init__(self, clock: Clock, cost: float) -> None:
        self._clock, self._cost = clock, cost
        self.begun, self.pushes, self.drawn, self.looked_at = 0, [], True, True
        self.shown: list[tuple[float, DriveStatus]] = []

    def begin(self, robot: Any) -> None:
        self.begun += 1

    def pushed(self, push: PushInput, time: float) -> None:
        self.pushes.append((push, time))

    def show(self, tick: Any, status: DriveStatus) -> None:
        self.shown.append((self._clock.now, status))
        self._clock.now += self._cost


class Drive:
    def __init__(
        self, tick: float = 0.0008, picture: float = 0.005, falls_at: float = 1e9, looked_at: bool = True
    ) -> None:
        self.clock = Clock()
        self.robots: list[DrivenRobot] = []
        self.page, self.inputs = DriveView(self.clock, picture), Inputs()
        self.page.looked_at = looked_at

        def begin() -> DrivenRobot:
            self.robots.append(DrivenRobot(self.clock, tick, falls_at))
            return self.robots[-1]

        self.session = Session(begin, self.page, self.inputs, self.clock)

    @property
    def robot(self) -> DrivenRobot:
        return self.robots[-1]

    @property
    def status(self) -> DriveStatus:
        return self.page.shown[-1][1]

    def go_on(self, seconds: float) -> None:
        end = self.clock.now + seconds
        while self.clock.now < end:
            rest = self.session.advance()
            self.clock.now += rest + 1e-6


def test_it_keeps_step_with_the_clock_and_shows_thirty_pictures_a_second():
    drive = Drive()
    drive.go_on(10.0)
    assert drive.robot.time == pytest.approx(10.0, abs=0.02)
    assert 27 * 10 <= len(drive.page.shown) <= 30 * 10 + 1
    assert drive.status.note == ""
    assert drive.status.pace == pytest.approx(1.0, abs=0.02)


def test_pictures_are_left_out_before_time_is_lost():
    """The ticks take 0.9 of the time; thirty pictures would take 0.6 of it."""
    drive = Drive(tick=0.9 * PERIOD, picture=0.02)
    drive.go_on(20.0)
    assert drive.robot.time == pytest.approx(20.0, abs=0.2)
    assert len(drive.page.shown) < 20 * 6
    assert drive.status.note == ""


def test_a_browser_that_draws_slowly_gets_few_pictures_which_leaves_it_less_to_draw():
    drive = Drive()
    drive.page.drawn = False
    drive.go_on(10.0)
    assert 10 * 4 < len(drive.page.shown) <= 10 * 5 + 1
    assert drive.robot.time == pytest.approx(10.0, abs=0.02)


def test_a_machine_that_is_too_slow_is_told_of_and_still_shows_pictures():
    drive = Drive(tick=1.25 * PERIOD, picture=0.001)
    drive.go_on(10.0)
    assert drive.robot.time == pytest.approx(8.0, rel=0.02)
    assert drive.status.note == "the machine is too slow: 0.8 x real time"
    assert len(drive.page.shown) > 10 * 4
    assert drive.status.pace == pytest.approx(0.8, abs=0.02)


def test_after_a_long_halt_it_does_not_rush():
    drive = Drive()
    drive.go_on(1.0)
    drive.clock.now += 30.0
    drive.go_on(1.0)
    assert drive.robot.time == pytest.approx(2.0, abs=0.05)


def test_it_stands_still_when_paused():
    drive = Drive()
    drive.go_on(1.0)
    drive.inputs.put(PaceInput(paused=True))
    drive.go_on(0.1)
    ticks = drive.robot.ticks
    drive.go_on(5.0)
    assert drive.robot.ticks == ticks
    assert drive.status.paused
    drive.inputs.put(PaceInput(paused=False))
    drive.go_on(1.0)
    assert drive.robot.ticks - ticks == pytest.approx(500, abs=20)


def test_slow_motion_is_as_slow_as_asked_for():
    drive = Drive()
    drive.inputs.put(PaceInput(speed=0.25))
    drive.go_on(8.0)
    assert drive.robot.time == pytest.approx(2.0, abs=0.02)
    assert drive.status.pace == pytest.approx(0.25, abs=0.01)


def test_a_command_is_given_once_between_ticks_and_no_more_often_than_may_be():
    drive = Drive()
    drive.go_on(1.0)
    for speed in range(40):
        drive.inputs.put(Twist(0.01 * speed))
        drive.go_on(0.02)
    drive.go_on(1.0)
    times = [time for time, *_ in drive.robot.told]
    assert len(times) <= 10
    assert all(b - a >= COMMAND_PERIOD - 1e-9 for a, b in itertools.pairwise(times))
    assert drive.robot.told[-1][2] == {"v_x": 0.39, "v_y": 0.0, "yaw_rate": 0.0}
    drive.inputs.put(Twist(0.39))
    drive.go_on(1.0)
    assert len(drive.robot.told) == len(times)


def test_a_stop_does_not_wait():
    drive = Drive()
    drive.inputs.put(Twist(0.3))
    drive.go_on(0.03)
    drive.inputs.put(Twist())
    drive.go_on(0.03)
    (first, *_), (second, _, keys) = drive.robot.told
    assert second - first < COMMAND_PERIOD
    assert keys == {"v_x": 0.0, "v_y": 0.0, "yaw_rate": 0.0}


def test_the_gait_alone_leaves_the_velocity_as_it_is():
    drive = Drive()
    drive.inputs.put(GaitInput(swing_height=0.07))
    drive.go_on(0.5)
    drive.inputs.put(GaitInput(single_support=0.6))
    drive.go_on(0.5)
    assert [keys for _, _, keys in drive.robot.told] == [{"swing_height": 0.07}, {"single_support": 0.6}]


def test_a_gait_that_is_refused_does_not_take_a_stop_with_it():
    drive = Drive()
    drive.inputs.put(Twist(0.3))
    drive.go_on(0.5)
    for given in (GaitInput(single_support=0.05), Twist()):
        drive.inputs.put(given)
    drive.go_on(0.5)
    assert [keys["v_x"] for _, _, keys in drive.robot.told] == [0.3, 0.0]
    assert drive.status.note == "too short; take longer"


def test_a_run_that_ends_in_its_first_tick_waits_for_a_reset():
    drive = Drive(falls_at=0.0)
    drive.go_on(0.5)
    assert drive.page.shown == []
    drive.inputs.put(Reset())
    drive.go_on(0.1)
    assert len(drive.robots) == 2


def test_a_push_has_its_impulse_and_is_shown():
    drive = Drive()
    drive.go_on(0.5)
    drive.inputs.put(push := PushInput((3.0, -2.0, 0.0), "torso"))
    drive.go_on(0.1)
    ((time, kind, force, duration, body),) = drive.robot.told
    assert (kind, body) == ("push", "torso")
    assert [part * duration for part in force] == pytest.approx([3.0, -2.0, 0.0])
    assert duration == PUSH_TIME
    assert drive.page.pushes == [(push, time)]


def test_what_is_refused_is_said_and_not_shown_as_done():
    drive = Drive()
    drive.inputs.put(PushInput((1.0, 0.0, 0.0), "nobody"))
    drive.go_on(0.1)
    assert drive.status.note == "unknown body 'nobody'; push another one"
    assert drive.page.pushes == []
    drive.inputs.put(Twist(0.1))
    drive.go_on(0.1)
    assert drive.status.note == ""


def test_a_reset_ends_the_run_and_begins_another_that_stands_with_the_gait_as_it_was_set():
    drive = Drive()
    for given in (Twist(0.3), GaitInput(swing_height=0.07)):
        drive.inputs.put(given)
    drive.go_on(1.0)
    drive.inputs.put(Reset())
    drive.go_on(1.0)
    first, second = drive.robots
    assert first.closed
    assert not second.closed
    assert [keys for _, _, keys in second.told] == [{"swing_height": 0.07}]
    assert second.time == pytest.approx(1.0, abs=0.05)
    assert (drive.page.begun, drive.status.run) == (2, 2)
    drive.session.close()
    assert second.closed


def test_after_a_fall_it_waits_for_a_reset():
    drive = Drive(falls_at=0.5)
    drive.go_on(2.0)
    drive.inputs.put(Twist(0.3))
    drive.inputs.put(PushInput((1.0, 0.0, 0.0), "torso"))
    drive.go_on(1.0)
    assert drive.robot.time == pytest.approx(0.5)
    assert drive.robot.told == []
    assert drive.status.over
    assert drive.status.note == "it has fallen at 0.5 s: reset it (R)"
    drive.inputs.put(Reset())
    drive.go_on(0.3)
    assert len(drive.robots) == 2
    assert drive.status == replace(drive.status, over=False, note="", run=2)


def test_it_runs_until_it_is_stopped():
    drive, rounds = Drive(), iter(range(5))
    slept = []
    drive.session.run(lambda: next(rounds) == 3, slept.append)
    assert len(slept) == 3


def test_the_first_run_waits_until_somebody_looks_and_others_do_not() -> None:
    drive = Drive(looked_at=False)
    drive.inputs.put(Twist(0.3, 0.0, 0.0))
    for _ in range(100):
        drive.clock.now += 0.1
        drive.session.advance()
    assert drive.robot.ticks == 1
    drive.page.looked_at = True
    drive.session.advance()
    begin = drive.clock.now
    while drive.clock.now < begin + 1.0:
        drive.clock.now += max(drive.session.advance(), 1e-4)
    assert drive.robot.time == pytest.approx(1.0, abs=0.05)  # the time before is not caught up
    drive.page.looked_at = False
    drive.inputs.put(Reset())
    drive.session.advance()
    drive.clock.now += 0.5
    drive.session.advance()
    assert drive.robot.ticks > 1


def test_inputs_that_go_on_coming_do_not_hold_up_a_run() -> None:
    drive, taken = Drive(), []
    take = drive.session._take

    def again(given: Any) -> None:
        taken.append(given)
        drive.inputs.put(given)
        take(given)

    drive.session._take = again
    drive.inputs.put(PaceInput(speed=1.0))
    drive.session.advance()
    assert len(taken) == 1
