"""Pairs of limbs that are left out are never those that have come near."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import limb_shapes, pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.setup.stance import frames_of
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.separation import Separation, SeparationParameters

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("fresh", [False, True])
@pytest.mark.parametrize("name", ["humanoid100", "g1", "talos"])
def test_rows_are_those_of_all_distances(kernels, name, fresh):
    """Along a way of joints at random, slowly, then by leaps; into the rows of the tick before, or into others."""
    robot = describe(name, RobotOptions())
    model = pinocchio_model(robot)
    terms, shapes, parameters = RobotTerms(model, frames_of(robot)), limb_shapes(robot), SeparationParameters()
    compiled, plain = Separation(model, shapes, parameters, terms.compiled), Separation(model, shapes, parameters)
    rng, q = np.random.default_rng(7), pin.neutral(model)
    q[7:] = robot.nominal_joint_positions
    measured, near = [], []
    one, low = np.ones((parameters.slots, model.nv)), np.zeros(parameters.slots)
    find = compiled.due.find
    compiled.due.find = lambda: measured.append(find()) or measured[-1]
    for tick in range(600):
        v = rng.normal(size=model.nv) * (2.0 if tick < 400 else 40.0)
        q = pin.integrate(model, q, 0.01 * v)
        terms.update(q, v)
        other, lower = np.ones((parameters.slots, model.nv)), np.zeros(parameters.slots)
        if fresh:
            one, low = other.copy(), lower.copy()
        compiled.write(terms.data, v, one, low, 1e9)
        plain.write(terms.data, v, other, lower, 1e9)
        np.testing.assert_allclose(low, lower, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)
        assert compiled.is_clear == (not (lower > -1e8).any())
        near.append(int((lower > -1e8).sum()))
    assert np.count_nonzero(near) > 20
    assert np.count_nonzero(np.diff(near)) > 10
    assert np.mean(measured[:400]) < 0.7 * len(shapes.collisionPairs)
