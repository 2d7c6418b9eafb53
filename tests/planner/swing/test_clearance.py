import numpy as np
import pytest

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import sole_corners, sole_pose
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.course import EDGE_CLEARANCE, Ground, swing_course
from surefoot.planner.swing.trajectory import start_swing
from surefoot.planner.types import FeetState, Foot, Footstep

pytestmark = pytest.mark.unit

PARAMETERS = PlannerParameters()


def walk_plan(direction, riser, tread, steps=6):
    stairs = Stairs(riser, tread, 3, direction, 0.5 * tread, 3 * tread, 3.0)
    terrain = stairs.build(Site(np.zeros(2), 0.0, 0.8))
    ground = terrain.height(0.0, 0.0)
    feet = FeetState(np.array([[0.0, 0.1, ground], [0.0, -0.1, ground]]), np.zeros(2), (True, True))
    return plan_footsteps(GaitParameters(steps=steps, step_length=tread), feet, terrain), terrain


def courses_of(plan, terrain, half_size, samples=75):
    ends = zip(plan, plan[2:], strict=False)
    ground = Ground(terrain, np.array(half_size), PARAMETERS)
    return [swing_course(step, *of, samples, 0.05, ground) for step, of in enumerate(ends, 1)]


def swings(plan, courses, samples):
    for row, course in enumerate(courses, start=2):
        before, after = plan[row - 2], plan[row]
        ends = sole_pose(before.position, before.yaw, before.normal), sole_pose(after.position, after.yaw, after.normal)
        yield start_swing(Foot.LEFT, ends, (0.0, samples), course, PARAMETERS)


def clearances(plan, terrain, half_size, samples):
    """The least height of the whole sole over what is neither its lift-off nor its landing place, of each step [m]."""
    for swing in swings(plan, courses_of(plan, terrain, half_size, samples), samples):
        clearance = []
        for time in np.arange(0.0, swing.touchdown_time, 0.002):
            pose = swing.evaluate(time)[0]
            grid = sole_corners(Footstep(Foot.LEFT, pose[:3], float(pose[3])), half_size)
            heights = terrain.heights(grid)
            if np.ptp(heights) > 1e-3:
                clearance.append(pose[2] - heights.max())
        yield min(clearance, default=EDGE_CLEARANCE)


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize(("riser", "tread", "foot"), [(0.1, 0.2, 0.075), (0.185, 0.24, 0.22), (0.235, 0.32, 0.22)])
@pytest.mark.parametrize("samples", [45, 75])
def test_the_whole_sole_clears_every_edge(direction, riser, tread, foot, samples):
    plan, terrain = walk_plan(direction, riser, tread)
    assert min(clearances(plan, terrain, 0.5 * np.array([foot, 0.1]), samples)) > EDGE_CLEARANCE - 2e-3


@pytest.mark.parametrize("room", [0.001, 0.002, 0.004, 0.006, 0.008])
def test_a_heel_close_to_the_riser_behind_it_clears_that_too_or_is_refused(room):
    """It comes down before its way over the ground is quite done."""
    plan, terrain = walk_plan(Direction.DOWN, 0.185, 0.28)
    try:
        least = min(clearances(plan, terrain, np.array([0.14 - room, 0.05]), 45))
    except ParameterError:
        assert room < 0.002
    else:
        assert room > 0.001
        assert least > EDGE_CLEARANCE - 3e-3


def test_on_level_ground_nothing_changes(stand):
    plan = plan_footsteps(GaitParameters(), stand(), flat())
    courses = courses_of(plan, flat(), [0.04, 0.04])
    assert {(c.apex, c.glide_start, c.glide_end, c.height) for c in courses} == {(0.5, 0.0, 1.0, 0.05)}
    plan, terrain = walk_plan(Direction.UP_DOWN, 0.1, 0.3, steps=9)
    courses = courses_of(plan, terrain, [0.04, 0.04])
    assert (courses[4].apex, courses[4].glide_start) == (0.5, 0.0)


def test_a_plain_swing_would_stub_its_toe():
    """Negative control: without a course of its own the swing goes through the nosings."""
    plan, terrain = walk_plan(Direction.UP, 0.185, 0.24)
    half_size = np.array([0.11, 0.05])
    plain = courses_of(plan_footsteps(GaitParameters(), stand_here(), flat()), flat(), half_size)
    swing = list(swings(plan, plain[:2], 45))[1]
    depth = []
    for time in np.arange(0.0, swing.touchdown_time, 0.01):
        pose = swing.evaluate(time)[0]
        corners = sole_corners(Footstep(Foot.LEFT, pose[:3], 0.0), half_size)
        depth.append(pose[2] - terrain.heights(corners).max())
    assert min(depth) < -0.05


def stand_here():
    return FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))


def test_edges_that_nothing_clears_are_refused():
    plan, terrain = walk_plan(Direction.UP, 0.2, 0.2)
    words = r"footstep 1 cannot be swung 0\.02 m clear of .*; put the edges"
    with pytest.raises(ParameterError, match=words) as refused:
        courses_of(plan, terrain, [0.16, 0.05])
    assert refused.value.key == ("terrain",)
