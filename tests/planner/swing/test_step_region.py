import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import seen_from, sole_corners
from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.swing.step_region import StepRegion, check_reach, reach_box, reachable_shifts
from surefoot.planner.types import Foot, Footstep, Twist

pytestmark = pytest.mark.unit

REGION = StepRegion(length=0.4, width=(0.08, 0.4), sole=(0.22, 0.11))
STRIDES = st.builds(Twist, st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(-0.6, 0.6), st.floats(0.05, 0.6))


def separation(a: Footstep, b: Footstep, half_size: np.ndarray) -> float:
    """Largest gap between two soles along the axes of either, by separating axes; negative when they overlap [m]."""
    corners = [sole_corners(foot, half_size) for foot in (a, b)]
    gaps = []
    for yaw in (a.yaw, a.yaw + math.pi / 2, b.yaw, b.yaw + math.pi / 2):
        one, other = (polygon @ [math.cos(yaw), math.sin(yaw)] for polygon in corners)
        gaps.append(max(one.min() - other.max(), other.min() - one.max()))
    return max(gaps)


def at(ahead: float, beside: float, turn: float) -> Footstep:
    """A left footstep, seen from its stance foot."""
    return Footstep(Foot.LEFT, np.array([ahead, beside, 0.0]), turn)


@given(stride=STRIDES, foot=st.sampled_from(list(Foot)))
def test_landing_is_where_the_footstep_planner_puts_the_foot(stand, stride, foot):
    gait = GaitParameters(steps=1, bouts=(Bout(1.0, (stride,)),), step_width=stride.width, first_foot=foot)
    steps = plan_footsteps(gait, stand(stride.width), flat())
    place, seen = stride.landing(foot), seen_from(steps[1], steps[2])
    np.testing.assert_allclose(seen.position, place.position, atol=1e-12)
    assert (seen.foot, seen.yaw) == (foot, pytest.approx(place.yaw))
    assert place.beside == pytest.approx(
        steps[2].position[1] - steps[1].position[1]
        if foot is Foot.LEFT
        else steps[1].position[1] - steps[2].position[1]
    )


@given(stride=STRIDES)
def test_admitted_strides_keep_the_soles_apart_and_in_reach(stride):
    fitted = REGION.fitted(stride)
    if not REGION.admits(fitted):
        return
    for foot in Foot:
        place = fitted.landing(foot)
        here = Footstep(foot.other, np.zeros(3), 0.0)
        assert separation(here, place, np.array([0.11, 0.055])) >= REGION.gap - 1e-9
        assert abs(place.position[0]) <= 0.4 + 1e-9
        assert 0.08 <= place.beside <= 0.4 + 1e-9


@given(stride=STRIDES)
@example(stride=Twist(0.4, 0.0, 1.2e-308, 0.25))  # as long as may be, in a turn that is hardly one
def test_fitting_changes_no_stride_that_fits_and_finds_a_width_if_there_is_one(stride):
    fitted = REGION.fitted(stride)
    if REGION.admits(stride):
        assert fitted.width == pytest.approx(stride.width, abs=1e-8)
    elif not REGION.admits(fitted):
        for width in np.linspace(0.05, 0.6, 56):
            assert not REGION.admits(stride._replace(width=width))


def test_nearest_is_tight_for_a_turned_foot_ahead():
    """At the least distance there is a place ahead at which the soles are just the gap apart; nearer they overlap."""
    half = np.array([0.11, 0.055])
    here = Footstep(Foot.RIGHT, np.zeros(3), 0.0)
    for turn in (-0.5, 0.0, 0.3, 0.5):
        near = REGION.nearest(turn)
        gaps = [separation(here, at(x, near, turn), half) for x in np.linspace(-0.1, 0.1, 41)]
        assert min(gaps) == pytest.approx(REGION.gap, abs=1e-9)
        assert separation(here, at(0.0, near - 0.02, turn), half) < 0.0


@pytest.mark.parametrize(
    ("place", "what", "right"),
    [
        (at(0.0, -0.1, 0.0), "crosses its stance foot, -0.100 m beside it", "0.120 m is the least"),
        (at(0.0, 0.1, 0.0), "would touch its stance foot, 0.100 m beside it", "0.120 m is the least"),
        (at(0.0, 0.5, 0.0), "lands 0.500 m beside its stance foot", "0.4 m is the most"),
        (at(-0.5, 0.2, 0.0), "lands -0.500 m ahead of its stance foot", "0.4 m is the most"),
        (at(0.0, 0.2, 0.6), "turns by 0.6 rad against its stance foot", "0.5 rad is the most"),
    ],
)
def test_what_is_wrong_with_a_landing(place, what, right):
    assert REGION.why_not(place) == (what, right)
    assert REGION.why_not(at(0.0, 0.2, 0.0)) is None


def test_legs_reach_a_disc_about_their_own_hip():
    region = StepRegion(0.4, (0.08, 0.4), (0.075, 0.075), leg_span=0.3, hip_width=0.2)
    assert region.why_not(at(0.3, 0.2, 0.0)) is None
    what, right = region.why_not(at(0.25, 0.39, 0.0))
    assert what.endswith("m from where the legs stand upright")
    assert right == "0.300 m is the most"


