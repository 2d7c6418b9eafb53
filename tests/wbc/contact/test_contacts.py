from dataclasses import replace

import numpy as np
import pytest

from surefoot.wbc.contact.contacts import ContactParameters, ContactSchedule
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import FootSensing

pytestmark = pytest.mark.unit

WEIGHT, PERIOD = 981.0, 0.002


def reference(**changes) -> WbcReference:
    zero = np.zeros(3)
    standing = WbcReference(
        com=np.array([0, 0, 1.0]), com_velocity=zero, com_acceleration=zero, zmp=np.zeros(2),
        zmp_offset=np.zeros(2), omega=3.13, stiffness=9.81, heading=0.0, heading_rate=0.0,
        planned_contact=(True, True), load_share=(0.5, 0.5),
        time_to_switch=np.inf, lifting_foot=-1, swing_foot=-1, swing_progress=0.0, swing_position=zero,
        swing_velocity=zero, swing_acceleration=zero, swing_rotation=np.eye(3),
        swing_angular_velocity=zero, swing_angular_acceleration=zero, ground_normal=np.tile([0.0, 0.0, 1.0], (2, 1)),
    )  # fmt: skip
    return replace(standing, **changes)


def swinging(progress: float) -> WbcReference:
    return reference(planned_contact=(True, False), swing_foot=1, swing_progress=progress, load_share=(1.0, 0.0))


@pytest.fixture
def schedule() -> ContactSchedule:
    return ContactSchedule(ContactParameters(), WEIGHT, PERIOD)


def test_the_plan_lifts_a_foot(schedule):
    state = schedule.update(swinging(0.0), FootSensing((900.0, 50.0)))
    assert state.active == (True, False)
    assert state.force_cap[1] == 0.0


def test_the_last_contact_is_never_released(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    flight = reference(planned_contact=(False, True), swing_foot=0)
    assert schedule.update(flight, FootSensing((900.0, 0.0))).active == (True, False)


def test_early_touchdown_makes_a_light_contact(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    for _ in range(3):
        state = schedule.update(swinging(0.9), FootSensing((900.0, 60.0)))
    assert state.active == (True, True)
    assert state.force_cap[1] == ContactParameters().early_cap
    assert state.landing == (False, False)  # it has come to rest already


def test_a_foot_that_comes_to_the_ground_before_the_next_tick_is_a_contact_once_it_may_land(schedule):
    coming = FootSensing((900.0, 0.0), touching=(False, True))
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    assert schedule.update(swinging(0.2), coming).active == (True, False)
    assert schedule.update(swinging(0.9), FootSensing((900.0, 0.0))).active == (True, False)
    assert schedule.update(swinging(0.9), coming).active == (True, True)
    # It stays one: nothing may be felt of it for a tick.
    assert schedule.update(swinging(0.95), FootSensing((900.0, 0.0))).active == (True, True)


def test_load_grows_only_once_the_foot_is_felt(schedule):
    """A foot that counts as landed while it is in the air carries nothing: the other foot has to carry the robot."""
    landed, cap = reference(lifting_foot=0, time_to_switch=0.5), ContactParameters().early_cap
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    state = schedule.update(landed, FootSensing((900.0, 0.0), touching=(False, True)))
    assert state.active == (True, True)
    for _ in range(10):
        state = schedule.update(landed, FootSensing((900.0, 0.0)))
        assert (state.force_cap, state.landing) == ((3 * WEIGHT, cap), (False, True))
    caps = [schedule.update(landed, FootSensing((900.0, 60.0))).force_cap[1] for _ in range(5)]
    assert caps[0] == cap < caps[-1]
    assert schedule.update(landed, FootSensing((900.0, 60.0))).landing == (False, False)
    # Nor does the load go back where the foot lifts for a tick.
    assert schedule.update(landed, FootSensing((900.0, 0.0))).force_cap[1] > caps[-1]


def test_a_scuff_in_early_swing_is_no_contact(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    for _ in range(5):
        state = schedule.update(swinging(0.2), FootSensing((900.0, 60.0)))
    assert state.active == (True, False)
    assert state.felt == (True, True)


def test_a_spike_of_one_tick_is_not_felt(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    assert schedule.update(swinging(0.9), FootSensing((900.0, 500.0))).active == (True, False)


def test_a_late_foot_waits_for_the_ground(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    landed = reference(lifting_foot=0, time_to_switch=0.5)
    assert schedule.update(landed, FootSensing((900.0, 0.0))).active == (True, False)
    for _ in range(2):
        state = schedule.update(landed, FootSensing((900.0, 100.0)))
    assert state.active == (True, True)


def test_load_grows_after_touchdown_and_fades_before_lift_off(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0)))
    caps = []
    for i in range(250):
        share = max(0.0, 1.0 - i / 200)
        now = reference(lifting_foot=0, time_to_switch=0.5 - i * PERIOD, load_share=(share, 1.0 - share))
        caps.append(schedule.update(now, FootSensing((600.0, 300.0))).force_cap)
    loading, unloading = np.array([c[1] for c in caps[2:]]), np.array([c[0] for c in caps])
    assert (np.diff(loading) >= 0).all()
    assert loading[-1] == 3 * WEIGHT
    assert np.abs(np.diff(loading)).max() < 0.2 * WEIGHT
    assert unloading[-1] < 0.03 * WEIGHT


def test_contacts_that_an_estimator_decided_are_taken_whatever_the_forces_say(schedule):
    schedule.update(swinging(0.0), FootSensing((900.0, 0.0), contact=(True, False)))
    assert schedule.update(swinging(0.9), FootSensing((900.0, 300.0), contact=(True, False))).felt == (True, False)
    state = schedule.update(swinging(0.9), FootSensing((900.0, 0.0), contact=(True, True)))
    assert state.felt == (True, True) and state.active == (True, True)


def test_contacts_that_stay_as_they_are_are_the_same_object(schedule):
    first = schedule.update(swinging(0.1), FootSensing((900.0, 0.0)))
    assert schedule.update(swinging(0.2), FootSensing((850.0, 1.0))) is first
    schedule.weight = 2.0 * WEIGHT
    assert schedule.update(swinging(0.2), FootSensing((850.0, 1.0))) is not first


def test_an_unloading_foot_may_take_its_planned_share_and_less_beside_it_the_sooner_it_lifts(schedule):
    numbers = ContactParameters()
    for left in (1.0, 0.5, 0.0):
        now = reference(lifting_foot=0, time_to_switch=left * numbers.unloading_time, load_share=(0.4, 0.6))
        most = schedule.update(now, FootSensing((400.0, 580.0))).force_cap[0]
        assert most == pytest.approx(WEIGHT * (0.4 + left * numbers.share_margin))
