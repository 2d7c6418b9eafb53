"""A robot of another size in a similar state gets the torques of the reference robot, scaled."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.models.pinocchio import limb_shapes, pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.similar import scaled
from surefoot.models.types import RobotOptions
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.body.falling import GivingWay
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.contact.cone import Sole
from surefoot.wbc.contact.external import LoadObserver
from surefoot.wbc.controller import WholeBodyController
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

QUARTER = Similarity(0.25, 0.25**3)
LENGTHS = ("com", "zmp", "zmp_offset", "swing_position")
SPEEDS = ("com_velocity", "swing_velocity")
RATES = ("omega", "heading_rate", "swing_angular_velocity")


def body(size):
    d = scaled(describe("humanoid100", RobotOptions(0.22, 0.11)), size.length)
    return d, pinocchio_model(d), JointLimits(d.torque_limit, d.velocity_limit, d.position_lower, d.position_upper)


def controller(size, robot, parameters):
    d, model, limits = body(size)
    sole = Sole(0.5 * d.sole_length, 0.5 * d.sole_width, 0.8)
    given = (
        robot.standing[7:],
        robot.leg_joints,
        0.002 * size.time,
        parameters,
        limb_shapes(d),
        robot.shoulders,
    )
    return WholeBodyController(model, robot.frames, sole, limits, *given)


def similar(state, size):
    q, v = state.q.copy(), state.v / size.time
    q[:3] *= size.length
    v[:3] *= size.length
    return RobotState(q, v)


def said(reference, size):
    """The same reference for another size."""
    factors = {name: size.length for name in LENGTHS} | {name: size.factor("m/s") for name in SPEEDS}
    factors |= {name: 1.0 / size.time for name in RATES} | {"stiffness": size.factor("1/s^2")}
    factors |= {"swing_angular_acceleration": size.factor("1/s^2"), "time_to_switch": size.time}
    changed = {name: factor * np.asarray(getattr(reference, name)) for name, factor in factors.items()}
    for name in ("omega", "stiffness", "heading_rate", "time_to_switch"):
        changed[name] = float(changed[name])
    return replace(reference, **changed)


def asked(size, robot, reference, parameters=None):
    """Torques over their limits in a moved state, after a few ticks on both feet."""
    wbc = controller(size, robot, parameters or size.scaled(WbcParameters()))
    state = similar(robot.moved(np.random.default_rng(4), 0.01, 0.1), size)
    sensing = FootSensing((490.0 * size.factor("N"), 490.0 * size.factor("N")))
    for _ in range(3):
        wbc.observe(state)
        report = wbc.update(said(reference, size), sensing)
    assert report.status is SolveStatus.SOLVED
    return report.torque / body(size)[2].torque, report


def test_torques_are_the_same_share_of_their_limits(robot, reference):
    (full, one), (small, other) = (asked(size, robot, reference) for size in (REFERENCE_SIZE, QUARTER))
    np.testing.assert_allclose(small, full, atol=1e-7)
    assert np.abs(full).max() > 0.05
    np.testing.assert_allclose(other.wrench[:, :3], QUARTER.factor("N") * one.wrench[:, :3], atol=1e-5)
    np.testing.assert_allclose(other.wrench[:, 3:], QUARTER.factor("N·m") * one.wrench[:, 3:], atol=1e-5)


@pytest.mark.parametrize("group", ["weights", "gains", "balance", "contact"])
def test_one_group_of_full_size_is_enough_to_tell(robot, references, group):
    reference = references[1]()
    wrong = replace(QUARTER.scaled(WbcParameters()), **{group: getattr(WbcParameters(), group)})
    (full, _), (small, _) = asked(REFERENCE_SIZE, robot, reference), asked(QUARTER, robot, reference, wrong)
    assert np.abs(small - full).max() > 1e-4


def test_who_falls_gives_way_alike(robot):
    state = robot.moved(np.random.default_rng(2), 0.3, 2.0)
    shares = []
    for size in (REFERENCE_SIZE, QUARTER):
        limits, own = body(size)[2], similar(state, size)
        shares.append(GivingWay(limits, size).torque(own.q[7:], own.v[6:]) / limits.torque)
    np.testing.assert_allclose(shares[1], shares[0], atol=1e-12)


def test_what_lasts_of_a_force_is_found_alike(robot):
    found = []
    for size in (REFERENCE_SIZE, QUARTER):
        wbc, mass = controller(size, robot, size.scaled(WbcParameters())), 100.0 * size.mass
        observer = LoadObserver(mass, 0.002 * size.time, size)
        state = similar(RobotState(robot.standing, np.zeros(robot.nv)), size)
        wrench = np.zeros((2, 6))
        wrench[:, 2] = 0.5 * mass * 9.81
        wrench[:, 0] = -15.0 * size.factor("N")
        for _ in range(400):
            load = observer.update(wbc.observe(state), wrench)
        found.append(load.force / size.factor("N"))
    assert found[0][0] == pytest.approx(30.0, rel=0.05)
    np.testing.assert_allclose(found[1], found[0], rtol=1e-9)
