"""Steps over edges: where both feet step again, how far aside later ones go, and how fast a climb may be."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.geometry.plane import frame_rotation, sole_pose
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Box, Site, Terrain, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.adaptation import aligned, with_steps_repeated
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import Stop, ramp_before, room_left, shortest_swing, turned_room
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.quintics import PEAK
from surefoot.planner.swing.trajectory import start_swing

pytestmark = pytest.mark.unit

STAIRS = GaitParameters(steps=5, step_length=0.28, single_support=0.9, double_support=0.3)
TURNING = GaitParameters(steps=5, step_length=0.2, lateral_step=0.03, turn=0.15)
LIFTING = PlannerParameters().recovery.lifting
LEGS = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (66.0, 50.0))


def laid(gait, stand, terrain):
    """All steps of a gait."""
    feet = stand(gait.step_width)
    feet.position[:, 2] = terrain.heights(feet.position[:, :2])
    return Schedule.start(gait, feet, Ground(terrain, np.array([0.11, 0.055]), PlannerParameters())).extended(1000.0)


def flight(direction):
    """Four risers of 0.185 m."""
    stairs = Stairs(0.185, 0.28, 4, direction, start=0.14, landing=1.0, beyond=2.0)
    return stairs.build(Site(np.zeros(2), 0.0, 0.8))


@pytest.mark.parametrize("swung", [1, 2, 4])
@pytest.mark.parametrize(
    ("gait", "terrain"), [(STAIRS, flight(Direction.UP)), (STAIRS, flight(Direction.DOWN)), (TURNING, flat())]
)
def test_both_feet_land_where_they_are_before_the_walk_goes_on_as_it_would_have(stand, gait, terrain, swung):
    usual = laid(gait, stand, terrain)
    schedule = with_steps_repeated(usual, swung).extended(1000.0)
    rows = [*range(-1, swung + 1), swung - 1, *range(swung, gait.steps + 1)]
    for here, row in zip(schedule.steps, rows, strict=True):
        there = usual.step(row)
        np.testing.assert_allclose(here.place.position, there.place.position, atol=1e-12)
        assert (here.place.foot, here.place.yaw) == (there.place.foot, pytest.approx(there.place.yaw))
        assert here.inserted is (here.number in (swung + 1, swung + 2))
        if here.inserted:
            assert here.climb == here.lift == 0.0
    kinds = "".join("SDs"[phase.kind] for phase in schedule.phases)
    assert kinds == "SD" + (gait.steps + 2) * "sD" + "S"


def test_the_body_follows_the_lower_foot_which_is_a_riser_a_step_but_for_the_first_step_up(stand):
    up, down = (laid(STAIRS, stand, flight(direction)) for direction in (Direction.UP, Direction.DOWN))
    assert [up.step(n).climb for n in range(1, 6)] == pytest.approx([0.185, *(3 * [0.37]), 0.185])
    assert [up.step(n).lift for n in range(1, 6)] == pytest.approx([0.0, *(4 * [0.185])])
    assert [down.step(n).climb for n in range(1, 6)] == pytest.approx([-0.185, *(3 * [-0.37]), -0.185])
    assert [down.step(n).lift for n in range(1, 6)] == pytest.approx([*(4 * [-0.185]), 0.0])


@pytest.mark.parametrize("aside", [0.3, -0.2, 0.0])
def test_steps_after_one_that_landed_aside_on_its_tread_go_as_far_aside_and_stay_on_theirs(stand, aside):
    before = laid(STAIRS, stand, flight(Direction.DOWN))
    after = aligned(before.moved(2, before.step(2).place.position + np.array([0.015, aside, 0.0])), 2)
    np.testing.assert_allclose(
        after.positions[3:] - before.positions[3:], [[0.015, aside, 0.0], *(3 * [[0.0, aside, 0.0]])]
    )
    np.testing.assert_array_equal(after.positions[:3], before.positions[:3])
    assert after.phases == before.phases
    np.testing.assert_allclose(after.shift, (0.0, aside), atol=1e-15)


def test_on_a_block_they_go_no_farther_aside_than_it_does(stand):
    """Blocks are half a metre wide, with a centimetre to their edges."""
    half = np.array([0.14, 0.25, 0.05])
    blocks = [Box(np.array([0.28 * n, 0.0, 0.05]), half, np.eye(3)) for n in range(-1, 8)]
    terrain = Terrain(tuple(blocks), path_start=(0.0, 0.0, 0.0))
    before = laid(STAIRS, stand, terrain)
    after = aligned(before.moved(1, before.step(1).place.position + np.array([0.0, 0.1, 0.0])), 1).positions
    way = after - before.positions
    np.testing.assert_allclose(way[2:, 1], [0.1, 0.1, 0.08, 0.1, 0.08], atol=1e-9)
    assert (terrain.edge_margins(after[3:, :2], after[3:, None, :2]) > 0.0).all()


@pytest.mark.parametrize(("direction", "step"), [(Direction.DOWN, 1), (Direction.UP, 1), (Direction.UP, 3)])
def test_a_climb_is_hurried_no_more_than_body_and_foot_can_be(stand, direction, step):
    """The one by 5 m/s^2, the other by what hips accelerate it with; one of them is at that."""
    terrain, legs = flight(direction), replace(LEGS, acceleration=(30.0, 25.0))
    schedule = laid(STAIRS, stand, terrain)
    order = schedule.step(step)
    usual = STAIRS.single_support - PlannerParameters().touchdown_lead
    quickest = shortest_swing(order, legs.acceleration[0], LIFTING)
    before, after = schedule.step(step - 2).place, order.place
    poses = sole_pose(before.position, before.yaw, before.normal), sole_pose(after.position, after.yaw, after.normal)
    swing = start_swing(order.place.foot, poses, (0.0, 45.0), order.course, PlannerParameters())
    hardest = np.abs([swing.evaluate(at)[2, :3] for at in np.linspace(0.0, usual, 500, endpoint=False)]).max()
    lifted = PEAK * abs(order.lift) / quickest**2
    swung = hardest * (usual / quickest) ** 2
    assert lifted <= LIFTING + 1e-9
    assert swung <= 30.0 * 1.02
    assert lifted == pytest.approx(LIFTING) or swung == pytest.approx(30.0, rel=0.02)


def test_only_a_step_that_climbs_is_put_off(stand):
    """While the one before it swings, on treads; blocks of one height, and bare ground, are stepped on at once."""
    level = [Box(np.array([0.28 * n, 0.0, 0.05]), np.array([0.135, 0.5, 0.05]), np.eye(3)) for n in range(-1, 8)]
    blocks = Terrain(tuple(level), path_start=(0.0, 0.0, 0.0))
    for terrain, climbs in ((flight(Direction.DOWN), True), (blocks, False), (flat(), False)):
        schedule = laid(STAIRS, stand, terrain)
        swing = schedule.step(1)
        assert not schedule.climbs_next(swing.lift_off - 1.0)
        assert schedule.climbs_next(swing.lift_off) is climbs


def test_the_room_of_a_step_is_counted_from_where_it_now_is_to_land(stand):
    before = laid(STAIRS, stand, flight(Direction.DOWN))
    after = aligned(before.moved(1, before.step(1).place.position + np.array([0.01, 0.3, 0.0])), 1)
    rooms = [room_left(schedule.step(2), schedule.step(0).place, 0.02) for schedule in (before, after)]
    np.testing.assert_allclose(rooms[1], rooms[0] - [0.0, 0.3], atol=1e-12)


@pytest.mark.parametrize("turned", [0.0, 0.6, -0.4])
@pytest.mark.parametrize("yaw", [-2.0, 0.0, 0.7])
def test_whatever_is_left_of_its_room_lies_in_it_wherever_a_step_goes(stand, yaw, turned):
    """Ways are in the heading of the stance foot, the room in that of the step; where both are one it is all left."""
    step, way, room = laid(STAIRS, stand, flat()).step(2), np.array([0.03, -0.05]), np.array([[-0.1, -0.3], [0.4, 0.2]])
    nominal, stance = replace(step.nominal, yaw=yaw), replace(step.nominal, yaw=yaw - turned)
    place = nominal.position + np.append(frame_rotation(yaw) @ way, 0.0)
    left = room_left(replace(step, nominal=nominal, room=room).landing(place, nominal.normal), stance, 0.02)
    corners = np.array([[left[i, 0], left[j, 1]] for i in (0, 1) for j in (0, 1)])
    seen = (place[:2] + corners @ frame_rotation(stance.yaw).T - nominal.position[:2]) @ frame_rotation(yaw)
    assert (seen >= room[0] - 1e-12).all() and (seen <= room[1] + 1e-12).all()
    assert (left[0] < 0.0).all() and (left[1] > 0.0).all()
    if turned == 0.0:
        np.testing.assert_allclose(left, room - way, atol=1e-12)


@pytest.mark.parametrize(("direction", "may"), [(Direction.UP, 5 * [True]), (Direction.DOWN, [*(4 * [False]), True])])
def test_no_foot_crosses_one_that_lets_the_body_down_which_the_last_step_of_a_flight_does_not(stand, direction, may):
    schedule = laid(STAIRS, stand, flight(direction))
    assert [schedule.ground.terrain.footholds.crossed(schedule.step(number).lift) for number in range(1, 6)] == may


@pytest.mark.parametrize("angle", [-0.9, -0.2, 0.3, 1.2])
def test_a_room_in_another_frame_lies_in_the_room(angle):
    """Each of its corners does, the middle of each side of a square goes half as far as its rhombus, and 0 is in it."""
    room = np.array([[-0.1, -0.3], [0.4, 0.2]])
    turned = turned_room(room, angle, 0.01)
    corners = np.array([[turned[i, 0], turned[j, 1]] for i in (0, 1) for j in (0, 1)])
    seen = corners @ frame_rotation(angle)  # from the frame in which the footstep, and its room, has this heading
    assert (seen >= room[0] - 1e-12).all() and (seen <= room[1] + 1e-12).all()
    assert (turned[0] < 0.0).all() and (turned[1] > 0.0).all()
    square, most = np.array([[-1.0, -1.0], [1.0, 1.0]]), max(abs(np.cos(angle)), abs(np.sin(angle)))
    np.testing.assert_allclose(turned_room(square, angle, 0.01), 0.5 / most * square)
    assert turned_room(room, 0.005, 0.01) is room


def test_the_weight_leaves_a_foot_while_it_shifts_and_not_while_it_rests(stand):
    step = laid(STAIRS, stand, flat()).step(2)
    assert ramp_before(step, None) == step.double_support
    assert ramp_before(step, Stop(30.0, 12.5, 5.0)) == 7.5


@pytest.mark.parametrize(("since", "shift"), [(-1.0, 20.0), (1.0, 20.0), (29.0, 20.0), (31.0, 12.0)])
def test_a_weight_shift_takes_other_times_until_its_standing_is_over(stand, since, shift):
    """Standing lasts 30 samples after the step before it; the present phase began so long after that."""
    schedule = laid(STAIRS, stand, flat())
    before, step = schedule.step(2), replace(schedule.step(3), stop=Stop(30.0, 12.0, 0.0))
    retimed = step.retimed(before, (50.0, 20.0), before.end + since, before.end + since, PlannerParameters())
    assert retimed.stop.shift == shift
    assert retimed.lift_off == before.end + 30.0 + shift


def test_a_turn_is_that_of_a_step_against_the_one_before_it(stand):
    """And there is none after the last step."""
    schedule = laid(replace(TURNING, steps=8), stand, flat())
    turns = [schedule.turn(number) for number in range(1, schedule.last.number + 1)]
    assert turns[:-1] == pytest.approx([0.15] * (len(turns) - 1)) and schedule.turn(schedule.last.number + 1) == 0.0


def test_a_foot_that_strikes_with_its_heel_rolls_as_it_lands_also_in_other_times(stand):
    gait = GaitParameters(steps=5, step_length=0.4, single_support=0.4, double_support=0.1, heel_strike=0.3)
    schedule = laid(gait, stand, flat())
    for number in (2, 3, 4):
        before, step = schedule.step(number - 1), schedule.step(number)
        times = (1.5 * step.single_support, 1.2 * step.double_support), before.end, before.end
        for one in (step, step.retimed(before, *times, PlannerParameters())):
            strike = one.heel_strike
            assert strike.foot is one.place.foot and strike.angle < 0.0
            assert one.lift_off < strike.start < one.touchdown < strike.end <= one.end
        assert one.touchdown - step.touchdown == pytest.approx(0.5 * step.single_support)
