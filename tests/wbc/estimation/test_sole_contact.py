"""The contact of a sole with the ground, by wrenches with noise and bias."""

import numpy as np
import pytest

from surefoot.readings import Reading
from surefoot.wbc.estimation.contact import SoleContact, sprung
from surefoot.wbc.estimation.parameters import ContactDetection, SensorNoise

pytestmark = pytest.mark.unit

PERIOD, WEIGHT, HALF = 0.002, 981.0, (0.1, 0.05)
GOOD, POOR = SensorNoise(), SensorNoise(wrench_force=20.0, wrench_bias=20.0, wrench_moment=0.5)


class Feet:
    """Two feet whose sensors have noise and a bias."""

    def __init__(self, sensors=GOOD, seed=1, bias=None, force=8.0):
        self.rng, self.sensors = np.random.default_rng(seed), sensors
        self.bias = sensors.wrench_bias * self.rng.normal(size=(2, 6)) if bias is None else bias
        self.contact = SoleContact(ContactDetection(force=force), sensors, WEIGHT, HALF, PERIOD)
        self.update(0.5, 0.5)

    def update(self, left, right, above=(0.0, 0.0), rolling=-1, cop=0.0, beside=0.0, ticks=1, edge=0):
        """Load the feet with shares of the weight; says after how many ticks the left one was felt.

        The CoP of the left one is so far ahead and beside of its centre, in half sizes of the sole.
        """
        felt = None
        for tick in range(ticks):
            wrench = np.zeros((2, 6))
            wrench[:, 2] = WEIGHT * left, WEIGHT * right
            wrench[0, 3], wrench[0, 4] = beside * HALF[1] * wrench[0, 2], -cop * HALF[0] * wrench[0, 2]
            noise = np.repeat([self.sensors.wrench_force, self.sensors.wrench_moment], 3)
            said = wrench + self.bias + noise * self.rng.normal(size=(2, 6))
            self.contact.update(Reading(said, 0.0, True), [k != rolling for k in (0, 1)], np.array(above), (edge, 0))
            if felt is None and self.contact.felt[0]:
                felt = tick + 1
        return felt


@pytest.mark.parametrize("sensors", [GOOD, POOR])
def test_a_swing_tares_the_sensor_and_feels_nothing(sensors):
    feet = Feet(sensors)
    feet.update(0.0, 1.0, ticks=40)
    assert feet.update(0.0, 1.0, above=(0.05, 0.0), ticks=30000) is None or sensors is POOR
    np.testing.assert_allclose(feet.contact.wrench[0] - 0.0, 0.0, atol=4.0 * sensors.wrench_force)
    assert feet.contact.tared[0] > 1.0 > feet.contact.tared[1]
    tare = feet.contact.tare[0] - feet.bias[0]
    assert np.abs(tare[:3]).max() < 0.5 * sensors.wrench_force
    # Both must have swung before no bias is left in what both feel.
    assert feet.contact.bias == pytest.approx(sensors.wrench_bias, rel=0.01)
    feet.update(1.0, 0.0, ticks=40)
    feet.update(1.0, 0.0, above=(0.0, 0.05), ticks=200)
    assert 0.0 < feet.contact.bias < 0.2 * sensors.wrench_bias


def swung(sensors=GOOD, **how):
    feet = Feet(sensors, **how)
    feet.update(0.0, 1.0, ticks=40)
    feet.update(0.0, 1.0, above=(0.05, 0.0), ticks=300)
    return feet


def test_a_touch_is_felt_soon_and_a_light_one_when_it_lasts():
    assert swung().update(0.06, 0.94, ticks=20) <= 4
    assert swung(POOR).update(0.10, 0.90, ticks=50) <= 8
    light = swung(POOR).update(0.045, 0.955, ticks=100)
    assert light is not None and light <= 60


