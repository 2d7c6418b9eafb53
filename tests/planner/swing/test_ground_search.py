import numpy as np
import pytest

from surefoot.planner.parameters import GroundSearch

pytestmark = pytest.mark.unit

STEP = 1e-4


@pytest.mark.parametrize("search", [GroundSearch(), GroundSearch(hurry_after=0.03), GroundSearch(hurry_after=0.0)])
def test_speed_and_acceleration_are_the_derivatives_of_the_way(search: GroundSearch) -> None:
    times = np.arange(0.0, 0.4, STEP)
    way, speed, bend = np.array([search.motion(float(time)) for time in times]).T
    np.testing.assert_allclose(np.diff(way) / STEP, 0.5 * (speed[1:] + speed[:-1]), atol=16.0 * STEP)
    assert np.abs(np.diff(speed)).max() <= max(search.acceleration, search.hurry_acceleration) * STEP * 1.001
    smooth = np.abs(np.diff(bend)) == 0.0
    np.testing.assert_allclose(np.diff(speed)[smooth] / STEP, bend[1:][smooth], atol=1e-6)


def test_it_begins_at_the_touchdown_speed_and_ends_at_the_top() -> None:
    search = GroundSearch(hurry_after=0.03)
    assert search.motion(0.0) == pytest.approx((0.0, search.touchdown_speed, search.acceleration))
    assert search.motion(1.0)[1:] == (search.hurry_speed, 0.0)
    assert GroundSearch().motion(1.0)[1:] == (GroundSearch().speed, 0.0)


def test_until_it_hurries_it_is_gentle() -> None:
    gentle, hasty = GroundSearch(), GroundSearch(hurry_after=0.03)
    for since in (0.0, 0.01, 0.0299):
        assert hasty.motion(since) == gentle.motion(since)
    assert hasty.motion(0.08)[0] > 2.0 * gentle.motion(0.08)[0]


@pytest.mark.parametrize("wrong", [{"speed": -0.1}, {"acceleration": 0.0}, {"hurry_speed": float("inf")}])
def test_what_cannot_be_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        GroundSearch(**wrong)
