import numpy as np
import pytest

from surefoot.planner.references.leg_offset import nominal_feet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit


def test_feet_that_search_for_the_ground_are_expected_to_find_it(schedule):
    """A swing goes on down after its touchdown; planned through the ground, its legs would seem to accelerate."""
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    soles, *_ = nominal_feet(made.samples, made.schedule, (np.eye(2), np.zeros(2)))
    assert (made.samples.kind == PhaseKind.SINGLE).any()
    assert soles[..., 2].max() > 0.04
    assert soles[..., 2].min() > -1e-9
