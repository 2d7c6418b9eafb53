"""The plant's side: limits of joints, the watchdog, and the hold at the start."""

import numpy as np
import pytest

import surefoot
from surefoot.apps.bridge.host import Care, Host
from surefoot.apps.bridge.limits import TORQUE_RATE, Limits, blended
from surefoot.apps.bridge.line import Disturbance
from surefoot.apps.bridge.messages import Start
from surefoot.joints import JointCommand, Servo
from surefoot.scenarios.setup.stances.start import pressed
from surefoot.scenarios.setup.walk import resolve
from surefoot.similarity import REFERENCE_SIZE
from surefoot.wbc.body.statics import LEVER, standing_torque

pytestmark = pytest.mark.unit

PERIOD = 0.002
_SERVO = ("position", "velocity", "stiffness", "damping")


@pytest.fixture(name="walk", scope="module")
def walk_fixture():
    return resolve(surefoot.load("walk-level", {"gait.steps": 1}))


@pytest.fixture(name="start", scope="module")
def start_fixture(walk):
    controller = surefoot.Controller("humanoid100", walk)
    body, q = controller.body, pressed(controller.posture, 1.0)
    torque = standing_torque(body.model, body.frames, q, LEVER)
    return Start(q, np.zeros(len(q) - 1), torque, senses=False)


@pytest.fixture(name="limits")
def limits_fixture(walk):
    limits = Limits(walk.robot, REFERENCE_SIZE, PERIOD)
    limits.begin(np.zeros_like(walk.robot.torque_limit))
    return limits


def test_a_torque_is_at_most_the_largest_and_grows_no_faster_than_its_rate(walk, limits):
    most, position = walk.robot.torque_limit, np.zeros_like(walk.robot.torque_limit)
    given, before = [], np.zeros_like(most)
    for sign in (1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0):
        command, bent = limits.within(JointCommand(sign * 9.0 * most), position)
        assert bent
        assert (np.abs(command.torque - before) <= TORQUE_RATE * PERIOD * most * (1 + 1e-9)).all()
        before = command.torque
        given.append(command.torque)
    assert np.allclose(given[2], most)
    assert np.allclose(given[-1], -most)


def test_a_sane_command_is_obeyed_to_the_bit(walk):
    most, rng = walk.robot.torque_limit, np.random.default_rng(1)
    limits = Limits(walk.robot, REFERENCE_SIZE, PERIOD, np.inf)
    limits.begin(np.zeros_like(most))
    q = rng.uniform(-0.3, 0.3, len(most))
    servo = Servo(q + rng.uniform(-0.1, 0.1, len(most)), rng.uniform(-1, 1, len(most)), most, 0.01 * most)
    for torque in (most * rng.uniform(-1, 1, len(most)), most, -most):
        command, bent = limits.within(JointCommand(torque, servo), q)
        assert not bent
        assert np.array_equal(command.torque, torque)
        assert all(np.array_equal(getattr(command.servo, name), getattr(servo, name)) for name in _SERVO)


def test_a_target_far_away_pulls_with_twice_the_largest_torque(walk, limits):
    most, zero = walk.robot.torque_limit, np.zeros_like(walk.robot.torque_limit)
    stiffness = np.where(np.arange(len(most)) == 0, 0.0, 2.0 * most)
    told = JointCommand(zero, Servo(np.full_like(most, 50.0), np.full_like(most, 1e3), stiffness, zero))
    command, bent = limits.within(told, zero)
    assert bent
    assert np.allclose(command.torque_at(zero, zero)[1:], 2.0 * most[1:])
    assert command.torque_at(zero, zero)[0] == 0.0
    assert np.array_equal(command.servo.velocity, walk.robot.velocity_limit)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_blend_is_that_of_the_torques_in_any_state(share):
    rng = np.random.default_rng(3)

    def numbers(count):
        return [rng.standard_normal(4) for _ in range(count)]

    one, other = JointCommand(*numbers(1)), JointCommand(*numbers(1), Servo(*map(abs, numbers(4))))
    for q, v in (numbers(2), numbers(2)):
        mixed = blended(one, other, share).torque_at(q, v)
        assert np.allclose(mixed, (1.0 - share) * one.torque_at(q, v) + share * other.torque_at(q, v))


def hosted(walk, start, **care):
    host = Host(walk, Care(**care))
    host.begin(start)
    return host


def test_commands_that_stop_damp_the_joints_and_nothing_undoes_it(walk, start):
    host = hosted(walk, start, watchdog=0.02)
    still = JointCommand(np.zeros(host.joints))
    for tick in range(20):
        host.take(tick, still)
        host.advance()
    assert host.damped == ""
    for _ in range(12):
        host.advance()
    assert host.damped == "no command answers a state of the last 0.022 s"
    host.take(host.tick, still)
    host.advance()
    state = host.state()
    assert state.answered.damped
    v, torque = state.measurement.v[6:], state.measurement.joint_torque
    assert (v * torque).max() < 1e-6  # damping gives no energy
    assert np.abs(torque).max() > 0.0


def test_a_command_that_comes_in_time_damps_nothing_and_each_that_does_not_is_counted(walk, start):
    host = hosted(walk, start, watchdog=0.02, disturbance=Disturbance(delay=0.01))
    for tick in range(30):
        host.take(tick, JointCommand(np.zeros(host.joints)))
        host.advance()
    host.advance()
    host.advance()
    answered = host.state().answered
    assert (host.damped, answered.tick, answered.missed) == ("", 26, 0)
    for _ in range(6):
        host.advance()
    answered = host.state().answered
    assert (host.damped, answered.tick, answered.missed) == ("", 29, 3)


def test_before_the_first_command_the_robot_is_held_standing(walk, start):
    host = hosted(walk, start, watchdog=0.02, soft_start=0.3)
    for _ in range(200):
        host.advance()
    state = host.state()
    assert np.abs(state.measurement.q[7:] - start.q[7:]).max() < 0.02
    assert state.measurement.q[2] > start.q[2] - 0.02
    loose = hosted(walk, start)
    for tick in range(200):
        loose.take(tick, JointCommand(np.zeros(loose.joints)))
        loose.advance()
    assert loose.state().measurement.q[2] < start.q[2] - 0.1


def test_a_soft_start_goes_over_from_the_hold_to_the_command(walk, start):
    given = {}
    for time in (0.0, 0.2, np.inf):
        host = hosted(walk, start, soft_start=time)
        if time < np.inf:
            host.take(0, JointCommand(0.5 * walk.robot.torque_limit))
        host.advance()
        given[time] = host.state().measurement.joint_torque.copy()
    assert np.allclose(given[0.0], 0.5 * walk.robot.torque_limit)
    assert np.allclose(given[0.2], given[np.inf])
    assert not np.allclose(given[0.0], given[0.2])
