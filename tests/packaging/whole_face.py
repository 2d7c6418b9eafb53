"""A program that uses the whole face, to be read by a type checker; `test_types` makes a wrong one of it."""

from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import surefoot
from surefoot.planner import (
    CentroidalState,
    FeetState,
    Motion,
    MotionProblem,
    Planner,
    PlannerParameters,
    Profile,
    WalkingPlanner,
    WalkPlan,
)
from surefoot.planner.laws.footstep_tvmpc import FootstepTvmpc
from surefoot.scenarios.judge.metric import RunView, metric
from surefoot.scenarios.judge.metrics import register
from surefoot.scenarios.setup.terrain import KINDS, TerrainKind
from surefoot.sim import Measurement
from surefoot.wbc import BodyFrames, RobotState, RobotTerms, WbcReference, WholeBodyController
from surefoot.wbc.tasks import TASKS, Task

Array = NDArray[np.float64]


class Law:
    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self.horizon = parameters.horizon

    def plan(self, problem: MotionProblem) -> Motion:
        return Motion(np.zeros((self.horizon, 2)), np.zeros((2, 2)), np.zeros(2), np.zeros(2))


class Whole:
    def __init__(self, inner: WalkingPlanner) -> None:
        self.parameters = inner.parameters
        self._inner = inner

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        return self._inner.update(state, feet)


class Hand:
    name, size, weight = "hand", 3, 1.0

    def __init__(self, model: pin.Model, frames: BodyFrames) -> None:
        self.nv: int = model.nv

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> list[float]:
        rows[:, : self.nv] = scale
        return [0.0, 0.0, reference.heading]


class Believing:
    is_truth = True

    def __init__(self, walk: surefoot.Walk) -> None: ...

    def estimate(self, measurement: Measurement) -> RobotState:
        return RobotState(measurement.q, measurement.v)


class Still:
    def __init__(self, walk: surefoot.Walk) -> None: ...

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        self.q = q

    def measure(self) -> Measurement:
        return Measurement.of_state(0.0, self.q, np.zeros(len(self.q) - 1))

    def act(self, command: surefoot.JointCommand, period: float) -> None: ...


@metric(unit="m", reads={"/truth": ("com",)})
def sway(run: RunView) -> float:
    """Standard deviation of the CoM's lateral position [m]."""
    return float(np.std(run.field("/truth", "com")[:, 1]))


def whole(inner: WalkingPlanner) -> Planner:
    return Whole(inner)


def hand(model: pin.Model, frames: BodyFrames) -> Task:
    return Hand(model, frames)


profile = Profile("mine", "of one's own", PlannerParameters(), Law, moves=False)
ours: Profile = Profile("ours", "", PlannerParameters(), FootstepTvmpc, moves=True)
register(sway)
KINDS.add("mine", TerrainKind())
TASKS.add("hand", Hand)
kind: TerrainKind = KINDS["mine"]
scenario = surefoot.load("walk", {"gait.steps": 4})
steps: int = scenario.gait.steps
parts = surefoot.Parts(tasks=(hand,), estimator=Believing, plant=Still)
result = surefoot.run(scenario, seed=1, out="runs", planner=profile, parts=parts)
passed: bool = result.verdict.passed
path: Path = result.log
com: Array = surefoot.read(path)["/truth"].field("com")
sim = surefoot.Simulation(
    scenario,
    planner=profile,
    controller=WholeBodyController,
    estimator=Believing,
    tasks=[Hand],
    plant=Still,
)
tick: surefoot.Tick = sim.step()
where: float = tick.time + float(tick.com[0])
height: float = tick.reference.com[2]
phase: int = tick.plan.phase.step
torque: Array | None = tick.report.torque if tick.report is not None else None
q: Array | None = None if tick.state is None else tick.state.q
sim.push((10.0, 0.0, 0.0), duration=0.1)
fell: bool = sim.fell
verdict: surefoot.Verdict = surefoot.judge(surefoot.read(path))
