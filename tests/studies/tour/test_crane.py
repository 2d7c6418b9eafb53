"""The start on the crane: the pelvis hangs still, feet above the ground, and falls when it is let go."""

import numpy as np
import pytest

from surefoot.joints import JointCommand
from surefoot.studies.tour.ride import Ride, Setting
from surefoot.studies.tour.robot import tour_robot
from surefoot.studies.tour.rows import ROWS
from surefoot.studies.tour.rules import Punch

pytestmark = pytest.mark.unit

CRANE = Setting("crane", "benchmark")


@pytest.fixture(scope="module")
def hung():
    return Ride(ROWS["contract"], 3, CRANE)


def test_it_hangs_as_the_benchmark_says_and_time_begins_when_it_is_let_go(hung):
    world, robot = hung.world, tour_robot()
    assert world.time == 0.0 and not world.energy.any()
    assert world.pelvis == pytest.approx([0.0, 0.0, robot.crane_height], abs=1e-3)
    assert 0.03 < world.lowest() < 0.05
    names = hung.walker.robot.joint_names
    legs = {name: world.data.qpos[7 + number] for number, name in enumerate(names) if "left" in name}
    for end, angle in robot.leg_stance.items():
        assert legs[f"left_{end}"] == pytest.approx(angle, abs=0.03)
    assert legs["left_hip_roll_joint"] == pytest.approx(0.0, abs=0.03)


def test_let_go_it_falls_to_the_ground_and_a_row_of_surefoot_stays_up():
    ride = Ride(ROWS["contract"], 3, CRANE)
    assert not ride.world.measure().wrench.any()
    first = ride.world.lowest()
    for _ in range(10):
        ride.step()
    assert ride.world.lowest() < 0.01 < first
    assert ride.world.measure().wrench[:, 2].sum() > 100.0
    assert ride.run(1.5).completed


def test_on_the_feet_it_does_not_hang():
    ride = Ride(ROWS["contract"], 3, Setting("feet", "benchmark"))
    assert abs(ride.world.lowest()) < 2e-3


@pytest.mark.parametrize("joint", [3, 18])
def test_a_punch_of_the_parent_turns_with_it_and_not_with_its_own_link(hung, joint):
    direction = np.array([0.6, 0.0, 0.8])
    own, parents = Punch(0.0, joint, direction, 100.0), Punch(0.0, joint, direction, 100.0, of_parent=True)
    world = hung.world
    body = int(world.model.jnt_bodyid[1 + joint])
    for punch, link in ((own, body), (parents, int(world.model.body_parentid[body]))):
        assert world.direction(punch) == pytest.approx(world.data.xmat[link].reshape(3, 3) @ direction)
    assert not np.allclose(world.direction(own), world.direction(parents), atol=1e-3)


def test_joints_that_are_not_held_do_not_keep_their_stance(hung):
    q = np.concatenate(([0.0, 0.0, 0.793, 0.0, 0.0, 0.0, 1.0], np.full(29, 0.1)))
    limp = hung.world.hang(q, JointCommand(np.zeros(29)), 0.5)
    assert limp[:3] == pytest.approx(q[:3], abs=1e-3)
    assert np.abs(limp[7:] - q[7:]).max() > 0.1
