"""The text is the robot of its source, and both engines read it alike."""

import biped
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.models.consistency import EnginePair
from surefoot.models.names import SHIPPED
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.robot_file.files import originals
from surefoot.models.robot_file.paths import resolve
from surefoot.models.robot_file.reduced import reduced
from surefoot.models.robot_file.schema import read
from surefoot.models.robot_file.source import read_source

pytestmark = pytest.mark.unit

TURNED = '<axis xyz="0.6 0 0.8"/>'


def source_model(file, path) -> pin.Model:
    """The model of a file as its text is made of it: reduced, with x of the base ahead."""
    made_of = originals(file, path.parent)
    return reduced(made_of, read_source(file, made_of.document)).model


def model_difference(one: pin.Model, other: pin.Model, q, v) -> float:
    """Largest difference of mass matrix and bias forces at one state."""
    pairs = [
        (pin.crba(model, data, q).copy(), pin.nle(model, data, q, v).copy())
        for model, data in ((model, model.createData()) for model in (one, other))
    ]
    return max(float(np.abs(a - b).max()) for a, b in zip(*pairs, strict=True))


@pytest.fixture
def cases(tmp_path):
    """Shipped robots, and a small one with an axis and frames that are turned."""
    changes = {'<axis xyz="0 0 1"/>': TURNED, 'rpy="0 0 0"/><axis xyz="1 0 0"/>': 'rpy="0 0 0.2"/><axis xyz="1 0 0"/>'}
    own = biped.write(tmp_path, biped.Biped(changes=changes, turned=True))
    return {"biped": own, **{name: SHIPPED[name] for name in ("talos", "g1", "alexander")}}


@pytest.mark.parametrize("name", ["biped", "talos", "g1", "alexander"])
def test_the_text_is_the_source(cases, name) -> None:
    path = cases[name]
    file = read(path)
    robot = describe(str(path), RobotOptions())
    source, text = source_model(file, resolve(file.model, path.parent)), pinocchio_model(robot)
    pair, rng = EnginePair(robot), np.random.default_rng(0)
    for _ in range(50):
        q, v = pair.random_state(rng)
        assert model_difference(source, text, q, v) < 1e-9
        assert pair.difference(q, v).largest < 1e-9


@pytest.mark.parametrize("name", ["biped", "talos"])
def test_the_source_is_what_pinocchio_reads(cases, name) -> None:
    """Joints alone, the base on the ground: its frame may be turned, and what is locked is locked where we lock it."""
    path = cases[name]
    file = read(path)
    model = resolve(file.model, path.parent)
    ours, theirs = source_model(file, model), pin.buildModelFromUrdf(str(model), pin.JointModelFreeFlyer())
    locked = [theirs.getJointId(joint) for joint in tuple(theirs.names)[2:] if not ours.existJointName(joint)]
    rest = np.clip(pin.neutral(theirs), theirs.lowerPositionLimit, theirs.upperPositionLimit)
    rest[:7] = pin.neutral(theirs)[:7]
    theirs = pin.buildReducedModel(theirs, locked, rest)
    theirs.armature = ours.armature.copy()
    rng = np.random.default_rng(1)
    for _ in range(20):
        q, v = pin.neutral(ours), np.zeros(ours.nv)
        q[7:], v[6:] = rng.uniform(-0.5, 0.5, ours.nq - 7), rng.normal(size=ours.nv - 6)
        masses = [pin.crba(m, m.createData(), q)[6:, 6:] for m in (ours, theirs)]
        biases = [pin.nle(m, m.createData(), q, v)[6:] for m in (ours, theirs)]
        np.testing.assert_allclose(*masses, atol=1e-10)
        np.testing.assert_allclose(*biases, atol=1e-9)


def test_another_inertia_is_seen(cases) -> None:
    """Negative control: a thousandth more mass in one link."""
    robot = describe(str(cases["biped"]), RobotOptions())
    one, other = (pinocchio_model(robot) for _ in range(2))
    other.inertias[4] = pin.Inertia(1.001 * one.inertias[4].mass, one.inertias[4].lever, one.inertias[4].inertia)
    q, v = EnginePair(robot).random_state(np.random.default_rng(0))
    assert model_difference(one, other, q, v) > 1e-6
