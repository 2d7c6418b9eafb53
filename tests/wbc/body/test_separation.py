"""Limbs that keep apart: the rows against finite differences, and what obeying them does."""

from itertools import product

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import limb_shapes
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.body.separation import Pair, Separation, SeparationParameters
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

UNBOUNDED = 1e9


@pytest.fixture(scope="module")
def geometry(robot) -> pin.GeometryModel:
    return limb_shapes(describe("humanoid100", RobotOptions()))


def _nearest(robot, geometry: pin.GeometryModel, q: np.ndarray) -> tuple[int, float]:
    data, shapes = robot.model.createData(), pin.GeometryData(geometry)
    pin.computeDistances(robot.model, data, geometry, shapes, q)
    distances = [result.min_distance for result in shapes.distanceResults]
    return int(np.argmin(distances)), min(distances)


def _distance(robot, geometry: pin.GeometryModel, q: np.ndarray, pair: int) -> float:
    data, shapes = robot.model.createData(), pin.GeometryData(geometry)
    pin.computeDistances(robot.model, data, geometry, shapes, q)
    return float(shapes.distanceResults[pair].min_distance)


def _row(robot, geometry, q, v, parameters: SeparationParameters) -> tuple[np.ndarray, float]:
    data = robot.model.createData()
    pin.computeAllTerms(robot.model, data, q, v)
    rows, lower = np.ones((parameters.slots, robot.nv)), np.zeros(parameters.slots)
    Separation(robot.model, geometry, parameters).write(data, v, rows, lower, UNBOUNDED)
    return rows[0], float(lower[0])


def _crossing(robot, angle: float) -> np.ndarray:
    """The left leg turned inwards about its hip."""
    q = robot.standing.copy()
    q[robot.model.joints[robot.model.getJointId("left_hip_roll")].idx_q] -= angle
    return q


def test_shapes_of_both_legs_that_come_nearest_are_kept_apart(robot, geometry) -> None:
    """However hips, knees and ankles bend in walking and crossing: what is left out never meets first."""
    pairs = {frozenset((pair.first, pair.second)) for pair in geometry.collisionPairs}
    names, every = [shape.name for shape in geometry.geometryObjects], geometry.copy()
    every.removeAllCollisionPairs()
    left, right = ([k for k, name in enumerate(names) if name.startswith(side)] for side in ("left", "right"))
    legs = [
        [k for k in side if any(part in names[k] for part in ("thigh", "knee", "shank", "sole"))]
        for side in (left, right)
    ]
    for one, other in product(*legs):
        every.addCollisionPair(pin.CollisionPair(one, other))
    data, shapes = robot.model.createData(), pin.GeometryData(every)
    rng, near = np.random.default_rng(0), set()
    ranges = {"hip_pitch": (-1.0, 0.5), "knee": (0.0, 1.2), "hip_roll": (-0.35, 0.2), "ankle_pitch": (-0.5, 0.3)}
    for _ in range(6000):
        q = robot.standing.copy()
        for (name, (low, high)), (side, out) in product(ranges.items(), (("left", 1.0), ("right", -1.0))):
            joint = robot.model.joints[robot.model.getJointId(f"{side}_{name}")]
            q[joint.idx_q] = rng.uniform(low, high) * (out if name == "hip_roll" else 1.0)
        pin.computeDistances(robot.model, data, every, shapes, q)
        distances = [result.min_distance for result in shapes.distanceResults]
        if 0.0 < min(distances) < 0.02:
            pair = every.collisionPairs[int(np.argmin(distances))]
            near.add(frozenset((pair.first, pair.second)))
    assert len(near) >= 9
    assert near <= pairs


def test_far_limbs_bound_nothing(robot, geometry) -> None:
    parameters = SeparationParameters(attention=0.02)
    row, lower = _row(robot, geometry, robot.standing, np.zeros(robot.nv), parameters)
    assert not row.any()
    assert lower == -UNBOUNDED


def test_row_is_the_gradient_of_the_distance(robot, geometry) -> None:
    """Central differences along every generalised velocity."""
    q = _crossing(robot, 0.08)
    pair, _ = _nearest(robot, geometry, q)
    row, _ = _row(robot, geometry, q, np.zeros(robot.nv), SeparationParameters(attention=1.0))
    step = 1e-6
    for i in range(robot.nv):
        move = np.zeros(robot.nv)
        move[i] = step
        ahead = _distance(robot, geometry, pin.integrate(robot.model, q, move), pair)
        behind = _distance(robot, geometry, pin.integrate(robot.model, q, -move), pair)
        assert row[i] == pytest.approx((ahead - behind) / (2 * step), abs=2e-5)


