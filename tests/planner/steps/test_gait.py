import math
from itertools import pairwise

import pytest

from surefoot.errors import ParameterError
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.gait import Bout, GaitParameters, in_samples
from surefoot.planner.types import Foot, PhaseKind, Twist

pytestmark = pytest.mark.unit


def test_feet_alternate_from_the_first():
    gait = GaitParameters(first_foot=Foot.RIGHT)
    assert [gait.step_foot(i) for i in (-1, 0, 1, 2, 3)] == [1, 0, 1, 0, 1]


@pytest.mark.parametrize(
    ("name", "value"),
    [("single_support", -1.0), ("step_width", 0.0), ("step_length", math.nan), ("steps", -1), ("apex_ss", -0.1)],
)
def test_bad_value_is_refused_by_name(name, value):
    with pytest.raises(ParameterError, match=rf"^{name} is .*; it must") as refused:
        GaitParameters(**{name: value})
    assert refused.value.key == ("gait", name)


def test_a_duration_may_be_anything_and_a_multiple_is_a_whole_number():
    assert in_samples(1.5, 0.02) == 75
    assert in_samples(0.02 * 3 * 7, 0.02) == 21
    assert in_samples(1.0, 1 / 30) == 30
    assert in_samples(0.637, 0.02) == pytest.approx(31.85)


@pytest.mark.parametrize(("name", "value"), [("horizon", 0), ("jerk_limit", -1.0), ("step_weight", math.nan)])
def test_bad_planner_parameter_is_refused_by_name(name, value):
    with pytest.raises(ParameterError, match=rf"^{name} of the planner is") as refused:
        PlannerParameters(**{name: value})
    assert refused.value.key == ("parameters", name)


def test_bad_stride_and_bout_are_refused():
    stride = Twist(0.2, width=0.2)
    for values in ((math.nan, 0.0, 0.0, 0.2), (0.2, 0.0, 0.0, 0.0), (0.2, 0.0, math.inf, 0.2)):
        with pytest.raises(ParameterError, match=r"of a stride is"):
            Bout(1.0, (stride, Twist(*values)))
    with pytest.raises(ParameterError, match=r"standing before a bout is -1 s"):
        Bout(-1.0, (stride,))
    with pytest.raises(ParameterError, match=r"at least one"):
        Bout(1.0, ())
    with pytest.raises(ParameterError, match=r"steps is 5, but the bouts have 2 strides"):
        GaitParameters(bouts=(Bout(1.0, (stride, stride)),))


def test_standing_has_no_strides():
    assert GaitParameters(steps=0).walk == ()
    assert GaitParameters(steps=0).strides == ()


def test_times_of_a_gait_are_those_of_its_phases(schedule):
    """Two bouts: lift-offs and durations in seconds against the phases that the clock lays out in samples."""
    stride = Twist(0.2, width=0.2)
    bouts = (Bout(1.0, (stride, stride, stride)), Bout(0.7, (stride, stride)))
    gait = GaitParameters(steps=5, bouts=bouts, single_support=0.6, double_support=0.2)
    phases = schedule(gait).phases
    swings = [(before, phase) for before, phase in pairwise(phases) if phase.kind is PhaseKind.SINGLE]
    assert len(swings) == 5
    for step, (before, phase) in enumerate(swings, start=1):
        assert gait.lift_off(step) == pytest.approx(0.02 * phase.start)
        assert gait.support_before(step) == pytest.approx(0.02 * before.samples)
    assert gait.duration == pytest.approx(0.02 * phases[-1].start)
    assert [gait.support_before(step) for step in range(1, 6)] == [0.4, 0.2, 0.2, 0.4, 0.2]
    assert GaitParameters(steps=0).duration == 1.0
    with pytest.raises(ParameterError, match="no step 1 of a gait that stands"):
        GaitParameters(steps=0).lift_off(1)
