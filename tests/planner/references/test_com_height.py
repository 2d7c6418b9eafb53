import numpy as np
import pytest

from surefoot.planner.check import check_height
from surefoot.planner.references.com_height import (
    BENT_KNEES,
    BentKneeHeight,
    PaperHeight,
    Rise,
    SmoothHeight,
    law_height,
    preview_height,
)
from surefoot.planner.references.height_transition import HeightTransition
from surefoot.planner.references.stride_height import StrideHeight
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.types import GRAVITY, PhaseKind, Twist

pytestmark = pytest.mark.unit

FINE = 1e-4
UP = np.array([0.0, 0.0, 0.1, 0.2, 0.25])
DOWN = np.array([0.25, 0.25, 0.15, 0.05, 0.0])
GAIT = GaitParameters(steps=3, single_support=0.6, double_support=0.3, initial_stand=0.1)
SMOOTH = [SmoothHeight(), SmoothHeight(Rise.SINGLE), BentKneeHeight(), BentKneeHeight(Rise.SINGLE)]


@pytest.fixture(scope="session")
def preview(schedule):
    def of(profile, support=UP, sample_time=FINE, gait=GAIT):
        plan = schedule(gait, sample_time, 10)
        samples = plan.schedule.samples(np.maximum(np.arange(-1.0, plan.last + 11.0), 0.0))
        index = samples.index[1:-1]
        ground = support[index] + samples.fraction[1:-1] * np.append(np.diff(support), 0.0)[index]
        height = law_height(profile, gait, samples, support)
        return preview_height(profile, height, ground), ground, plan

    return of


