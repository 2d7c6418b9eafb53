"""The pelvis turns and lists with the steps: when, how far, to which side, and not where nobody steps ahead."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.sway import STILL
from surefoot.planner.types import Foot, PhaseKind

pytestmark = pytest.mark.unit

YAW, LIST = 0.08, 0.04
GAIT = GaitParameters(
    steps=6, step_length=0.3, single_support=0.5, double_support=0.16, initial_stand=0.2, com_height=0.95,
    pelvis_yaw=YAW, pelvis_list=LIST,
)  # fmt: skip


@pytest.fixture(scope="module")
def plans(walk):
    """Plans of walks that differ from the gait."""
    kept = {}

    def of(**changes):
        key = tuple(sorted(changes.items()))
        if key not in kept:
            kept[key] = walk(replace(GAIT, **changes), foot=(0.22, 0.11))[1].plans
        return kept[key]

    return of


def angles(plans):
    """Yaw and list with their derivatives as planned at each tick, shape (n, 2, 3)."""
    return np.array([[sway.evaluate(plan.time) for sway in (plan.pelvis.yaw, plan.pelvis.roll)] for plan in plans])


def landings(plans):
    """Ticks at which a foot has just landed, and that foot."""
    for k in range(1, len(plans)):
        if plans[k - 1].phase.kind is PhaseKind.SINGLE and plans[k].phase.kind is not PhaseKind.SINGLE:
            yield k, plans[k - 1].phase.stance.other


def middles(plans):
    """Ticks in the middle of single supports, and the stance foot."""
    for k in range(1, len(plans)):
        half = 0.5 * plans[k].phase.duration
        if plans[k].phase.kind is PhaseKind.SINGLE and plans[k - 1].phase.elapsed < half <= plans[k].phase.elapsed:
            yield k, plans[k].phase.stance


def test_the_hip_of_the_foot_that_lands_is_ahead(plans):
    found = angles(plans())
    landed = list(landings(plans()))
    assert len(landed) == 6
    for k, foot in landed[:-1]:
        assert found[k, 0] == pytest.approx((-foot.side * YAW, 0.0, 0.0), abs=2e-3)
    assert found[landed[-1][0], 0, 0] == pytest.approx(0.0, abs=1e-3)  # beside the other one


def test_the_side_of_the_swing_foot_is_down_in_mid_swing(plans):
    found, half = angles(plans()), list(middles(plans()))
    assert len(half) == 6
    for k, stance in half[:-1]:
        assert found[k, 1, 0] == pytest.approx(stance.side * LIST, abs=1e-3)
        assert abs(found[k, 1, 1]) < 0.05 * np.abs(found[:, 1, 1]).max()


def test_it_is_at_rest_before_and_after(plans):
    found = angles(plans())
    assert not found[:10].any()
    np.testing.assert_allclose(found[-10:], 0.0, atol=1e-12)


def test_neither_angle_nor_rate_nor_acceleration_jumps(plans):
    found, ts = angles(plans()), plans()[0].sample_time
    smooth = found[1:, :, 0] - found[:-1, :, 0] - 0.5 * ts * (found[1:, :, 1] + found[:-1, :, 1])
    assert np.abs(smooth).max() < 1e-4
    step = 0.66
    assert np.abs(np.diff(found[:, :, 2], axis=0)).max() < 60.0 * 2.0 * YAW / step**3 * ts * 1.5
    assert np.abs(found[:, 0, 2]).max() < 1.2 * 5.774 * 2.0 * YAW / step**2


def test_feet_that_change_sides_change_its_side(plans):
    mirrored = angles(plans(first_foot=Foot.RIGHT))
    np.testing.assert_allclose(mirrored, -angles(plans()), atol=1e-9)
    assert np.abs(mirrored).max() > 0.05


@pytest.mark.parametrize("changes", [{"step_length": 0.0}, {"step_length": 0.0, "lateral_step": 0.05}])
def test_it_stays_where_no_foot_lands_ahead(plans, changes):
    np.testing.assert_allclose(angles(plans(**changes)), 0.0, atol=2e-3)


def test_steps_back_turn_it_the_other_way(plans):
    ahead, back = (np.abs(angles(plans(step_length=length)))[:, 0, 0].max() for length in (0.3, -0.3))
    assert back == pytest.approx(ahead, abs=1e-3)
    k, foot = next(landings(plans(step_length=-0.3)))
    assert angles(plans(step_length=-0.3))[k, 0, 0] == pytest.approx(foot.side * YAW, abs=2e-3)


def test_a_gait_without_it_plans_none(plans):
    assert all(plan.pelvis is None for plan in plans(pelvis_yaw=0.0, pelvis_list=0.0))
    assert all(plan.pelvis.roll is STILL for plan in plans(pelvis_list=0.0))
