"""The exchange with an estimator of either kind, and the part of its estimate for controller and planner."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.parts.guard import Guard, MisfitError
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.readings import Readings
from surefoot.scenarios.setup.parts import ESTIMATE, guarded
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Deviation, Estimate, Planned
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import NONE_TOUCHES, Array, FootSensing, WbcReport

if TYPE_CHECKING:
    from surefoot.wbc.estimation.torques import TorqueWrench


class Senses:
    """An estimator of either kind, asked the same way: one that is given the measurement, or one that senses.

    Args:
        estimator: made of the walk, not yet behind its guard.
        guard: of its package.

    Attributes:
        is_truth: whether it hands on the true state.
        reads: whether it is given what sensors say, in place of the measurement.
        listens: whether it wants to know what was decided; see `feed_back`.

    Raises:
        MisfitError: it is of neither kind.
    """

    def __init__(self, estimator: Any, guard: Guard) -> None:
        self.reads, hears = callable(getattr(estimator, "sense", None)), callable(getattr(estimator, "told", None))
        if not self.reads and not callable(getattr(estimator, "estimate", None)):
            raise MisfitError("has neither a method sense nor a method estimate")
        part = guarded(estimator, guard, ESTIMATE)
        self.is_truth = not self.reads and bool(part.is_truth)
        if self.reads:
            self._sense = part.sense
        else:
            self._estimate = part.estimate
        self._last: Estimate | None = None
        self._feed: Callable[[Planned], None] | None = part.told if self.reads and hears else None
        self.listens = self._feed is not None

    def __call__(self, readings: Readings | Measurement) -> Estimate:
        """The estimate of a tick, with the wrenches of the sensors where the estimator has none of its own.

        Raises:
            ParameterError: it is given what an estimator of the other kind needs.
        """
        if self.reads != isinstance(readings, Readings):
            wanted = "what sensors say, as surefoot.Readings" if self.reads else "the state, as surefoot.Measurement"
            raise ParameterError(("readings",), f"a {type(readings).__name__} for this estimator", f"give {wanted}")
        if isinstance(readings, Measurement):
            state, wrench, last = self._estimate(readings), readings.wrench, self._last
            if isinstance(state, Estimate):
                # Of an estimator that says more than the state.
                return state if state.wrench is not None else replace(state, wrench=wrench)
            # A world that measures into the same arrays, and a state of these, make the same estimate.
            if last is None or last.state is not state or last.wrench is not wrench:
                self._last = last = Estimate(state, wrench)
            return last
        estimate: Estimate = self._sense(readings)
        felt = readings.wrench
        if estimate.wrench is not None or felt is None:
            return estimate
        return replace(estimate, wrench=felt.values, wrench_age=felt.age)

    def feed_back(self, reference: WbcReference, report: WbcReport) -> None:
        """Give the estimator what was decided, if it takes that."""
        if self._feed is not None:
            self.decided(Planned(report.acceleration.copy(), report.torque.copy(), report.active, reference.edge))

    def decided(self, planned: Planned) -> None:
        """Give the estimator what somebody else has decided, if it takes that."""
        if self._feed is not None:
            self._feed(planned)


def foot_sensing(
    estimate: Estimate,
    wrench: Array,
    wanted: bool,
    inferred: "TorqueWrench | None" = None,
    touching: tuple[bool, bool] = NONE_TOUCHES,
) -> FootSensing:
    """The sensing of the feet.

    Args:
        estimate: of this tick.
        wrench: of the soles, shape (2, 6) [N, N·m].
        wanted: whether a lasting force is to be found.
        inferred: what makes these wrenches of the joints' torques, for an estimate that tells none; None of wrenches
            that are felt.
        touching: see `FootSensing`.
    """
    deviation, age, sure = (0.0, 0.0), estimate.wrench_age, estimate.deviation
    if inferred is not None:
        deviation, age = inferred.deviation, age + inferred.late
    if sure is not None:
        deviation = sure.force, sure.moment
    forces = wrench.item(2), wrench.item(8)
    return FootSensing(forces, wrench if wanted else None, estimate.contact, deviation, age, touching)


def with_deviations(deviation: Deviation, state: CentroidalState, feet: FeetState) -> tuple[CentroidalState, FeetState]:
    """State and feet with how sure they are."""
    com, velocity = float(np.hypot(*deviation.com[:2])), float(np.hypot(*deviation.com_velocity[:2]))
    return replace(state, deviation=(com, velocity)), replace(feet, height_deviation=deviation.step_height)
