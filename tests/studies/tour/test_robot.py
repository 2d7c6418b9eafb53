"""The robot of the tour weighs what the benchmark's does, and is its own where revision 1.0 is another."""

import mujoco
import numpy as np
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.studies.tour.robot import robot_file, tour_robot

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def described():
    return describe(str(robot_file()), RobotOptions())


def test_it_weighs_what_the_benchmark_says_and_the_usual_one_does_not(described):
    assert described.mass == pytest.approx(35.112, abs=2e-3)
    assert describe("g1", RobotOptions()).mass == pytest.approx(33.34, abs=0.01)


def test_shoulders_and_head_are_where_they_are_in_revision_1_though_the_torso_is_not(described):
    places = []
    for robot in (described, describe("g1", RobotOptions())):
        model = mujoco.MjModel.from_xml_string(robot.mjcf)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        names = ("torso_link", "left_shoulder_pitch_link", "right_shoulder_pitch_link")
        places.append([data.xpos[model.body(name).id] - data.xpos[1] for name in names])
    mine, usual = np.array(places)
    assert mine[1:] == pytest.approx(usual[1:], abs=1e-9)
    assert mine[0, 2] - usual[0, 2] == pytest.approx(0.01)


def test_every_joint_has_its_armature_and_its_limit(described):
    model = mujoco.MjModel.from_xml_string(described.mjcf)
    armature = dict(zip(described.joint_names, model.dof_armature[6:], strict=True))
    torque = dict(zip(described.joint_names, described.torque_limit, strict=True))
    assert armature["left_hip_roll_joint"] == 0.025101925 and armature["right_hip_yaw_joint"] == 0.01017752
    assert armature["left_wrist_yaw_joint"] == 0.00425 and armature["right_elbow_joint"] == 0.003609725
    assert torque["left_hip_roll_joint"] == 88.0 and torque["right_knee_joint"] == 139.0
    assert torque["left_ankle_roll_joint"] == torque["waist_roll_joint"] == 50.0 and torque["waist_yaw_joint"] == 88.0


def test_drives_of_the_arms_are_limp():
    stiffness, damping = tour_robot().drive_gains(0.003609725)
    assert stiffness == pytest.approx(14.25, abs=0.01) and damping == pytest.approx(0.907, abs=0.001)
