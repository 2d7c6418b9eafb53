"""Knees of the legs that carry are brought to a small flexion."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.wbc.parameters import StraightKnees, WbcParameters
from surefoot.wbc.tasks.knees import Knees, StanceKnees

pytestmark = pytest.mark.unit

STRAIGHT = StraightKnees(weight=0.01, flexion=0.2, gains=(40.0, 12.0))


@pytest.fixture
def state(robot, rng):
    return robot.moved(rng, 0.02, 0.3)


def written(task, terms, reference, nv):
    rows = np.zeros((2, nv + 12))
    return rows, np.array(tuple(task.write(terms, reference, np.ones((2, 1)), rows)))


@pytest.mark.parametrize("shares", [(1.0, 0.0), (0.0, 1.0), (0.3, 0.7)], ids=str)
def test_each_knee_counts_by_the_weight_on_its_foot(robot, state, references, shares):
    knees = Knees((3, 9), (0.1, -0.2), (1.0, -0.5))
    task, terms = StanceKnees(STRAIGHT, knees), robot.controller().observe(state)
    rows, target = written(task, terms, references[0](load_share=shares), robot.nv)
    for k, (joint, straight, turn) in enumerate(zip(knees.joints, knees.straight, knees.turn, strict=True)):
        expected = np.zeros(robot.nv + 12)
        expected[6 + joint] = shares[k]
        np.testing.assert_allclose(rows[k], expected)
        wanted = 40.0 * (straight + 0.2 * turn - state.q[7 + joint]) - 12.0 * state.v[6 + joint]
        assert target[k] == pytest.approx(shares[k] * wanted)


def test_without_a_weight_there_is_no_task(robot):
    knees = Knees((3, 9), (0.0, 0.0), (1.0, 1.0))
    without = robot.controller(knees=knees)
    assert "knees" not in dict(without.task_layout)
    assert dict(robot.controller(WbcParameters(knees=STRAIGHT), knees=knees).task_layout)["knees"] == 2
    assert "knees" not in dict(robot.controller(WbcParameters(knees=STRAIGHT)).task_layout)


def test_it_does_not_count_while_a_step_catches_the_body(robot, state, references, loaded):
    knees = Knees((3, 9), (0.0, 0.0), (1.0, 1.0))
    torques = []
    for flexion, catching in ((0.2, False), (0.6, False), (0.2, True), (0.6, True)):
        parameters = WbcParameters(knees=replace(STRAIGHT, weight=0.1, flexion=flexion))
        controller = robot.controller(parameters, knees=knees)
        controller.observe(state)
        torques.append(controller.update(references[0](catching=catching), loaded).torque)
    assert np.abs(torques[0] - torques[1]).max() > 0.1
    np.testing.assert_array_equal(torques[2], torques[3])
