"""Metrics of strides, of a walk whose knees, soles and forces are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge import strides
from surefoot.scenarios.judge.digest import RunView
from surefoot.similarity import REFERENCE_SIZE

pytestmark = pytest.mark.unit

RATE, STEP, DOUBLE, STEPS = 500, 250, 50, 10
TICKS, WEIGHT = (STEPS + 2) * STEP, 100.0 * 9.81


class _Channel:
    def __init__(self, fields):
        self._fields, self.time_ns = fields, np.arange(TICKS) * 2_000_000
        self.time = self.time_ns / 1e9

    def __len__(self):
        return TICKS

    def field(self, name):
        return self._fields[name]


class Walk:
    """Ten steps of half a second, the left foot first, with a tenth of a second of double support after each."""

    def __init__(self, steps=STEPS):
        self.planned, self.knee = np.ones((TICKS, 2), int), np.full((TICKS, 2), 0.5)
        self.sole = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (2, TICKS, 1))
        self.landings, self.leavings = [], []
        for step in range(steps):
            foot, lands = step % 2, (step + 2) * STEP - DOUBLE
            self.planned[(step + 1) * STEP : lands, foot] = 0
            self.landings.append((foot, lands))
            self.leavings.append((foot, (step + 1) * STEP - 1))
        self.force = 0.5 * WEIGHT * self.planned

    def pitched(self, foot, tick, pitch):
        """The sole of a foot pitched at a tick, heel up."""
        self.sole[foot, tick, 3:] = 0.0, np.sin(0.5 * pitch), 0.0, np.cos(0.5 * pitch)

    @property
    def view(self):
        fields = {
            "/truth": {"left_sole": self.sole[0], "right_sole": self.sole[1]},
            "/contact": {"planned": self.planned, "active": self.planned, "normal_force": self.force},
            "/reference": {"roll": np.zeros((TICKS, 2))},
            "/measurement": {"joint_position": self.knee},
        }
        constants = SimpleNamespace(
            mass=100.0, control_rate=RATE, boxes=(), plane=0.0, similarity=REFERENCE_SIZE, foot_length=0.2,
            foot_width=0.1, joint_names=("left_knee", "right_knee"), roles={}, knee_straight=(), knee_turn=(),
        )  # fmt: skip
        return RunView({topic: _Channel(of) for topic, of in fields.items()}, constants)


def test_knees_count_while_their_foot_carries_and_as_it_lands():
    walk = Walk()
    walk.knee[walk.planned == 0] = 1.2
    for foot, tick in walk.landings[3:-3]:
        walk.knee[tick, foot] = 0.2
    assert strides.knee_stance_mean(walk.view) == pytest.approx(0.5, abs=0.003)
    assert strides.knee_heel_strike(walk.view) == pytest.approx(0.2)
    # A foot lands once in two steps; at 30 % of that it stands alone.
    for foot, tick in walk.landings[3:-3]:
        walk.knee[tick + 150, foot] = 0.3
    assert strides.knee_midstance(walk.view) == pytest.approx(0.3)


def test_the_first_and_the_last_three_steps_do_not_count():
    walk = Walk()
    for foot, tick in (*walk.landings[:3], *walk.landings[-3:]):
        walk.knee[tick, foot], walk.force[tick, foot] = 1.0, 5.0 * WEIGHT
        walk.pitched(foot, tick, -0.3)
    assert strides.knee_heel_strike(walk.view) == pytest.approx(0.5)
    assert strides.landing_peak(walk.view) == pytest.approx(0.5)
    assert strides.heel_strike_pitch(walk.view) == pytest.approx(0.0)


def test_a_landing_is_the_first_eighth_of_a_second_of_a_load():
    walk = Walk()
    (foot, tick), (other, later) = walk.landings[4:6]
    walk.force[tick + 30 : tick + 40, foot] = 1.5 * WEIGHT
    walk.force[later + 70, other] = 3.0 * WEIGHT
    assert strides.landing_peak(walk.view) == pytest.approx(1.5)
    assert strides.landing_rate(walk.view) == pytest.approx(100.0)


def test_pitches_are_of_the_first_and_the_last_tick_that_carries():
    walk = Walk()
    for foot, tick in walk.landings:
        walk.pitched(foot, tick, -0.2)
    for foot, tick in walk.leavings:
        walk.pitched(foot, tick, 0.3)
    assert strides.heel_strike_pitch(walk.view) == pytest.approx(0.2)
    assert strides.toe_off_pitch(walk.view) == pytest.approx(0.3)


def test_a_walk_of_few_steps_has_no_steady_ones():
    view = Walk(steps=5).view
    found = [getattr(strides, name)(view) for name in ("knee_stance_mean", "landing_peak", "toe_off_pitch")]
    assert found == [None, None, None]
