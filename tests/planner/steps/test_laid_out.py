"""Steps that are laid before a walk begins are those that would be laid on the way."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps import schedule as module
from surefoot.planner.steps.adaptation import with_steps_repeated
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground

pytestmark = pytest.mark.unit

WALK = GaitParameters(steps=12, step_length=0.28, initial_stand=0.1)


def begun(stand, edges, gait=WALK):
    stairs = Stairs(0.1, 0.28, 4, Direction.UP, start=0.14, landing=1.0, beyond=2.0)
    terrain = stairs.build(Site(np.zeros(2), 0.0, 0.8)) if edges else flat()
    parameters = PlannerParameters(reach_length=0.8)
    return Schedule.start(gait, stand(), Ground(terrain, np.array([0.075, 0.05]), parameters))


def told(step):
    return (
        *(step.number, step.ordinal, step.stride, step.course, step.climb, step.lift, step.hardest, step.support),
        *(
            step.stop,
            step.lift_off,
            step.single_support,
            step.double_support,
            step.toe_off,
            step.heel_strike,
            step.place.foot,
            step.place.yaw,
        ),
        *(step.place.position.tolist(), step.place.normal.tolist(), step.room.tolist(), step.path.middle.tolist()),
    )


@pytest.fixture
def laid(monkeypatch):
    """Numbers of the steps that are laid."""
    numbers, make_step = [], module.make_step

    def counted(stride, before, *rest):
        numbers.append(before[1].number + 1)
        return make_step(stride, before, *rest)

    monkeypatch.setattr(module, "make_step", counted)
    return numbers


@pytest.mark.parametrize("edges", [False, True])
def test_steps_laid_beforehand_are_those_laid_on_the_way(stand, edges, laid):
    on_the_way = begun(stand, edges)
    beforehand = on_the_way.with_nominal_steps()
    laid.clear()
    way = np.array([0.01, -0.02, 0.0])
    for clock in np.arange(0.0, 900.0, 37.0):
        walks = []
        for schedule in (on_the_way, beforehand):
            seen = schedule.extended(clock + 100.0, clock)
            number = seen.phase(clock).leaves
            if number <= seen.last.number:
                seen = seen.moved(number, seen.step(number).place.position + way)
            walks.append(seen.forgotten(clock))
        on_the_way, beforehand = walks
        assert [*map(told, on_the_way.steps)] == [*map(told, beforehand.steps)]
        assert on_the_way.phases == beforehand.phases == replace(beforehand).phases
        for name in ("supports", "yaws", "first_support"):
            np.testing.assert_array_equal(getattr(beforehand, name), getattr(replace(beforehand), name))
    assert laid == [*range(1, 13)]  # each once: on the way


def test_what_comes_otherwise_than_laid_is_laid_anew(stand, laid):
    schedule = begun(stand, False).with_nominal_steps()
    walk = schedule.extended(100.0)
    laid.clear()
    assert walk.until(2, stands=False).extended(100.0).steps[2:] != walk.steps[2:]
    assert not laid
    repeated = with_steps_repeated(walk, 2).extended(400.0)
    assert laid == [*range(3, repeated.last.number + 1)]
    laid.clear()
    faster = walk.until(2, stands=False).retimed(replace(WALK, single_support=0.7), 0.0).extended(100.0)
    assert laid == [*range(3, faster.last.number + 1)]
    laid.clear()
    late = schedule.extended(400.0, now=30.0)
    assert laid[0] == 1
    assert late.step(1).lift_off > walk.step(1).lift_off


def test_of_a_long_walk_on_bare_ground_two_minutes_are_laid(stand):
    laid = begun(stand, False, replace(WALK, steps=200)).with_nominal_steps().nominal_steps
    assert laid[-2].lift_off < 120.0 / 0.02 <= laid[-1].lift_off
