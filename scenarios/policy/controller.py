"""A policy in the seat of planner and whole-body controller: a network that its contract connects to the robot."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError, PartError
from surefoot.joints import JointCommand
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.readings import Readings
from surefoot.scenarios.errors import nearest
from surefoot.scenarios.policy.connection import Connection
from surefoot.scenarios.policy.contract import KEY
from surefoot.scenarios.policy.files import Files, read
from surefoot.scenarios.policy.network import Network
from surefoot.scenarios.run.assembly import Parts, senses_of
from surefoot.scenarios.run.seat import placed
from surefoot.scenarios.setup.seat import STANDING
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Planned
from surefoot.wbc.types import RobotState

Array = NDArray[np.float64]


class Policy:
    """A network that walks a robot; see `surefoot.scenarios.run.seat.SeatedController`.

    Its `told` has observation and action of the last decision, for the log.

    Args:
        walk: what is walked.
        file: of the contract, or what `surefoot.scenarios.policy.files.read` takes for one.
        digest: of its files, which must be these; None for any.
        known_as: name of the robot in contracts; None for its own.

    Attributes:
        contract: of the network.
        network: that decides.
        connection: of the contract with the robot.
        reads: whether it is given what sensors say, in place of the truth.
        parameters: for the log.
        posture: of all joints at the start, shape (nj,) [rad].

    Raises:
        ParameterError: contract, network, robot and rates do not fit together, or onnxruntime is not installed.
    """

    def __init__(
        self, walk: Walk, file: str, digest: str | None = None, known_as: str | None = None, **others: Any
    ) -> None:
        if others:
            what = f"controller.options of a policy, which takes none but known_as: {', '.join(others)}"
            raise ParameterError(("controller", "options"), what, "leave them out")
        files: Files = read(Path(file), walk.robot.joint_names)
        self.walk, self.contract = walk, files.contract
        self.network = Network(files.network)
        found = files.digest()
        if digest is not None and digest != found:
            what = f"{file} is not the policy that made the log: its digest is {found[:12]}, not {digest[:12]}"
            raise ParameterError(KEY, what, "give the files of then, or leave out controller.digest")
        contract = self.contract
        self.connection = Connection(walk, contract, self._observed(), file, known_as)
        self._output = self._decided_output()
        self.posture = self.connection.posture
        self._senses = senses_of(walk, Parts())
        self.reads = self._senses.reads
        self.parameters = {"file": file, "digest": found, "rate": contract.rate, "contract": contract.model_dump()}
        self.reset(None)
        self._check_sizes()

    def _observed(self) -> tuple[str, ...]:
        """Inputs of the network that are no states."""
        contract, network = self.contract, self.network
        for state in contract.recurrent:
            for name, there, kind in (
                (state.input, network.inputs, "input"),
                (state.output, network.outputs, "output"),
            ):
                if name not in there:
                    raise ParameterError(KEY, f"the network has no {kind} '{name}'", nearest(name, list(there)))
        states = [state.input for state in contract.recurrent]
        return tuple(name for name in network.inputs if name not in states)

    def _decided_output(self) -> str:
        """The output that is the action."""
        contract, network = self.contract, self.network
        carried = [state.output for state in contract.recurrent]
        outputs = [name for name in network.outputs if name not in carried]
        action = contract.action
        if action.output is None and len(outputs) != 1:
            raise ParameterError(KEY, f"the network has outputs {', '.join(outputs)}", "name one as action.output")
        found = action.output or outputs[0]
        if found not in network.outputs:
            raise ParameterError(KEY, f"the network has no output '{found}'", nearest(found, outputs))
        return found

    def _check_sizes(self) -> None:
        """Hold the sizes of the network against those of the contract, term by term."""
        for name, (size, terms) in self.connection.sizes().items():
            wanted = self.network.inputs[name]
            if wanted and size != wanted:
                table = ", ".join(f"{term} {count}" for term, count in terms)
                what = (
                    f"input '{name}' takes {wanted} numbers, and the terms make {size} ({table}, each with its history)"
                )
                raise ParameterError(KEY, what, "mend terms, joints or history of the contract")
        size, moved = self.network.outputs[self._output], len(self.connection.moved)
        if size and size != moved:
            what = f"output '{self._output}' has {size} numbers, and action moves {moved} joints"
            raise ParameterError(KEY, what, "mend joints or action.joints of the contract")

    @property
    def followed(self) -> Twist:
        """The velocity that it follows, within those that it was trained for."""
        return self.connection.followed

    @property
    def target(self) -> Array:
        """Targets of the joints that it moves, as last decided, shape (m,) [rad, N·m]."""
        return self.connection.target

    def reset(self, q: Array | None) -> None:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        if q is not None:
            self._senses = senses_of(placed(self.walk, q) if self.reads else self.walk, Parts())
        self._begin, self._next = math.nan, -math.inf
        self._command = JointCommand(np.zeros(len(self.posture)))
        self._states = {
            state.input: self.network.shaped(state.input, np.zeros(max(self.network.inputs[state.input], 1)))
            for state in self.contract.recurrent
        }
        self.connection.reset()
        self.told: Mapping[str, Array] | None = None

    def step(self, readings: Readings | Measurement, command: Command | None = None) -> JointCommand:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        if math.isnan(self._begin):
            self._begin = readings.time
        now = readings.time - self._begin
        if command is not None:
            self.connection.follow(command.twist or STANDING, command.march)
        due = now >= self._next
        if not due and self._senses.is_truth:
            return self._command  # the truth needs no look in between
        estimate = self._senses(readings)
        state = estimate.state
        if due:
            self._next = self.connection.due(now)
            self._command = self._decided(now, state)
        if self._senses.listens:
            self._tell(state, estimate.contact)
        return self._command

    def _decided(self, now: float, state: RobotState) -> JointCommand:
        """The decision of the network on the state."""
        observed = self.connection.observe(now, state)
        given = dict(self._states)
        for name, values in observed.items():
            given[name] = self.network.shaped(name, values)
        found = self.network.run(given)
        for one in self.contract.recurrent:
            self._states[one.input] = found[one.output]
        output = np.asarray(found[self._output], dtype=np.float64).ravel()
        if len(output) != len(self.connection.moved) or not np.isfinite(output).all():
            raise PartError(f"the network of {self.network.path.name} gave no finite action at {now:.3f} s", "mend it")
        command = self.connection.command(output)
        self.told = self.connection.reported(observed)
        return command

    def _tell(self, state: RobotState, contact: tuple[bool, bool] | None) -> None:
        """Give an estimator what was decided; of a policy no acceleration is known."""
        torque = self._command.torque_at(state.q[7:], state.v[6:])
        self._senses.decided(Planned(np.zeros_like(state.v), torque, contact or (True, True), (0, 0)))