@pytest.mark.parametrize("support", [UP, DOWN], ids=["up", "down"])
@pytest.mark.parametrize("profile", SMOOTH, ids=str)
def test_smooth_heights_are_twice_continuously_differentiable(preview, profile, support):
    z = preview(profile, support)[0].height
    np.testing.assert_allclose(np.gradient(z[0], FINE)[1:-1], z[1][1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(z[1], FINE)[1:-1], z[2][1:-1], atol=1e-2)
    assert np.abs(np.diff(z[0])).max() < 2.0 * FINE
    assert np.abs(np.diff(z[1])).max() < 10.0 * FINE
    assert np.abs(np.diff(z[2])).max() < 300.0 * FINE


@pytest.mark.parametrize("support", [UP, DOWN], ids=["up", "down"])
@pytest.mark.parametrize("profile", [*SMOOTH, PaperHeight()], ids=str)
def test_heights_start_and_end_at_com_height_over_the_support(preview, profile, support):
    z = preview(profile, support)[0].height[0]
    height = GAIT.com_height - (BENT_KNEES if isinstance(profile, BentKneeHeight) else 0.0)
    assert z[0] == pytest.approx(height + support[0])
    # In single support the level of the last double support is that of its lower foot.
    last = min(support[-2:]) if getattr(profile, "rise", Rise.DOUBLE) is Rise.SINGLE else support[-1]
    assert z[-1] == pytest.approx(height + last)


@pytest.mark.parametrize("profile", [SmoothHeight(), PaperHeight()], ids=str)
def test_apex_of_the_first_single_support(preview, profile):
    height = preview(profile)[0].height[0]
    assert height[round((0.1 + 0.6 + 0.3) / FINE)] == pytest.approx(GAIT.com_height + GAIT.apex_ss)


@pytest.mark.parametrize("support", [UP, DOWN], ids=["up", "down"])
def test_in_single_support_rises_a_double_support_is_level_with_its_lower_foot(preview, support):
    shown, _, plan = preview(BentKneeHeight(Rise.SINGLE), support)
    for phase in plan.phases:
        if phase.kind is PhaseKind.DOUBLE:
            lower = min(support[phase.step : phase.step + 2])
            over = shown.height[0, round(phase.start) : round(phase.end)] - lower
            np.testing.assert_allclose(over, GAIT.com_height - BENT_KNEES, atol=1e-12)


def test_bent_knees_keep_a_constant_height(preview):
    z = preview(BentKneeHeight(), np.zeros(5))[0].height
    np.testing.assert_allclose(z[0], GAIT.com_height - BENT_KNEES)
    assert not z[1:].any()


def test_paper_height_is_the_printed_equation(preview):
    shown, _, plan = preview(PaperHeight(), sample_time=0.02)
    z, start, t = shown.height[0], 0.0, 0.02
    for phase in plan.phases[:-1]:
        count = round(phase.samples)
        local, seconds = t * np.arange(count), t * count
        expected = np.full(count, GAIT.com_height + UP[max(phase.step, 0)])
        if phase.kind is PhaseKind.SINGLE:
            expected += GAIT.apex_ss * np.sin(np.pi / seconds * local)
        if phase.kind is PhaseKind.DOUBLE and phase.step:
            expected += GAIT.apex_ds * np.sin(np.pi / seconds * local)
            expected += (UP[phase.step + 1] - UP[phase.step]) / seconds * local
        if phase.step:
            np.testing.assert_allclose(z[round(phase.start) : round(phase.end)], expected, atol=1e-12)
        start += seconds


def test_paper_height_is_continuous_and_its_velocity_jumps_as_the_errata_say(preview):
    """Errata 17: steps of 0.1 m in 0.5 s at 50 Hz give impulses of -8.2 and +11.8 m/s^2, λ from 1.65 to 21.65."""
    gait = GaitParameters(steps=4)
    support = np.array([0.0, 0.0, 0.1, 0.2, 0.3, 0.3])
    shown = preview(PaperHeight(), support, 0.02, gait)[0]
    z = shown.height
    np.testing.assert_allclose(np.diff(z[0], 2) / 0.02**2, z[2, 1:-1], atol=1e-9)
    np.testing.assert_allclose((z[0, 2:] - z[0, :-2]) / 0.04, z[1, 1:-1], atol=1e-9)
    assert z[2].min() == pytest.approx(-8.2, abs=0.1)
    assert z[2].max() == pytest.approx(11.8, abs=0.1)
    assert shown.stiffness.min() == pytest.approx(1.65, abs=0.1)
    fine = preview(PaperHeight(), support, 0.001, gait)[0].height
    assert np.abs(np.diff(fine[0])).max() < 1e-3
    assert fine[2].max() > 5.0 * z[2].max()


@pytest.mark.parametrize("profile", [*SMOOTH, PaperHeight()], ids=str)
@pytest.mark.parametrize("riser", [-0.18, 0.18])
def test_stiffness_stays_positive(preview, profile, riser):
    support = max(0.0, -4 * riser) + riser * np.array([0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0])
    shown = preview(profile, support, 0.02, GaitParameters(steps=5))[0]
    assert shown.stiffness.min() > 0.0


def test_stiffness_counts_the_height_above_the_zmp(preview):
    shown, ground, _ = preview(SmoothHeight())
    np.testing.assert_allclose(shown.stiffness * (shown.height[0] - ground), GRAVITY + shown.height[2], rtol=1e-12)


class Own:
    """A law of one's own, in whole numbers or too short."""

    rise, impulsive = Rise.DOUBLE, False

    def __init__(self, missing):
        self.missing = missing

    def standing(self, gait):
        return 1.0

    def height(self, gait, samples, support_height):
        return np.ones((3, len(samples.clock) - self.missing), dtype=int)


def test_a_law_of_ones_own_may_tell_whole_numbers_but_not_fewer_than_there_are_samples(preview):
    shown = preview(Own(0), np.zeros(5))[0]
    np.testing.assert_allclose(shown.stiffness, GRAVITY + 1.0)
    with pytest.raises(ValueError, match="shape"):
        preview(Own(3), np.zeros(5))


@pytest.mark.parametrize(
    ("rise", "name", "riser"), [(Rise.DOUBLE, "double_support", 0.2), (Rise.SINGLE, "single_support", 0.3)]
)
def test_a_step_too_high_for_its_support_is_refused(schedule, rise, name, riser):
    gait = GaitParameters(steps=2, single_support=0.36, double_support=0.3)
    samples, profile = schedule(gait).samples, SmoothHeight(rise)
    check_height(profile, gait, samples, np.array([0.0, 0.0, 0.05, 0.05]))
    with pytest.raises(ValueError, match=r"falls off with 1\d\.\d m/s\^2.*; 7\.8 m/s\^2 is the most") as refused:
        check_height(profile, gait, samples, np.array([0.0, 0.0, riser, riser]))
    assert refused.value.key == ("gait", name)


@pytest.mark.parametrize("place", list(Rise))
def test_a_stop_on_a_tread_leaves_the_level_alone(schedule, place):
    """Up two treads, closing the stance on the second, and on after a stop: the height is smooth and ends on top."""
    stride, closing = Twist(0.2, width=0.2), Twist(width=0.2)
    gait = GaitParameters(steps=5, bouts=(Bout(1.0, (stride, stride, closing)), Bout(1.0, (stride, closing))))
    plan = schedule(gait)
    feet = np.array([0.0, 0.0, 0.1, 0.2, 0.2, 0.3, 0.3])
    supports = feet[plan.schedule.supports].mean(axis=1)
    height = SmoothHeight(place).height(gait, plan.samples, supports)
    assert np.abs(np.diff(height[0])).max() < 0.02 * 0.4
    assert np.abs(np.diff(height[1])).max() < 0.02 * 5.0
    for phase in plan.phases:
        if phase.kind is PhaseKind.STAND and phase.step:
            level = feet[phase.step + 1]
            np.testing.assert_allclose(height[0, round(phase.start)], gait.com_height + level, atol=1e-12)


@pytest.mark.parametrize("left", [1.0, 8.4, 30.0])
@pytest.mark.parametrize(("rise", "speed"), [(0.0, 0.0), (0.03, -0.1), (-0.02, 0.15)])
def test_a_bridge_goes_smoothly_from_a_state_to_its_law(preview, rise, speed, left):
    """Once the phase ends, or as soon after it as the body is not accelerated too hard."""
    t = 0.01
    law = preview(SmoothHeight(), sample_time=t)[0].height[:, 20:]
    state = law[:, 0] + (rise, speed, 0.0)
    bridge = HeightTransition.onto(law, state, 7, left, t, 5.0)
    height = bridge.over(law, 7)
    np.testing.assert_allclose(height[:, 0], state, atol=1e-12)
    np.testing.assert_array_equal(height[:, bridge.samples :], law[:, bridge.samples :])
    assert bridge.samples >= left
    assert np.abs(height[2, : bridge.samples]).max() <= max(5.0, abs(state[2])) + 1e-9
    np.testing.assert_allclose(np.gradient(height[0], t)[1:-1], height[1, 1:-1], atol=0.02)
    np.testing.assert_allclose(np.gradient(height[1], t)[1:-1], height[2, 1:-1], atol=1.0)
    # At a later tick it is what it was to be then.
    np.testing.assert_allclose(bridge.over(law[:, 1:], 8), height[:, 1:], atol=1e-12)


@pytest.mark.parametrize("profile", [*SMOOTH, StrideHeight()], ids=str)
def test_a_clock_that_changes_its_rate_changes_the_derivatives(schedule, profile):
    """z(c(t)), of a clock c that goes faster and slower, has derivatives by time."""
    whole = schedule(GAIT, FINE, 10).schedule
    n = np.arange(0.0, 20000.0)
    clock = n + 900.0 * np.sin(n / 3000.0)
    rate, bend = 1.0 + 0.3 * np.cos(n / 3000.0), -0.0001 * np.sin(n / 3000.0) / FINE
    z = law_height(profile, GAIT, whole.samples(clock, (rate, bend)), UP)
    np.testing.assert_allclose(np.gradient(z[0], FINE)[1:-1], z[1][1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(z[1], FINE)[1:-1], z[2][1:-1], atol=2e-2)
    np.testing.assert_allclose(z[0], law_height(profile, GAIT, whole.samples(clock), UP)[0], atol=1e-12)


@pytest.mark.parametrize("off", [0.0, 0.01, -0.03])
@pytest.mark.parametrize(("left", "samples"), [(30.0, 30), (30.0 + 1e-10, 30), (30.2, 31)])
def test_a_transition_ends_with_its_phase_to_rounding(left, samples, off):
    """Though it would be calmer if it ended later."""
    law = np.zeros((3, 200))
    assert HeightTransition.onto(law, np.array([off, 0.0, 0.0]), 0, left, 0.01, 5.0).samples == samples


def test_a_transition_from_a_state_that_is_accelerated_harder_ends_as_soon():
    """An acceleration that is there is no fault of the transition: it bounds it."""
    law = np.zeros((3, 200))
    usual, harder = (
        HeightTransition.onto(law, np.array([0.0, 0.0, bend]), 0, 10.0, 0.01, 5.0).samples for bend in (4.999, 5.001)
    )
    assert abs(usual - harder) <= 1 and harder < 150
