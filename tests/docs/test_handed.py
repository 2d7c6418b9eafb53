"""Shapes that the documentation gives for what parts get and give are those of a walk."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.planner import WalkingPlanner
from surefoot.scenarios.run.sensing import TrueState
from surefoot.wbc.tasks.task import Task

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def handing():
    spec = importlib.util.spec_from_file_location("reference", Path(__file__).parents[2] / "docs" / "reference.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.handed


@pytest.fixture(scope="module")
def crossed():
    """Values that pass to parts in a tick, by their class; arguments of a task by name."""
    seen = {}

    def note(*things):
        seen.update({type(thing): thing for thing in things})

    class Law:
        def __init__(self, parameters, height):
            self.inner = PROFILES["default"].law(parameters, height)

        def plan(self, problem):
            motion = self.inner.plan(problem)
            note(problem, problem.reference, problem.steps, motion)
            return motion

    class Planner:
        def __init__(self, *given):
            self.inner = WalkingPlanner(*given)
            self.parameters = self.inner.parameters

        def update(self, state, feet):
            plan = self.inner.update(state, feet)
            note(state, feet, plan)
            return plan

    class Hand:
        name, size, weight = "hand", 2, 1.0

        def __init__(self, model, frames): ...

        def write(self, terms, reference, scale, rows):
            note(terms, reference)
            seen[Task.write] = {"scale": scale, "rows": rows}
            return [0.0, 0.0]

    class Estimator(TrueState):
        def estimate(self, measurement):
            state = super().estimate(measurement)
            note(measurement, state)
            return state

    default = PROFILES["default"]
    profile = Profile("seen", "looks", default.parameters, Law, moves=True, planner=Planner)
    scenario = surefoot.load("walk-level", {"duration": 0.02, "criteria": {"fell": False}})
    with surefoot.Simulation(scenario, planner=profile, estimator=Estimator, tasks=[Hand]) as sim:
        sim.step()
    return seen


def test_shapes_are_those_of_a_walk(handing, crossed):
    plan, terms = (next(t for k, t in crossed.items() if k.__name__ == name) for name in ("WalkPlan", "RobotTerms"))
    window = next(len(t.omega) for k, t in crossed.items() if k.__name__ == "MotionProblem")
    sizes = {"N": len(plan.jerk), "M": window - len(plan.jerk) - 1, "n": window, "size": 2}
    sizes |= {"nq": terms.model.nq, "nv": terms.model.nv, "nj": terms.model.nv - 6}
    checked = 0
    for handed in handing.HANDED:
        thing = crossed[handed.thing]
        for name, meaning in handed.entries():
            found = re.search(handing.SHAPE, meaning)
            value = thing.get(name) if isinstance(thing, dict) else getattr(thing, name, None)
            if found is None or value is None:
                continue
            free = {"v": len(plan.support_polygon) if name == "support_polygon" else len(plan.inner_polygon)}
            told = eval(found[1], {}, {**sizes, **free})
            assert np.shape(value) == told, f"{handed.thing.__qualname__}.{name}"
            checked += 1
    assert checked > 75
