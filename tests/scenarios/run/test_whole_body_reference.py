"""The reference of the whole-body controller for a plan."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

import surefoot
from surefoot.planner.geometry.orientation import sole_rates, sole_rotation
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.swing.sway import STILL
from surefoot.planner.types import FeetState, PhaseKind, Twist
from surefoot.scenarios.run.reference import planned, whole_body_reference
from surefoot.wbc.reference import LEVEL

pytestmark = pytest.mark.unit


def test_a_foot_is_unloaded_only_before_it_lifts():
    """At the end of a bout both feet stay loaded; before a step it is the foot that steps."""
    stride, closing = Twist(0.2, width=0.2), Twist(width=0.2)
    bouts = (Bout(0.2, (stride, closing)), Bout(0.0, (stride, closing)), Bout(0.4, (stride, closing)))
    gait = GaitParameters(steps=6, bouts=bouts, single_support=0.5, double_support=0.2)
    feet = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
    planner = WalkingPlanner(gait, feet, 0.22, 0.11)
    trace = walk_pendulum(planner, feet, gait.duration, com=np.array([0.0, 0.0, 1.0]), substeps=1)
    assert trace.fall_time is None
    lifting = [whole_body_reference(plan, PlanSampler(plan).sample(plan.time)).lifting_foot for plan in trace.plans]
    for tick, plan in enumerate(trace.plans):
        rest = [later.phase for later in trace.plans[tick:]]
        after = next((b for a, b in pairwise(rest) if b.elapsed < a.elapsed), None)
        steps = plan.phase.kind is PhaseKind.DOUBLE and after is not None and after.kind is PhaseKind.SINGLE
        assert lifting[tick] == (after.stance.other if steps else -1)


@pytest.fixture(
    scope="module", params=[("walk-brisk", 2.4), ("walk-curve", 2.0), ("walk-fast", 2.4)], ids=lambda case: case[0]
)
def plans(request):
    """The plans of a walk; the feet of the fast ones roll, the pelvis sways with those of the fastest."""
    (name, seconds), found = request.param, []
    with surefoot.Simulation(surefoot.load(name, {"fidelity": "pendulum"})) as simulation:
        while simulation.time < seconds:
            plan = simulation.step().plan
            if not found or plan is not found[-1]:
                found.append(plan)
    return found


def test_a_reference_says_what_sample_and_plan_say(plans):
    swung, rolled, swayed = 0, 0, 0
    for plan in [*plans[::3], *scaled(plans[1::6])]:
        sampler = PlanSampler(plan)
        for ahead in (0.0, 0.018, 0.0195, 0.31):
            sample, reference = planned(sampler, plan.time + ahead, plan.time + ahead + 0.001)
            _, until = sampler.tick(plan.time + ahead, plan.time + ahead + 0.001)
            np.testing.assert_array_equal(sample.point, sampler.sample(plan.time + ahead).point)
            for name in ("com", "com_velocity", "com_acceleration", "omega", "stiffness"):
                np.testing.assert_array_equal(getattr(reference, name), getattr(until, name))
            np.testing.assert_array_equal(reference.zmp, until.pendulum_zmp)
            np.testing.assert_allclose(reference.zmp_offset, until.zmp_offset, atol=1e-15)
            for name in ("", "_velocity", "_acceleration"):
                swing = getattr(reference, f"swing{name or '_position'}")
                np.testing.assert_array_equal(swing, getattr(until, f"swing{name}")[:3])
            motion = until.swing[3:], until.swing_velocity[3:], until.swing_acceleration[3:]
            np.testing.assert_array_equal(reference.swing_rotation, sole_rotation(*until.swing[3:]))
            spins = reference.swing_angular_velocity, reference.swing_angular_acceleration
            np.testing.assert_array_equal(spins, sole_rates(*motion))
            assert reference.load_share == (until.load_left, 1.0 - until.load_left)
            assert reference.planned_contact == until.contacts
            passed, phase = until.time - plan.time, plan.phase
            assert reference.time_to_switch == max(0.0, phase.left - passed)
            if until.swing_foot is not None:
                assert reference.swing_progress == min(1.0, (phase.elapsed + passed) / phase.duration)
            yaw, normal = [foot.yaw for foot in plan.footholds], [foot.normal for foot in plan.footholds]
            foot = until.swing_foot
            assert reference.swing_foot == (-1 if foot is None else foot)
            if foot is not None:
                swung += 1
                yaw[foot], normal[foot] = until.swing[3], plan.footsteps[0].normal
            np.testing.assert_array_equal(reference.ground_normal, normal)
            assert reference.heading == 0.5 * sum(yaw)
            assert reference.heading_rate == 0.5 * until.swing_velocity[3]
            edges, pitches = [0, 0], [LEVEL, LEVEL]
            for roll in plan.rolls:
                if roll.rolling(until.time):
                    assert edges[roll.foot] == 0
                    edges[roll.foot], pitches[roll.foot] = roll.edge, roll.evaluate(until.time)
            assert reference.edge == tuple(edges)
            assert reference.roll == tuple(pitches)
            sways = (STILL, STILL) if plan.pelvis is None else (plan.pelvis.yaw, plan.pelvis.roll)
            swayed += plan.pelvis is not None
            for found, sway in zip((reference.pelvis_yaw, reference.pelvis_list), sways, strict=True):
                assert found == sway.evaluate(until.time)
            rolled += edges != [0, 0]
    assert swung
    assert bool(swayed) == any(plan.pelvis is not None for plan in plans)
    assert bool(rolled) == any(plan.rolls for plan in plans)


def scaled(plans):
    """Plans with feet that roll by a clock that goes faster."""
    for plan in plans:
        if plan.rolls:
            scaling = TimeScaling(plan.sample_time, 10.0).scaled(15.0, 12.0)
            yield replace(plan, rolls=tuple(replace(roll, scaling=scaling, shown=plan.time) for roll in plan.rolls))


def test_progress_and_time_to_the_switch_go_on_between_plans_as_the_next_plans_say(plans):
    """A plan says of an instant ahead the same as the plan of that instant, while the phase goes on."""
    compared = 0
    for now, later in pairwise(plans):
        ahead = later.time - now.time
        goes_on = later.phase.kind is now.phase.kind and later.phase.elapsed == pytest.approx(now.phase.elapsed + ahead)
        if not goes_on or later.phase.duration != now.phase.duration:
            continue
        seen = whole_body_reference(now, PlanSampler(now).sample(later.time))
        then = whole_body_reference(later, PlanSampler(later).sample(later.time))
        if seen.swing_foot == then.swing_foot:
            compared += seen.swing_foot >= 0
            assert seen.swing_progress == pytest.approx(then.swing_progress, abs=1e-9)
            assert seen.time_to_switch == pytest.approx(then.time_to_switch, abs=1e-9)
    assert compared > 10
