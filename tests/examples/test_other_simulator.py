"""The same controller walks in DART: the robot there is that of the robot file, and the walks keep their bounds."""

import csv
import importlib.util
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.models.pinocchio import pinocchio_model
from surefoot.sim import World

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples" / "other_simulator"
G = 9.81


@pytest.fixture(scope="module")
def compare():
    sys.path.insert(0, str(FOLDER))
    try:
        spec = importlib.util.spec_from_file_location("compare", FOLDER / "compare.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        yield module
    finally:
        sys.path.remove(str(FOLDER))


def walk_of(robot, **keys):
    return surefoot.Simulation(surefoot.load("walk-level", {"robot": robot, "sensing.source": "truth", **keys})).walk


def high(walk):
    """A configuration in the air, bent and turned, and a velocity."""
    model = pinocchio_model(walk.true_robot)
    rng = np.random.default_rng(3)
    q = pin.integrate(model, pin.neutral(model), 0.3 * rng.standard_normal(model.nv))
    q[:3] = 0.0, 0.0, 5.0
    q[7:] = np.clip(q[7:], walk.true_robot.position_lower + 0.1, walk.true_robot.position_upper - 0.1)
    return model, q, 0.2 * rng.standard_normal(model.nv)


@pytest.mark.unit
@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_a_robot_in_flight_moves_as_its_rigid_body_model_does(compare, robot):
    """Momentum of pin's model: gravity alone changes it, whatever the joints do; a push adds its impulse."""
    walk = walk_of(robot)
    model, q, v = high(walk)
    data = model.createData()
    plant = compare.DartPlant(walk)
    plant.reset(q, v)
    before = plant.measure()
    np.testing.assert_allclose(before.q, q, atol=1e-9)
    np.testing.assert_allclose(before.v, v, atol=1e-9)
    momentum = pin.computeCentroidalMomentum(model, data, before.q, before.v).linear.copy()
    mass, period = pin.computeTotalMass(model), 10 / walk.rates.physics
    torque = 2e-3 * mass * np.sin(np.arange(model.nv - 6))
    plant.push(Push(0.5 * period, 5 * period, np.array([30.0, -20.0, 10.0]), walk.true_robot.torso_body))
    for _ in range(10):
        plant.act(JointCommand(torque), period)
    after = plant.measure()
    changed = pin.computeCentroidalMomentum(model, data, after.q, after.v).linear - momentum
    expected = 10 * period * mass * np.array([0.0, 0.0, -G]) + 5 * period * np.array([30.0, -20.0, 10.0])
    np.testing.assert_allclose(changed, expected, atol=2e-3 * mass * G * 10 * period)
    assert not after.nonfoot_contact


@pytest.mark.unit
@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_a_joint_accelerates_with_the_reflected_inertia_of_its_motor(compare, robot):
    """Held against the mass matrix of pin's model, in which the inertia stands on the diagonal."""
    walk = walk_of(robot)
    model, q, _ = high(walk)
    data, v = model.createData(), np.zeros(model.nv)
    mass_matrix = pin.crba(model, data, q)
    torque = np.diag(mass_matrix)[6:] * np.linspace(-3.0, 3.0, model.nv - 6)
    plant, short = compare.DartPlant(walk), 1 / walk.rates.physics
    plant.reset(q, v)
    for _ in range(40):
        plant.act(JointCommand(torque), short)
    seen = (plant.measure().v[6:] - v[6:]) / (40 * short)
    wanted = aba(model, data, q, v, torque)
    assert np.linalg.norm(seen - wanted) < 0.25 * np.linalg.norm(wanted)
    light = model.copy()
    light.armature = np.zeros(model.nv)
    if np.any(model.armature):
        bare = aba(light, light.createData(), q, v, torque)
        assert np.linalg.norm(seen - bare) > 0.5 * np.linalg.norm(wanted)


def aba(model, data, q, v, torque):
    return pin.aba(model, data, q, v, np.r_[np.zeros(6), torque])[6:].copy()


@pytest.mark.unit
@pytest.mark.parametrize("scenario", ["stairs-up", "blocks", "slope"])
def test_ground_of_the_catalogue_is_there(compare, scenario):
    """Each shape of the ground that MuJoCo has is one of DART's."""
    walk = surefoot.Simulation(surefoot.load(scenario, {"sensing.source": "truth"})).walk
    mjcf = World(walk.true_robot, walk.ground.true_terrain, walk.rates.physics, size=walk.size).model
    plant = compare.DartPlant(walk)
    shapes = plant._world.getSkeleton("ground").getBodyNode(0).getShapeNodes()
    assert len(shapes) == int(np.sum(mjcf.geom_bodyid == 0))


@pytest.mark.unit
def test_a_shape_that_dart_has_not_got_is_refused(compare, monkeypatch):
    monkeypatch.setattr(sys.modules["dart_plant"], "SHAPES", {})
    with pytest.raises(ParameterError, match="take planes and boxes"):
        compare.DartPlant(walk_of("humanoid100"))


@pytest.mark.unit
def test_the_table_has_every_walk_and_each_keeps_its_bounds(compare):
    with (ROOT / "docs" / "other-simulator.csv").open() as file:
        _, *rows = csv.reader(file)
    assert {tuple(row[:3]) for row in rows} == {
        (walk, robot, engine) for walk in compare.WALKS for robot in compare.ROBOTS for engine in compare.ENGINES
    }
    assert {row[3] for row in rows} == {"pass"}


@pytest.mark.physics
@pytest.mark.parametrize("robot", ["humanoid100", pytest.param("g1", marks=pytest.mark.long)])
def test_a_pushed_walk_in_dart_keeps_its_bounds(compare, tmp_path, robot):
    scenario = compare.scenario("walk, pushed left", robot, "DART")
    keys = {
        "gait.steps": 6,
        "pushes": [{"step": 3, "phase": "single", "fraction": 0.5, "impulse": 0.2, "direction": 1.57}],
    }
    scenario = surefoot.load(
        "walk-level", {"robot": robot, "sensing.source": "truth", "criteria": compare.BOUNDS, **keys}
    )
    result = surefoot.run(scenario, out=tmp_path, parts=surefoot.Parts(plant=compare.DartPlant))
    assert result.verdict.passed, result.verdict


@pytest.mark.long
@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_every_walk_of_the_table_keeps_its_bounds_in_dart(compare, robot):
    rows = [compare.row((walk, robot, "DART")) for walk in compare.WALKS]
    assert {row[3] for row in rows} == {"pass"}, rows
