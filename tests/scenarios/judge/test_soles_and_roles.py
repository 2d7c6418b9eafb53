"""Poses of soles against scipy and the planner's geometry, and joints by role."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from surefoot.planner.geometry.plane import corners, forward, headings, level_corners, rotations, sole_corners
from surefoot.planner.types import Foot, Footstep
from surefoot.scenarios.judge.body import knees, leg, torso
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import compute
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import RunConstants
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

LENGTH, WIDTH = 0.22, 0.11


@pytest.fixture(scope="module")
def poses():
    rng = np.random.default_rng(3)
    return np.column_stack((rng.normal(size=(50, 3)), Rotation.random(50, rng=3).as_quat()))


def test_rotations_are_those_of_scipy(poses):
    expected = Rotation.from_quat(poses[:, 3:]).as_matrix()
    assert rotations(poses[:, 3:]) == pytest.approx(expected, abs=1e-12)
    assert forward(poses[:, 3:]) == pytest.approx(expected[:, :2, 0], abs=1e-12)
    assert headings(poses[0, 3:]) == pytest.approx(np.arctan2(expected[0, 1, 0], expected[0, 0, 0]))


def test_corners_are_where_the_sole_ends(poses):
    found = corners(poses, LENGTH, WIDTH)
    local = np.einsum("nji,nkj->nki", rotations(poses[:, 3:]), found - poses[:, None, :3])
    signs = np.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]])
    assert local == pytest.approx(np.broadcast_to(signs * (LENGTH / 2, WIDTH / 2, 0), local.shape), abs=1e-12)


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5])
def test_level_corners_are_those_of_the_planner_and_of_a_pose(yaw):
    place = np.array([[0.3, -0.2, 0.1, yaw]])
    footstep = Footstep(Foot.LEFT, place[0, :3], yaw)
    found = level_corners(place, LENGTH, WIDTH)[0]
    assert found == pytest.approx(sole_corners(footstep, np.array([LENGTH, WIDTH]) / 2), abs=1e-12)
    pose = np.concatenate((place[0, :3], Rotation.from_euler("z", yaw).as_quat()))[None]
    assert corners(pose, LENGTH, WIDTH)[0, :, :2] == pytest.approx(found, abs=1e-12)


NAMES = ("left_hip", "left_knee", "right_hip", "right_knee", "waist", "left_elbow")


def test_without_roles_the_names_tell():
    assert knees(NAMES, {}) == [1, 3]
    assert leg(NAMES, {}, "left") == [0, 1]
    assert leg(NAMES, {}, "right") == [2, 3]
    assert torso({}) == "torso"


def test_roles_tell_whatever_the_names_are():
    roles = {"knees": ("waist",), "left_leg": ("left_elbow",), "right_leg": (), "torso": ("chest",)}
    assert knees(NAMES, roles) == [4]
    assert leg(NAMES, roles, "left") == [5]
    assert leg(NAMES, roles, "right") == []
    assert torso(roles) == "chest"


def test_the_metrics_take_the_knees_of_the_log(tmp_path, robot, motion, two_steps):
    """The invented joints stand at 0.1, 0.3, 0.1 and -0.5 rad; the second and the last are called knees."""
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    assert RunView(log).knees == [1, 3]
    assert compute(log)["knee_angle_mean"] == pytest.approx(0.4)
    roles = SimpleNamespace(**{**vars(robot.roles), "knees": ("left_hip", "right_knee")})
    other = SimpleNamespace(**{**vars(robot), "roles": roles})
    log = read(run_scenario(two_steps, tmp_path, None, motion(), other).log)
    assert RunView(log).knees == [0, 3]
    assert compute(log)["knee_angle_mean"] == pytest.approx(0.3)


def test_a_log_says_what_joints_are_for_and_one_without_is_read_as_ever(tmp_path, robot, motion, two_steps):
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    assert RunConstants.from_metadata(log.metadata, "log").roles["knees"] == ("left_knee", "right_knee")
    older = {"run": {name: value for name, value in log.metadata["run"].items() if name != "roles"}}
    assert RunConstants.from_metadata(older, "log").roles == {}
