"""Control ticks one after another: what the QP holds is of the tick alone, whatever the feet did before."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.models.pinocchio import limb_shapes
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.body.separation import SeparationParameters
from surefoot.wbc.contact.contacts import ContactState
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks import TaskGains, TaskWeights
from surefoot.wbc.tasks.trunk import Torso
from surefoot.wbc.types import FootSensing

pytestmark = pytest.mark.unit

BOTH, LEFT = (ContactState((True, on), (True, on), (2943.0, 2943.0 * on)) for on in (True, False))
ROLLING, LANDING = replace(BOTH, edge=(-1, 1)), replace(BOTH, landing=(True, True))
QP = ("H", "g", "A", "bounds_lower", "bounds_upper")


class Wayward:
    """A task that gives a number too few."""

    name, size, weight = "wayward", 2, 0.3

    def write(self, terms, reference, scale, rows):
        return (0.4,)


class Calm(Torso):
    """A task that inherits a law and writes something else."""

    name = "calm"

    def write(self, terms, reference, scale, rows):
        rows[:] = 0.0
        return 7.0, 8.0, 9.0


@pytest.mark.parametrize("leaning", [None, 0.02])
def test_a_qp_has_nothing_of_the_ticks_before(robot, references, rng, leaning):
    """At one state: where the feet stood when the contacts changed is what the ZMP keeps to."""
    leans = replace(robot, frames=replace(robot.frames, leaning=leaning))
    standing, swinging = references
    rolls = (-0.2, 0.4, 0.3), (0.3, 0.5, -0.4)
    rolling = standing(edge=(-1, 1), roll=rolls)
    lifting = swinging(edge=(0, 1), roll=rolls)
    stopped = swinging(swing_rotation=np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]]))
    cases = [
        (standing(), BOTH), (rolling, ROLLING), (lifting, LEFT), (swinging(), LEFT), (stopped, LEFT),
        (standing(), BOTH), (swinging(catching=True), LEFT), (standing(), LANDING), (standing(), BOTH)
    ]  # fmt: skip
    used, state = leans.controller(), robot.moved(rng, 0.05, 0.5)
    for reference, contacts in cases:
        fresh = leans.controller()
        one, other = (made.build(made.observe(state), reference, contacts) for made in (used, fresh))
        for name in QP:
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def test_terms_of_another_controller_give_the_qp_of_that(robot, references, rng):
    own, other = robot.controller(), robot.controller()
    own.observe(robot.moved(rng))
    terms = other.observe(robot.moved(rng))
    one, two = (made.build(terms, references[1](), LEFT) for made in (own, other))
    for name in QP:
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name), err_msg=name)


def test_so_do_the_distances_between_its_limbs(robot, references):
    limbs = limb_shapes(describe("humanoid100", RobotOptions()))
    near, far = robot.standing.copy(), robot.standing.copy()
    near[robot.model.joints[robot.model.getJointId("left_hip_roll")].idx_q] -= 0.08
    within = WbcParameters(separation=SeparationParameters(attention=0.05))
    own, other = (robot.controller(within, limbs) for _ in range(2))
    for q in (far, near):
        own.terms.update(q, np.zeros(robot.nv))
        qp = own.build(own.terms, references[0](), BOTH)
        other.terms.update(near if q is far else far, np.zeros(robot.nv))
        bounds = qp.bounds_lower[-within.separation.slots :].copy()
        assert (bounds > -1e8).any() == (q is near)
        changed = own.build(other.terms, references[0](), BOTH).bounds_lower[-within.separation.slots :]
        assert (changed > -1e8).any() == (q is far)


def test_a_task_that_inherits_a_law_is_asked_itself(robot, references, rng):
    controller = robot.controller(tasks=(Calm(TaskWeights(), TaskGains()),))
    controller.build(controller.observe(robot.moved(rng)), references[0](), BOTH)
    np.testing.assert_allclose(controller.tasks.target[-3:], [7.0, 8.0, 9.0])


def test_a_task_that_gives_too_few_numbers_is_refused(robot, references, rng):
    controller = robot.controller(tasks=(Wayward(),))
    controller.observe(robot.moved(rng))
    with pytest.raises(ValueError, match="shape"):
        controller.update(references[0](), FootSensing((490.0, 490.0)))
