from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.plan.sample import PLACES, POINT, PlanSample, in_point
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit


@pytest.fixture(params=[20, 130, 180])
def plan(request, diagonal):
    return diagonal[1].plans[request.param]


def test_samples_are_the_plans_own(plan):
    sampler = PlanSampler(plan)
    for k in (0, 1, 7, 50):
        sample = sampler.sample(plan.time + k * plan.sample_time)
        np.testing.assert_allclose(sample.com, plan.com[k], atol=1e-12)
        np.testing.assert_allclose(sample.com_velocity, plan.com_velocity[k], atol=1e-12)
        np.testing.assert_allclose(sample.com_acceleration, plan.com_acceleration[k], atol=1e-9)
        np.testing.assert_allclose(sample.zmp, plan.zmp[k], atol=1e-9)
        np.testing.assert_allclose(sample.zmp_reference, plan.zmp_reference[k], atol=1e-12)
        assert sample.load_left == pytest.approx(plan.load_left[k])
        assert sample.stiffness == pytest.approx(plan.stiffness[k])
        assert sample.omega == pytest.approx(plan.omega[k])


def test_derivatives_within_and_across_samples(plan):
    sampler, step = PlanSampler(plan), 1e-4
    samples = [sampler.sample(plan.time + 0.01 + step * i) for i in range(400)]
    for value, rate, tolerance in (("com", "com_velocity", 1e-6), ("com_velocity", "com_acceleration", 4e-3)):
        values = np.array([getattr(s, value) for s in samples])
        rates = np.array([getattr(s, rate) for s in samples])
        np.testing.assert_allclose(np.gradient(values, step, axis=0)[1:-1], rates[1:-1], atol=tolerance)


@pytest.mark.parametrize("number", [130, 180])
def test_who_does_over_each_tick_what_the_middle_says_stays_on_the_plan(diagonal, number):
    """CoM and swing foot, with the acceleration of the middle held over each of 5 ticks of 2 ms."""
    plan, h = diagonal[1].plans[number], 0.002
    sampler = PlanSampler(plan)
    state = None
    for i in range(6):
        now, asked = sampler.tick(plan.time + h * i, plan.time + h * (i + 0.5))
        for k, (value, rate, bend) in enumerate(
            (("com", "com_velocity", "com_acceleration"), ("swing", "swing_velocity", "swing_acceleration"))
        ):
            state = state or [[now.com, now.com_velocity], [now.swing, now.swing_velocity]]
            position, velocity = state[k]
            np.testing.assert_allclose(position, getattr(asked, value), atol=2e-7)
            np.testing.assert_allclose(velocity, getattr(asked, rate), atol=2e-5)
            a = getattr(asked, bend)
            state[k] = [position + h * velocity + 0.5 * h**2 * a, velocity + h * a]


def test_a_tick_has_the_state_of_its_begin_and_all_else_of_its_middle(plan):
    sampler, begin, middle = PlanSampler(plan), plan.time + 0.004, plan.time + 0.013
    (now, until), late = sampler.tick(begin, middle), sampler.sample(middle)
    np.testing.assert_array_equal(now.point, sampler.sample(begin).point)
    assert (until.time, until.contacts, until.swing_foot) == (middle, late.contacts, late.swing_foot)
    for name in ("com", "swing"):
        np.testing.assert_array_equal(getattr(until, name), getattr(now, name))
        np.testing.assert_array_equal(getattr(until, f"{name}_velocity"), getattr(now, f"{name}_velocity"))
        np.testing.assert_array_equal(getattr(until, f"{name}_acceleration"), getattr(late, f"{name}_acceleration"))
    for name in ("zmp", "zmp_offset", "pendulum_zmp", "zmp_reference", "dcm", "omega", "stiffness", "load_left"):
        np.testing.assert_array_equal(getattr(until, name), getattr(late, name))


def test_a_swing_that_ends_within_a_tick_is_done_as_in_its_middle(diagonal):
    plan = next(p for p in diagonal[1].plans if p.swing is not None and p.phase.left < 0.9)
    sampler = PlanSampler(plan)
    landed = int(np.argmax(plan.contacts.all(axis=1)))
    edge = plan.time + landed * plan.sample_time
    now, until = sampler.tick(edge - 1e-3, edge + 1e-3)
    assert now.swing_foot is not None and until.swing_foot is None
    np.testing.assert_array_equal(until.point, sampler.sample(edge + 1e-3).point)


