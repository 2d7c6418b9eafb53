"""What the compiled control tick does with what no walk of the catalogue has: leaning feet, and tasks of one's own."""

from dataclasses import replace

import numpy as np
import pytest
from needs import KERNELS

from surefoot.native.library import VARIABLE
from surefoot.wbc.contacts import ContactState
from surefoot.wbc.tasks import TaskGains, TaskWeights
from surefoot.wbc.tasks.trunk import Torso
from surefoot.wbc.types import FootSensing

pytestmark = pytest.mark.unit

BOTH, LEFT = (ContactState((True, on), (True, on), (2943.0, 2943.0 * on)) for on in (True, False))
ROLLING, LANDING = replace(BOTH, rolling=1), replace(BOTH, landing=(True, True))


class Still:
    """A task of one's own: joints that do not accelerate."""

    name, size, weight = "still", 2, 0.3

    def write(self, terms, reference, scale, rows):
        rows[0, 9] = rows[1, 12] = float(scale[0, 0])
        return 0.4, -0.2


class Wayward(Still):
    """One that gives a number too few."""

    def write(self, terms, reference, scale, rows):
        return (0.4,)


@pytest.fixture
def pair(monkeypatch):
    """A plain controller and a compiled one."""

    def make(robot, **given):
        KERNELS.or_skip()
        monkeypatch.setenv(VARIABLE, "0")
        plain = robot.controller(**given)
        monkeypatch.delenv(VARIABLE)
        return plain, robot.controller(**given)

    return make


def held_alike(robot, pair, cases, rng):
    """Every case, in turn, at states of its own."""
    for reference, contacts in cases:
        state = robot.moved(rng, 0.05, 0.5)
        qps, answers = [], []
        for controller in pair:
            terms = controller.observe(state)
            qp = controller.build(terms, reference, contacts)
            qps.append(qp.copy())
            answers.append(controller.interpret(terms, controller.solve(qp)[1]))
        for name in ("H", "g", "A", "bounds_lower", "bounds_upper"):
            one, other = (getattr(qp, name) for qp in qps)
            np.testing.assert_allclose(other, one, rtol=1e-11, atol=1e-11 * np.abs(one).max(), err_msg=name)
        for name in ("torque", "acceleration", "wrench", "task_error"):
            one, other = (getattr(answer, name) for answer in answers)
            np.testing.assert_allclose(other, one, atol=1e-9 * max(1.0, np.abs(one).max()), err_msg=name)


@pytest.mark.parametrize("leaning", [None, 0.02])
def test_feet_that_roll_lean_or_swing_one_after_another(robot, pair, references, rng, leaning):
    leans = replace(robot, frames=replace(robot.frames, leaning=leaning))
    standing, swinging = references
    rolling = standing(rolling_foot=1, roll=(0.3, 0.5, -0.4))
    lifting = swinging(rolling_foot=1, roll=(0.3, 0.5, -0.4))
    stopped = swinging(swing_rotation=np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]]))
    cases = [
        (standing(), BOTH), (rolling, ROLLING), (lifting, LEFT), (swinging(), LEFT), (stopped, LEFT),
        (standing(), BOTH), (standing(), LANDING), (standing(), LANDING), (standing(), BOTH)
    ]  # fmt: skip
    held_alike(leans, pair(leans), cases, rng)


def test_tasks_of_ones_own_stand_beside_kernels_one_by_one(robot, pair, references, rng):
    held_alike(robot, pair(robot, tasks=(Still(),)), [(references[1](), LEFT), (references[0](), BOTH)], rng)


def test_terms_of_others_are_read_by_plain_python(robot, pair, references, rng):
    plain, compiled = pair(robot)
    compiled.observe(robot.moved(rng))
    terms = plain.observe(robot.moved(rng))
    one, other = (controller.build(terms, references[1](), LEFT) for controller in (plain, compiled))
    for name in ("H", "g", "A", "bounds_lower", "bounds_upper"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
    x = plain.solve(one)[1]
    np.testing.assert_array_equal(plain.interpret(terms, x).torque, compiled.interpret(terms, x).torque)


def test_a_task_that_inherits_a_kernel_is_asked_itself(robot, references):
    class Calm(Torso):
        name = "calm"

        def write(self, terms, reference, scale, rows):
            rows[:] = 0.0
            return 7.0, 8.0, 9.0

    controller = robot.controller(tasks=(Calm(TaskWeights(), TaskGains()),))
    controller.build(controller.observe(robot.moved(np.random.default_rng(2))), references[0](), BOTH)
    np.testing.assert_allclose(controller.tasks.target[-3:], [7.0, 8.0, 9.0])


def test_a_task_that_gives_too_few_numbers_is_refused(robot, references):
    controller = robot.controller(tasks=(Wayward(),))
    controller.observe(robot.moved(np.random.default_rng(2)))
    with pytest.raises(ValueError, match="shape"):
        controller.update(references[0](), FootSensing((490.0, 490.0)))
