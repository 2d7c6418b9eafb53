"""A swing foot that is due counts as about to land, however slowly it comes down."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.planner.types import Foot
from surefoot.scenarios.run.controller import comes_down

pytestmark = pytest.mark.unit


def coming(touchdown: float, speed: float) -> tuple[SimpleNamespace, SimpleNamespace, np.ndarray]:
    """Plan, terms and soles of a robot whose left foot is 1 cm above the ground."""
    plan = SimpleNamespace(
        swing=SimpleNamespace(foot=Foot.LEFT, touchdown_time=touchdown),
        footsteps=[SimpleNamespace(position=np.zeros(3))],
    )
    terms = SimpleNamespace(
        sole_position=np.full((2, 3), 0.01),
        sole_rotation=np.tile(np.eye(3), (2, 1, 1)),
        sole_velocity=np.full((2, 6), speed),
    )
    return plan, terms, terms.sole_position


@pytest.mark.parametrize(
    ("touchdown", "speed", "lands", "due"),
    [(1.5, -0.5, True, True), (1.03, -0.1, False, True), (1.05, -0.1, False, False), (1.5, 0.5, False, False)],
)
def test_a_foot_lands_that_falls_so_fast_or_is_due_by_then(touchdown, speed, lands, due):
    now, left = 1.0, 0.04
    assert comes_down(*coming(touchdown, speed), now, left) == (lands, False)
    assert comes_down(*coming(touchdown, speed), now, left, due=True) == (due, False)