def test_samples_are_fresh_at_every_call(plan):
    sampler = PlanSampler(plan)
    first = sampler.sample(plan.time)
    kept = first.point.copy()
    sampler.tick(plan.time + 0.01, plan.time + 0.011)
    np.testing.assert_array_equal(first.point, kept)


def test_plans_of_other_numbers_are_sampled_as_those_of_ours(plan):
    single = replace(plan, load_left=np.ones(51, dtype=np.int64), jerk=plan.jerk.astype(np.float32))
    sample, other = PlanSampler(single).sample(plan.time + 0.01), PlanSampler(plan).sample(plan.time + 0.01)
    assert sample.load_left == 1.0
    np.testing.assert_allclose(sample.com, other.com, atol=1e-9)


def test_quantities_fill_the_point_of_a_sample():
    places = [in_point(name) for name in vars(PlanSample) if name in PLACES]
    assert sorted(index for place in places for index in range(POINT)[place]) == list(range(POINT))


def test_zmp_and_dcm_fit_the_motion(plan):
    sample = PlanSampler(plan).sample(plan.time + 0.033)
    np.testing.assert_allclose(
        sample.stiffness * (sample.com[:2] - sample.zmp), sample.com_acceleration[:2], atol=1e-12
    )
    np.testing.assert_allclose(sample.omega * (sample.dcm - sample.com[:2]), sample.com_velocity[:2], atol=1e-12)


def test_after_the_horizon_the_last_sample_is_held(plan):
    sampler = PlanSampler(plan)
    np.testing.assert_array_equal(sampler.sample(plan.time + 1.5).com, sampler.sample(plan.time + 9.0).com)


def test_swing_is_there_only_in_single_support(diagonal):
    for plan in diagonal[1].plans[::25]:
        sample = PlanSampler(plan).sample(plan.time)
        single = plan.phase.kind is PhaseKind.SINGLE
        assert (sample.swing_foot is not None) == single == (not all(sample.contacts))
        if single:
            assert sample.swing_foot is plan.phase.stance.other
            expected = plan.swing.evaluate(plan.time)
            np.testing.assert_allclose([sample.swing, sample.swing_velocity, sample.swing_acceleration], expected)


@pytest.mark.parametrize("single", [0.506, 0.513])
def test_a_swing_is_its_own_also_where_it_touches_down_between_samples(walk, single):
    """Going on with the descent would accelerate, by up to several m/s^2, a foot that is to press gently."""
    plans = walk(GaitParameters(steps=3, single_support=single, double_support=0.2))[1].plans
    touching = [p for p in plans if p.swing is not None and 0.0 < p.swing.touchdown_time - p.time < p.sample_time]
    assert touching
    for plan in touching:
        sampler, touchdown = PlanSampler(plan), plan.swing.touchdown_time
        assert 0.1 * plan.sample_time < touchdown - plan.time < 0.99 * plan.sample_time
        for time in (touchdown - 1e-4, touchdown, 0.5 * (touchdown + plan.time + plan.sample_time), touchdown - 2e-4):
            sample = sampler.sample(time)
            flown = [sample.swing, sample.swing_velocity, sample.swing_acceleration]
            np.testing.assert_allclose(flown, plan.swing.evaluate(time), atol=1e-9)


def test_a_foot_is_planned_to_bear_load_from_the_end_of_its_single_support_on(walk):
    """Phases end at any time; the ZMP that moves on must not wait for the next plan to find a foot that bears it."""
    plans = walk(GaitParameters(steps=3, single_support=0.513, double_support=0.2))[1].plans
    ending = [p for p in plans if p.phase.kind is PhaseKind.SINGLE and p.phase.left < 0.9 * p.sample_time]
    assert ending
    for plan in ending:
        sampler, end = PlanSampler(plan), plan.time + plan.phase.left
        assert sum(sampler.sample(end - 1e-4).contacts) == 1
        assert sampler.sample(end).contacts == (True, True)
        assert sampler.sample(end + 1e-4).swing_foot is plan.swing.foot


def test_at_an_instant_of_a_sample_its_own_contacts_hold(plan):
    """To rounding of the time, but for a foot that lands within the first one."""
    sampler, T = PlanSampler(plan), plan.sample_time
    for k in range(1, len(plan.contacts) - 1):
        for off in (-1e-12, 0.0, 1e-12):
            assert sampler.sample(plan.time + k * T + off).contacts == tuple(plan.contacts[k].tolist())
    assert plan.time < 1.0 or len(np.unique(plan.contacts, axis=0)) > 1
