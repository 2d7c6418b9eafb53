"""Results of tours together: means, shares, punches and causes, out of tours that are made up."""

import json
import math

import numpy as np
import pytest

from surefoot.studies.tour.results import Mean, RowResult, cause, to_json
from surefoot.studies.tour.ride import PunchTaken, TourResult

pytestmark = pytest.mark.unit


def punch(time=0.1, joint="left_wrist_yaw_joint", level=0.3, direction=(0.0, 1.0, 0.0), survived=True, **keys):
    keys = {"phase": "single", "stance": "left", "fraction": 0.5, **keys}
    return PunchTaken(time, joint, level, level, direction, survived=survived, **keys)


def tour(seed=0, survival=90.0, punches=(), errors=(0.02,), **keys):
    return TourResult("torque", seed, survival, survival == 90.0, errors, errors, (400.0,), punches, "", 0, None)


def test_the_interval_of_a_mean_holds_it_as_often_as_it_says():
    rng, held = np.random.default_rng(1), 0
    for _ in range(200):
        mean = Mean.of(rng.exponential(20.0, 40))
        held += mean.low <= 20.0 <= mean.high
    assert 0.85 < held / 200 < 0.99
    assert Mean.of([3.0] * 5) == Mean(3.0, 3.0, 3.0, 5)
    assert math.isnan(Mean.of([]).value)


def test_a_row_is_counted():
    lost = punch(10.1, level=0.65, survived=False)
    tours = [
        tour(0),
        tour(1, 11.0, (punch(level=0.32), punch(5.1, level=0.31), lost)),
        tour(2, 30.0, (punch(25.1, level=0.39),)),
    ]
    row = RowResult.of(tours)
    assert row.tours == 3 and row.completed.kept == 1 and row.survival.value == pytest.approx(131.0 / 3.0)
    strength = {share.of: (share.kept, share.count) for share in row.punches["level impulse"]}
    assert strength == {"0.3 to 0.4": (3, 3), "0.6 to 0.7": (0, 1)}
    assert row.energy.value == pytest.approx(0.4 * 18)
    assert dict(row.falls) == {"over the stance foot, on arm": 1, "no punch": 1}
    assert json.dumps(to_json(row), allow_nan=False)


@pytest.mark.parametrize(
    ("direction", "keys", "told"),
    [
        ((1.0, 0.1, 0.0), {}, "forward, on arm"),
        ((-1.0, 0.1, 0.0), {}, "backward, on arm"),
        ((0.1, 0.0, 0.99), {}, "upward, on arm"),
        ((0.1, 0.0, -0.99), {}, "downward, on arm"),
        ((0.0, 1.0, 0.0), {"joint": "left_hip_yaw_joint"}, "over the stance foot, on leg or waist"),
        ((0.0, -1.0, 0.0), {}, "to the swing foot, on arm"),
        ((0.0, -1.0, 0.0), {"stance": "right"}, "over the stance foot, on arm"),
        ((0.0, -1.0, 0.0), {"phase": "double", "stance": "none"}, "sideways in double support, on arm"),
    ],
)
def test_a_fall_has_the_cause_of_its_last_punch(direction, keys, told):
    assert cause(tour(0, 1.0, (punch(direction=direction, survived=False, **keys),))) == told


def test_a_fall_long_after_a_punch_has_another_cause():
    assert cause(tour(0, 4.9, (punch(),))) == "no punch"
    assert cause(tour(0, 0.05)) == "no punch"
