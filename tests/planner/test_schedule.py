import numpy as np
import pytest

from planner.gait import GaitParameters
from planner.schedule import schedule
from planner.types import PhaseKind

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("steps", [0, 1, 2, 7])
@pytest.mark.parametrize("stand", [0.0, 1.0])
def test_phases_cover_the_clock_without_gaps(steps, stand):
    plan = schedule(GaitParameters(steps=steps, initial_stand=stand), 0.02, 150)
    assert plan.phases[0].start == 0
    assert all(a.end == b.start for a, b in zip(plan.phases, plan.phases[1:], strict=False))
    assert [p.kind for p in plan.phases].count(PhaseKind.SINGLE) == steps
    assert plan.phases[-1].kind is PhaseKind.STAND
    assert plan.phase(plan.last + 10_000) is plan.phases[-1]
    assert len(plan.index) >= plan.last + 151


def test_support_progress_is_continuous_and_never_goes_back():
    plan = schedule(GaitParameters(steps=4), 0.02, 150)
    progress = plan.index + plan.fraction
    assert np.all(np.diff(progress) >= 0.0)
    assert np.diff(progress).max() == pytest.approx(0.02 / 0.5)
    assert progress[0] == 0.0
    assert progress[-1] == 5.0


def test_one_foot_carries_all_in_single_support_and_load_is_continuous():
    plan = schedule(GaitParameters(steps=3), 0.02, 150)
    for phase in plan.phases:
        if phase.kind is PhaseKind.SINGLE:
            span = slice(phase.start, phase.end)
            assert np.all(plan.load_left[span] == float(phase.stance == 0))
            assert not plan.contacts[span, phase.stance.other].any()
    assert np.abs(np.diff(plan.load_left)).max() <= 0.04 + 1e-12
    assert plan.load_left[0] == plan.load_left[-1] == 0.5


def test_first_double_support_rests_for_half_of_it():
    plan = schedule(GaitParameters(initial_stand=1.0, double_support=0.5), 0.02, 150)
    assert np.all(plan.fraction[:76] == 0.0)
    assert plan.fraction[76] > 0.0


def test_duration_off_the_grid_is_refused():
    with pytest.raises(ValueError, match=r"gait\.single_support is 0\.75 s"):
        schedule(GaitParameters(single_support=0.75), 0.02, 150)
