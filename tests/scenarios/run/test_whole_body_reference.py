"""What the whole-body controller is told of a plan."""

from itertools import pairwise

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.planner.plan import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.types import FeetState, PhaseKind, Twist
from surefoot.scenarios.run.reference import whole_body_reference

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
