"""Places that are held against a plan are taken from the estimate's world to the true one by the foot that carries."""

import numpy as np
import pytest

from surefoot.scenarios.judge.placed import to_truth

pytestmark = pytest.mark.unit

TICKS, YAW = 5, 0.1


class Run:
    """A run whose estimate has drifted: turned by a tenth and moved."""

    def __init__(self, sensed=True):
        rng = np.random.default_rng(1)
        self.sensed, self.true = sensed, rng.normal(size=(2, TICKS, 7))
        c, s = np.cos(YAW), np.sin(YAW)
        self.R, self.away = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), np.array([0.3, -0.2, 0.01])
        self.believed = self.true.copy()
        self.believed[..., :3] = self.drifted(self.true[..., :3])
        self.fields = {
            "left_sole": self.believed[0], "right_sole": self.believed[1], "yaw_error": np.full(TICKS, YAW),
            "normal_force": np.tile([[0.0, 900.0], [900.0, 0.0]], (3, 1))[:TICKS],
        }  # fmt: skip

    def drifted(self, points):
        return points @ self.R.T + self.away

    def has(self, *topics):
        return self.sensed

    def field(self, topic, name):
        return self.fields[name]

    def sole(self, foot):
        return self.true[foot]


def test_a_drift_is_taken_out_whichever_foot_takes_it():
    run, rng = Run(), np.random.default_rng(2)
    points = rng.normal(size=(TICKS, 4, 3))
    for right in (None, np.zeros(TICKS, dtype=bool), np.ones(TICKS, dtype=bool)):
        np.testing.assert_allclose(to_truth(run, run.drifted(points), right=right), points, atol=1e-12)
    rows = np.array([3, 1, 1])
    np.testing.assert_allclose(to_truth(run, run.drifted(points[rows, 0]), rows), points[rows, 0], atol=1e-12)
    flat = to_truth(run, run.drifted(points[:, 0])[:, :2])
    np.testing.assert_allclose(flat, points[:, 0, :2], atol=1e-12)


def test_where_one_foot_has_slipped_in_the_estimate_it_is_the_other_that_counts():
    run = Run()
    run.fields["left_sole"] = run.believed[0] + np.array([0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    point = np.zeros((TICKS, 3))
    found = to_truth(run, run.drifted(point))
    carried_right = run.fields["normal_force"][:, 1] > 0.0
    np.testing.assert_allclose(found[carried_right], 0.0, atol=1e-12)
    assert np.linalg.norm(found[~carried_right], axis=1) == pytest.approx(0.05)


def test_with_the_truth_points_stay_to_the_bit():
    points = np.random.default_rng(3).normal(size=(TICKS, 2))
    assert to_truth(Run(sensed=False), points) is points
