"""The fall rule at its bounds, for one tick and for many."""

import numpy as np
import pytest

from surefoot.scenarios.judge.body import FALLEN_HEIGHT, FALLEN_TILT, LOST_DISTANCE, lies, lost

pytestmark = pytest.mark.unit

STANDING = (1.0, 0.0, False)


@pytest.mark.parametrize(
    ("height", "tilt", "touching", "fallen"),
    [
        (*STANDING, False),
        (FALLEN_HEIGHT * 1.0, 0.0, False, False),
        (np.nextafter(FALLEN_HEIGHT, 0.0), 0.0, False, True),
        (1.0, FALLEN_TILT, False, False),
        (1.0, np.nextafter(FALLEN_TILT, 9.0), False, True),
        (1.0, 0.0, True, True),
        (1.0, 0.0, 1, True),
    ],
)
def test_a_body_lies_when_it_is_low_tilted_or_touches(height, tilt, touching, fallen):
    assert bool(lies(height, 1.0, tilt, touching)) is fallen
    many = lies(np.array([1.0, height]), 1.0, np.array([0.0, tilt]), np.array([0, touching]))
    assert many.tolist() == [False, fallen]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_pendulum_is_lost_beyond_any_foot(sign):
    zmp = np.array([0.2, -0.1])
    near = zmp + sign * np.array([0.6, 0.8]) * (LOST_DISTANCE - 1e-9)
    far = zmp + sign * np.array([0.6, 0.8]) * (LOST_DISTANCE + 1e-9)
    assert not lost(near, zmp)
    assert lost(far, zmp)
    assert lost(np.stack((near, far)), np.stack((zmp, zmp))).tolist() == [False, True]
