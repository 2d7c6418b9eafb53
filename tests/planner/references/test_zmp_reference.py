from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.maths.polygon import convex_hull
from surefoot.planner.geometry.plane import frame_rotation, signed_distance, sole_corners
from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.zmp_reference import (
    SupportKey,
    hull_of,
    load_left,
    present_support,
    support_table,
    zmp_reference,
)
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import Foot, Footstep, PhaseKind

pytestmark = pytest.mark.unit

HALF = np.array([0.11, 0.055])


@pytest.fixture(scope="session")
def setup(schedule):
    """The footsteps of a walk, its phases, and its ZMP reference from a sample on with a table of support points."""

    def of(**options):
        plan = schedule(GaitParameters(initial_stand=0.0, **options))

        def reference(table, start, count):
            return zmp_reference(plan.schedule.samples(start + np.arange(count, dtype=float)), table)

        return plan.schedule, plan, reference

    return of


def test_reference_is_the_papers_zmp_equation(setup):
    steps, _, refer = setup(step_length=0.2, lateral_step=0.1)
    reference = refer(support_table(steps, 0, (True, True), HALF), 50, 101)
    world = reference.point @ frame_rotation(0.0).T + steps.positions[1, :2]
    foot, following = steps.positions[1, :2], steps.positions[2, :2]
    time = 0.02 * np.arange(100)
    share = np.clip((time - 1.5) / 0.5, 0.0, 1.0)[:, None]
    np.testing.assert_allclose(world[:100], foot + share * (following - foot), atol=1e-12)


@pytest.mark.parametrize("row", [1, 3, 4])
def test_gain_is_the_derivative_of_the_reference(setup, row):
    steps, plan, refer = setup(steps=4, single_support=0.6, double_support=0.2)
    start = next(p.start for p in plan.phases if p.step == row and p.stance is not None)
    table = support_table(steps, row - 1, (True, True), HALF)
    base = refer(table, start, 151)
    for j in range(2):
        moved = (
            steps.moved(row + j, steps.step(row + j).place.position + np.array([0.01, 0.0, 0.0]))
            if row + j < 5
            else steps
        )
        shifted = refer(support_table(moved, row - 1, (True, True), HALF), start, 151)
        np.testing.assert_allclose((shifted.point - base.point)[:, 0] / 0.01, base.gain[:, j], atol=1e-9)


def test_a_fixed_footstep_has_no_gain(setup):
    steps, _, refer = setup()
    reference = refer(support_table(steps, 0, (False, False), HALF), 0, 151)
    assert not reference.gain.any()


def test_gain_where_footsteps_stay_is_that_of_one_alone(setup):
    steps, plan, refer = setup(steps=4, single_support=0.6, double_support=0.2)
    start = next(p.start for p in plan.phases if p.step == 1 and p.stance is not None)
    base = refer(support_table(steps, 0, (True, True), HALF, stay=True), start, 151)
    for j in range(2):
        place = steps.step(1 + j).place
        alone = steps.step(1 + j).landing(place.position + np.array([0.01, 0.0, 0.0]), place.normal)
        one_moved = replace(steps, steps=(*steps.steps[: 2 + j], alone, *steps.steps[3 + j :]))
        moved = refer(support_table(one_moved, 0, (True, True), HALF, stay=True), start, 151)
        np.testing.assert_allclose((moved.point - base.point)[:, 0] / 0.01, base.gain[:, j], atol=1e-9)
    assert base.gain[-1, 0] == 0.0


def test_the_box_of_a_stand_is_as_wide_as_both_feet(setup):
    steps, _, refer = setup(steps=0)
    reference = refer(support_table(steps, 0, (False, False), HALF), 0, 2)
    np.testing.assert_allclose(reference.half_size[0], HALF + np.array([0.0, 0.1]))


@pytest.mark.parametrize("room", [(np.inf, np.inf), (0.03, np.inf), (0.03, 0.02)])
def test_the_box_keeps_to_what_the_ankles_bear(stand, room):
    parameters = PlannerParameters(cop_room=room)
    schedule = Schedule.start(GaitParameters(), stand(), Ground(flat(), HALF, parameters)).extended(151.0)
    key = SupportKey(schedule, 0, 0.0, (True, True))
    support = present_support(key, PhaseKind.STAND, 0.9, parameters.cop_room)
    np.testing.assert_allclose(support.table[0, :, 4:6].min(axis=0), np.minimum(0.9 * HALF, room))


@pytest.mark.parametrize("turn", [0.0, 0.25])
def test_moving_box_lies_in_the_support_polygon(setup, turn):
    steps, plan, refer = setup(steps=3, single_support=0.6, double_support=0.2, step_length=0.15, turn=turn)
    reference = refer(support_table(steps, 0, (True, True), HALF), 0, 151)
    world = steps.positions[1, :2] + reference.point @ frame_rotation(steps.yaws[1]).T
    for k in range(150):
        i = plan.samples.index[k]
        # Where the robot stands the support point lies between two feet.
        points = (i, i + 1) if plan.samples.fraction[k] else (i,)
        rows = {int(row) for point in points for row in steps.supports[point]}
        soles = [sole_corners(steps.steps[row].place, HALF) for row in rows]
        hull = convex_hull(np.concatenate(soles))
        corners = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]) * reference.half_size[k]
        for corner in corners @ frame_rotation(steps.yaws[1]).T:
            assert signed_distance(hull, world[k] + corner) >= -1e-9


@given(yaw=st.floats(-4.0, 4.0), tilt=st.floats(-0.3, 0.3), across=st.floats(-0.3, 0.3))
def test_hull_of_a_sole_is_its_corners_from_the_leftmost_one_on(yaw, tilt, across):
    normal = np.array([np.sin(tilt), np.sin(across), 1.0])
    place = Footstep(Foot.LEFT, np.array([3.0, -2.0, 0.1]), yaw, normal / np.linalg.norm(normal))
    corners = sole_corners(place, np.array([0.11, 0.055]))
    np.testing.assert_array_equal(hull_of(corners), convex_hull(corners))


def test_the_load_goes_evenly_from_one_support_point_to_the_next(schedule):
    samples = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2)).samples
    on_left = np.random.default_rng(0).uniform(0.0, 1.0, int(max(samples.index)) + 2)
    passed = np.add(samples.index, samples.fraction)
    assert max(samples.fraction) > 0.0 and len(set(samples.index)) > 2
    np.testing.assert_allclose(load_left(samples, on_left), np.interp(passed, np.arange(len(on_left)), on_left))
