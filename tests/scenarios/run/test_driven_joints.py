"""Arms that somebody else moves: the robot walks on, told and untold, and its own joints are never overruled."""

import numpy as np
import pytest

import surefoot
from surefoot.joints import Servo
from surefoot.scenarios.file.control import ControlSettings
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.driven import Somebody
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

ROBOTS = {
    "humanoid100": ({}, {".*(shoulder|elbow).*": [60.0, 4.0]}),
    "g1": ({"robot": "g1", "sized_for": "humanoid100"}, {".*(shoulder|elbow|wrist).*": [14.0, 0.9]}),
}


def arms(robot, **keys):
    overrides, joints = ROBOTS[robot]
    return {**overrides, "control": {"driven_joints": joints, **keys}}


@pytest.mark.parametrize(
    ("robot", "told"),
    [
        ("humanoid100", False),
        ("g1", True),
        pytest.param("humanoid100", True, marks=pytest.mark.long),
        pytest.param("g1", False, marks=pytest.mark.long),
    ],
)
def test_it_walks_with_arms_that_are_moved_at_random(robot, told):
    keys = arms(robot, driven_motion=0.06, driven_told=told)
    with surefoot.Simulation(load("walk-level", {**keys, "gait.steps": 2, "sensing.source": "truth"})) as simulation:
        q = [simulation.step().measurement.q[7:]]
        while not simulation.done:
            simulation.advance()
        assert simulation.end.kind == "completed"
        moved = np.abs(simulation.look().measurement.q[7:] - q[0])
    arm = [i for i, name in enumerate(simulation.walk.robot.joint_names) if "shoulder" in name]
    assert moved[arm].max() > 0.05


def test_somebody_moves_their_joints_alone_and_the_same_each_time():
    walk = resolve(load("walk-level", arms("g1", driven_motion=0.06)))
    posture = np.zeros(len(walk.robot.joint_names))
    first, again = (Somebody(walk.control, walk.robot, posture, 3) for _ in range(2))
    seen = [first.command(0.02 * k).servo for k in range(50)]
    assert all(np.array_equal(one.position, again.command(0.02 * k).servo.position) for k, one in enumerate(seen))
    targets = np.array([one.position for one in seen])
    assert not targets[:, ~first.joints].any() and not seen[0].stiffness[~first.joints].any()
    assert 0.0 < np.abs(np.diff(targets, axis=0)).max() <= 0.06
    own = surefoot.JointCommand(np.arange(len(posture), dtype=float))
    both = own.with_joints(first.joints, first.command(1.0))
    q = v = np.full(len(posture), 0.1)
    assert np.array_equal(both.torque_at(q, v)[~first.joints], own.torque[~first.joints])
    assert np.array_equal(both.torque_at(q, v)[first.joints], first.command(1.0).torque_at(q, v)[first.joints])


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"driven_joints": {"tail": [1.0, 1.0]}}, "no joint is called 'tail'"),
        ({"driven_joints": {"left_knee": [1.0, 1.0]}}, "somebody else drives left_knee, which is of a leg"),
        ({"driven_motion": 0.1}, "control.driven_motion without joints that somebody else drives"),
        ({"driven_told": False}, "control.driven_told without joints"),
    ],
)
def test_what_cannot_be_is_refused(keys, told):
    with pytest.raises(surefoot.SetupError, match=told):
        closed_loop(resolve(load("walk-level", {"control": keys})), NoLog())


def test_a_controller_is_told_what_drives_them():
    keys = ControlSettings.model_validate(arms("humanoid100")["control"])
    stand = load("stand", {"sensing.source": "truth"})
    controller = surefoot.Controller("humanoid100", stand, control=keys.model_dump(exclude_none=True))
    q = controller.posture
    controller.reset(q)
    seen = surefoot.Measurement.of_state(0.0, q, np.zeros(len(q) - 1))
    wanted = np.full(len(q) - 7, 0.5)
    controller.step(seen, driven_joints=surefoot.JointCommand(wanted))
    report, terms = controller.report, controller.terms
    torque = terms.mass_matrix @ report.acceleration + terms.bias
    torque -= terms.contact_jacobian.T @ report.wrench.ravel()
    driven = [i for i, name in enumerate(controller.walk.robot.joint_names) if "elbow" in name or "shoulder" in name]
    assert torque[6:][driven] == pytest.approx(0.5, abs=1e-5)


def test_drives_that_follow_targets_give_way_until_the_end_of_a_period():
    """Their torque is that of where they are then, as they are found to be accelerated."""
    keys = ControlSettings.model_validate(arms("humanoid100")["control"])
    stand = load("stand", {"sensing.source": "truth"})
    controller = surefoot.Controller("humanoid100", stand, control=keys.model_dump(exclude_none=True))
    q, period = controller.posture, 1.0 / controller.walk.rates.control
    controller.reset(q)
    driven = np.array(["elbow" in name or "shoulder" in name for name in controller.walk.robot.joint_names])
    v = np.concatenate((np.zeros(6), np.where(driven, 2.0, 0.0)))
    still, stiff, damped = np.zeros(len(driven)), np.full(len(driven), 300.0), np.full(len(driven), 2.0)
    target = q[7:] + 0.05
    command = surefoot.JointCommand(still, Servo(target, still, stiff, damped))
    controller.step(surefoot.Measurement.of_state(0.0, q, v), driven_joints=command)
    report, terms = controller.report, controller.terms
    torque = terms.mass_matrix @ report.acceleration + terms.bias - terms.contact_jacobian.T @ report.wrench.ravel()
    bend = report.acceleration[6:]
    ends = q[7:] + period * v[6:] + 0.5 * period**2 * bend, v[6:] + period * bend
    expected = stiff * (target - ends[0]) - damped * ends[1]
    np.testing.assert_allclose(torque[6:][driven], expected[driven], atol=1e-5)
