"""The channel of an estimator: what was told, and errors against their definition, in terms that are overwritten."""

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.readings import Reading, Readings
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.estimation import EstimationRecorder
from surefoot.wbc.estimation.estimate import Deviation

pytestmark = pytest.mark.unit

SIZES = Sizes(nj=4, nq=11, nv=10, horizon=5)
TICKS, CHANGED = 60, 40


class Terms:
    """Terms of a robot, whose arrays stay where they are; rotations lie by columns, as Pinocchio's do."""

    def __init__(self):
        self.q, self.sole_pose, self.com, self.com_velocity = np.zeros(11), np.zeros((2, 7)), np.zeros(3), np.zeros(3)
        self.base_rotation = np.zeros((3, 3), order="F")

    def move(self, rng):
        self.q[:], self.sole_pose[:], self.com[:] = rng.normal(size=11), rng.normal(size=(2, 7)), rng.normal(size=3)
        self.com_velocity[:], self.base_rotation[:] = rng.normal(size=3), pin.exp3(rng.normal(size=3))


def said(rng):
    one = [Reading(rng.normal(size=size), 0.002, True) for size in (4, 4, 3, 3, 3)]
    return Readings(0.0, one[0], None, *one[1:], None)


def estimated(rng, tick):
    sure = Deviation(*(rng.normal(size=size) for size in (3, 3, 2, 2)), 0.0, tick + 0.5, tick + 0.25)
    channels = {"bias": rng.normal(size=3)}
    return SimpleNamespace(deviation=sure, contact=(bool(tick % 2), True), channels=channels)


def flat(tell):
    return {name: np.array(value, dtype=float).ravel() for name, value in tell.items()}


def errors(terms, truth, stance):
    """Errors of an estimate, from the stance foot and with its heading turned to the true one."""
    R, true = terms.base_rotation, truth.base_rotation
    yaw = np.arctan2(R[1, 0], R[0, 0]) - np.arctan2(true[1, 0], true[0, 0])
    yaw = np.arctan2(np.sin(yaw), np.cos(yaw))
    back = pin.utils.rotate("z", -yaw)
    tilt = back @ R @ true.T
    place, true_place = terms.sole_pose[stance, :3], truth.sole_pose[stance, :3]
    return {
        "com_error": back @ (terms.com - place) - (truth.com - true_place),
        "com_velocity_error": back @ terms.com_velocity - truth.com_velocity,
        "tilt_error": (0.5 * (tilt[2, 1] - tilt[1, 2]), 0.5 * (tilt[0, 2] - tilt[2, 0])),
        "sole_height_error": terms.sole_pose[:, 2] - truth.sole_pose[:, 2],
        "yaw_error": yaw,
        "place_error": place - true_place,
    }


def test_the_log_has_what_was_told_at_each_tick(tmp_path):
    rng, terms, truth, wanted, wrong, biases = np.random.default_rng(0), Terms(), Terms(), [], [], []
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        recorder = EstimationRecorder(writer, SIZES)
        for tick in range(TICKS):
            if tick == CHANGED:
                terms = Terms()
            terms.move(rng)
            truth.move(rng)
            estimate, wrench, forces = estimated(rng, tick), rng.normal(size=(2, 6)), rng.normal(size=2)
            recorder.tick(tick * 2_000_000, said(rng), estimate, wrench, terms, truth, forces)
            sure = estimate.deviation
            wanted.append(flat({
                "base_pose": terms.q[:7], "left_sole": terms.sole_pose[0], "right_sole": terms.sole_pose[1],
                "wrench_left": wrench[0], "wrench_right": wrench[1], "contact": estimate.contact,
                "com_deviation": sure.com, "com_velocity_deviation": sure.com_velocity, "tilt_deviation": sure.tilt,
                "sole_height_deviation": sure.sole_height, "force_deviation": sure.force,
                "moment_deviation": sure.moment,
            }))  # fmt: skip
            wrong.append(flat(errors(terms, truth, int(forces[1] > forces[0]))))
            biases.append(estimate.channels["bias"])
    log = read(tmp_path / "log.mcap")
    found = log["/estimation"]
    assert log.count("/readings") == TICKS
    assert {field.name for field in found.fields} == {*wanted[0], *wrong[0]}
    np.testing.assert_array_equal(log["/estimator"].field("bias"), biases)
    for name in wanted[0]:
        told = found.field(name).reshape(TICKS, -1)
        np.testing.assert_array_equal(told, [one[name] for one in wanted], err_msg=name)
    for name in wrong[0]:
        made = found.field(name).reshape(TICKS, -1)
        np.testing.assert_allclose(made, [one[name] for one in wrong], atol=1e-12, err_msg=name)


def test_an_estimator_that_does_not_say_how_sure_it_is_has_no_deviations(tmp_path):
    rng, terms = np.random.default_rng(1), Terms()
    terms.move(rng)
    estimate = SimpleNamespace(deviation=None, contact=None, channels={})
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        recorder = EstimationRecorder(writer, SIZES)
        for tick in range(3):
            recorder.tick(tick * 2_000_000, said(rng), estimate, np.zeros((2, 6)), terms, terms, np.zeros(2))
    found = read(tmp_path / "log.mcap")["/estimation"]
    for name in ("com_deviation", "sole_height_deviation", "force_deviation", "moment_deviation"):
        assert np.isnan(found.field(name)).all()
    assert not found.field("contact").any()
    np.testing.assert_allclose(found.field("com_error"), 0.0, atol=1e-12)
