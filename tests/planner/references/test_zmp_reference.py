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
    on_edges,
    present_support,
    sole_of,
    support_table,
    zmp_reference,
)
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import Edge, Foot, Footstep, PhaseKind

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


ROLLING = GaitParameters(
    steps=5, step_length=0.42, single_support=0.4, double_support=0.2, initial_stand=0.0, heel_off=0.5, heel_strike=0.2
)


def _stood_on(phase, place, clock):
    """Corners of what of a foot is down."""
    edge = phase.edges(clock)[place.foot]
    corners = sole_corners(place, HALF if edge == Edge.SOLE else HALF * (0.0, 1.0))
    return corners + edge * HALF[0] * frame_rotation(place.yaw)[:, 0]


def _box(reference, k, yaw, origin):
    """Corners of the box of a sample in the world."""
    corners = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]) * reference.half_size[k]
    return origin + (reference.point[k] + reference.middle[k] + corners) @ frame_rotation(yaw).T


def test_the_box_lies_in_the_hull_of_what_is_down_of_rolling_feet(schedule):
    """A box of flat feet does not. Where the reference is outside, the box reaches from there to the reference."""
    walk = schedule(ROLLING)
    steps, support = (
        walk.schedule,
        present_support(SupportKey(walk.schedule, 0, 0.0, (True, True)), PhaseKind.STAND, 1.0, (9.0, 9.0)),
    )
    count = len(walk.samples.clock)
    flat_feet = zmp_reference(walk.samples, support.table)
    edges, rolled, beyond, reaching, seen = on_edges(flat_feet, walk.samples, support, count), 0, 0, 0, set()
    for k, clock in enumerate(walk.samples.clock.tolist()):
        phase = walk.samples.phases[walk.samples.which[k]]
        if phase.edges(clock) == (0, 0) or phase.step < 1:
            assert not edges.middle[k].any()
            np.testing.assert_array_equal(edges.half_size[k], flat_feet.half_size[k])
            continue
        seen.add(tuple(sorted(phase.edges(clock))))
        feet = [steps.step(number).place for number in (phase.step, phase.step - 1)]
        hull = convex_hull(np.concatenate([_stood_on(phase, place, clock) for place in feet]))
        outside = [
            min(signed_distance(hull, corner) for corner in _box(each, k, 0.0, support.origin))
            for each in (edges, flat_feet)
        ]
        middle, half = edges.middle[k, 0], edges.half_size[k, 0]
        assert abs(middle) <= half + 1e-12
        if abs(middle) < half - 1e-9:
            assert outside[0] > -1e-9
        else:
            far = support.origin + edges.point[k] + (2.0 * middle, edges.middle[k, 1])
            assert signed_distance(hull, far) > -1e-9
            reaching += 1
        rolled, beyond = rolled + 1, beyond + (outside[1] < -0.01)
    assert beyond > 0.8 * rolled > 20 and 0 < reaching < rolled
    assert seen == {(-1, 0), (0, 1), (-1, 1)}


def test_boxes_beyond_what_is_planned_are_those_of_flat_feet(schedule):
    walk = schedule(ROLLING)
    support = present_support(SupportKey(walk.schedule, 0, 0.0, (True, True)), PhaseKind.STAND, 1.0, (9.0, 9.0))
    flat_feet = zmp_reference(walk.samples, support.table)
    edges = on_edges(flat_feet, walk.samples, support, 60)
    assert edges.middle[:60].any() and not edges.middle[60:].any()
    np.testing.assert_array_equal(edges.half_size[60:], flat_feet.half_size[60:])


def test_a_stance_foot_that_rolls_alone_has_its_box_on_its_edge(schedule):
    """As of a heel that leaves the ground before the other foot has landed."""
    walk = schedule(replace(ROLLING, heel_strike=0.0))
    steps = walk.schedule
    step = steps.step(3)
    early = replace(step, toe_off=step.toe_off._replace(start=steps.step(2).touchdown - 10.0))
    at = steps.index(3)
    rolled = steps.with_steps((*steps.steps[:at], early, *steps.steps[at + 1 :]))
    phase = next(p for p in rolled.phases if p.step == 2 and p.stance is not None)
    assert phase.edges(phase.end - 1.0)[phase.stance] == Edge.TOE and phase.edges(phase.start) == (0, 0)
    key = SupportKey(rolled, 1, phase.start, (True, True), phase.edges(phase.end - 1.0))
    support = present_support(key, PhaseKind.SINGLE, 0.9, (9.0, 9.0))
    reference = on_edges(
        zmp_reference(rolled.samples(phase.end - np.arange(1.0, 20.0)), support.table),
        rolled.samples(phase.end - np.arange(1.0, 20.0)),
        support,
        19,
    )
    np.testing.assert_allclose(reference.middle[:9, 0], 0.5 * HALF[0])
    np.testing.assert_allclose(reference.half_size[:9, 0], 0.5 * HALF[0])
    assert reference.half_size[0, 1] > 0.04 and not reference.middle[9:].any()
    # The polygon that is planned is a strip at its toes.
    ahead = (support.outer - support.origin) @ support.rotation[:, 0]
    assert 0.0 < np.ptp(ahead) < 0.01 and ahead.max() == pytest.approx(HALF[0])


@pytest.mark.parametrize("edge", [Edge.TOE, Edge.HEEL])
def test_an_edge_of_a_sole_lies_at_its_end(edge):
    place = Footstep(Foot.LEFT, np.array([1.0, 0.2, 0.0]), 0.3, np.array([0.0, 0.0, 1.0]))
    for corners, width in zip(sole_of(place, HALF, 0.9, int(edge)), (1.0, 0.9), strict=True):
        along, across = ((corners - place.position[:2]) @ frame_rotation(place.yaw)).T
        assert np.abs(along).max() <= HALF[0] + 1e-12 and (along * edge).min() > 0.9 * HALF[0]
        assert np.abs(across).max() == pytest.approx(width * HALF[1])


