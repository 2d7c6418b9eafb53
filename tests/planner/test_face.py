"""The names that `from surefoot.planner import ...` gives, and what strangers bring: a law and a planner."""

import inspect
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import surefoot.planner as face
from surefoot.planner import (
    PROFILES,
    CentroidalState,
    GaitParameters,
    Motion,
    PlannerParameters,
    Profile,
    WalkingPlanner,
)

pytestmark = pytest.mark.unit


def test_every_public_name_is_there_and_documented():
    for name in face.__all__:
        assert inspect.getdoc(getattr(face, name))
    assert set(face.__all__) == set(dir(face))
    with pytest.raises(AttributeError, match="no attribute 'WalkingPlaner'"):
        face.WalkingPlaner  # noqa: B018


def test_types_come_without_the_solvers():
    code = "import sys, surefoot.planner.types; assert not {'qpsolvers', 'daqp', 'scipy'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


class Coasting:
    """A law from outside: no jerk and no shifts."""

    def __init__(self, parameters, com_height):
        self.com_height = com_height

    def plan(self, problem):
        zero = np.zeros(2)
        return Motion(np.zeros_like(problem.fallback), np.zeros((2, 2)), zero, zero)


@pytest.fixture
def stranger():
    profile = Profile("coasting", "no jerk at all", PlannerParameters(), Coasting, moves=False)
    yield PROFILES.add(profile.name, profile)
    PROFILES.discard(profile.name)


def test_a_law_from_outside_is_a_profile_like_any_other(stand, stranger):
    assert PROFILES["coasting"] is stranger
    gait = GaitParameters(steps=0, com_height=0.9)
    planner = WalkingPlanner(gait, stand(), 0.2, 0.1, profile=stranger)
    plan = planner.update(CentroidalState(0.0, np.array([0.0, 0.0, 0.9]), np.array([0.1, 0.0, 0.0])), stand())
    np.testing.assert_array_equal(plan.jerk, 0.0)
    np.testing.assert_allclose(plan.com[:, 0], 0.1 * 0.02 * np.arange(51), atol=1e-12)
    assert planner._law.com_height == pytest.approx(0.9)


def test_every_profile_says_in_a_line_what_it_is():
    for name, profile in PROFILES.items():
        assert profile.name == name
        assert profile.doc
        assert "\n" not in profile.doc
        assert not profile.doc.endswith(".")


def test_a_profile_may_bring_a_whole_planner(stand):
    """It gets what `WalkingPlanner` gets; here it is one that only wears another name."""
    profile = replace(PROFILES["default"], planner=WalkingPlanner)
    planner = profile.planner(GaitParameters(steps=0), stand(), 0.2, 0.1, profile=profile)
    state = CentroidalState(0.0, np.array([0.01, 0.0, 1.0]), np.zeros(3))
    own = WalkingPlanner(GaitParameters(steps=0), stand(), 0.2, 0.1).update(state, stand())
    np.testing.assert_array_equal(planner.update(state, stand()).jerk, own.jerk)
