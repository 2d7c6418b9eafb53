"""Forces from outside, and what they are per mass."""

import numpy as np
import pytest

from surefoot.forces import NO_LOAD, ExternalLoad

pytestmark = pytest.mark.unit


def test_a_load_per_mass_accelerates_as_the_load_does():
    load = ExternalLoad(np.array([40.0, -20.0, 0.0]), np.array([3.0, 0.0, -1.5]), 1.2)
    told = load.per_mass(80.0)
    np.testing.assert_allclose(80.0 * told.force, load.force)
    np.testing.assert_allclose(80.0 * told.moment, load.moment)
    assert told.mass_scale == 1.0  # it is of the true mass already


def test_no_load_is_none_whatever_the_mass():
    told = NO_LOAD.per_mass(100.0)
    assert not told.force.any()
    assert not told.moment.any()
