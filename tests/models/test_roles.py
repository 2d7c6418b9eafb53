"""Roles of joints: true of the mechanics, and refused where they contradict the description."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from surefoot.models import JointRoles, RobotError, RobotOptions, describe

pytestmark = pytest.mark.unit

ROBOT = describe("humanoid100", RobotOptions())
MODEL = mujoco.MjModel.from_xml_string(ROBOT.mjcf)


def posture(**angles):
    """Kinematics with the named joints at angles [rad], all others at zero."""
    data = mujoco.MjData(MODEL)
    for name, angle in angles.items():
        data.joint(name).qpos[0] = angle
    mujoco.mj_kinematics(MODEL, data)
    mujoco.mj_comPos(MODEL, data)
    return data


def joints_between(body, base):
    """Joints of the chain from a body, excluded, to another body below it."""
    found, index = [], MODEL.body(body).id
    while index != MODEL.body(base).id:
        assert index, f"{base} does not carry {body}"
        found.append(MODEL.joint(MODEL.body_jntadr[index]).name)
        index = MODEL.body_parentid[index]
    return tuple(reversed(found))


def test_legs_are_the_chains_from_the_pelvis_to_the_soles() -> None:
    for site, leg in zip(ROBOT.sole_sites, (ROBOT.roles.left_leg, ROBOT.roles.right_leg), strict=True):
        foot = MODEL.body(MODEL.site_bodyid[MODEL.site(site).id]).name
        assert joints_between(foot, ROBOT.pelvis_body) == leg
    assert joints_between(ROBOT.torso_body, ROBOT.pelvis_body) == ROBOT.roles.waist


def test_a_knee_is_the_joint_that_shortens_its_leg() -> None:
    """The law of cosines gives it; no other joint of the leg changes the distance of hip and ankle."""
    thigh, shank = 0.43, 0.43
    for side, knee, leg in zip(
        ("left", "right"), ROBOT.roles.knees, (ROBOT.roles.left_leg, ROBOT.roles.right_leg), strict=True
    ):
        for joint in leg:
            data = posture(**{joint: 0.5})
            span = np.linalg.norm(data.body(f"{side}_thigh").xpos - data.body(f"{side}_foot").xpos)
            expected = (
                np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(0.5)) if joint == knee else thigh + shank
            )
            assert span == pytest.approx(expected)


def test_positive_arm_swing_moves_the_arm_back() -> None:
    for side, joint in zip(("left", "right"), ROBOT.roles.arm_swing, strict=True):
        before, after = (data.body(f"{side}_forearm").xpos for data in (posture(), posture(**{joint: 0.3})))
        assert after[0] < before[0] - 0.05
        assert after[1] == pytest.approx(before[1])


def test_shanks_at_their_spacing_are_a_centimetre_apart() -> None:
    left, right = (MODEL.geom(f"{side}_shank_shape").size[0] for side in ("left", "right"))
    assert ROBOT.shank_spacing - left - right == pytest.approx(0.01, abs=0.005)


def test_indices_are_places_in_the_joint_order() -> None:
    left, right = ROBOT.joint_indices(ROBOT.roles.knees)
    assert (ROBOT.joint_names[left], ROBOT.joint_names[right]) == ("left_knee", "right_knee")


def roles(**changes):
    return replace(ROBOT.roles, **changes)


@pytest.mark.parametrize(
    ("changes", "key", "message"),
    [
        ({"roles": roles(knees=("left_kne", "right_knee"))}, ("roles", "knees"), "did you mean 'left_knee'"),
        ({"roles": roles(knees=("right_knee", "left_knee"))}, ("roles", "knees"), "is not inside its leg left_hip_yaw"),
        ({"roles": roles(knees=("left_ankle_roll", "right_knee"))}, ("roles", "knees"), "above and below it"),
        ({"roles": roles(left_leg=ROBOT.roles.right_leg)}, ("roles",), "twice in the legs"),
        ({"roles": roles(arm_swing=("torso", "torso"))}, ("roles", "arm_swing"), "no joint of it"),
        ({"roles": roles(waist=("hip",))}, ("roles", "waist"), "no joint of it"),
        ({"torso_body": "chest"}, ("torso_body",), "names 'chest', which is no body of it; choose from pelvis"),
        ({"torque_limit": np.ones(24)}, ("torque_limit",), "one number for each of 25 joints"),
        (
            {"velocity_limit": np.full(25, np.inf)},
            ("velocity_limit", 0),
            "'left_hip_yaw' of humanoid100 is inf; it must",
        ),
        ({"torque_limit": np.zeros(25)}, ("torque_limit", 0), "it must be positive"),
        ({"position_lower": np.full(25, np.nan)}, ("position_lower", 0), "must be a finite number"),
        ({"position_upper": ROBOT.position_lower}, ("position_upper", 0), "must exceed position_lower"),
        ({"shank_spacing": 0.0}, ("shank_spacing",), "must be a positive distance"),
    ],
)
def test_a_description_that_contradicts_itself_is_refused(changes, key, message) -> None:
    with pytest.raises(RobotError, match=message) as refused:
        replace(ROBOT, **changes)
    assert refused.value.key == key


def test_arms_and_waist_may_be_missing() -> None:
    bare = JointRoles(ROBOT.roles.left_leg, ROBOT.roles.right_leg, ROBOT.roles.knees)
    assert replace(ROBOT, roles=bare).roles.arm_swing is None
