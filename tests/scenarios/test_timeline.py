import pytest

from planner.schedule import schedule
from planner.types import PhaseKind
from scenarios.file.planner_setup import gait_parameters
from scenarios.file.schema import Gait, Scenario
from scenarios.file.timeline import FINAL_STAND, phase_duration, phase_start, run_duration

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("stand", [0.0, 1.0])
def test_times_are_those_of_the_planners_schedule(stand):
    scenario = Scenario(gait=Gait(steps=4, single_support=0.6, double_support=0.2, initial_stand=stand))
    phases = schedule(gait_parameters(scenario), 0.02, 10).phases
    singles = [phase for phase in phases if phase.kind is PhaseKind.SINGLE]
    doubles = [phase for phase in phases if phase.kind is PhaseKind.DOUBLE]
    for step, (single, double) in enumerate(zip(singles, doubles, strict=False), start=1):
        for name, phase in (("single", single), ("double", double)):
            assert phase_start(scenario.gait, step, name) == pytest.approx(0.02 * phase.start)
            assert phase_duration(scenario.gait, step, name) == pytest.approx(0.02 * phase.samples)
    assert run_duration(scenario) == pytest.approx(0.02 * phases[-1].start + FINAL_STAND)
