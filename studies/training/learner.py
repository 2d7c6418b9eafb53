"""A controller in the seat of a robot under training: it observes by a contract, and does what is decided outside."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.readings import Readings
from surefoot.scenarios.policy.connection import Connection
from surefoot.scenarios.policy.contract import KEY, contract_of
from surefoot.scenarios.run.assembly import Parts, senses_of
from surefoot.scenarios.run.seat import placed
from surefoot.scenarios.setup.seat import STANDING
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Estimate, Planned

Array = NDArray[np.float64]

NAME = "learner"
"""Name that it has in scenarios."""


class Learner:
    """Carries out the last decision that it was given; see `surefoot.scenarios.run.seat.SeatedController`.

    Its `told` has observation and action of the last decision, for the log.

    Args:
        walk: what is walked.
        contract: plain values of a policy's contract, whose network is not looked at.

    Attributes:
        connection: of the contract with the robot.
        reads: whether it is given what sensors say, in place of the truth.
        parameters: for the log.
        posture: of all joints at the start, shape (nj,) [rad].

    Raises:
        ParameterError: contract, robot and rates do not fit together.
    """

    def __init__(self, walk: Walk, contract: Mapping[str, Any]) -> None:
        self.walk, found = walk, contract_of(contract, "the contract")
        self.connection = Connection(walk, found)
        self.posture = self.connection.posture
        self._senses = senses_of(walk, Parts())
        self.reads = self._senses.reads
        self.parameters = {"rate": found.rate, "contract": found.model_dump()}
        self.reset(None)

    @property
    def followed(self) -> Twist:
        """The velocity that it is to follow, within those of the contract."""
        return self.connection.followed

    def reset(self, q: Array | None) -> None:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        if q is not None:
            self._senses = senses_of(placed(self.walk, q) if self.reads else self.walk, Parts())
        self._begin, self._next = math.nan, -math.inf
        self._command = JointCommand(np.zeros(len(self.posture)))
        self._estimate: tuple[float, Estimate] | None = None
        self._output = np.zeros(len(self.connection.moved))
        self._observed: dict[str, Array] = {}
        self.connection.reset()
        self.told: Mapping[str, Array] | None = None

    def is_due(self, time: float) -> bool:
        """Return true if a decision is due at an instant [s]."""
        return math.isnan(self._begin) or time - self._begin >= self._next

    def observe(self, readings: Readings | Measurement, command: Command | None) -> dict[str, Array]:
        """Observe what `step` will be given, by each input, once before each decision."""
        self._hear(readings, command)
        state = self._found(readings).state
        self._observed = self.connection.observe(readings.time - self._begin, state)
        return self._observed

    def decide(self, output: Array) -> None:
        """Give the output of a network, shape (m,), for the decision that comes next."""
        if output.shape != self._output.shape or not np.isfinite(output).all():
            what = (
                f"an action of shape {output.shape} that is not finite" if output.shape else "an action without shape"
            )
            raise ParameterError(KEY, what, f"give {len(self._output)} finite numbers")
        self._output = np.array(output, dtype=np.float64)

    def step(self, readings: Readings | Measurement, command: Command | None = None) -> JointCommand:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        self._hear(readings, command)
        estimate, now = self._found(readings), readings.time - self._begin
        self._estimate = None
        if now >= self._next:
            self._next = self.connection.due(now)
            if not self._observed:
                self._observed = self.connection.observe(now, estimate.state)
            self._command = self.connection.command(self._output)
            self.told, self._observed = self.connection.reported(self._observed), {}
        if self._senses.listens:
            state = estimate.state
            torque = self._command.torque_at(state.q[7:], state.v[6:])
            self._senses.decided(Planned(np.zeros_like(state.v), torque, estimate.contact or (True, True), (0, 0)))
        return self._command

    def _hear(self, readings: Readings | Measurement, command: Command | None) -> None:
        if math.isnan(self._begin):
            self._begin = readings.time
        if command is not None:
            self.connection.follow(command.twist or STANDING, command.march)

    def _found(self, readings: Readings | Measurement) -> Estimate:
        """The state, which the estimator finds once for each reading."""
        if self._estimate is None or self._estimate[0] != readings.time:
            self._estimate = readings.time, self._senses(readings)
        return self._estimate[1]