def test_from_rest_the_gap_opens_as_the_row_says(robot, geometry) -> None:
    """d(t) = d + ½ t² J q̈ for constant joint accelerations."""
    rng, q, t = np.random.default_rng(3), _crossing(robot, 0.08), 2e-3
    pair, gap = _nearest(robot, geometry, q)
    row, _ = _row(robot, geometry, q, np.zeros(robot.nv), SeparationParameters(attention=1.0))
    for _ in range(10):
        a = rng.uniform(-20.0, 20.0, robot.nv)
        moved = _distance(robot, geometry, pin.integrate(robot.model, q, 0.5 * t**2 * a), pair)
        assert moved - gap == pytest.approx(0.5 * t**2 * float(row @ a), abs=2e-6)


def test_legs_that_obey_do_not_touch(robot, geometry) -> None:
    """The hip drives the legs together, at up to 0.7 m/s where they are looked at; without the rows they meet."""
    parameters = SeparationParameters()
    for obeys in (True, False):
        q, v, dt = _crossing(robot, 0.0), np.zeros(robot.nv), 1e-3
        hip = robot.model.joints[robot.model.getJointId("left_hip_roll")].idx_v
        least = np.inf
        for _ in range(400):
            a = -5.0
            if obeys:
                row, lower = _row(robot, geometry, q, v, parameters)
                if row[hip] != 0.0:
                    bound = lower / row[hip]
                    a = max(a, bound) if row[hip] > 0 else min(a, bound)
            v[hip] += a * dt
            q = pin.integrate(robot.model, q, v * dt)
            least = min(least, _nearest(robot, geometry, q)[1])
            if least < -0.01:
                break
        assert (least > 0.9 * parameters.clearance) == obeys


def test_the_controller_brakes_a_leg_before_it_meets_the_other(robot, geometry, references) -> None:
    """The swing leg is sent through the stance leg; with the rows the gap obeys its bound, without them it does not."""
    _, swing = references
    reference = swing(swing_position=np.array([0.0, 0.3, 0.02]), swing_velocity=np.zeros(3))
    hip = robot.model.joints[robot.model.getJointId("right_hip_roll")]
    q, v = robot.standing.copy(), np.zeros(robot.nv)
    q[hip.idx_q] += 0.1
    v[hip.idx_v] = 0.3
    row, lower = _row(robot, geometry, q, v, SeparationParameters(attention=0.05))
    assert lower > -UNBOUNDED
    for limbs in (geometry, None):
        controller = robot.controller(WbcParameters(separation=SeparationParameters(attention=0.05)), limbs)
        controller.observe(RobotState(q, v))
        report = controller.update(reference, FootSensing((981.0, 0.0)))
        assert report.status is SolveStatus.SOLVED
        assert (row @ report.acceleration >= lower - 1e-6) == (limbs is not None)


def test_a_robot_that_moves_as_a_whole_has_no_pair_to_be_measured(robot, geometry) -> None:
    parameters, rng, data = SeparationParameters(), np.random.default_rng(2), robot.model.createData()
    separation, v = Separation(robot.model, geometry, parameters), np.zeros(robot.nv)
    rows, lower = np.zeros((parameters.slots, robot.nv)), np.zeros(parameters.slots)
    pin.computeAllTerms(robot.model, data, robot.standing, v)
    separation.write(data, v, rows, lower, UNBOUNDED)
    near = set(separation.due())
    assert len(near) < len(geometry.collisionPairs)
    for _ in range(20):
        move = np.concatenate((rng.normal(size=6), np.zeros(robot.nv - 6)))
        pin.computeAllTerms(robot.model, data, pin.integrate(robot.model, robot.standing, move), v)
        assert set(separation.due()) <= near


