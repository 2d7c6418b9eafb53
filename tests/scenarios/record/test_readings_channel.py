"""The channel of the readings: values, ages, freshness as an estimator got them; NaN where no sensor says anything."""

import numpy as np
import pytest

from surefoot.readings import Reading, Readings
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.readings import ReadingsRecorder

pytestmark = pytest.mark.unit

SIZES = Sizes(nj=4, nq=11, nv=10, horizon=5)


def readings(tick, rng, velocity=True, wrench=True):
    def one(*shape, age=0.0, fresh=True):
        return Reading(rng.normal(size=shape), age, fresh)

    return Readings(
        time=0.002 * tick,
        joint_position=one(4, age=0.004, fresh=bool(tick % 2)),
        joint_velocity=one(4) if velocity else None,
        joint_torque=one(4),
        angular_velocity=one(3),
        mean_angular_velocity=one(3),
        specific_force=one(3, age=0.002),
        wrench=one(2, 6, age=0.01, fresh=False) if wrench else None,
    )


@pytest.fixture
def logged(tmp_path):
    def write(sent):
        path = tmp_path / "log.mcap"
        with LogWriter(path, {}, []) as writer:
            recorder = ReadingsRecorder(writer, SIZES)
            for tick, one in enumerate(sent):
                recorder.tick(tick * 2_000_000, one)
        return read(path)["/readings"]

    return write


def test_what_was_said_is_in_the_log(logged):
    rng = np.random.default_rng(0)
    sent = [readings(tick, rng) for tick in range(6)]
    found = logged(sent)
    assert found.time_ns.tolist() == [2_000_000 * tick for tick in range(6)]
    for name in ("joint_position", "joint_velocity", "joint_torque", "angular_velocity", "specific_force"):
        np.testing.assert_array_equal(found.field(name), [getattr(one, name).values for one in sent])
    for foot, name in enumerate(("wrench_left", "wrench_right")):
        np.testing.assert_array_equal(found.field(name), [one.wrench.values[foot] for one in sent])
    assert found.field("joint_age").tolist() == [0.004] * 6
    assert found.field("imu_age").tolist() == [0.002] * 6
    assert found.field("wrench_age").tolist() == [0.01] * 6
    assert found.field("joint_fresh").tolist() == [0, 1, 0, 1, 0, 1]
    assert found.field("imu_fresh").tolist() == [1] * 6
    assert found.field("wrench_fresh").tolist() == [0] * 6


def test_sensors_that_are_not_there_say_nan(logged):
    rng = np.random.default_rng(0)
    found = logged([readings(tick, rng, velocity=False, wrench=False) for tick in range(3)])
    for name in ("joint_velocity", "wrench_left", "wrench_right", "wrench_age"):
        assert np.isnan(found.field(name)).all()
    assert not found.field("wrench_fresh").any()
    assert np.isfinite(found.field("joint_position")).all()