def test_a_foot_may_turn_as_far_as_it_may_to_rounding():
    region = StepRegion(length=0.4, width=(0.08, 0.4), sole=(0.22, 0.11), turn=0.3)
    for turn, right in ((0.3, True), (-0.3, True), (0.301, False), (-0.301, False)):
        fault = region.why_not(at(0.0, 0.3, turn))
        assert fault is None if right else "turns by" in fault[0]


@pytest.mark.parametrize("here", [(0.1, 0.05), (-0.15, 0.08), (0.02, -0.04)])
def test_a_step_is_shifted_by_no_more_than_its_foot_goes_in_the_time_left(here):
    """To within that of where the foot is now, but for the nominal footstep, which is always in reach."""
    parameters, increment = PlannerParameters(reach_length=0.8), np.array([[0.1, 0.25], [0.1, -0.25]])
    wide = reachable_shifts(parameters, increment, 1.0, (True, True), None, 0.0)
    lower, upper = reachable_shifts(parameters, increment, 1.0, (True, True), increment[0] + here, 0.1)
    travel = 0.1 * parameters.swing_speed / np.sqrt(2.0)
    np.testing.assert_allclose(lower[0], np.maximum(wide[0][0], np.minimum(np.array(here) - travel, 0.0)))
    np.testing.assert_allclose(upper[0], np.minimum(wide[1][0], np.maximum(np.array(here) + travel, 0.0)))
    assert (lower[1] == wide[0][1]).all() and (upper[1] == wide[1][1]).all()


@pytest.mark.parametrize("ahead", [0.4, -0.4])
def test_a_foot_may_land_as_far_ahead_and_beside_as_it_may_to_rounding(ahead):
    for place, right in ((ahead, True), (1.001 * ahead, False)):
        assert (REGION.why_not(at(place, 0.3, 0.0)) is None) is right
    near, far = REGION.nearest(0.0), REGION.width[1]
    for beside, right in ((near, True), (near - 1e-3, False), (far, True), (far + 1e-3, False)):
        assert (REGION.why_not(at(0.0, beside, 0.0)) is None) is right


@pytest.mark.parametrize("foot", Foot)
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("end", [0, 1])
def test_a_nominal_footstep_may_land_as_far_as_the_reach_box_goes_to_rounding(foot, axis, end):
    box, out = reach_box(PlannerParameters(), 1.0), (-1.0, 1.0)[end]
    for beyond, refused in ((0.0, False), (1e-9, False), (1e-7, True), (-1e-7, False)):
        place = np.array([0.0, 0.2, 0.0])
        place[axis] = box[end][axis] + out * beyond
        footstep = Footstep(foot, place * (1.0, foot.side, 1.0), 0.0)
        if refused:
            with pytest.raises(ParameterError, match="footstep 3 would land"):
                check_reach(3, footstep, PlannerParameters())
        else:
            check_reach(3, footstep, PlannerParameters())


@pytest.mark.parametrize("free", [(True, False), (False, True), (False, False)])
def test_a_step_that_is_not_free_has_room_to_either_side_of_where_it_is(free):
    """It stays there since it costs something to move; the room of the other one is its own."""
    parameters, increment = PlannerParameters(reach_length=0.8), np.array([[0.1, 0.25], [0.2, -0.3]])
    both, found = (reachable_shifts(parameters, increment, 1.0, kind, None, 0.0) for kind in ((True, True), free))
    for step in (0, 1):
        if free[step]:
            np.testing.assert_array_equal([ends[step] for ends in found], [ends[step] for ends in both])
        else:
            np.testing.assert_array_equal(found[0][step], -found[1][step])
            assert (found[1][step] > 0.5).all()


def test_shifts_are_those_that_keep_both_steps_in_the_reachable_area():
    """The first step lands beside its stance foot, the second one on the other side."""
    parameters, increment = PlannerParameters(reach_length=0.8), np.array([[0.1, 0.25], [0.2, -0.3]])
    for side in (1.0, -1.0):
        lower, upper = reachable_shifts(parameters, side * increment, side, (True, True), None, 0.0)
        for k, foot in enumerate((side, -side)):
            box = reach_box(parameters, foot)
            least, most = box[0] - side * increment[k], box[1] - side * increment[k]
            if k == 1:
                least, most = np.minimum(least, 0.0), np.maximum(most, 0.0)
            np.testing.assert_allclose([lower[k], upper[k]], [least, most])


@pytest.mark.parametrize("yaw", [0.4, -0.4])
@pytest.mark.parametrize("ahead", [0.25, -0.25])
def test_in_a_turn_feet_stand_no_wider_than_the_outer_one_can_go(yaw, ahead):
    region = StepRegion(length=0.4, width=(0.08, 3.0), sole=(0.05, 0.03))
    fitted = region.fitted(Twist(ahead, 0.0, yaw, 2.5))
    farthest = max(abs(fitted.landing(foot).position[0]) for foot in Foot)
    assert farthest == pytest.approx(region.length) and region.admits(fitted)
