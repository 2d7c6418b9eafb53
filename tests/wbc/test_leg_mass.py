import numpy as np
import pinocchio as pin
import pytest

from wbc.leg_mass import LegMass, leg_mass

pytestmark = pytest.mark.unit


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
    """The same of point masses at both soles, the moving one further ahead for vertical motion."""
    total = 0.0
    for k, r in enumerate(soles):
        relative = (np.array(velocity) if k == foot else np.zeros(3)) - com_velocity
        total += leg.ratio * (r[2] * relative[0] - r[0] * relative[2])
    return total - leg.ratio * leg.lever * velocity[2]


@pytest.mark.parametrize("foot", [0, 1])
def test_point_masses_have_the_pitching_momentum_of_a_leg_that_moves_forward(robot, foot):
    leg = leg_mass(robot.model, robot.frames, robot.standing, robot.leg_joints)
    full, com_velocity, soles = pitching(robot, foot, (1.0, 0.0, 0.0))
    assert point_masses(leg, foot, (1.0, 0.0, 0.0), com_velocity, soles) == pytest.approx(full, rel=0.01)


@pytest.mark.parametrize("foot", [0, 1])
def test_the_lever_makes_up_for_most_of_the_knee(robot, foot):
    leg, upward = leg_mass(robot.model, robot.frames, robot.standing, robot.leg_joints), (0.0, 0.0, 1.0)
    full, com_velocity, soles = pitching(robot, foot, upward)
    missing = abs(full - point_masses(leg, foot, upward, com_velocity, soles))
    without = abs(full - point_masses(LegMass(leg.ratio, 0.0), foot, upward, com_velocity, soles))
    assert missing < 0.25 * without


def test_heading_does_not_matter(robot):
    turned = robot.standing.copy()
    turned[3:7] = (0.0, 0.0, np.sin(0.5), np.cos(0.5))
    here, there = (leg_mass(robot.model, robot.frames, q, robot.leg_joints) for q in (robot.standing, turned))
    assert (there.ratio, there.lever) == pytest.approx((here.ratio, here.lever), rel=1e-9)