@pytest.mark.parametrize("said", [12.0, 15.0, -15.0])
def test_what_a_sensor_says_that_was_never_tared_is_no_touch_unless_it_is_more_than_a_bias(said):
    """Two deviations of that are; a foot that has swung high enough is felt by what would be a bias."""
    sensors, bias = SensorNoise(wrench_force=0.1, wrench_bias=20.0, wrench_moment=0.01), np.zeros((2, 6))
    bias[0, 2] = said
    feet = Feet(sensors, bias=bias)
    feet.update(0.0, 1.0, ticks=40)
    assert not feet.contact.felt[0]
    assert feet.update(0.0, 1.0, ticks=400) is None
    assert feet.update(0.08, 0.92, ticks=40) is not None
    feet = Feet(sensors, bias=bias)
    feet.update(0.0, 1.0, ticks=40)
    feet.update(0.0, 1.0, above=(0.05, 0.0), ticks=2000)
    assert feet.update(0.02, 0.98, ticks=40) is not None


def test_a_touch_near_the_ground_is_not_tared_away():
    feet = swung()
    feet.update(0.02, 0.98, above=(0.001, 0.0), ticks=2000)
    assert feet.contact.wrench[0, 2] == pytest.approx(0.02 * WEIGHT, abs=12.0)
    high = swung(force=400.0)
    high.update(0.02, 0.98, above=(0.05, 0.0), ticks=2000)
    assert abs(high.contact.wrench[0, 2]) < 12.0


def test_no_sensor_is_tared_while_nothing_carries_the_robot():
    """A robot that is let down, or jumps, may touch with either foot next."""
    for carried, tares in ((0.3, False), (0.5, True)):
        feet = Feet()
        feet.update(0.0, carried, ticks=40)
        feet.update(0.0, carried, above=(0.05, 0.0), ticks=100)
        assert (feet.contact.tared[0] > 0.0) == tares


@pytest.mark.parametrize("blow", [-0.08, -0.3])
def test_a_blow_from_above_or_before_is_no_bias(blow):
    """As of a toe that strikes the riser of a step: it is no touch of the sole, and would be read as one when over."""
    feet = swung()
    feet.update(blow, 1.0, above=(0.05, 0.0), ticks=30)
    assert feet.update(0.0, 1.0, above=(0.05, 0.0), ticks=100) is None
    assert abs(feet.contact.wrench[0, 2]) < 12.0


def test_hysteresis_holds_a_contact():
    feet = swung()
    feet.update(0.5, 0.5, ticks=50)
    share = 0.75 * feet.contact.threshold / WEIGHT
    feet.update(share, 1.0 - share, ticks=20)
    assert feet.contact.felt[0]
    feet.update(0.0, 1.0, ticks=20)
    assert not feet.contact.felt[0]
    feet.update(share, 1.0 - share, ticks=5)
    assert not feet.contact.felt[0]


def test_a_foot_on_its_edge_or_rolling_or_hardly_loaded_does_not_stand_still():
    for given, firm in (
        ({}, True),
        ({"cop": 0.97}, False),
        ({"cop": 0.6}, True),
        ({"beside": 0.97}, False),
        ({"beside": 0.6}, True),
        ({"rolling": 0}, False),
    ):
        feet = swung()
        feet.update(0.3, 0.7, ticks=30, **given)
        assert feet.contact.felt == [True, True]
        assert feet.contact.firm == [firm, True], given
    feet = swung()
    feet.update(0.05, 0.95, ticks=30)
    assert feet.contact.felt[0] and feet.contact.firm == [False, True]


def test_a_foot_that_rolls_over_its_toes_stands_still_on_their_edge_if_it_is_loaded_there():
    for given, firm in (
        ({"cop": 0.97}, True),
        ({"cop": 0.0}, True),
        ({"cop": -0.97}, False),
        ({"cop": 0.97, "beside": 0.97}, False),
        ({"cop": 0.97, "rolling": 0}, False),
    ):
        feet = swung()
        feet.update(0.3, 0.7, ticks=30, edge=1, **given)
        assert feet.contact.firm == [firm, True], given
    feet = swung()
    feet.update(0.05, 0.95, ticks=30, cop=0.97, edge=1)
    assert feet.contact.firm == [False, True]


