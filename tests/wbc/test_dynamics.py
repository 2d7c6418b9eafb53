"""The joint bounds of the whole-body QP."""

import numpy as np
import pytest

from surefoot.wbc.types import FootSensing, RobotState

pytestmark = pytest.mark.unit


def upper_bounds(robot, reference, v):
    controller = robot.controller()
    terms = controller.observe(RobotState(robot.standing, v))
    controller.update(reference, FootSensing((490.0, 0.0 if reference.swing_foot == 1 else 490.0)))
    return terms, controller.qp.bounds_upper[6 : robot.nv].copy()


def ankle(robot):
    return [robot.model.joints[robot.model.getJointId(f"right_ankle_{axis}")].idx_v for axis in ("pitch", "roll")]


def test_a_held_foot_that_ripples_does_not_hasten_its_ankle_to_the_end_of_its_range(robot, references):
    rest, spun = np.zeros(robot.nv), np.zeros(robot.nv)
    spun[ankle(robot)] = 0.4, 1.0
    still, rippling = (upper_bounds(robot, references[0](), v)[1] for v in (rest, spun))
    np.testing.assert_allclose(rippling, still, atol=1e-6)


def test_a_shank_that_turns_over_a_foot_at_rest_does(robot, references):
    """Negative control, with the foot at rest: its spin is not taken from a rate that is the shank's."""
    v, columns = np.zeros(robot.nv), ankle(robot)
    terms, _ = upper_bounds(robot, references[0](), v)
    spin = terms.sole_jacobian[1, 3:]
    v[columns] = 0.4, 1.0
    v[3:6] = -np.linalg.solve(spin[:, 3:6], spin[:, columns] @ v[columns])
    still, turning = (upper_bounds(robot, references[0](), rates)[1] for rates in (np.zeros(robot.nv), v))
    moved = robot.controller().observe(RobotState(robot.standing, v))
    np.testing.assert_allclose(moved.sole_velocity[1, 3:], 0.0, atol=1e-9)
    assert np.all(turning[np.array(columns) - 6] < still[np.array(columns) - 6] - 1.0)


def test_neither_does_a_foot_that_swings_count_as_at_rest(robot, references):
    rest, spun = np.zeros(robot.nv), np.zeros(robot.nv)
    spun[ankle(robot)] = 0.4, 1.0
    still, swinging = (upper_bounds(robot, references[1](), v)[1] for v in (rest, spun))
    columns = np.array(ankle(robot)) - 6
    assert np.all(swinging[columns] < still[columns] - 1.0)
