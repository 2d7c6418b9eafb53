"""The filter on a log in the form of other authors."""

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from benchmarks.foreign import ForeignLog, compared, errors, states

pytestmark = pytest.mark.unit

GRAVITY = np.array([0.0, 0.0, -9.81])
PERIOD, TICKS = 0.002, 1000


def written(folder: Path, stands: bool) -> tuple[ForeignLog, np.ndarray]:
    """A body that sways over two feet at rest, with an IMU that is turned, and what is true of it."""
    lines, truth = [], []
    feet = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
    mounted = np.diag([1.0, -1.0, -1.0])
    for i in range(TICKS):
        t = i * PERIOD
        way, speed, gain = (0.05 * f(3.0 * t) * g for f, g in ((np.sin, 1.0), (np.cos, 3.0), (np.sin, -9.0)))
        # What the IMU says is the mean over the period that follows.
        R = pin.exp3(np.array([0.2 * t, 0.0, 0.0])) @ mounted
        p, v = np.array([way, 0.5 * way, 0.8]), np.array([speed, 0.5 * speed, 0.0])
        force = R.T @ (np.array([gain, 0.5 * gain, 0.0]) - GRAVITY)
        rate = mounted.T @ np.array([0.2, 0.0, 0.0])
        lines.append("IMU " + " ".join(map(repr, map(float, (t, *rate, *force)))))
        lines.append(f"CONTACT {t} 0 {int(stands)} 1 {int(stands)}")
        row = [t]
        for k in (0, 1):
            quaternion = pin.Quaternion(R.T)
            covariance = np.diag([1e-2] * 3 + [1e-6] * 3).ravel()
            row += [k, quaternion.w, quaternion.x, quaternion.y, quaternion.z, *(R.T @ (feet[k] - p)), *covariance]
        lines.append("KINEMATIC " + " ".join(map(repr, map(float, row))))
        truth.append([t, *R.ravel(), *v, *p])
    path = folder / "log.txt"
    path.write_text("\n".join(lines) + "\n")
    return ForeignLog.of(path), np.array(truth)


def test_the_filter_finds_the_velocity_that_it_was_not_told(tmp_path: Path) -> None:
    log, truth = written(tmp_path, stands=True)
    start = truth[0].copy()
    start[10:13] += [0.01, -0.01, 0.0]
    found = states(log, start, 1)
    np.testing.assert_allclose(found[-1, 10:13], truth[-1, 10:13], atol=2e-3)
    place, _, tilt, _ = errors(found, truth)
    assert place < 3.0 and tilt < 0.1


def test_without_feet_it_drifts(tmp_path: Path) -> None:
    log, truth = written(tmp_path, stands=False)
    start = truth[0].copy()
    start[10:13] += [0.01, -0.01, 0.0]
    place, speed, _, _ = errors(states(log, start, 1), truth)
    assert place > 10.0 and speed > 10.0


def test_the_table_has_both_filters(tmp_path: Path) -> None:
    log, truth = written(tmp_path, stands=True)
    rows = compared(log, truth, truth, 10).rows
    assert [row[0] for row in rows] == ["of Surefoot, gain each tick", "of Surefoot, gain each 10 ticks", "the other"]
    np.testing.assert_allclose(rows[-1][1:], 0.0, atol=1e-12)
