"""Joints that somebody else drives are equalities of the QP: by their torque, or by the acceleration that is seen."""

import numpy as np
import pytest

from surefoot.models.pinocchio import limb_shapes
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.qp.driven import without_driven
from surefoot.wbc.types import FootSensing, SolveStatus

pytestmark = pytest.mark.unit


@pytest.fixture
def driven(robot):
    """Mark the last four joints that are of no leg."""
    mask = np.zeros(len(robot.leg_joints), dtype=bool)
    mask[np.flatnonzero(~robot.leg_joints)[-4:]] = True
    return mask


@pytest.fixture
def standing(robot, references):
    return references[0]()


def solved(robot, standing, controller, tell=None):
    controller.observe(robot.moved(np.random.default_rng(3), 0.01, 0.1))
    if tell is not None:
        controller.driven.tell(*tell)
    report = controller.update(standing, FootSensing((490.0, 490.0)))
    assert report.status is SolveStatus.SOLVED
    return report


def torque_of(controller, report):
    """Joint torques that the equations of motion take of a solution, shape (nj,) [N·m]."""
    terms = controller.terms
    pushed = terms.contact_jacobian.T @ report.wrench.ravel()
    return (terms.mass_matrix @ report.acceleration + terms.bias - pushed)[6:]


def test_a_known_torque_is_that_of_the_solution(robot, standing, driven):
    controller, torque = robot.controller(driven=driven), np.full(len(driven), 0.7)
    report = solved(robot, standing, controller, (torque,))
    assert torque_of(controller, report)[driven] == pytest.approx(0.7, abs=1e-5)
    free = robot.controller()
    assert np.abs(torque_of(free, solved(robot, standing, free))[driven] - 0.7).max() > 0.1


def test_a_drive_with_gains_is_that_of_the_end_of_the_period(robot, standing, driven):
    controller, zero = robot.controller(driven=driven), np.zeros(len(driven))
    stiffness, damping, period = 20.0, 2.0, 0.002
    report = solved(robot, standing, controller, (zero, stiffness, damping))
    gained = report.acceleration[6:][driven]
    expected = -(damping * period + 0.5 * stiffness * period**2) * gained
    assert torque_of(controller, report)[driven] == pytest.approx(expected, abs=1e-5)


def test_unknown_ones_go_on_as_they_are_seen_to(robot, standing, driven):
    controller = robot.controller(driven=driven)
    report = solved(robot, standing, controller, (None,))
    assert report.acceleration[6:][driven] == pytest.approx(0.0, abs=1e-6)


def test_limits_bind_none_of_them(robot, standing, driven):
    controller = robot.controller(driven=driven)
    torque = np.where(driven, 1.2 * robot.limits.torque, 0.0)
    report = solved(robot, standing, controller, (torque,))
    assert torque_of(controller, report)[driven] == pytest.approx(torque[driven], rel=1e-6)


def test_pairs_of_bodies_that_they_move_are_left_alone(robot, driven):
    limbs = limb_shapes(describe("humanoid100", RobotOptions()))
    left = without_driven(robot.model, limbs, driven)
    assert 0 < len(left.collisionPairs) < len(limbs.collisionPairs)
