"""The simulated world of the tour: mechanics that a stranger can work out by hand."""

import mujoco
import numpy as np
import pytest

from surefoot.joints import JointCommand, Servo
from surefoot.models import RobotOptions, describe
from surefoot.studies.tour.robot import robot_file, tour_robot
from surefoot.studies.tour.rules import PUNCH_TIME, Punch
from surefoot.studies.tour.world import RATE, TourWorld

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def described():
    return describe(str(robot_file()), RobotOptions())


def world(described, height=0.0):
    made = TourWorld(described, tour_robot())
    q = np.zeros(made.model.nq)
    q[2], q[6] = 2.0 + height, 1.0
    q[7:] = described.nominal_joint_positions
    made.reset(q)
    return made, q


def holding(q, joints=29):
    return JointCommand(np.zeros(joints), Servo(q[7:], np.zeros(joints), np.full(joints, 60.0), np.full(joints, 2.0)))


@pytest.mark.parametrize("joint", [3, 14, 21])
def test_a_punch_in_the_air_gives_the_body_its_impulse(described, joint):
    ends, given = [], np.zeros(3)
    for force in (0.0, 200.0):
        made, q = world(described)
        punch = Punch(0.0, joint, np.array([0.6, 0.0, 0.8]), force)
        for _ in range(round(PUNCH_TIME * RATE)):
            given += made.direction(punch) * force / RATE  # as the link turns
            made.advance(holding(q), 1.0 / RATE, punch)
        mujoco.mj_forward(made.model, made.data)
        mujoco.mj_subtreeVel(made.model, made.data)
        ends.append((made.data.subtree_linvel[1] * described.mass).copy())
    assert ends[1] - ends[0] == pytest.approx(given, abs=0.03 * punch.impulse)
    assert np.linalg.norm(given) > 0.9 * punch.impulse


def test_soles_carry_the_weight_of_what_stands_and_nothing_of_what_flies(described):
    made, q = world(described)
    made.advance(holding(q), 0.02)
    assert not made.measure().wrench.any()
    lowest = min(made.data.site_xpos[made.model.site(name).id][2] for name in described.sole_sites)
    q[2] -= lowest
    made.reset(q)
    forces = []
    for _ in range(200):
        made.advance(holding(q), 0.002)
        forces.append(made.measure().wrench[:, 2].sum())
    # Until it tips over, what is held is carried in the mean.
    assert np.mean(forces[100:]) == pytest.approx(9.81 * described.mass, rel=0.1)


def test_torques_are_clipped_to_the_limits_and_their_work_is_counted(described):
    made, _ = world(described)
    made.advance(JointCommand(np.full(29, 1e4)), 0.002)
    assert np.array_equal(made.torque, described.torque_limit)
    assert made.energy == pytest.approx(np.abs(made.torque * made.data.qvel[6:]) * 0.002)


def test_hands_stay_before_the_body_and_below_the_head(described):
    made, _ = world(described)
    left, right = (
        np.flatnonzero([name.startswith(side) and ("shoulder" in name or "elbow" in name or "wrist" in name)
                        for name in described.joint_names]) for side in ("left", "right")
    )  # fmt: skip
    allowed = made.hands_allowed(tour_robot(), left, right)
    stance = np.array(tour_robot().arm_stance)
    assert allowed(stance)
    behind, above = stance.copy(), stance.copy()
    behind[0], above[0] = 1.2, -2.8
    assert not allowed(behind) and not allowed(above)
    ahead = stance.copy()
    ahead[0] = -0.4
    assert allowed(ahead)
