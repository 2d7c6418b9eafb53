from itertools import pairwise

import numpy as np
import pytest

from surefoot.planner.references.com_height import Rise, SmoothHeight, law_height
from surefoot.planner.references.stride_height import StrideHeight
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.types import PhaseKind, Twist

pytestmark = pytest.mark.unit

FINE, LEVEL = 1e-4, np.zeros(9)
STRIDES = (Twist(0.3, width=0.2), Twist(width=0.2))
GAIT = GaitParameters(steps=4, single_support=0.42, double_support=0.12, initial_stand=0.1, apex_ss=0.02)
STOPPING = GaitParameters(
    steps=4,
    single_support=0.42,
    double_support=0.12,
    apex_ss=0.02,
    bouts=(Bout(0.1, STRIDES), Bout(0.3, STRIDES)),
)


@pytest.fixture(scope="session")
def law(schedule):
    """z, z', z'' of a law over a whole walk, shape (3, n), and the plan."""

    def of(profile, gait=GAIT, support=LEVEL, sample_time=FINE):
        plan = schedule(gait, sample_time, 10)
        samples = plan.schedule.samples(np.maximum(np.arange(-1.0, plan.last + 11.0), 0.0))
        return law_height(profile, gait, samples, support), plan

    return of


@pytest.mark.parametrize("gait", [GAIT, STOPPING], ids=["once", "with a stop"])
@pytest.mark.parametrize("profile", [StrideHeight(), StrideHeight(Rise.SINGLE)], ids=str)
def test_it_is_twice_continuously_differentiable(law, profile, gait):
    z, _ = law(profile, gait)
    np.testing.assert_allclose(np.gradient(z[0], FINE)[1:-1], z[1][1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(z[1], FINE)[1:-1], z[2][1:-1], atol=1e-2)
    assert np.abs(np.diff(z[2])).max() < 300.0 * FINE
    assert z[0, 0] == z[0, -1] == pytest.approx(GAIT.com_height)
    assert not z[1:, 0].any()


def test_it_is_lowest_between_the_feet_and_highest_over_one(law):
    z, plan = law(StrideHeight())
    singles = [phase for phase in plan.phases if phase.kind is PhaseKind.SINGLE]
    for phase in singles:
        middle = round(phase.start + 0.5 * phase.samples)
        assert z[0, middle] == pytest.approx(GAIT.com_height + GAIT.apex_ss, abs=1e-6)
    for one, other in pairwise(singles):
        middle = round(0.5 * (one.end + other.start))
        assert z[0, middle] == pytest.approx(GAIT.com_height, abs=1e-6)


def test_it_takes_less_than_half_of_the_acceleration_of_a_bump_in_each_phase(law):
    """A (2 π / T)² / 2 over the step T, against 3 A (π / T_ss)² at the apex of A sin³."""
    period = GAIT.single_support + GAIT.double_support
    wave, bump = (np.abs(law(profile)[0][2]) for profile in (StrideHeight(), SmoothHeight()))
    middle = slice(len(wave) // 3, 2 * len(wave) // 3)
    assert wave[middle].max() == pytest.approx(0.5 * GAIT.apex_ss * (2.0 * np.pi / period) ** 2, rel=1e-3)
    assert wave[middle].max() < 0.42 * bump[middle].max()


def test_a_step_of_another_duration_is_joined_smoothly(law, schedule):
    """The rate of the wave where phases change is the gait's, whatever they last."""
    slower = GaitParameters(steps=4, single_support=0.6, double_support=0.2, initial_stand=0.1, apex_ss=0.02)
    plan = schedule(slower, FINE, 10)
    samples = plan.schedule.samples(np.maximum(np.arange(-1.0, plan.last + 11.0), 0.0))
    z = law_height(StrideHeight(), GAIT, samples, np.zeros(9))
    np.testing.assert_allclose(np.gradient(z[1], FINE)[1:-1], z[2][1:-1], atol=1e-2)
    assert np.abs(np.diff(z[2])).max() < 300.0 * FINE


def test_it_climbs_as_the_other_laws_do(law):
    up = np.array([0.0, 0.0, 0.1, 0.2, 0.25, 0.25, 0.25, 0.25, 0.25])
    climbing, level = law(StrideHeight(Rise.SINGLE), support=up)[0], law(StrideHeight(Rise.SINGLE))[0]
    still = GaitParameters(
        steps=4, single_support=0.42, double_support=0.12, initial_stand=0.1, apex_ss=0.0, apex_ds=0.0
    )
    stairs = law(SmoothHeight(Rise.SINGLE), still, up)[0] - law(SmoothHeight(Rise.SINGLE), still)[0]
    np.testing.assert_allclose(climbing - level, stairs, atol=1e-9)
