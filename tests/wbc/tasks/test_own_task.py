"""A task from outside: it is stacked, heard, reported and named, and a wrong one is refused."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.parts.guard import Guard, Guarded
from surefoot.parts.plugins import PluginError
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks import DEFAULT_LAYOUT, TASKS, Task, TaskWeights, Weighted, angular_acceleration
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

PERIOD = 0.002
LOCAL = pin.ReferenceFrame.LOCAL


class Elbow:
    """Holds the left elbow, where the forearm's frame is, at a place in the world."""

    name, size = "left elbow", 3

    def __init__(self, model, frames, target=(0.3, 0.3, 1.2), weight=5.0):
        self.weight = weight
        self.frame = model.getFrameId("left_forearm")
        self.target = np.array(target)

    def place(self, terms):
        return pin.updateFramePlacement(terms.model, terms.data, self.frame)

    def write(self, terms, reference, scale, rows):
        model, data, nv = terms.model, terms.data, terms.model.nv
        place = self.place(terms)
        J = pin.getFrameJacobian(model, data, self.frame, LOCAL)[:3]
        velocity = pin.getFrameVelocity(model, data, self.frame, LOCAL).linear
        bias = pin.getFrameClassicalAcceleration(model, data, self.frame, LOCAL).linear
        np.multiply(J, scale, out=rows[:, :nv])
        return 100.0 * place.rotation.T @ (self.target - place.translation) - 20.0 * velocity - bias


class Head:
    """Keeps the head turned, whatever the trunk does; one weight for each row."""

    name, size = "head", 3

    def __init__(self, model, frames):
        self.weight = np.array([1.0, 2.0, 3.0])
        self.frame, self.desired = model.getFrameId("head"), pin.utils.rotate("z", 0.4)

    def write(self, terms, reference, scale, rows):
        model, data = terms.model, terms.data
        R = pin.updateFramePlacement(model, data, self.frame).rotation
        rows[:, : model.nv] = scale * pin.getFrameJacobian(model, data, self.frame, LOCAL)[3:]
        velocity = pin.getFrameVelocity(model, data, self.frame, LOCAL).angular
        bias = pin.getFrameAcceleration(model, data, self.frame, LOCAL).angular
        return np.array(angular_acceleration((100.0, 20.0), R, velocity, self.desired, (0.0, 0.0, 0.0))) - bias


def hold(robot, reference, controller, seconds=1.2):
    """Let the robot follow the planned accelerations; the terms of the last state and the report of the last tick."""
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    for _ in range(round(seconds / PERIOD)):
        terms = controller.observe(RobotState(q, v))
        report = controller.update(reference, FootSensing((490.0, 490.0)))
        assert report.status is SolveStatus.SOLVED
        v = v + PERIOD * report.acceleration
        q = pin.integrate(robot.model, q, PERIOD * v)
    return terms, report


@pytest.fixture
def reach(robot):
    """A place for the left elbow ahead of and above where it hangs: that of an arm raised by 0.6 rad."""
    q, data = robot.standing.copy(), robot.model.createData()
    q[7 + robot.shoulders[0]] -= 0.6
    pin.framesForwardKinematics(robot.model, data, q)
    return data.oMf[robot.model.getFrameId("left_forearm")].translation.copy()


def test_an_elbow_reaches_its_target_while_the_robot_stands(robot, references, reach):
    task = Elbow(robot.model, robot.frames, reach)
    # The posture pulls the arm back; what holds the elbow must outweigh it.
    weights = replace(TaskWeights(), upper_posture=0.01)
    controller = robot.controller(WbcParameters(weights=weights), tasks=(task,))
    terms, report = hold(robot, references[0](), controller)
    assert np.abs(task.place(terms).translation - reach).max() < 5e-3
    assert report.task_error.shape == (21,)
    assert np.abs(report.task_error[18:]).max() < 0.5
    assert np.abs(terms.com - [0.0, 0.0, 1.0]).max() < 5e-3


