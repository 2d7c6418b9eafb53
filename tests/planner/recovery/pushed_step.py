"""A step that a push has made a problem, for tests of how it is adjusted."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.recovery.step_problem import StepProblem
from surefoot.planner.references.window import Window


@dataclass(frozen=True, slots=True)
class PushedStep(StepProblem):
    """A step as scheduled, with the body's state and what is known of the window."""

    com: np.ndarray
    dcm: np.ndarray
    window: Window | None = None