WINDING = GaitParameters(steps=4, step_length=0.2, lateral_step=0.05, turn=0.25, initial_stand=0.0, heel_off=0.4)


def laid(stand, yaw=0.0, gait=WINDING):
    """All steps of a gait that begins with a heading, the second of which lies higher."""
    feet = stand(gait.step_width, (0.3, -0.4), yaw)
    whole = Schedule.start(gait, feet, Ground(flat(), HALF, PlannerParameters(reach_length=0.8))).extended(np.inf)
    return whole.moved(2, whole.step(2).place.position + np.array([0.0, 0.0, 0.06]))


def test_support_points_are_the_same_whichever_way_a_walk_goes(stand):
    one, other = (support_table(laid(stand, yaw), 1, (True, True), HALF) for yaw in (0.0, 0.9))
    np.testing.assert_allclose(one, other, atol=1e-12)
    assert np.abs(one[0, :, 1]).max() > 0.05 and np.ptp(one[0, :, 4]) > 1e-3


def test_support_points_are_those_of_the_feet_seen_from_the_stance_foot(stand):
    schedule = laid(stand)
    values = support_table(schedule, 1, (True, True), HALF)[0]
    place, row = schedule.step(1).place, schedule.index(1)
    feet = (schedule.positions[:, :2] - place.position[:2]) @ frame_rotation(place.yaw)
    for (left, right), at in zip(schedule.supports, values, strict=True):
        np.testing.assert_allclose(at[:2], 0.5 * (feet[left] + feet[right]), atol=1e-12)
        assert at[6] == pytest.approx(0.5 * (schedule.positions[left, 2] + schedule.positions[right, 2]))
    assert schedule.positions[row + 1, 2] == pytest.approx(0.06)
    samples = schedule.samples(np.arange(0.0, 400.0))
    heights, index, share = zmp_reference(samples, support_table(schedule, 1, (True, True), HALF)).height, *(
        samples.index, samples.fraction
    )  # fmt: skip
    following = values[np.minimum(index + 1, len(values) - 1), 6]
    np.testing.assert_allclose(heights, values[index, 6] + share * (following - values[index, 6]), atol=1e-12)


@pytest.mark.parametrize("half", [HALF, HALF[::-1]], ids=["long", "wide"])
def test_boxes_are_the_largest_of_their_kinds(stand, half):
    """In one foot that of its proportions whose corners touch its edges, between two the one of the greatest area."""
    schedule = laid(stand)
    values, yaws = support_table(schedule, 1, (True, True), half)[0], schedule.yaws - schedule.step(1).place.yaw
    corners, boxes = np.array([[1.0, 1.0], [1.0, -1.0]]), {}

    def of(foot):
        box = next(at[4:6] for at, (one, other) in zip(values, schedule.supports, strict=True) if one == other == foot)
        farthest = np.abs(box * corners @ frame_rotation(yaws[foot])).max(axis=0) / half
        assert farthest.max() == pytest.approx(1.0) and box[0] / box[1] == pytest.approx(half[0] / half[1])
        return box

    boxes = {foot: of(foot) for foot in {one for one, other in schedule.supports.tolist() if one == other}}
    for at, (one, other) in zip(values, schedule.supports.tolist(), strict=True):
        if one == other or one not in boxes or other not in boxes:
            continue
        between = 0.5 * (boxes[one] + boxes[other])
        apart = schedule.positions[other, :2] - schedule.positions[one, :2]
        way = 0.5 * np.abs(apart @ frame_rotation(schedule.step(1).place.yaw))
        shares = np.linspace(0.0, 1.0, 2001)[:, None]
        family = np.concatenate((between + shares * way * (-1.0, 1.0), between + shares * way * (1.0, -1.0)))
        areas = np.where((family > 0.0).all(axis=1), family.prod(axis=1), 0.0)
        assert at[4:6].prod() == pytest.approx(areas.max(), rel=1e-5)
        np.testing.assert_allclose(at[4:6], family[areas.argmax()], atol=1e-3)


def test_the_zmp_goes_to_the_edge_of_a_turned_foot_that_rolls(stand):
    """Along the heading of that foot, ahead to its toes, whichever way the walk goes."""
    seen = []
    for yaw in (0.0, 0.9):
        schedule, looked = laid(stand, yaw), []
        samples = schedule.samples(np.arange(0.0, 400.0))
        key = SupportKey(schedule, 1, schedule.step(1).touchdown, (True, True))
        support = present_support(key, PhaseKind.DOUBLE, 1.0, (9.0, 9.0))
        middle = on_edges(zmp_reference(samples, support.table), samples, support, 400).middle
        for k, number in enumerate(samples.which):
            phase = samples.phases[number]
            rolling = [roll.foot for roll in phase.rolls if roll.start < samples.clock[k] < roll.end]
            if len(rolling) == 1 and abs(middle[k]).min() > 1e-6:
                steps = (schedule.step(phase.step), schedule.step(phase.step - 1))
                step = next(step for step in steps if step.place.foot is rolling[0])
                # To its left where it is turned to the left of the stance foot, with its toes; boxes that reach to the
                # reference are about there.
                turned = step.place.yaw - schedule.step(1).place.yaw
                assert np.sign(middle[k, 1]) == np.sign(turned * middle[k, 0])
                looked.append(step.number)
        seen.append(middle)
        assert len(set(looked)) >= 2
    np.testing.assert_allclose(*seen, atol=1e-12)
