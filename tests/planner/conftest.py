from collections.abc import Callable

import numpy as np
import pytest

from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import PendulumTrace, walk_pendulum
from surefoot.planner.types import FeetState
from surefoot.planner.walk.gait import GaitParameters


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
    duration = planner.schedule.last * planner.parameters.sample_time + 2.0
    options = {"substeps": 3, "duration": duration, "com": com} | options
    return planner, walk_pendulum(planner, stand(gait.step_width), **options)


@pytest.fixture(name="stand", scope="session")
def stand_fixture() -> Callable[..., FeetState]:
    return stand


@pytest.fixture(name="walk", scope="session")
def walk_fixture() -> Callable[..., tuple[WalkingPlanner, PendulumTrace]]:
    return walk


@pytest.fixture(scope="session")
def diagonal() -> tuple[WalkingPlanner, PendulumTrace]:
    return walk(GaitParameters(lateral_step=0.1))
