"""Metrics of standing feet on invented ticks: each sees its own fault, and none where there is none."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge import effort, feet
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.motion_checks import foot_slip
from surefoot.similarity import REFERENCE_SIZE

pytestmark = pytest.mark.unit

RATE, TICKS = 500, 500
LENGTH, WIDTH = 0.22, 0.11
SWING = slice(150, 350)
"""Ticks in which the right foot swings, 0.4 s; it lands at tick 350."""


def quaternion(yaw=0.0, pitch=0.0, roll=0.0):
    """Quaternion x y z w of a yaw, then a pitch, then a roll, each of shape (n,) or a number."""
    halves = [np.asarray(angle) / 2 for angle in (yaw, pitch, roll)]
    (cy, cp, cr), (sy, sp, sr) = ([f(half) for half in halves] for f in (np.cos, np.sin))
    rows = (cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr)
    return np.stack(np.broadcast_arrays(*rows, cy * cp * cr + sy * sp * sr), axis=-1)


class Walk:
    """Arrays of a step of the right foot on flat ground, to be spoilt."""

    def __init__(self):
        self.left = np.tile([0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 1.0], (TICKS, 1))
        self.right = self.left * (1, -1, 1, 1, 1, 1, 1)
        self.right[SWING, 0] = np.linspace(0.0, 0.3, 200)
        self.right[SWING, 2] = 0.05
        self.right[350:, 0] = 0.3
        self.planned = np.ones((TICKS, 2), int)
        self.planned[SWING, 1] = 0
        self.active = self.planned.copy()
        self.force = 490.0 * self.planned
        self.roll = np.zeros((TICKS, 2))
        self.com = np.tile([0.0, 0.0, 0.9], (TICKS, 1))
        self.speed = np.zeros((TICKS, 2))
        self.footstep = [0.3, -0.1, 0.0, 0.0]
        self.boxes = ()
        self.velocity_limit = (10.0, 20.0)
        self.roles = {}

    @property
    def view(self):
        fields = {
            "/truth": {"left_sole": self.left, "right_sole": self.right, "torso_tilt": np.zeros(TICKS),
                       "nonfoot_contact": np.zeros(TICKS), "com": self.com},
            "/contact": {"planned": self.planned, "active": self.active, "normal_force": self.force,
                         "felt": self.force > 20.0},
            "/reference": {"roll": self.roll},
            "/measurement": {"joint_velocity": self.speed},
        }  # fmt: skip
        constants = SimpleNamespace(
            mass=100.0, foot_length=LENGTH, foot_width=WIDTH, control_rate=RATE, boxes=self.boxes, plane=0.0,
            similarity=REFERENCE_SIZE, roles=self.roles,
            velocity_limit=self.velocity_limit, fidelity="full", com_height=0.9,
        )  # fmt: skip
        footstep = _Channel({"foot": [1], "planned": np.array([self.footstep])}, [350])
        return RunView({**{topic: _Channel(of) for topic, of in fields.items()}, "/footstep": footstep}, constants)


class _Channel:
    def __init__(self, fields, ticks=range(TICKS)):
        self._fields = fields
        self.time_ns = np.array(ticks) * 2_000_000
        self.time = self.time_ns / 1e9

    def __len__(self):
        return len(self.time_ns)

    def field(self, name):
        return self._fields[name]


@pytest.fixture
def walk():
    return Walk()


def measured(walk):
    view = walk.view
    return tuple(
        m(view) for m in (feet.foot_slip_max, feet.stance_twist_max, feet.stance_tilt_max, feet.unplanned_flight_time)
    )


def test_a_sound_step_has_neither_slip_nor_twist_nor_tilt_nor_flight(walk):
    assert measured(walk) == (0.0, 0.0, 0.0, 0.0)


def test_a_stance_foot_that_turns(walk):
    """It turns by 0.1 rad about its centre: the corners go 0.1 rad times half the diagonal."""
    walk.right[350:, 3:] = quaternion(yaw=3.1 + np.linspace(0.0, 0.1, 150))
    slip, twist, tilt, _ = measured(walk)
    assert twist == pytest.approx(0.1)
    assert slip == pytest.approx(0.1 * np.hypot(LENGTH, WIDTH) / 2, rel=1e-3)
    assert tilt == pytest.approx(0.0, abs=1e-9)


def test_a_foot_that_turns_in_its_swing_or_unloaded_twists_nothing(walk):
    walk.right[200:, 3:] = quaternion(yaw=0.3)
    walk.force[340:, 1] = 10.0
    assert measured(walk)[:2] == (0.0, 0.0)


def test_a_tilted_stance_foot(walk):
    walk.left[100:200, 3:] = quaternion(pitch=0.05, roll=0.02)
    assert measured(walk)[2] == pytest.approx(np.arccos(np.cos(0.05) * np.cos(0.02)))


def test_a_planned_roll_is_no_tilt_but_what_goes_sideways_is(walk):
    walk.left[100:200, 3:] = quaternion(yaw=0.7, pitch=0.4)
    walk.roll[100:200, 0] = 0.4
    assert measured(walk)[2] == pytest.approx(0.0, abs=1e-9)
    walk.left[150:160, 3:] = quaternion(yaw=0.7, pitch=0.4, roll=0.1)
    assert measured(walk)[2] == pytest.approx(np.arcsin(np.cos(0.4) * np.sin(0.1)))
    walk.roll[:] = walk.roll[:, ::-1]
    assert measured(walk)[2] > 0.4


def test_a_foot_that_no_joint_rolls_tilts_ahead_only_and_lands_where_its_edge_does(walk):
    walk.roles = {"left_leg": ("yaw", "roll", "pitch", "knee", "ankle")}
    walk.left[100:200, 3:] = quaternion(yaw=0.7, roll=-0.2)
    assert measured(walk)[2] == pytest.approx(0.0, abs=1e-9)
    walk.left[100:200, 3:] = quaternion(yaw=0.7, pitch=0.05, roll=-0.2)
    assert measured(walk)[2] == pytest.approx(0.05)
    # The right foot lands leaning outward, on the edge to its right.
    walk.right[:, 3:] = quaternion(roll=0.2)
    walk.right[:, 1:3] += WIDTH / 2 * np.array([np.cos(0.2), np.sin(0.2)])
    assert feet.footstep_error_max(walk.view) == pytest.approx(0.0, abs=1e-9)
    walk.roles = {}
    assert feet.footstep_error_max(walk.view) == pytest.approx(WIDTH / 2)


def test_a_sole_flat_on_sloping_ground_is_not_tilted(walk):
    slope = 0.2
    c, s = np.cos(slope), np.sin(slope)
    walk.boxes = ((0.0, 0.0, 0.0, 2.0, 2.0, 0.1, c, 0, s, 0, 1, 0, -s, 0, c),)
    walk.left[:, 3:] = walk.right[:, 3:] = quaternion(pitch=slope)
    assert measured(walk)[2] == pytest.approx(0.0, abs=1e-9)
    walk.left[:, 3:] = quaternion()
    assert measured(walk)[2] == pytest.approx(slope)


def test_flight_counts_from_the_first_load_on(walk):
    walk.force[:10] = 0.0
    assert measured(walk)[3] == 0.0
    walk.force[200:205] = walk.force[490:] = 0.0
    assert measured(walk)[3] == pytest.approx(15 / RATE)


def test_a_planned_flight_is_none(walk):
    walk.force[200:205] = walk.planned[200:205] = 0
    assert measured(walk)[3] == 0.0


def test_joint_speeds_over_no_load_speeds(walk):
    walk.speed[7] = (-5.0, 30.0)
    assert effort.joint_speed_ratio_max(walk.view) == pytest.approx(1.5)
    walk.velocity_limit = ()
    assert np.isnan(effort.joint_speed_ratio_max(walk.view))


def slid(walk, start, end, way):
    """The right foot slides while it is loaded from one tick to another, and rests from then on."""
    walk.right[start:end, 0] = np.linspace(0.3 - way, 0.3, end - start)
    walk.right[end:, 0] = 0.3
    walk.right[start:, 2] = 0.0
    walk.force[start:, 1] = 490.0


def test_sliding_before_the_planned_touchdown_counts(walk):
    slid(walk, 320, 345, 0.0044)
    assert measured(walk)[0] == pytest.approx(0.0044)
    assert foot_slip(walk.view).value == pytest.approx(0.0044)


def test_what_slips_after_a_fall_is_no_finding_but_is_measured(walk):
    walk.left[450:, 0], walk.com[420:, 2] = 0.2, 0.3
    assert foot_slip(walk.view).value == 0.0
    assert measured(walk)[0] == pytest.approx(0.2)


def test_a_short_dropout_does_not_begin_a_new_stance(walk):
    slid(walk, 320, 345, 0.0044)
    walk.force[325:340, 1] = 0.0
    assert measured(walk)[0] == pytest.approx(0.0044)
    walk.force[400:420, 1] = 0.0
    walk.right[410:, 1] += 0.003
    assert measured(walk)[0] == pytest.approx(np.hypot(0.0044, 0.003))


def test_a_contact_that_is_held_stays_one_however_long_it_is_not_felt(walk):
    """The controller keeps a foot that landed early where it is, whether or not it feels it."""
    slid(walk, 280, 345, 0.0044)
    walk.force[283:346, 1] = 0.0
    assert measured(walk)[0] == 0.0
    walk.active[281:, 1] = 1
    assert measured(walk)[0] == pytest.approx(0.0044)


def test_a_graze_in_the_swing_is_no_touchdown(walk):
    walk.force[290:293, 1] = 100.0
    assert measured(walk)[0] == 0.0


def test_a_foot_that_rolls_over_an_edge_does_not_slip(walk):
    """About its toe edge, by half a radian; the same place of its centre without the pitch has slid."""
    pitch = np.linspace(0.0, 0.5, 50)
    walk.left[100:150, 3:] = quaternion(pitch=pitch)
    walk.left[100:150, 0] += LENGTH / 2 * (1.0 - np.cos(pitch))
    walk.left[100:150, 2] += LENGTH / 2 * np.sin(pitch)
    assert measured(walk)[0] < 1e-4
    walk.left[100:150, 2:] = (0.0, 0.0, 0.0, 0.0, 1.0)
    assert measured(walk)[0] == pytest.approx(LENGTH / 2 * (1.0 - np.cos(0.5)))


def test_a_foot_on_the_edge_of_a_block_counts_by_its_centre(walk):
    walk.boxes = ((0.0, 0.1, -0.1, 0.05, 0.02, 0.15, 1, 0, 0, 0, 1, 0, 0, 0, 1),)
    walk.left[:, 2] = 0.05
    walk.left[100:, 0] = 0.007
    assert measured(walk)[0] == pytest.approx(0.007)


def test_a_footstep_is_measured_where_the_sole_truly_is_not_where_it_is_believed(walk):
    """The invented log does not even say where the controller believes the sole."""
    assert feet.footstep_error_max(walk.view) == pytest.approx(0.0)
    walk.right[350:, 1] -= 0.004
    assert feet.footstep_error_max(walk.view) == pytest.approx(0.004)
    walk.boxes = ((0.3, -0.1, -0.1, 0.13, 0.08, 0.15, 1, 0, 0, 0, 1, 0, 0, 0, 1),)
    assert feet.stair_edge_margin_min(walk.view) == pytest.approx(min(0.13 - LENGTH / 2, 0.08 - 0.004 - WIDTH / 2))
