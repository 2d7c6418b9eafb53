"""The structure of the cost."""

from dataclasses import fields, replace

import numpy as np
import pytest

from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks import ANGULAR, LINEAR, PELVIS, SWING, TORSO, TaskWeights

pytestmark = pytest.mark.unit

ONLY_DIAGONAL = {"upper_posture", "leg_posture", "acceleration", "force", "moment"}


@pytest.fixture
def written(robot, rng, references, loaded):
    """QP and task stack of a swing state, made with given changes of the weights."""
    state = robot.moved(rng, 0.02, 0.3)

    def write(**changes):
        controller = robot.controller(WbcParameters(weights=replace(TaskWeights(), **changes)))
        controller.observe(state)
        controller.update(references[1](), loaded)
        return controller, controller.qp, controller._tasks

    return write


def test_the_cost_is_least_squares_plus_a_diagonal(written):
    _, qp, tasks = written()
    T, t = tasks._rows, tasks._target
    np.testing.assert_allclose(qp.H, T.T @ T + np.diag(tasks._diagonal), atol=1e-10)
    np.testing.assert_allclose(qp.g, -(T.T @ t + tasks._linear), atol=1e-10)
    assert np.linalg.eigvalsh(qp.H).min() > 0.0


@pytest.mark.parametrize(
    ("weight", "rows"),
    [
        ("com_horizontal", [0, 1]),
        ("com_vertical", [2]),
        ("angular_momentum", ANGULAR),
        ("orientation", slice(PELVIS.start, TORSO.stop)),
        ("swing", SWING),
    ],
)
def test_a_weight_of_zero_removes_its_task(written, weight, rows):
    _, qp, tasks = written(**{weight: 0.0})
    _, whole, full = written()
    assert not tasks._rows[rows].any()
    T = full._rows[rows]
    np.testing.assert_allclose(whole.H - qp.H, T.T @ T, atol=1e-9)
    np.testing.assert_allclose(whole.g - qp.g, -T.T @ full._target[rows], atol=1e-9)
    assert np.isfinite(tasks.residual(np.ones(qp.g.size))).all()


def test_every_weight_matters(written):
    _, whole, _ = written()
    for field in fields(TaskWeights):
        _, qp, _ = written(**{field.name: 2.0 * getattr(TaskWeights(), field.name)})
        changed = np.flatnonzero(np.abs(qp.H - whole.H).max(axis=0))
        assert changed.size > 0, field.name
        if field.name in ONLY_DIAGONAL:
            off = qp.H - whole.H
            np.testing.assert_allclose(off, np.diag(np.diag(off)), atol=1e-12)


def test_the_rows_are_the_accelerations_they_claim(written, robot, rng):
    """Momentum rows against Newton and Euler, swing and torso rows against the frames, for arbitrary x."""
    controller, qp, tasks = written()
    terms, x = controller.terms, rng.normal(size=qp.g.size)
    nv, wrench = robot.nv, controller.layout.wrench_unit * x[robot.nv :].reshape(2, 6)
    force = np.einsum("kij,kj->ki", terms.sole_rotation, wrench[:, :3])
    moment = np.einsum("kij,kj->ki", terms.sole_rotation, wrench[:, 3:])
    moment += np.cross(terms.sole_position - terms.com, force)
    rows = (tasks._rows @ x) * tasks._unscale
    np.testing.assert_allclose(rows[LINEAR], force.sum(0) / terms.mass, atol=1e-10)
    np.testing.assert_allclose(rows[ANGULAR], moment.sum(0) / terms.mass, atol=1e-10)
    np.testing.assert_allclose(rows[PELVIS], x[3:6], atol=1e-12)
    np.testing.assert_allclose(rows[TORSO], terms.torso_jacobian @ x[:nv], atol=1e-10)
    np.testing.assert_allclose(rows[SWING], terms.sole_jacobian[1] @ x[:nv], atol=1e-10)


def test_the_swing_task_is_absent_when_both_feet_stand(robot, references, loaded):
    controller = robot.controller()
    controller.observe(robot.moved(np.random.default_rng(0)))
    controller.update(references[1](), loaded)
    assert controller._tasks._rows[SWING].any()
    controller.update(references[0](), loaded)
    assert not controller._tasks._rows[SWING].any()
