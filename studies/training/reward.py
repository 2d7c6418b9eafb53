"""The reward that a walk has where nobody gives another one."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.types import Twist
from surefoot.scenarios.run.simulation import Simulation

ASTRAY = 0.25
"""Error of a velocity, squared, at which its share of the reward has come down to 1/e [m^2/s^2, rad^2/s^2]."""


@dataclass(frozen=True, slots=True)
class Transition:
    """Outcome of an action.

    Attributes:
        simulation: that goes on; `Simulation.measurement` and `Simulation.look` tell the true state.
        command: the velocity that was to be followed.
        action: shape (m,).
        fell: whether the robot has fallen, or a fault has ended the run.
    """

    simulation: Simulation
    command: Twist
    action: NDArray[np.float64]
    fell: bool


def upright_and_on_course(step: Transition) -> float:
    """1 for being up, and up to 1 and 1/2 for how well the base follows velocity and rate of the heading [-]."""
    if step.fell:
        return 0.0
    v, asked = step.simulation.measurement.v, step.command
    astray = (v.item(0) - asked.x) ** 2 + (v.item(1) - asked.y) ** 2
    return 1.0 + math.exp(-astray / ASTRAY) + 0.5 * math.exp(-((v.item(5) - asked.yaw) ** 2) / ASTRAY)
