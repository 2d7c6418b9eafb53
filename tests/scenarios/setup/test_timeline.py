import numpy as np
import pytest

from surefoot.planner.ground.terrain import flat
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.groups.gait import FINAL_STAND, phase_of
from surefoot.scenarios.setup.walk import Walk

pytestmark = pytest.mark.unit


def phases_of(walk):
    """The phases of a whole walk."""
    ground = Ground(flat(), np.array([0.1, 0.05]), walk.formulation.parameters)
    return Schedule.start(walk.asked_gait, walk.ground.stance, ground).extended(np.inf).phases


@pytest.mark.parametrize("stand", [0.0, 1.0])
def test_times_are_those_of_the_planners_schedule(stand):
    scenario = Scenario(gait=Gait(steps=4, single_support=0.6, double_support=0.2, initial_stand=stand))
    phases = phases_of(Walk(scenario))
    singles = [phase for phase in phases if phase.kind is PhaseKind.SINGLE]
    doubles = [phase for phase in phases if phase.kind is PhaseKind.DOUBLE]
    for step, (single, double) in enumerate(zip(singles, doubles, strict=False), start=1):
        for name, phase in (("single", single), ("double", double)):
            assert phase_of(Walk(scenario).asked_gait, step, name)[0] == pytest.approx(0.02 * phase.start)
            assert phase_of(Walk(scenario).asked_gait, step, name)[1] == pytest.approx(0.02 * phase.samples)
    assert Walk(scenario).duration == pytest.approx(0.02 * phases[-1].start + FINAL_STAND)


def test_times_of_a_walk_that_stops():
    velocity = ({"time": 0.0, "v_x": 0.3}, {"time": 4.0}, {"time": 8.0, "v_x": 0.2}, {"time": 10.0})
    scenario = Scenario(gait=Gait(single_support=0.6, double_support=0.2, velocity=velocity))
    phases = phases_of(Walk(scenario))
    singles = [index for index, phase in enumerate(phases) if phase.kind is PhaseKind.SINGLE]
    assert Walk(scenario).asked_gait.steps == len(singles)
    for step, index in enumerate(singles, start=1):
        for name, phase in (("single", phases[index]), ("double", phases[index - 1])):
            assert phase_of(Walk(scenario).asked_gait, step, name)[0] == pytest.approx(0.02 * phase.start)
            assert phase_of(Walk(scenario).asked_gait, step, name)[1] == pytest.approx(0.02 * phase.samples)
    assert Walk(scenario).duration == pytest.approx(0.02 * phases[-1].start + FINAL_STAND)


def test_a_gait_without_motion_lasts_its_stand():
    standing = (Gait(velocity=({"time": 3.0},)), Gait(steps=0))
    assert [Walk(Scenario(gait=gait)).gait_duration for gait in standing] == [1.0, 1.0]
