"""Landings of the next footsteps, and ways of swing feet there from where they were measured."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.flight import swinging_to, upcoming
from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.terrain import Box, Site, Terrain, flat
from surefoot.planner.look import look
from surefoot.planner.measured import Measured
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.state import WalkState
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.track import advanced
from surefoot.planner.types import CentroidalState, PhaseKind
from surefoot.planner.walk_model import WalkModel

pytestmark = pytest.mark.unit

GAIT = GaitParameters(
    steps=4, step_length=0.2, single_support=0.4, double_support=0.1, initial_stand=0.1, com_height=0.95
)
LEGS = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0), height=0.85, length=0.94)
STILL = np.zeros((2, 2))
T = 0.02


def swinging(feet, terrain=None, ticks=0, legs=LEGS):
    """State so many ticks after the first foot has left the ground, and what is measured."""
    ground = Ground(terrain or flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    state = WalkState.start(WalkModel.of(GAIT, ground, SmoothHeight(), legs), feet)
    com = np.append(feet.position[:, :2].mean(axis=0), GAIT.com_height)
    measured = Measured(CentroidalState(0.0, com, np.zeros(3)), feet)
    while state.phase.kind is not PhaseKind.SINGLE:
        state = advanced(state, measured)
    for _ in range(ticks):
        state = advanced(state, measured)
    return state, measured


@pytest.mark.parametrize("ticks", [0, 7])
@pytest.mark.parametrize("now", [0.0, 5.0])
def test_footsteps_land_at_the_end_of_their_single_supports(stand, ticks, now):
    state, _ = swinging(stand(GAIT.step_width), ticks=ticks)
    first, *later = (step.touchdown_time for step in upcoming(state, now, STILL))
    assert first == pytest.approx(now + GAIT.single_support - T * ticks)
    np.testing.assert_allclose(np.diff([first, *later]), GAIT.single_support + GAIT.double_support)


@pytest.mark.parametrize("shift", [(0.02, 0.02), (0.02, -0.02), (-0.03, 0.01), (0.0, 0.02), (1e-4, -2e-4)])
def test_a_footstep_that_is_shifted_lands_on_the_ground_that_is_there(stand, shift):
    """But where it is hardly shifted, where the ground is as high to a hair."""
    slope = Slope(0.05, 0.05, 4.0, 1.0).build(Site(np.zeros(2), 0.0, 0.7))
    state, _ = swinging(stand(GAIT.step_width), slope)
    landing, shifted = (upcoming(state, 0.0, np.array([way, (0.0, 0.0)]))[0].position for way in ((0.0, 0.0), shift))
    np.testing.assert_allclose(shifted[:2], landing[:2] + shift)
    assert shifted[2] == pytest.approx(slope.height(*shifted[:2]), abs=1e-9 if np.abs(shift).max() > 1e-3 else 2e-5)
    assert landing[2] > 1e-3


@pytest.mark.parametrize("off", [0.0, 0.002, -0.003])
@pytest.mark.parametrize("height", [0.0, 0.3])
def test_feet_go_astray_by_as_much_as_they_stand_over_the_map(stand, height, off):
    plateau = Terrain((Box(np.array([0.0, 0.0, 0.5 * height]), np.array([9.0, 9.0, 0.5 * height]), np.eye(3)),))
    feet = stand(GAIT.step_width)
    feet = replace(feet, position=np.array([0.0, 0.0, height + off]) + feet.position)
    state, measured = swinging(feet, plateau if height else None)
    swung = swinging_to(state, upcoming(state, 0.0, STILL)[0], measured, False)
    assert swung.astray == pytest.approx(off, abs=1e-9)


@pytest.mark.parametrize("yaw", [0.0, 3.1, -3.1])
@pytest.mark.parametrize("turned", [0.0, 0.1, -0.1])
def test_a_swing_begins_as_its_foot_is_turned_and_takes_the_short_way(stand, yaw, turned):
    feet = stand(GAIT.step_width, yaw=yaw)
    state, measured = swinging(feet)
    landing = upcoming(state, 0.0, STILL)[0]
    measured = replace(measured, feet=replace(feet, yaw=np.arctan2(*(f(feet.yaw + turned) for f in (np.sin, np.cos)))))
    swing = swinging_to(state, landing, measured, False).swing.trajectory
    assert swing.positions(np.array([swing.start_time]))[0, 3] == pytest.approx(yaw + turned)
    assert swing.target[3] == pytest.approx(landing.yaw)


@pytest.mark.parametrize("unsure", [0.0, 0.001])
def test_a_swing_goes_on_until_its_footstep_is_another_one(stand, unsure):
    """Its foot is aimed below footsteps whose height is unsure, wherever they come to be."""
    state, measured = swinging(stand(GAIT.step_width))
    measured = replace(measured, feet=replace(measured.feet, height_deviation=unsure))
    landing = upcoming(state, 0.0, STILL)[0]
    state = swinging_to(state, landing, measured, False)
    begun = state.swing.trajectory
    assert (begun.aim > 0.0) is (unsure > 0.0)
    later = replace(measured, body=replace(measured.body, time=5 * T))
    assert swinging_to(state, landing, later, False).swing.trajectory is begun
    for way in ((0.03, 0.02, 0.0), (-0.02, 0.0, 0.04)):
        elsewhere = replace(landing, position=landing.position + way)
        swing = swinging_to(state, elsewhere, later, False).swing.trajectory
        np.testing.assert_allclose(swing.footstep, elsewhere.position, atol=1e-12)
        assert swing.aim == begun.aim


def heights(stand, lowering):
    """CoM heights, now and a sample later, of a step that lowers the body from its third tick on; and a transition."""
    state, measured = swinging(stand(GAIT.step_width), ticks=2)
    state, found = look(state, measured).state, []
    for tick in range(20):
        state = replace(advanced(state, measured), lowering=lowering * (1.0 + 1e-5 * tick), adapted=lowering > 0.0)
        view = look(state, measured)
        state = view.state
        found.append(view.window.height.height[:, :2].copy())
    return np.array(found), state.memory.transition


def test_a_body_that_is_to_go_lower_gets_there_without_a_jump_and_stays_there(stand):
    """A height that is lower by a hair is the same."""
    (usual, none), (lower, over) = heights(stand, 0.0), heights(stand, 0.04)
    np.testing.assert_allclose(lower[1:, :, 0], lower[:-1, :, 1], atol=1e-6)
    np.testing.assert_allclose(lower[0, 0, 0], usual[0, 0, 0], atol=2e-3)
    np.testing.assert_allclose(usual[-1, 0] - lower[-1, 0], 0.04, atol=1e-5)
    assert none is None and over is None
