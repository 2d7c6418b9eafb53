import math

import pytest

from planner.gait import GaitParameters, samples
from planner.parameters import PlannerParameters
from planner.types import Foot

pytestmark = pytest.mark.unit


def test_feet_alternate_from_the_first():
    gait = GaitParameters(first_foot=Foot.RIGHT)
    assert [gait.step_foot(i) for i in (-1, 0, 1, 2, 3)] == [1, 0, 1, 0, 1]


@pytest.mark.parametrize(
    ("name", "value"),
    [("single_support", -1.0), ("step_width", 0.0), ("step_length", math.nan), ("steps", -1), ("apex_ss", -0.1)],
)
def test_bad_value_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=rf"gait\.{name} is .*\.$"):
        GaitParameters(**{name: value})


def test_duration_must_be_a_multiple_and_the_nearest_is_named():
    assert samples("gait.single_support", 1.5, 0.02) == 75
    with pytest.raises(ValueError, match=r"nearest is 0\.16 s"):
        samples("gait.double_support", 0.151, 0.02)


@pytest.mark.parametrize(("name", "value"), [("horizon", 0), ("jerk_limit", -1.0), ("step_weight", math.nan)])
def test_bad_planner_parameter_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=rf"planner\.{name} is"):
        PlannerParameters(**{name: value})
