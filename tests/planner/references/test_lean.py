"""The ZMP that a lasting force adds is that of the moment balance."""

import math

import numpy as np
import pytest

from surefoot.forces import ExternalLoad
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.window import lean
from surefoot.planner.types import GRAVITY

pytestmark = pytest.mark.unit


def test_a_body_leans_so_that_nothing_turns_about_the_zmp():
    """The moment of weight, inertia, lasting force and its moment about the ZMP has no horizontal part."""
    rng = np.random.default_rng(3)
    bend, ground = np.array([0.4, -0.7, 0.1]), 0.2
    height = np.array([[0.95, 0.93, 0.9], [0.0, 0.0, 0.0], bend])
    seen = HeightPreview(height, (GRAVITY + bend) / (height[0] - ground))
    c, s = math.cos(0.6), math.sin(0.6)
    rotation = np.array([[c, -s], [s, c]])
    load = ExternalLoad(np.append(rng.normal(size=2), 0.0), rng.normal(size=3))
    leaned = lean(load, rotation, seen) @ rotation.T
    com, acceleration = rng.normal(size=(3, 2)), rng.normal(size=(3, 2))
    for k in range(3):
        zmp = com[k] - acceleration[k] / seen.stiffness[k] + leaned[k]
        arm = np.append(com[k] - zmp, height[0, k] - ground)
        force = load.force - np.append(acceleration[k], GRAVITY + bend[k])
        np.testing.assert_allclose((np.cross(arm, force) + load.moment)[:2], 0.0, atol=1e-12)
