"""Links, masses and the point mass of the reduced legs against the whole body."""

from dataclasses import astuple

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.facts import facts_of
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.setup.robot.body import body_of, leg_inertia
from surefoot.wbc.body.ik import PostureTarget

pytestmark = pytest.mark.unit

STANCE = PostureTarget(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), np.array([0.0, 0.0, 1.0]), 0.0)


@pytest.fixture(scope="module")
def body():
    return body_of(describe("humanoid100", RobotOptions()))


@pytest.fixture(scope="module")
def standing(body):
    posture, q = body.robot.nominal_joint_positions, pin.neutral(body.model)
    q[2], q[7:] = body.robot.leg_length, posture
    result = body.ik(posture).solve(STANCE, q)
    assert result.reached
    return result.q


@pytest.fixture(scope="module")
def reduced(body, standing):
    return leg_inertia(body.model, body.frames, standing, body.leg_joints)


def pitching(body, standing, foot, velocity):
    """Pitching momentum over mass of one sole moving at `velocity`: of the full body, and what its CoM and soles do."""
    model, data = body.model, body.model.createData()
    pin.computeJointJacobians(model, data, standing)
    pin.updateFramePlacements(model, data)
    frames = [model.getFrameId(name) for name in body.frames.soles]
    joints = 6 + np.flatnonzero(body.leg_joints)
    J = pin.getFrameJacobian(model, data, frames[foot], pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
    v = np.zeros(model.nv)
    v[joints] = np.linalg.lstsq(J, np.append(velocity, np.zeros(3)), rcond=None)[0]
    momentum = pin.computeCentroidalMomentum(model, data, standing, v)
    mass = pin.computeTotalMass(model)
    soles = [data.oMf[frame].translation - data.com[0] for frame in frames]
    return momentum.angular[1] / mass, momentum.linear / mass, soles


def point_masses(leg, foot, velocity, com_velocity, soles):
    """The same of point masses at both soles."""
    total = 0.0
    for k, r in enumerate(soles):
        relative = (np.array(velocity) if k == foot else np.zeros(3)) - com_velocity
        total += leg.mass_ratio * (r[2] * relative[0] - r[0] * relative[2])
    return total


@pytest.mark.parametrize("foot", [0, 1])
def test_point_masses_have_the_pitching_momentum_of_a_leg_that_moves_forward(body, standing, reduced, foot):
    full, com_velocity, soles = pitching(body, standing, foot, (1.0, 0.0, 0.0))
    assert point_masses(reduced, foot, (1.0, 0.0, 0.0), com_velocity, soles) == pytest.approx(full, rel=0.01)


def test_links_are_those_of_the_robot(body, standing, reduced):
    data = body.model.createData()
    pin.forwardKinematics(body.model, data, standing)
    at = {
        name: data.oMi[body.model.getJointId(f"left_{name}")].translation
        for name in ("hip_pitch", "knee", "ankle_pitch")
    }
    assert reduced.chain.thigh.length == pytest.approx(np.linalg.norm(at["hip_pitch"] - at["knee"]))
    assert reduced.chain.shank.length == pytest.approx(np.linalg.norm(at["knee"] - at["ankle_pitch"]))
    names = [
        name
        for name in body.model.names
        if name.startswith("left") and name.endswith(("knee", "ankle_roll", "hip_pitch"))
    ]
    inertias = {name: body.model.inertias[body.model.getJointId(name)] for name in names}
    assert reduced.chain.shank.mass == pytest.approx(inertias["left_knee"].mass / pin.computeTotalMass(body.model))
    assert 0.0 < reduced.chain.thigh.centre < 0.5


def test_reduced_body_has_the_robots_com(body, standing, reduced):
    data = body.model.createData()
    com = pin.centerOfMass(body.model, data, standing)
    pin.forwardKinematics(body.model, data, standing)
    pin.updateFramePlacements(body.model, data)
    joint = {name: data.oMi[body.model.getJointId(name)].translation for name in body.model.names}
    r = reduced.chain
    found = (1.0 - 2.0 * (r.thigh.mass + r.shank.mass + r.foot_mass)) * (
        0.5 * (joint["left_hip_pitch"] + joint["right_hip_pitch"]) + np.array(r.trunk)
    )
    for side in ("left", "right"):
        hip, knee, ankle = (joint[f"{side}_{name}"] for name in ("hip_pitch", "knee", "ankle_pitch"))
        found += r.thigh.mass * (hip + r.thigh.centre * (knee - hip))
        found += r.shank.mass * (knee + r.shank.centre * (ankle - knee))
        found += r.foot_mass * (ankle + np.array(r.foot_centre))
    np.testing.assert_allclose(found, com, atol=1e-6)


@pytest.mark.parametrize("name", ["humanoid100", "talos", "jvrc1", "alexander"])
def test_joints_of_the_reduced_body_are_where_those_of_the_robot_are(name):
    """In postures of a walk; alexander's legs roll about axes far from their pitch axes, which do not meet."""
    body = body_of(describe(name, RobotOptions()))
    robot, model, data = body.robot, body.model, body.model.createData()
    ik, q = body.ik(robot.nominal_joint_positions), pin.neutral(body.model)
    q[2], q[7:] = robot.leg_length, robot.nominal_joint_positions
    scale, height = robot.leg_length / 0.94, robot.com_height
    width = 0.5 * max(robot.hip_width, robot.shank_spacing)
    soles = np.array([[0.0, width, 0.0], [0.0, -width, 0.0]])
    standing = ik.solve(PostureTarget(soles, np.zeros(2), np.array([0.0, 0.0, height]), 0.0), q).q
    chain = leg_inertia(model, body.frames, standing, body.leg_joints).chain
    for forward, aside, lift in ((0.15, 0.0, 0.0), (-0.1, 0.06, 0.08), (0.2, -0.04, 0.05)):
        moved = soles + scale * np.array([[forward, 0.0, 0.0], [-forward, 0.0, lift]])
        com = np.array([0.0, scale * aside, height - 0.04 * scale])
        found = ik.solve(PostureTarget(moved, np.zeros(2), com, 0.0), standing)
        assert found.reached
        pin.forwardKinematics(model, data, found.q)
        pin.updateFramePlacements(model, data)
        true = pin.centerOfMass(model, data, found.q)
        placed = np.array([data.oMf[model.getFrameId(sole)].translation for sole in body.frames.soles])
        _, knees, _ = chain.joints(true[None], placed[:, None], np.zeros((2, 1)))
        for k, sole in enumerate(body.frames.soles):
            legs = [j for j in model.supports[model.frames[model.getFrameId(sole)].parentJoint] if j > 1]
            knee = data.oMi[legs[3]]
            # Where on its axis a knee is does not matter.
            across = (knee.translation - knees[k, 0]) @ (np.eye(3) - np.outer(*[knee.rotation[:, 1]] * 2))
            assert np.abs(across).max() < 5e-3 * scale, (name, forward)


def test_heading_does_not_matter(body, standing, reduced):
    turned = standing.copy()
    turned[3:7] = (0.0, 0.0, np.sin(0.5), np.cos(0.5))
    there = leg_inertia(body.model, body.frames, turned, body.leg_joints)
    flat = [np.hstack([leg.mass_ratio, *map(np.ravel, astuple(leg.chain))]) for leg in (reduced, there)]
    np.testing.assert_allclose(flat[1].astype(float), flat[0].astype(float), atol=1e-9)


def test_a_sole_is_swung_by_the_torque_of_its_hip():
    """Held against a simulated leg that hangs straight: that torque at the hip alone, all else rigid and fixed."""
    robot = describe("humanoid100", RobotOptions())
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    data = mujoco.MjData(model)
    for joint, reached in zip(("left_hip_pitch", "left_hip_roll"), facts_of(robot).swing_acceleration, strict=True):
        mujoco.mj_resetData(model, data)
        data.qvel[model.joint(joint).dofadr[0]] = 1.0
        mujoco.mj_forward(model, data)
        mujoco.mj_energyVel(model, data)
        limit = robot.torque_limit[robot.joint_names.index(joint)]
        np.testing.assert_allclose(reached, limit / (2.0 * data.energy[1]) * robot.leg_length, rtol=0.01)


@pytest.mark.parametrize("name", ["humanoid100", "g1"])
def test_a_bent_leg_swings_its_sole_as_hard_against_gravity(name):
    """The hip's torque less that of gravity, at the inertia and lever of the posture: no less than is counted with."""
    robot = describe(name, RobotOptions())
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    data = mujoco.MjData(model)
    for joint, angle in zip(robot.joint_names, robot.nominal_joint_positions, strict=True):
        data.qpos[model.joint(joint).qposadr[0]] = angle
    mujoco.mj_forward(model, data)
    hips = [joint for joint in robot.joint_names if joint.startswith("left_hip")]
    for part, axis, reached in zip(("pitch", "roll"), (0, 1), facts_of(robot).swing_acceleration, strict=True):
        (joint,) = (hip for hip in hips if part in hip)
        place, (dof,) = model.joint(joint).id, model.joint(joint).dofadr
        unit, inertia = np.zeros((2, model.nv))
        unit[dof] = 1.0
        mujoco.mj_mulM(model, data, inertia, unit)
        body, beside = model.jnt_bodyid[place], 1 - axis
        arm = data.site(robot.sole_sites[0]).xpos - data.xanchor[place]
        weight = 9.81 * model.body_subtreemass[body] * abs(data.subtree_com[body] - data.xanchor[place])[axis]
        limit = robot.torque_limit[robot.joint_names.index(joint)]
        lever = np.linalg.norm(np.delete(arm, beside))
        assert (limit - weight) * lever / inertia[dof] > 0.9 * reached
