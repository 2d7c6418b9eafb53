"""The joint observer against motions whose truth is known."""

import numpy as np
import pytest

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.joints import JointObserver

pytestmark = pytest.mark.unit

PERIOD, RATE = 0.002, 6.0


def readings(position, late=0, fresh=True, velocity=None):
    """Readings of encoders, so many ticks late."""
    nothing = Reading(np.zeros(3), 0.0, True)
    told = Reading(np.atleast_1d(position), late * PERIOD, fresh)
    speed = None if velocity is None else Reading(np.atleast_1d(velocity), late * PERIOD, fresh)
    return Readings(0.0, told, speed, nothing, nothing, nothing, nothing, None)


def motion(tick):
    """Position, velocity and mean acceleration until the next tick, of a swing of 6 rad/s."""
    t = tick * PERIOD
    following = np.cos(RATE * (t + PERIOD)) * RATE
    return np.sin(RATE * t), RATE * np.cos(RATE * t), (following - RATE * np.cos(RATE * t)) / PERIOD


def followed(late=0, told=True, noise=0.0, lost=0.0, ticks=3000, bandwidth=80.0):
    """Errors of position and velocity at each tick."""
    observer, rng, found = JointObserver(1, PERIOD, bandwidth, max(noise, 1e-9)), np.random.default_rng(1), []
    held, age = 0, 0
    for tick in range(ticks):
        at = max(tick - late, 0)
        if not lost or rng.random() > lost:
            fresh, held = at > held or tick == 0, at
        else:
            fresh = False
        age = tick - held
        q, qd = observer.update(readings(motion(held)[0] + noise * rng.normal(), age, fresh))
        true = motion(tick)
        found.append((q[0] - true[0], qd[0] - true[1]))
        if told:
            observer.drive(np.array([true[2]]))
    return np.array(found)[500:]


def test_follows_what_is_told_without_lag_however_late_and_lost():
    for late, lost in ((0, 0.0), (3, 0.0), (3, 0.3)):
        errors = np.abs(followed(late, lost=lost)).max(axis=0)
        assert errors[0] < 2e-5 and errors[1] < 2e-3, (late, lost, errors)
    # A swing that is not told is followed with a lag.
    assert np.abs(followed(3, told=False)).max(axis=0)[1] > 0.1


def test_noise_of_a_velocity_is_as_told():
    for bandwidth in (20.0, 60.0):
        noise = 1e-4
        observer = JointObserver(1, PERIOD, bandwidth, noise)
        errors = followed(noise=noise, ticks=20000, bandwidth=bandwidth)
        assert errors[:, 1].std() == pytest.approx(observer.rate_noise, rel=0.1)


def test_coarse_encoders_are_followed_more_slowly():
    fine, coarse = (JointObserver(1, PERIOD, 80.0, noise).bandwidth for noise in (1e-5, 1.5e-4))
    assert fine > 1.5 * coarse > 30.0


def test_velocities_that_encoders_say_are_taken():
    observer = JointObserver(1, PERIOD, 80.0, 1e-5)
    for tick in range(10):
        q, qd = observer.update(readings(motion(tick)[0], velocity=motion(tick)[1]))
        assert (q[0], qd[0]) == motion(tick)[:2]
        observer.drive(np.array([motion(tick)[2]]))
    q, qd = observer.update(readings(motion(8)[0], late=2, velocity=motion(8)[1]))
    assert q[0] == pytest.approx(motion(10)[0], abs=1e-6) and qd[0] == pytest.approx(motion(10)[1], abs=1e-6)
