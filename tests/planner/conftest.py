from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from pendulum_walk import PendulumTrace, walk_pendulum

from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.types import FeetState, Foot


def stand(width: float = 0.2, origin: tuple[float, float] = (0.0, 0.0), yaw: float = 0.0) -> FeetState:
    side = 0.5 * width * np.array([-np.sin(yaw), np.cos(yaw)])
    position = np.zeros((2, 3))
    position[0, :2], position[1, :2] = origin + side, origin - side
    return FeetState(position, np.full(2, yaw), (True, True))


def walk(
    gait: GaitParameters, foot: tuple[float, float] = (0.075, 0.075), **options: object
) -> tuple[WalkingPlanner, PendulumTrace]:
    planner = WalkingPlanner(gait, stand(gait.step_width), *foot)
    com = np.array([0.0, 0.0, gait.com_height])
    duration = gait.duration + 2.0
    options = {"substeps": 3, "duration": duration, "com": com} | options
    return planner, walk_pendulum(planner, stand(gait.step_width), **options)


def schedule(
    gait: GaitParameters,
    sample_time: float = 0.02,
    after: int = 150,
) -> SimpleNamespace:
    """All steps of a gait in one schedule, and its phases at every sample until some after its end."""
    ground = Ground(flat(), np.array([0.11, 0.055]), PlannerParameters(sample_time=sample_time, reach_length=0.8))
    whole = Schedule.start(gait, stand(gait.step_width), ground).extended(np.inf)
    last = round(whole.phases[-1].start)
    samples = whole.samples(np.arange(last + after, dtype=np.float64))
    on_left = whole.at_supports(np.array([float(step.place.foot is Foot.LEFT) for step in whole.steps]))
    following = on_left[np.minimum(samples.index + 1, len(on_left) - 1)]
    return SimpleNamespace(
        schedule=whole,
        phases=whole.phases,
        samples=samples,
        last=last,
        load_left=(1.0 - samples.fraction) * on_left[samples.index] + samples.fraction * following,
    )


@pytest.fixture(name="schedule", scope="session")
def schedule_fixture() -> Callable[..., SimpleNamespace]:
    return schedule


@pytest.fixture(name="stand", scope="session")
def stand_fixture() -> Callable[..., FeetState]:
    return stand


@pytest.fixture(name="walk", scope="session")
def walk_fixture() -> Callable[..., tuple[WalkingPlanner, PendulumTrace]]:
    return walk


@pytest.fixture(scope="session")
def diagonal() -> tuple[WalkingPlanner, PendulumTrace]:
    return walk(GaitParameters(lateral_step=0.1))
