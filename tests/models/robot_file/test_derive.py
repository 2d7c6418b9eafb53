"""Values derived of a robot are true of its mechanics, however its axes and frames are turned."""

import biped
import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotOptions, describe, explain
from surefoot.models.joints import meeting_point
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.robot_file.touch import joined

pytestmark = pytest.mark.unit

SHIPPED = ("talos", "g1", "alexander")


@pytest.fixture(scope="module")
def shipped():
    """Descriptions of the robots whose models every installation has."""
    return {name: explain(name).description for name in SHIPPED}


def described(folder, *args, **changes):
    return describe(str(biped.write(folder, biped.Biped(**changes), *args)), RobotOptions())


def placed(robot, angles):
    """Model and placements with the base at the origin."""
    model = pinocchio_model(robot)
    data, q = model.createData(), pin.neutral(model)
    q[7:] = angles
    pin.framesForwardKinematics(model, data, q)
    return model, data


def frame(model, data, name):
    return data.oMf[model.getFrameId(name)]


def test_lengths_and_roles_are_those_of_the_model(tmp_path) -> None:
    robot = described(tmp_path)
    assert robot.roles.left_leg == tuple(
        f"left_{joint}" for joint in ("yaw", "roll", "pitch", "knee", "ankle_pitch", "ankle_roll")
    )
    assert robot.roles.knees == ("left_knee", "right_knee")
    assert robot.roles.knee_bend == (1.0, 1.0)
    assert robot.roles.arm_swing == ("left_shoulder", "right_shoulder")
    assert (robot.torso_body, robot.pelvis_body, robot.roles.waist) == ("base", "base", ())
    assert robot.leg_length == pytest.approx(biped.THIGH + biped.SHANK + biped.ANKLE)
    assert robot.hip_width == pytest.approx(2 * biped.HIP)
    assert (robot.sole_length, robot.sole_width) == pytest.approx(biped.FOOT[:2])
    np.testing.assert_allclose(robot.straight_joint_positions[:12], 0.0, atol=1e-9)


def test_the_sole_is_where_the_foot_touches(tmp_path) -> None:
    robot = described(tmp_path)
    model, data = placed(robot, robot.straight_joint_positions)
    sole = frame(model, data, "left_sole")
    np.testing.assert_allclose(sole.translation, (biped.AHEAD, biped.HIP, -robot.leg_length), atol=1e-9)
    np.testing.assert_allclose(sole.rotation, np.eye(3), atol=1e-9)


def test_a_knee_may_bend_by_negative_angles(tmp_path) -> None:
    """Its sign is told, and the crouch is the same."""
    robots = []
    for axis in ("y", "-y"):
        (tmp_path / axis).mkdir()
        robots.append(described(tmp_path / axis, knee=axis))
    assert [robot.roles.knee_bend[0] for robot in robots] == [1.0, -1.0]
    knee = robots[0].joint_names.index("left_knee")
    angles = [robot.nominal_joint_positions[knee] for robot in robots]
    assert angles == pytest.approx((0.65, -0.65))
    assert robots[0].com_height == pytest.approx(robots[1].com_height, abs=1e-9)


@pytest.mark.parametrize(("axis", "sign"), [("y", 1.0), ("-y", -1.0)])
def test_the_sign_that_swings_an_arm_back_moves_it_back(tmp_path, axis, sign) -> None:
    robot = described(tmp_path, shoulder=axis)
    assert robot.roles.arm_back == (sign, sign)
    angles = robot.nominal_joint_positions.copy()
    x = []
    for step in (0.0, 0.3):
        angles[robot.joint_names.index("left_shoulder")] += sign * step
        x.append(frame(*placed(robot, angles), "left_forearm").translation[0])
    assert x[1] < x[0] - 0.05


def test_a_base_that_looks_backward_is_turned(tmp_path) -> None:
    """The robot is the same one, and its file is told of."""
    (tmp_path / "turned").mkdir()
    robot = described(tmp_path)
    turned = explain(str(biped.write(tmp_path / "turned", biped.Biped(turned=True))))
    assert any("turned by 180 deg" in note for note in turned.notes)
    for name in ("left_sole", "right_sole", "left_forearm"):
        np.testing.assert_allclose(
            frame(*placed(turned.description, robot.nominal_joint_positions), name).homogeneous,
            frame(*placed(robot, robot.nominal_joint_positions), name).homogeneous,
            atol=1e-9,
        )
    assert turned.description.com_height == pytest.approx(robot.com_height, abs=1e-9)
    masses = [placed(one, robot.nominal_joint_positions)[0].inertias[1] for one in (robot, turned.description)]
    np.testing.assert_allclose(masses[0].lever, masses[1].lever, atol=1e-12)
    np.testing.assert_allclose(masses[0].inertia, masses[1].inertia, atol=1e-12)