def test_without_the_task_the_elbow_stays_where_it_hangs(robot, references, reach):
    """Negative control: neither the default tasks nor a weight of zero bring the elbow there."""
    for tasks in ((), (Elbow(robot.model, robot.frames, reach, weight=0.0),)):
        terms, report = hold(robot, references[0](), robot.controller(tasks=tasks), 0.1)
        place = Elbow(robot.model, robot.frames).place(terms).translation
        assert np.abs(place - reach).max() > 0.09
        assert not report.task_error[18:].any()


def test_tasks_from_outside_come_after_the_default_ones(robot, references, loaded, rng):
    state, reference = robot.moved(rng, 0.02, 0.2), references[1]()
    own = (Elbow(robot.model, robot.frames), Head(robot.model, robot.frames))
    controller, plain = robot.controller(tasks=own), robot.controller()
    assert controller.task_layout == (*DEFAULT_LAYOUT, ("left elbow", 3), ("head", 3))
    for made in (controller, plain):
        made.observe(state)
    report, default = controller.update(reference, loaded), plain.update(reference, loaded)
    T, first = controller.tasks.rows, default.task_error.size
    np.testing.assert_array_equal(T[:first], plain.tasks.rows)
    np.testing.assert_allclose(controller.qp.H - plain.qp.H, T[first:].T @ T[first:], atol=1e-9)
    x = np.concatenate([report.acceleration, np.zeros(12)])
    for task, error in zip(own, np.split(report.task_error[first:], 2), strict=True):
        J = np.zeros((3, x.size))
        a = task.write(controller.terms, reference, np.ones((3, 1)), J)
        np.testing.assert_allclose(error, J @ x - a, atol=1e-9)
    assert np.abs(report.torque - default.torque).max() > 1e-3


def test_a_task_can_be_given_another_weight(robot, references, loaded, rng):
    state, task = robot.moved(rng, 0.02, 0.2), Elbow(robot.model, robot.frames, weight=1.0)
    rows, errors = [], []
    for given in (task, Weighted(task, 4.0)):
        controller = robot.controller(tasks=(given,))
        controller.observe(state)
        errors.append(controller.update(references[0](), loaded).task_error[18:].copy())
        rows.append(controller.tasks.rows[18:])
        assert controller.task_layout[-1] == ("left elbow", 3)
    np.testing.assert_allclose(rows[1], 2.0 * rows[0])
    assert np.linalg.norm(errors[1]) < np.linalg.norm(errors[0])


def test_a_task_may_count_for_more_while_a_step_catches_the_body(robot, references, loaded, rng):
    state, task = robot.moved(rng, 0.02, 0.2), Elbow(robot.model, robot.frames, weight=1.0)
    task.catching_weight = 9.0
    guarded = Guarded(task, Guard("elbow of a test"))
    for given, more in ((task, 3.0), (guarded, 3.0), (Weighted(task, 1.0), 1.0)):
        rows = []
        for catching in (False, True):
            controller = robot.controller(tasks=(given,))
            controller.observe(state)
            controller.update(references[1](catching=catching), loaded)
            rows.append(controller.tasks.rows[18:])
        np.testing.assert_allclose(rows[1], more * rows[0])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"catching_weight": -3.0}, "weight -3.0; .* not negative"),
        ({"name": "pelvis"}, "a name of its own"),
        ({"size": 0}, "size must be at least 1"),
        ({"weight": -1.0}, "not negative"),
        ({"weight": np.ones(2)}, "one for each row"),
        ({"weight": np.nan}, "finite"),
    ],
)
def test_a_task_that_cannot_be_stacked_is_refused(robot, changes, words):
    task = Elbow(robot.model, robot.frames)
    for name, value in changes.items():
        setattr(task, name, value)
    with pytest.raises(ValueError, match=words):
        robot.controller(tasks=(task,))


def test_a_registered_name_makes_a_task(robot):
    TASKS.add("left-elbow", Elbow)
    try:
        task: Task = TASKS["left-elbow"](robot.model, robot.frames)
        assert robot.controller(tasks=(task,)).task_layout[-1] == ("left elbow", 3)
    finally:
        TASKS.discard("left-elbow")
    assert "left-elbow" not in TASKS
    with pytest.raises(PluginError, match="must be a function or a class"):
        TASKS.add("left-elbow", "no factory")
