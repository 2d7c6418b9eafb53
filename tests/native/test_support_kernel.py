"""The support region by kernels: the same as that of plain Python."""

import numpy as np
import pytest

from surefoot.native.library import VARIABLE
from surefoot.planner.orientation import sole_rotation
from surefoot.wbc.balance import SupportRegion

pytestmark = pytest.mark.unit

CONTACTS = [((True, True), -1), ((True, False), -1), ((False, True), -1), ((True, True), 0), ((True, True), 1)]


@pytest.mark.parametrize(("active", "rolling"), CONTACTS)
def test_a_point_goes_to_the_same_place_of_both_regions(kernels, monkeypatch, active, rolling):
    compiled = SupportRegion(0.11, 0.05, 0.95)
    monkeypatch.setenv(VARIABLE, "0")
    plain = SupportRegion(0.11, 0.05, 0.95)
    rng = np.random.default_rng(5)
    for case in range(40):
        # Feet side by side, one edge in line with the other's, and feet anyhow.
        yaw = 0.0 if case < 5 else rng.uniform(-0.6, 0.6)
        positions = np.array([[0.0, 0.1, 0.0], [0.0 if case < 5 else rng.uniform(-0.4, 0.4), -0.1, 0.02]])
        rotations = np.array([sole_rotation(yaw, 0.02 * case / 40, 0.0), sole_rotation(-yaw, 0.0, 0.01)])
        for region in (compiled, plain):
            region.rebuild(positions, rotations, active, rolling)
        for x, y in rng.uniform(-0.6, 0.6, (20, 2)):
            np.testing.assert_allclose(compiled.project(x, y), plain.project(x, y), rtol=0.0, atol=1e-12)
        lengths = [sorted(region.edges[: region.edge_count[0], 4]) for region in (compiled, plain)]
        assert sum(lengths[0]) == pytest.approx(sum(lengths[1]), rel=1e-12)