def test_without_arms_the_heaviest_body_is_the_torso(tmp_path) -> None:
    robot = described(tmp_path, arms=False)
    assert robot.roles.arm_swing is None
    assert robot.torso_body == "base"


def test_arms_hang_free_of_the_body(tmp_path, shipped) -> None:
    """Hands below shoulders, and nothing touches in the posture. G1's go farther aside, past its wide trunk."""
    arms = {
        "biped": ("left_arm", "left_forearm"),
        "talos": ("arm_left_2_link", "arm_left_7_link"),
        "g1": ("left_shoulder_pitch_link", "left_wrist_yaw_link"),
    }
    for robot in (described(tmp_path), shipped["talos"], shipped["g1"]):
        model = mujoco.MjModel.from_xml_string(robot.mjcf)
        data = mujoco.MjData(model)
        data.qpos[2], data.qpos[7:] = 10.0, robot.nominal_joint_positions
        mujoco.mj_forward(model, data)
        touching = [[model.geom(geom).name for geom in contact.geom] for contact in data.contact]
        assert not touching
        shoulder, hand = (data.body(name).xpos for name in arms[robot.name])
        assert hand[2] < shoulder[2] - (0.8 if robot.name == "g1" else 0.9) * np.linalg.norm(hand - shoulder)


def test_arms_that_hang_have_room_to_swing(shipped) -> None:
    """A push at the trunk swings them, and they are kept from it; those of G1 used to hang 4 mm beside it."""
    for name, trunk, arm in (("g1", "torso_link", "shoulder_yaw_link"), ("talos", "torso_2_link", "3_link")):
        robot = shipped[name]
        model = mujoco.MjModel.from_xml_string(robot.mjcf)
        data = mujoco.MjData(model)
        data.qpos[7:] = robot.nominal_joint_positions
        mujoco.mj_kinematics(model, data)
        for side in ("left", "right"):
            upper = f"{side}_{arm}" if name == "g1" else f"arm_{side}_{arm}"
            shapes = f"{trunk}_shape", f"{upper}_shape"
            gap = mujoco.mj_geomDistance(model, data, *(model.geom(shape).id for shape in shapes), 1.0, None)
            assert gap > 0.025
            assert shapes in robot.kept_apart


def test_arms_are_kept_from_torso_base_and_both_thighs(shipped) -> None:
    """From their second link on, which hit the torso of TALOS when it was pushed hard."""
    pairs = {name: {frozenset(pair) for pair in shipped[name].kept_apart} for name in ("g1", "talos")}
    for side, other in (("left", "right"), ("right", "left")):
        upper, hand = f"arm_{side}_2_link_shape", f"arm_{side}_7_link_shape"
        assert {frozenset((upper, "torso_2_link_shape")), frozenset((hand, "base_link_shape"))} <= pairs["talos"]
        assert frozenset((hand, f"leg_{other}_3_link_shape")) in pairs["talos"]
        assert frozenset((f"{side}_shoulder_roll_link_shape", "torso_link_shape")) in pairs["g1"]
        assert frozenset((f"{side}_elbow_link_shape", "pelvis_shape")) in pairs["g1"]


def test_each_leg_is_kept_from_thigh_shank_and_sole_of_the_other_one(tmp_path) -> None:
    pairs = {frozenset(pair) for pair in described(tmp_path).kept_apart}
    parts = [[f"{side}_{part}" for part in ("thigh_shape", "shank_shape", "sole_box")] for side in ("left", "right")]
    across = {frozenset((one, other)) for one in parts[0] for other in parts[1]}
    soles_and_thighs = {frozenset((parts[one][2], parts[1 - one][0])) for one in (0, 1)}
    assert across - soles_and_thighs <= pairs


def test_what_the_file_says_counts(tmp_path) -> None:
    text = biped.FILE + (
        "sole: {length: 0.1, width: 0.05, centre: [0.01, 0.005, -0.06]}\ncom_height: 0.55\n"
        "torque_limit: {'*': 50, left_*: 60}\narmature: {'*_knee': 0.03}\n"
        "lock: {'*_elbow': -0.4}\nposture: {'*_yaw': 0.1}\n"
        "keep_apart: [[left_shank, right_shank]]\n"
    )
    robot = described(tmp_path, text)
    assert (robot.sole_length, robot.sole_width, robot.com_height) == (0.1, 0.05, 0.55)
    limits = dict(zip(robot.joint_names, robot.torque_limit, strict=True))
    assert (limits["left_knee"], limits["right_knee"]) == (60.0, 50.0)
    assert "left_elbow" not in robot.joint_names
    assert robot.nominal_joint_positions[robot.joint_names.index("left_yaw")] == 0.1
    assert robot.kept_apart == (("left_shank_shape", "right_shank_shape"),)
    model = pinocchio_model(robot)
    assert model.armature[model.joints[model.getJointId("left_knee")].idx_v] == 0.03
    soles = [
        frame(*placed(robot, robot.straight_joint_positions), f"{side}_sole").translation for side in ("left", "right")
    ]
    assert soles[0] * (1, -1, 1) == pytest.approx(soles[1], abs=1e-9)


