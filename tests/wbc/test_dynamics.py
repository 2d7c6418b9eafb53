"""The joint bounds of the whole-body QP."""

import numpy as np
import pytest

from surefoot.wbc.qp.data import UNBOUNDED
from surefoot.wbc.tasks.swing import AnkleStops
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
    assert turning[columns[0] - 6] < still[columns[0] - 6] - 1.0


def bounds_at_the_end(robot, reference):
    """Bounds of a right ankle whose roll is at the end of its range and goes on, shape (2, 2) [rad/s^2]."""
    q, v, columns = robot.standing.copy(), np.zeros(robot.nv), ankle(robot)
    q[columns[1] + 1], v[columns[1]] = robot.limits.upper[columns[1] - 6], 1.0
    controller = robot.controller()
    controller.observe(RobotState(q, v))
    controller.update(reference, FootSensing((490.0, 0.0 if reference.swing_foot == 1 else 490.0)))
    return np.array([controller.qp.bounds_lower[columns], controller.qp.bounds_upper[columns]])


def test_the_end_of_the_range_of_its_roll_does_not_stop_the_body_over_a_held_foot(robot, references):
    lower, upper = bounds_at_the_end(robot, references[0]())
    assert lower[1] <= -UNBOUNDED and upper[1] >= UNBOUNDED
    assert lower[0] > -UNBOUNDED and upper[0] < UNBOUNDED


def test_it_stops_that_of_a_swinging_foot(robot, references):
    """Negative control: nothing but the joint itself turns that foot."""
    _, upper = bounds_at_the_end(robot, references[1]())
    assert upper[1] < 0.0


def test_an_ankle_that_rolls_its_foot_is_told_from_one_that_pitches_it(robot):
    stops = AnkleStops(robot.model, robot.frames, robot.limits)
    sides = ("left", "right")
    rolls = tuple(robot.model.joints[robot.model.getJointId(f"{side}_ankle_roll")].idx_v for side in sides)
    assert stops.rolling == rolls


def test_neither_does_a_foot_that_swings_count_as_at_rest(robot, references):
    rest, spun = np.zeros(robot.nv), np.zeros(robot.nv)
    spun[ankle(robot)] = 0.4, 1.0
    still, swinging = (upper_bounds(robot, references[1](), v)[1] for v in (rest, spun))
    columns = np.array(ankle(robot)) - 6
    assert np.all(swinging[columns] < still[columns] - 1.0)
