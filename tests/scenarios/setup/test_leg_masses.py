from dataclasses import astuple

import numpy as np
import pinocchio as pin
import pytest
from surefoot.wbc.leg_mass import leg_mass

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def reduced(robot):
    return leg_mass(robot.model, robot.frames, robot.standing, robot.leg_joints)


def pitching(robot, foot, velocity):
    """Pitching momentum over mass of one sole moving at `velocity`: of the full body, and what its CoM and soles do."""
    model, data = robot.model, robot.model.createData()
    pin.computeJointJacobians(model, data, robot.standing)
    pin.updateFramePlacements(model, data)
    frames = [model.getFrameId(name) for name in robot.frames.soles]
    joints = 6 + np.flatnonzero(robot.leg_joints)
    J = pin.getFrameJacobian(model, data, frames[foot], pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
    v = np.zeros(model.nv)
    v[joints] = np.linalg.lstsq(J, np.append(velocity, np.zeros(3)), rcond=None)[0]
    momentum = pin.computeCentroidalMomentum(model, data, robot.standing, v)
    mass = pin.computeTotalMass(model)
    soles = [data.oMf[frame].translation - data.com[0] for frame in frames]
    return momentum.angular[1] / mass, momentum.linear / mass, soles


def point_masses(leg, foot, velocity, com_velocity, soles):
    """The same of point masses at both soles."""
    total = 0.0
    for k, r in enumerate(soles):
        relative = (np.array(velocity) if k == foot else np.zeros(3)) - com_velocity
        total += leg.ratio * (r[2] * relative[0] - r[0] * relative[2])
    return total


@pytest.mark.parametrize("foot", [0, 1])
def test_point_masses_have_the_pitching_momentum_of_a_leg_that_moves_forward(robot, reduced, foot):
    full, com_velocity, soles = pitching(robot, foot, (1.0, 0.0, 0.0))
    assert point_masses(reduced, foot, (1.0, 0.0, 0.0), com_velocity, soles) == pytest.approx(full, rel=0.01)


def test_links_are_those_of_the_robot(robot, reduced):
    data, q = robot.model.createData(), robot.standing
    pin.forwardKinematics(robot.model, data, q)
    at = {
        name: data.oMi[robot.model.getJointId(f"left_{name}")].translation
        for name in ("hip_pitch", "knee", "ankle_pitch")
    }
    assert reduced.thigh.length == pytest.approx(np.linalg.norm(at["hip_pitch"] - at["knee"]))
    assert reduced.shank.length == pytest.approx(np.linalg.norm(at["knee"] - at["ankle_pitch"]))
    names = [
        name
        for name in robot.model.names
        if name.startswith("left") and name.endswith(("knee", "ankle_roll", "hip_pitch"))
    ]
    inertias = {name: robot.model.inertias[robot.model.getJointId(name)] for name in names}
    assert reduced.shank.mass == pytest.approx(inertias["left_knee"].mass / pin.computeTotalMass(robot.model))
    assert 0.0 < reduced.thigh.centre < 0.5


def test_reduced_body_has_the_robots_com(robot, reduced):
    data = robot.model.createData()
    com = pin.centerOfMass(robot.model, data, robot.standing)
    pin.forwardKinematics(robot.model, data, robot.standing)
    pin.updateFramePlacements(robot.model, data)
    joint = {name: data.oMi[robot.model.getJointId(name)].translation for name in robot.model.names}
    r = reduced
    found = (1.0 - 2.0 * (r.thigh.mass + r.shank.mass + r.foot_mass)) * (
        0.5 * (joint["left_hip_pitch"] + joint["right_hip_pitch"]) + np.array(r.trunk)
    )
    for side in ("left", "right"):
        hip, knee, ankle = (joint[f"{side}_{name}"] for name in ("hip_pitch", "knee", "ankle_pitch"))
        found += r.thigh.mass * (hip + r.thigh.centre * (knee - hip))
        found += r.shank.mass * (knee + r.shank.centre * (ankle - knee))
        found += r.foot_mass * (ankle + np.array(r.foot_centre))
    np.testing.assert_allclose(found, com, atol=1e-6)


def test_heading_does_not_matter(robot, reduced):
    turned = robot.standing.copy()
    turned[3:7] = (0.0, 0.0, np.sin(0.5), np.cos(0.5))
    there = leg_mass(robot.model, robot.frames, turned, robot.leg_joints)
    flat = [np.hstack([np.ravel(value) for value in astuple(leg)]) for leg in (reduced, there)]
    np.testing.assert_allclose(flat[1].astype(float), flat[0].astype(float), atol=1e-9)