@pytest.mark.parametrize("name", SHIPPED)
def test_soles_are_level_and_on_one_height(shipped, name) -> None:
    robot = shipped[name]
    for angles in (robot.nominal_joint_positions, robot.straight_joint_positions):
        model, data = placed(robot, angles)
        soles = [frame(model, data, site) for site in robot.sole_sites]
        for sole in soles:
            np.testing.assert_allclose(sole.rotation[:, 2], (0, 0, 1), atol=1e-9)
            assert abs(sole.rotation[1, 0]) < 1e-6
        assert soles[0].translation[2] == pytest.approx(soles[1].translation[2], abs=1e-5)


@pytest.mark.parametrize("name", SHIPPED)
def test_straight_legs_are_as_long_as_said_and_longer_than_bent_ones(shipped, name) -> None:
    robot = shipped[name]
    postures = (robot.straight_joint_positions, robot.nominal_joint_positions)
    heights = [-frame(*placed(robot, angles), "left_sole").translation[2] for angles in postures]
    assert heights[0] > heights[1] + 0.02 * robot.leg_length
    spans = []
    for change in (0.0, -0.1, 0.1):
        angles = robot.straight_joint_positions.copy()
        knee = robot.joint_names.index(robot.roles.knees[0])
        angles[knee] = np.clip(angles[knee] + change, robot.position_lower[knee], robot.position_upper[knee])
        model, data = placed(robot, angles)
        leg = [model.getJointId(joint) for joint in robot.roles.left_leg]
        place = robot.roles.left_leg.index(robot.roles.knees[0])
        ends = [meeting_point(model, data, group) for group in (leg[:place], leg[place + 1 :])]
        spans.append(np.linalg.norm(ends[0] - ends[1]))
    assert spans[0] >= max(spans) - 1e-6


def test_talos_is_its_own_mirror_image(shipped) -> None:
    robot = shipped["talos"]
    assert tuple(name.replace("left", "right") for name in robot.roles.left_leg) == robot.roles.right_leg
    assert robot.roles.knees == ("leg_left_4_joint", "leg_right_4_joint")
    assert (robot.torso_body, robot.roles.waist) == ("torso_2_link", ("torso_1_joint", "torso_2_joint"))
    model, data = placed(robot, robot.nominal_joint_positions)
    for left in (name for name in (*robot.bodies, *robot.sole_sites) if "left" in name and "arm" not in name):
        here, there = (frame(model, data, name).translation for name in (left, left.replace("left", "right")))
        np.testing.assert_allclose(here * (1, -1, 1), there, atol=1e-6)


def test_joints_and_masses_of_the_shipped_robots(shipped) -> None:
    found = {name: (len(robot.joint_names), round(robot.mass, 1)) for name, robot in shipped.items()}
    assert found == {"talos": (30, 93.3), "g1": (29, 33.3), "alexander": (13, 49.1)}


def test_hips_whose_axes_do_not_meet_are_where_these_come_nearest(shipped) -> None:
    assert shipped["g1"].leg_length == pytest.approx(0.675, abs=0.002)


def test_a_robot_without_a_shoulder_pitch_keeps_its_arms(shipped) -> None:
    assert shipped["talos"].roles.arm_swing is None
    assert shipped["g1"].roles.arm_swing == ("left_shoulder_pitch_joint", "right_shoulder_pitch_joint")


def test_fingers_and_joints_that_follow_others_are_locked(shipped) -> None:
    assert not [name for name in shipped["talos"].joint_names if "gripper" in name]


def test_bodies_with_joints_alone_between_them_are_neighbours() -> None:
    """A chain 1-2-3-4 of which 2 has no shape, and a branch 5 on 1; neighbours proper MuJoCo knows by itself."""
    parents = [0, 0, 1, 2, 3, 1]
    assert joined({1: "pelvis", 3: "thigh", 4: "shank", 5: "torso"}, parents) == [("pelvis", "thigh")]
