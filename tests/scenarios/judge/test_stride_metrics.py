"""Metrics of strides, of a walk whose knees, soles and forces are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge import people, strides
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


def test_toe_clearance_is_that_of_the_toe_edge_in_the_middle_of_a_swing():
    walk = Walk()
    walk.sole[:, :, 2] = 0.05
    foot, lands = walk.landings[5]
    middle = lands - 100
    walk.sole[foot, middle, 2] = 0.03
    assert strides.toe_clearance_min(walk.view) == pytest.approx(0.03)
    # A heel that is up leaves its toes lower, by half the length of the sole times the sine of the pitch.
    walk.pitched(foot, middle, 0.1)
    assert strides.toe_clearance_min(walk.view) == pytest.approx(0.03 - 0.1 * np.sin(0.1), abs=1e-6)
    # One that is down is not lower at its toes, and what is near a landing is no clearance.
    walk.pitched(foot, middle, -0.1)
    walk.sole[foot, lands - 10, 2] = 0.0
    assert strides.toe_clearance_min(walk.view) == pytest.approx(0.03 + 0.1 * np.sin(0.1), abs=1e-6)


NAMES = ("hip_yaw", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")


class Person(Walk):
    """Legs that move as people's means do, or as given; with hips and ankles of any sign and zero."""

    def __init__(self, flexion=None, hip=(1.0, 0.0), ankle=1.0, lean=0.0):
        super().__init__()
        mean = people.people()[0] if flexion is None else flexion
        self.joints = np.zeros((TICKS, 2 * len(NAMES)))
        turn, rng = np.array([0.0, np.sin(0.5 * lean), 0.0, np.cos(0.5 * lean)]), np.random.default_rng(0)
        self.q = np.column_stack((np.zeros((TICKS, 3)), np.tile(turn, (TICKS, 1))))
        for foot in (0, 1):
            lands = next(tick for side, tick in self.landings if side == foot)
            share = ((np.arange(TICKS) - lands) / (2.0 * STEP)) % 1.0
            H, K, D = (np.interp(share, np.arange(101) / 100.0, (*row, row[0])) for row in mean)
            own = slice(len(NAMES) * foot, len(NAMES) * (foot + 1))
            yaw, roll = 0.02 * rng.normal(size=(2, TICKS))
            self.joints[:, own] = np.column_stack((yaw, hip[0] * H + hip[1], K, ankle * D, roll))
            self.sole[foot, :, 4] = np.sin(0.5 * (lean + K - H - D))
            self.sole[foot, :, 6] = np.cos(0.5 * (lean + K - H - D))

    @property
    def view(self):
        view = super().view
        view.log["/truth"]._fields["q"], view.log["/measurement"]._fields["joint_position"] = self.q, self.joints
        sides = [[f"{side}_{name}" for name in NAMES] for side in ("left", "right")]
        view.constants.joint_names = (*sides[0], *sides[1])
        view.constants.roles = dict(zip(("left_leg", "right_leg"), sides, strict=True))
        return view


@pytest.mark.parametrize("how", [{}, {"hip": (-1.0, 0.3)}, {"ankle": -1.0, "lean": 0.2}], ids=str)
def test_legs_that_move_as_peoples_do_are_like_theirs_whatever_turns_them(how):
    view = Person(**how).view
    assert people.human_correlation(view) == pytest.approx([1.0, 1.0, 1.0], abs=0.01)
    share = people.human_share(view)
    # An ankle's zero is known as well as that of the hip is.
    assert share[:2] == [1.0, 1.0] and (share[2] == 1.0 or how.get("hip"))


def test_a_crouch_is_like_people_in_its_hips_alone():
    """The knees and ankles are bent by 40 and 25 degrees more; its curves have the shape of people's."""
    mean = people.people()[0]
    view = Person(mean + np.radians([[65.0], [40.0], [25.0]])).view
    assert people.human_share(view)[0] == 1.0
    assert max(people.human_share(view)[1:]) < 0.05
    assert people.human_correlation(view) == pytest.approx([1.0, 1.0, 1.0], abs=0.01)
    plateau = np.stack((mean[0], np.full(100, 0.8) + 0.1 * np.sin(np.arange(100) * np.pi / 50.0), -mean[2]))
    shares, shapes = people.human_share(Person(plateau).view), people.human_correlation(Person(plateau).view)
    assert shares[1] < 0.4 and abs(shapes[1]) < 0.9 and shapes[2] == pytest.approx(-1.0, abs=0.01)


def test_legs_that_do_not_fit_together_are_not_judged():
    person = Person()
    person.joints[:, 3] = np.random.default_rng(1).normal(size=TICKS)
    assert people.human_share(person.view) is None and people.human_correlation(person.view) is None
    few = Person()
    few.planned[:] = 1
    assert people.human_share(few.view) is None
