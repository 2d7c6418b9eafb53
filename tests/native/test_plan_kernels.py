"""Samples and whole-body references of plans: kernels against plain Python, at every tick of real walks."""

from dataclasses import fields, replace

import numpy as np
import pytest

import surefoot
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.plan import PlanSample, PlanSampler
from surefoot.planner.plan_kernel import PlanKernel
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.types import Foot
from surefoot.scenarios.run.reference import ReferenceMaker, whole_body_reference
from surefoot.wbc.types import WbcReference

pytestmark = pytest.mark.unit

OWN = ("point", "numbers")
"""What only kernels give."""


def assert_alike(one, other, kind):
    for field in fields(kind):
        if field.name in OWN:
            continue
        a, b = (getattr(value, field.name) for value in (one, other))
        if a is None or b is None:
            assert a is b, field.name
            continue
        np.testing.assert_allclose(
            np.asarray(b, dtype=float), np.asarray(a, dtype=float), rtol=1e-11, atol=1e-11, err_msg=field.name
        )


@pytest.fixture(scope="module", params=[("walk-fast", 2.4), ("walk-curve", 2.0)], ids=lambda case: case[0])
def plans(request):
    """The plans of a walk; the feet of the fast one roll."""
    name, seconds = request.param
    found = []
    with surefoot.Simulation(surefoot.load(name, {"fidelity": "pendulum"})) as simulation:
        while simulation.time < seconds:
            plan = simulation.step().plan
            if not found or plan is not found[-1]:
                found.append(plan)
    return found


def test_samples_and_references_are_those_of_plain_python(kernels, plans):
    kernel = PlanKernel(kernels)
    maker, rolled = ReferenceMaker(kernel), 0
    for plan in [*plans[::3], *_scaled(plans[1::6])]:
        plain, compiled = PlanSampler(plan), PlanSampler(plan, kernel)
        for ahead in (0.0, 0.004, 0.018, 0.0195, 0.02, 0.31, 10.0):
            times = plan.time + ahead, plan.time + ahead + 0.001
            now, until = plain.tick(*times)
            for one, other in zip((now, until), compiled.tick(*times), strict=True):
                assert_alike(one, other, PlanSample)
            sample, reference = maker.tick(compiled, *times)
            assert_alike(now, sample, PlanSample)
            assert_alike(whole_body_reference(plan, until), reference, WbcReference)
            assert_alike(now, compiled.sample(times[0]), PlanSample)
            if reference.numbers is not None:
                assert (*reference.numbers[-2:],) == (reference.rolling_foot, reference.catching)
                rolled += reference.rolling_foot >= 0
    assert bool(rolled) == any(plan.roll is not None for plan in plans)


def _scaled(plans):
    """Plans with feet that roll by a clock that goes faster."""
    for plan in plans:
        if plan.roll is not None:
            scaling = TimeScaling(plan.sample_time, 10.0).scaled(15.0, 12.0)
            yield replace(plan, roll=replace(plan.roll, scaling=scaling, told=plan.time))


def test_samples_are_fresh_at_every_call(kernels, plans):
    sampler = PlanSampler(plans[1], PlanKernel(kernels))
    first = sampler.sample(plans[1].time)
    kept = first.com.copy()
    sampler.tick(plans[1].time + 0.01, plans[1].time + 0.011)
    np.testing.assert_array_equal(first.com, kept)


def test_a_reference_that_is_changed_does_not_keep_the_numbers_of_the_old_one(kernels, plans):
    plan = plans[1]
    kernel = PlanKernel(kernels)
    sample, reference = ReferenceMaker(kernel).tick(PlanSampler(plan, kernel), plan.time, plan.time + 0.001)
    assert reference.numbers is not None
    assert replace(reference, heading=1.0).numbers is None
    assert replace(sample, omega=1.0).point is None


def test_what_is_no_kernel_without_numbers_is_called_by_python(kernels):
    arrays = [(np.arange(6.0), np.arange(6.0) + k, np.zeros(3), np.zeros(3)) for k in range(2)]
    done = []
    names = "level", "rates", "position", "velocity"
    takes_numbers = kernels.bind("roll_centre", **dict(zip(names, arrays[0], strict=True)))
    kernels.sequence([lambda: done.append(1), lambda: takes_numbers(0.1, 0.2, 0.3)])()
    assert done == [1]
    assert arrays[0][2].any()


def test_a_rolled_sole_is_where_plain_python_has_it(kernels):
    rng, level, rates, position, velocity = np.random.default_rng(3), np.zeros(6), np.zeros(6), np.zeros(3), np.zeros(3)
    run = kernels.bind("roll_centre", level=level, rates=rates, position=position, velocity=velocity)
    for _ in range(50):
        roll = FootRoll(Foot.LEFT, 0.0, 1.0, rng.uniform(0.1, 0.6), 0.1)
        level[:], rates[:], time = rng.normal(size=6), rng.normal(size=6), rng.uniform(0.05, 0.95)
        pitch, rate, _ = roll.evaluate(time)
        run(roll.toe, pitch, rate)
        for found, right in zip((position, velocity), roll.centre(time, level, rates), strict=True):
            np.testing.assert_allclose(found, right, rtol=1e-11, atol=1e-11)
