"""The costs of single variables: their weights add up, and the motion that they want is one that they leave alone."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks.arm_swing import ArmSwing
from surefoot.wbc.tasks.diagonal import ForceDistribution, Posture, Regularisation
from surefoot.wbc.types import GRAVITY, RobotState

pytestmark = pytest.mark.unit

PARAMETERS = WbcParameters()
WEIGHTS, (STIFFNESS, DAMPING) = PARAMETERS.weights, PARAMETERS.gains.posture
LEGS = np.array([True, True, False, False, False])


def weights(term, rng):
    """Weights that a term adds to those that are there, of a base, five joints and two soles."""
    before = rng.uniform(1.0, 2.0, 6 + 5 + 12)
    after = before.copy()
    term.weigh(after)
    return after - before


def test_an_angular_acceleration_counts_by_the_size_of_the_robot(rng):
    linear = WEIGHTS.acceleration
    expected = np.repeat([linear, 4.0 * linear, 0.0], [3, 3 + 5, 12])
    np.testing.assert_allclose(weights(Regularisation(WEIGHTS, 2.0), rng), expected, atol=1e-12)


def test_joints_count_by_the_limb_that_they_are_of(rng):
    term = Posture(WEIGHTS, PARAMETERS.gains, np.zeros(5), LEGS)
    expected = np.repeat([0.0, WEIGHTS.leg_posture, WEIGHTS.upper_posture, 0.0], [6, 2, 3, 12])
    np.testing.assert_allclose(weights(term, rng), expected, atol=1e-12)


def test_wrenches_count_in_newtons_and_not_in_their_unit(rng):
    each = [0.0, WEIGHTS.force, WEIGHTS.moment, WEIGHTS.force, WEIGHTS.moment]
    expected = 50.0**2 * np.repeat(each, [11, 3, 3, 3, 3])
    np.testing.assert_allclose(weights(ForceDistribution(WEIGHTS, 50.0), rng), expected, atol=1e-12)


def wanted(robot, controller, q, v, reference):
    """Accelerations that the posture wants of the joints, and forces that are wanted of the soles [rad/s^2, N]."""
    terms = controller.observe(RobotState(q, v))
    controller.tasks.write(terms, reference)
    asked, nv = controller.tasks.linear, robot.nv
    weight = np.where(robot.leg_joints, WEIGHTS.leg_posture, WEIGHTS.upper_posture)
    forces = asked[nv:] / (terms.wrench_unit**2 * WEIGHTS.force) * terms.wrench_unit
    return asked[6:nv] / weight, forces, terms


@pytest.mark.parametrize("back", [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)], ids=str)
@pytest.mark.parametrize("foot", [0, 1])
def test_an_arm_that_swings_as_it_should_is_asked_for_the_acceleration_of_its_swing_alone(
    robot, references, rng, back, foot
):
    """The posture moves with the legs; what the upper body is beside it is brought back as by springs and dampers."""
    left, right = robot.shoulders
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    q[7 + robot.model.getJointId("left_hip_pitch") - 2] -= 0.3
    v[6:] = rng.uniform(-1.0, 1.0, robot.nv - 6)
    controller = robot.controller(PARAMETERS, arm_back=back)
    swing = ArmSwing(robot.shoulders, PARAMETERS.arm_swing, back)
    reference = replace(references[0](), swing_foot=foot, swing_acceleration=np.array([5.0, 2.0, 1.0]))
    angle, rate, acceleration = swing.offset(controller.observe(RobotState(q, v)), reference)
    assert min(abs(angle), abs(rate), abs(acceleration)) > 0.02
    for joint, way in ((left, back[0]), (right, -back[1])):
        q[7 + joint], v[6 + joint] = robot.standing[7 + joint] + way * angle, way * rate
    asked, _, _ = wanted(robot, controller, q, v, reference)
    assert asked[left] == pytest.approx(back[0] * acceleration)
    assert asked[right] == pytest.approx(-back[1] * acceleration)

    more, faster = np.where(robot.leg_joints, 0.0, rng.uniform(0.1, 0.2, (2, robot.nv - 6)))
    q[7:], v[6:] = q[7:] + more, v[6:] + faster
    returned, _, _ = wanted(robot, controller, q, v, reference)
    np.testing.assert_allclose(returned - asked, -STIFFNESS * more - DAMPING * faster, atol=1e-9)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_soles_are_to_carry_the_weight_by_their_shares(robot, references, share):
    reference = references[0](load_share=(share, 1.0 - share))
    _, forces, terms = wanted(robot, robot.controller(PARAMETERS), robot.standing, np.zeros(robot.nv), reference)
    expected = np.zeros(12)
    expected[2], expected[8] = share, 1.0 - share
    np.testing.assert_allclose(forces, terms.mass * GRAVITY * expected, rtol=1e-12)