@pytest.mark.parametrize("cop", [-0.97, 0.0, 0.97])
def test_a_foot_that_comes_down_on_its_heel_is_still_once_it_is_flat_or_carries_alone(cop):
    feet = swung()
    feet.update(0.3, 0.7, ticks=30, edge=-1, cop=cop)
    assert feet.contact.firm == [False, True]
    feet.update(0.3, 0.7, ticks=30, cop=0.0)
    assert feet.contact.firm == [True, True]
    feet.update(1.0, 0.0, ticks=30, edge=-1, cop=cop)
    assert feet.contact.firm == [True, False]


def test_the_last_contact_stands_whatever_its_edge():
    feet = Feet()
    feet.update(1.0, 0.0, cop=0.97, rolling=0, ticks=60)
    assert feet.contact.firm == [True, False]


@pytest.mark.parametrize("sensors", [GOOD, POOR])
def test_a_force_that_grows_evenly_acted_when_its_age_says(sensors):
    feet, latency, slope = Feet(sensors, bias=np.zeros((2, 6))), 0.003, np.array([1000.0, 5000.0])
    for tick in range(100):
        wrench = np.zeros((2, 6))
        wrench[:, 2] = 100.0 + slope * (tick * PERIOD - latency)
        feet.contact.update(Reading(wrench, latency, True), [True, True], np.zeros(2))
    assert feet.contact.age > latency + 0.0005
    np.testing.assert_allclose(feet.contact.wrench[:, 2], 100.0 + slope * (99 * PERIOD - feet.contact.age), atol=1e-6)


def test_a_sole_on_springs_under_its_corners_moves_until_they_bear_the_change():
    half, give, rng = (0.11, 0.05), 2.5e-7, np.random.default_rng(2)
    changed = rng.normal(size=(2, 6)) * 100.0
    roll, pitch, rises = sprung(changed, half, give).T
    corners = np.array([[x * half[0], y * half[1]] for x in (-1, 1) for y in (-1, 1)])
    for k in (0, 1):
        # A corner at x, y of a sole that rolls and pitches rises by y times roll less x times pitch.
        high = rises[k] + corners[:, 1] * roll[k] - corners[:, 0] * pitch[k]
        force = -high / (4.0 * give)
        found = [force.sum(), force @ corners[:, 1], -force @ corners[:, 0]]
        np.testing.assert_allclose(found, changed[k, [2, 3, 4]], rtol=1e-12)


@pytest.mark.parametrize("edge", [1, -1])
def test_an_edge_sinks_as_the_sole_does_there_and_turns_at_will(edge):
    """Under a force at its edge alone a sole goes down there as far, by its pitch and by its height, as the edge."""
    half, give = (0.11, 0.05), 2.5e-7
    changed = np.zeros((2, 6))
    changed[:, 2], changed[:, 4] = 100.0, -100.0 * edge * half[0]
    (_, pitch, rises), (_, turned, sinks) = sprung(changed, half, give, (0, edge))
    assert sinks == pytest.approx(rises - edge * half[0] * pitch) and sinks < 0.0
    assert turned == 0.0 != pitch


@pytest.mark.parametrize("noise", [2.0, 20.0])
def test_a_contact_is_felt_from_as_many_deviations_on_as_was_asked_for(noise):
    """Deviations are those of the force as it is filtered, of white noise."""
    sensors = SensorNoise(wrench_force=noise, wrench_bias=0.0, wrench_moment=0.01)
    feet, loads = Feet(sensors), []
    for _ in range(20000):
        feet.update(0.5, 0.5)
        loads.append(feet.contact.wrench[:, 2].copy())
    numbers = ContactDetection(force=8.0)
    assert feet.contact.threshold - numbers.force == pytest.approx(numbers.certain * np.std(loads[100:]), rel=0.05)
