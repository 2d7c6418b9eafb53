import numpy as np
import pytest

from surefoot.planner.walk.reach import Legs

pytestmark = pytest.mark.unit

LEGS = Legs(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0))


def way(start, end):
    return np.linspace(start, end, 50)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    ("start", "end", "corner"),
    [
        ((-0.28, 0.2), (0.28, -0.1), (0.24, 0.115)),
        ((-0.28, -0.1), (0.28, 0.3), (-0.24, 0.115)),
        ((0.28, 0.2), (-0.28, -0.1), (-0.24, 0.115)),
        ((-0.28, 0.2), (0.28, 0.2), None),
        ((-0.28, 0.2), (0.28, 0.05), None),
        ((0.25, 0.2), (0.3, -0.1), None),
    ],
)
def test_a_foot_that_crosses_goes_ahead_first_and_comes_back_before_it_passes(side, start, end, corner):
    mirror = np.array([1.0, side])
    found = LEGS.corner(way(start, end) * mirror, side)
    if corner is None:
        assert found is None
    else:
        np.testing.assert_allclose(found, corner * mirror)
