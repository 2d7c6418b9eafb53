"""The estimator slot: from what the sensors say to the state that controller and planner are given."""

from collections.abc import Callable
from typing import Protocol

from surefoot.plugins import Registry
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.types import RobotState


class Estimator(Protocol):
    """A state estimator, asked once per control tick, from tick 0 on.

    Attributes:
        is_truth: whether it hands on the true state, so that the record of the truth needs no kinematics of its own.
    """

    is_truth: bool

    def estimate(self, measurement: Measurement) -> RobotState:
        """The state now.

        Args:
            measurement: of this tick; its arrays are overwritten by the next, and `q` and `v` are the truth, which an
                honest estimator looks at only at tick 0.
        """
        ...


class TrueState:
    """No estimation: the true state. The default.

    Args:
        walk: what is run.
    """

    is_truth = True

    def __init__(self, walk: Walk) -> None:
        """Nothing is needed of the walk."""

    def estimate(self, measurement: Measurement) -> RobotState:
        """See `Estimator`."""
        return RobotState(measurement.q, measurement.v)


EstimatorMaker = Callable[[Walk], Estimator]

ESTIMATORS: Registry[EstimatorMaker] = Registry("surefoot.estimators", None, {"truth": TrueState})
"""What makes an estimator of a walk, by the value of ``sensing.source``."""
