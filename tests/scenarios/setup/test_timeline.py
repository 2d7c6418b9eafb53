from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.planner.types import PhaseKind
from surefoot.planner.walk.clock import schedule
from surefoot.scenarios.file.schema import Gait, Scenario
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.gait import (
    FINAL_STAND,
    on_samples,
    phase_of,
)

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("stand", [0.0, 1.0])
def test_times_are_those_of_the_planners_schedule(stand):
    scenario = Scenario(gait=Gait(steps=4, single_support=0.6, double_support=0.2, initial_stand=stand))
    phases = schedule(Draft(scenario).gait, 0.02, 10).phases
    singles = [phase for phase in phases if phase.kind is PhaseKind.SINGLE]
    doubles = [phase for phase in phases if phase.kind is PhaseKind.DOUBLE]
    for step, (single, double) in enumerate(zip(singles, doubles, strict=False), start=1):
        for name, phase in (("single", single), ("double", double)):
            assert phase_of(Draft(scenario).gait, step, name)[0] == pytest.approx(0.02 * phase.start)
            assert phase_of(Draft(scenario).gait, step, name)[1] == pytest.approx(0.02 * phase.samples)
    assert Draft(scenario).duration == pytest.approx(0.02 * phases[-1].start + FINAL_STAND)


def test_times_of_a_walk_that_stops():
    velocity = ({"time": 0.0, "v_x": 0.3}, {"time": 4.0}, {"time": 8.0, "v_x": 0.2}, {"time": 10.0})
    scenario = Scenario(gait=Gait(single_support=0.6, double_support=0.2, velocity=velocity))
    phases = schedule(Draft(scenario).gait, 0.02, 10).phases
    singles = [index for index, phase in enumerate(phases) if phase.kind is PhaseKind.SINGLE]
    assert Draft(scenario).gait.steps == len(singles)
    for step, index in enumerate(singles, start=1):
        for name, phase in (("single", phases[index]), ("double", phases[index - 1])):
            assert phase_of(Draft(scenario).gait, step, name)[0] == pytest.approx(0.02 * phase.start)
            assert phase_of(Draft(scenario).gait, step, name)[1] == pytest.approx(0.02 * phase.samples)
    assert Draft(scenario).duration == pytest.approx(0.02 * phases[-1].start + FINAL_STAND)


def test_a_gait_without_motion_lasts_its_stand():
    standing = (Gait(velocity=({"time": 3.0},)), Gait(steps=0))
    assert [Draft(Scenario(gait=gait)).gait_duration for gait in standing] == [1.0, 1.0]


@given(st.integers(1, 1700), st.sampled_from([0.02, 0.01, 0.005, 1 / 30]))
def test_multiples_stay_to_the_bit(count, sample_time):
    for value in (count * sample_time, float(f"{count * sample_time:.10g}")):
        gait = Gait(single_support=value, double_support=value, initial_stand=value, velocity=({"time": value},))
        assert on_samples(gait, sample_time)[0] is gait


@given(st.floats(1e-6, 60.0), st.sampled_from([0.02, 0.01, 1 / 30]))
def test_other_durations_are_walked_at_the_nearest_multiple(value, sample_time):
    gait, notes = on_samples(Gait(single_support=value, initial_stand=value), sample_time)
    for name, least in (("single_support", sample_time), ("initial_stand", 0.0)):
        walked = getattr(gait, name)
        assert abs(walked - max(value, least)) <= 0.5 * sample_time * (1 + 1e-9)
        assert walked / sample_time == pytest.approx(round(walked / sample_time), abs=1e-6)
        assert any(note.startswith(f"gait.{name} ") for note in notes) == (walked != value)


def test_times_of_commands_keep_their_order():
    commands = ({"time": 0.0, "v_x": 0.2}, {"time": 1.013}, {"time": 4.0, "v_x": 0.1}, {"time": 8.55})
    gait, notes = on_samples(Gait(velocity=commands), 0.02)
    times = [command.time for command in gait.velocity]
    assert times[:3] == [0.0, 1.02, 4.0]
    assert all(before < after for before, after in pairwise(times))
    assert len(notes) == 2
    assert notes[0] == (
        "gait.velocity.1.time 1.013 s is walked as 1.02 s, the nearest multiple of planner.sample_time 0.02 s"
    )
