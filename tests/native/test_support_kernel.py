"""The hulls of soles by kernels: the same as those of plain Python."""

import numpy as np
import pytest

from surefoot.planner.geometry import sole_rotation
from surefoot.planner.references.compiled import CompiledHulls
from surefoot.planner.references.zmp_reference import Sole, hulls_of
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("far", [0.0, 10.0, -3000.0])
def test_hulls_of_two_soles_are_the_same_to_the_bit(kernels, far):
    find, rng = CompiledHulls(kernels).find, np.random.default_rng(7)
    for case in range(200):
        # Feet side by side, one edge in line with the other's; the same foothold twice; and feet anyhow.
        ahead, yaw = (0.0, 0.0) if case < 20 else rng.uniform(-0.5, 0.5, 2)
        beside = 0.0 if case < 3 else rng.uniform(0.02, 0.4)
        tilt = sole_rotation(0.0, *rng.uniform(-0.2, 0.2, 2))[:, 2] if case > 40 else np.array([0.0, 0.0, 1.0])
        places = (far, far, 0.0), (far + ahead, far + beside, 0.02)
        steps = [
            Footstep(foot, np.array(at), n * yaw, tilt) for n, (foot, at) in enumerate(zip(Foot, places, strict=True))
        ]
        soles = tuple(Sole.of(step, np.array([0.11, 0.055]), 0.9) for step in steps)
        for one, other in zip(find(soles), hulls_of(soles), strict=True):
            np.testing.assert_array_equal(one, other)
    (outer, inner), alone = find(soles[:1]), hulls_of(soles[:1])
    assert (outer.tolist(), inner.tolist()) == (alone[0].tolist(), alone[1].tolist())