def test_no_pair_comes_near_unseen(robot, geometry) -> None:
    """However the limbs move, as many rows have a bound as pairs are within the attention."""
    parameters = SeparationParameters(slots=len(geometry.collisionPairs))
    rng, data, v, found = np.random.default_rng(2), robot.model.createData(), np.zeros(robot.nv), set()
    separation, q = Separation(robot.model, geometry, parameters), robot.standing.copy()
    rows, lower = np.zeros((parameters.slots, robot.nv)), np.full(parameters.slots, -UNBOUNDED)
    for _ in range(200):
        q = pin.integrate(robot.model, q, np.concatenate((rng.normal(size=6), 0.05 * rng.normal(size=robot.nv - 6))))
        pin.computeAllTerms(robot.model, data, q, v)
        separation.write(data, v, rows, lower, UNBOUNDED)
        shapes = pin.GeometryData(geometry)
        pin.computeDistances(robot.model, robot.model.createData(), geometry, shapes, q)
        close = sum(0.0 < one.min_distance < parameters.attention for one in shapes.distanceResults)
        assert (lower > -UNBOUNDED).sum() == close
        found.add(close)
    assert len(found) > 2


def test_pairs_are_looked_at_before_they_come_near_whichever_way_they_lie(robot, geometry) -> None:
    """Rows are those of distances that are all measured anew, also of shapes beside the axes of their bodies."""
    rng, parameters = np.random.default_rng(6), SeparationParameters(attention=0.03)
    beside, data = geometry.copy(), robot.model.createData()
    for shape in beside.geometryObjects:
        shape.placement = pin.SE3(shape.placement.rotation, shape.placement.translation + 0.05 * np.eye(3)[0])
    rows, lower = np.zeros((parameters.slots, robot.nv)), np.zeros(parameters.slots)
    seldom, q, v, near = Separation(robot.model, beside, parameters), robot.standing.copy(), np.zeros(robot.nv), 0
    for step in range(120):
        angle, turned = 0.1 - 0.1 * np.cos(0.08 * step), 0.5 * np.sin(0.05 * step)
        q = _crossing(robot, angle)
        for side, way in (("left", 1.0), ("right", -1.0)):
            for name in ("hip_pitch", "hip_yaw"):
                q[robot.model.joints[robot.model.getJointId(f"{side}_{name}")].idx_q] += way * turned
        q = pin.integrate(robot.model, q, 1e-3 * rng.normal(size=robot.nv))
        pin.computeAllTerms(robot.model, data, q, v)
        seldom.write(data, v, rows, lower, UNBOUNDED)
        anew, least = _row(robot, beside, q, v, parameters)
        np.testing.assert_allclose(rows[0], anew, atol=1e-9)
        assert lower[0] == pytest.approx(least)
        near += bool(anew.any())
    assert 10 < near < 110


def test_a_distance_changes_as_a_shape_turns_by_no_more_than_its_farthest_point_moves(robot, geometry) -> None:
    """One that turns about its own middle does not come nearer than that, and the whole robot may move as it likes."""
    rng, shapes, data = np.random.default_rng(6), geometry.copy(), robot.model.createData()
    pin.computeAllTerms(robot.model, data, robot.standing, np.zeros(robot.nv))
    for shape in shapes.geometryObjects:
        shape.placement = shape.placement * pin.SE3(pin.exp3(rng.normal(size=3)), 0.05 * rng.normal(size=3))

    def put(joint: int, place: pin.SE3) -> None:
        data.oMi[joint].rotation, data.oMi[joint].translation = place.rotation, place.translation

    for of in shapes.collisionPairs:
        pair = Pair(robot.model, data, np.zeros((6, robot.nv)), shapes, of)
        first, second = (shapes.geometryObjects[k] for k in (of.first, of.second))
        one, two = first.parentJoint, second.parentJoint
        still, there = data.oMi[one].copy(), data.oMi[two].copy()
        second.geometry.computeLocalAABB()
        centre, radius = second.placement.act(np.array(second.geometry.aabb_center)), second.geometry.aabb_radius
        assert pair.is_due(0.0)
        pair.distance = 0.1
        for axis in rng.normal(size=(4, 3)):
            turned = pin.exp3(0.05 * axis / np.linalg.norm(axis)) @ there.rotation
            away = pin.SE3.Random()
            put(one, away * still)
            put(two, away * pin.SE3(turned, there.act(centre) - turned @ centre))
            most = 2.0 * np.sin(0.025) * radius
            assert not pair.is_due(0.1 - 1.001 * most)
            put(two, away * pin.SE3(there.rotation, there.translation + 0.03 * axis / np.linalg.norm(axis)))
            assert not pair.is_due(0.07 - 1e-6)
        put(one, still)
        put(two, pin.SE3(turned, there.act(centre) - turned @ centre + (0.0, 0.0, 0.02)))
        assert pair.is_due(0.08 - 0.999 * most)
        put(two, there)
