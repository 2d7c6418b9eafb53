"""A swing foot that is due counts as about to land, however slowly it comes down."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.types import Foot
from surefoot.scenarios.run.controller import comes_down

pytestmark = pytest.mark.unit


def coming(
    touchdown: float, speed: float, ground: float = 0.0, foot: Foot = Foot.LEFT
) -> tuple[SimpleNamespace, SimpleNamespace, np.ndarray]:
    """Plan, terms and soles of a robot whose swing foot is 1 cm above the ground, which is so high [m]."""
    plan = SimpleNamespace(
        swing=SimpleNamespace(foot=foot, touchdown_time=touchdown),
        footsteps=[SimpleNamespace(position=np.array([0.0, 0.0, ground]))],
    )
    terms = SimpleNamespace(
        sole_position=np.full((2, 3), ground + 0.01),
        sole_rotation=np.tile(np.eye(3), (2, 1, 1)),
        sole_velocity=np.full((2, 6), speed),
    )
    return plan, terms, terms.sole_position


@pytest.mark.parametrize(
    ("touchdown", "speed", "lands", "due"),
    [(1.5, -0.5, True, True), (1.03, -0.1, False, True), (1.05, -0.1, False, False), (1.5, 0.5, False, False)],
)
@pytest.mark.parametrize("ground", [0.0, 0.3, -0.2])
@pytest.mark.parametrize("foot", Foot)
def test_a_foot_lands_that_falls_so_fast_or_is_due_by_then(touchdown, speed, lands, due, ground, foot):
    """Whichever foot it is, and however high the ground."""
    now, left, robot = 1.0, 0.04, coming(touchdown, speed, ground, foot)
    assert comes_down(*robot, now, left) == (lands and foot is Foot.LEFT, lands and foot is Foot.RIGHT)
    assert comes_down(*robot, now, left, due=True) == (due and foot is Foot.LEFT, due and foot is Foot.RIGHT)


def test_the_foot_of_a_step_that_catches_arrives_once_its_place_is_decided():
    """From then on, and for the time of a command before it, until it is felt."""
    usual, due = PROFILES["default"], []

    def listening(view):
        feet, plan, swing = view.measured.feet, view.state.plan, view.state.phase.swing_foot
        flown = plan is not None and plan.swing is not None and swing is plan.swing.foot
        if flown and plan.balance.catching and not feet.contact[swing]:
            left = plan.swing.touchdown_time - view.measured.time
            due.append((left, view.state.model.parameters.freeze_catching, feet.arriving[swing]))
            assert not feet.arriving[swing.other]
        return view

    push = {"step": 1, "phase": "single", "fraction": 0.5, "duration": 0.1, "impulse": 0.6, "direction": 0.2}
    keys = {"robot": "g1", "sensing.source": "truth", "gait.initial_stand": 0.1, "duration": 1.3, "pushes": [push]}
    profile = replace(usual, rules=(listening, *usual.rules))
    with surefoot.Simulation(surefoot.load("walk-level", keys), planner=profile) as simulation:
        while not simulation.done:
            simulation.step()
    assert all(arrives for left, decided, arrives in due if left <= decided)
    assert not any(arrives for left, decided, arrives in due if left > 3.0 * decided)
    assert sum(left <= decided for left, decided, _ in due) >= 2 and max(due)[0] > 0.3
