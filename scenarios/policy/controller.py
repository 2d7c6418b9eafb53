"""A policy in the seat of planner and whole-body controller: a network that its contract connects to the robot."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError, PartError
from surefoot.joints import JointCommand, Servo
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.readings import Readings
from surefoot.scenarios.errors import nearest
from surefoot.scenarios.file.registries import CONTROLLERS
from surefoot.scenarios.policy.contract import KEY, PerJoint
from surefoot.scenarios.policy.feed import Feed
from surefoot.scenarios.policy.files import Files, read
from surefoot.scenarios.policy.joints import Joints, indices, spread
from surefoot.scenarios.policy.network import Network
from surefoot.scenarios.policy.terms import Seen
from surefoot.scenarios.run.assembly import Parts, senses_of
from surefoot.scenarios.run.seat import placed
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.seat import STANDING
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Planned
from surefoot.wbc.types import RobotState

Array = NDArray[np.float64]

_UPRIGHT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""A base at the origin, its quaternion x y z w."""

_ROUNDING = 1e-6
"""Times of decisions are compared with this tolerance, a share of their period [-]."""


class Policy:
    """A network that walks a robot; see `surefoot.scenarios.run.seat.SeatedController`.

    Args:
        walk: what is walked.
        file: of the contract, or what `surefoot.scenarios.policy.files.read` takes for one.
        digest: of its files, which must be these; None for any.
        known_as: name of the robot in contracts; None for its own.

    Attributes:
        contract: of the network.
        network: that decides.
        reads: whether it is given what sensors say, in place of the truth.
        parameters: for the log.
        posture: of all joints at the start, shape (nj,) [rad].
        followed: the velocity that it follows, within those that it was trained for.
        reported: observation and action of the last decision, for the log.
        target: of the joints that it moves, as last decided, shape (m,) [rad, N·m].

    Raises:
        ParameterError: contract, network, robot and rates do not fit together, or onnxruntime is not installed.
    """

    def __init__(self, walk: Walk, file: str, digest: str | None = None, known_as: str | None = None) -> None:
        files: Files = read(Path(file), walk.robot.joint_names)
        self.walk, self.contract = walk, files.contract
        self.network = Network(files.network)
        found = files.digest()
        if digest is not None and digest != found:
            what = f"{file} is not the policy that made the log: its digest is {found[:12]}, not {digest[:12]}"
            raise ParameterError(KEY, what, "give the files of then, or leave out controller.digest")
        contract, robot = self.contract, walk.robot
        called = known_as or robot.name
        if contract.robot is not None and contract.robot != called:
            what = f"{file} is the contract of robot {contract.robot}, and this is {called}"
            raise ParameterError(KEY, what, "run it with its own robot")
        if contract.rate > walk.rates.control * (1.0 + _ROUNDING):
            what = f"{file} decides {contract.rate:g} times a second, under rates.control {walk.rates.control} Hz"
            raise ParameterError(KEY, what, "raise rates.control")
        self.joints, self._body = Joints(contract, robot), body_of(robot)
        self._driven = np.zeros(len(contract.joints), dtype=bool)
        self.posture = self.joints.posture
        model, frames = self._body.model, self._body.frames
        self._data, self._torso = model.createData(), model.getFrameId(frames.torso)
        self._soles = [model.getFrameId(name) for name in frames.soles]
        self._connect()
        self._senses = senses_of(walk, Parts())
        self.reads = self._senses.reads
        self.parameters = {"file": file, "digest": found, "rate": contract.rate, "contract": contract.model_dump()}
        self.reset(None)
        self._check_sizes()

    def _connect(self) -> None:
        """Find which input is made of what, and which output means what."""
        contract, network = self.contract, self.network
        states = [state.input for state in contract.recurrent]
        for state in contract.recurrent:
            for name, there, kind in (
                (state.input, network.inputs, "input"),
                (state.output, network.outputs, "output"),
            ):
                if name not in there:
                    raise ParameterError(KEY, f"the network has no {kind} '{name}'", nearest(name, list(there)))
        free = [name for name in network.inputs if name not in states]
        feeds = contract.inputs or ({free[0]: contract.observations} if len(free) == 1 else {})
        if sorted(feeds) != sorted(free):
            what = f"the network has inputs {', '.join(free)}, and the contract tells {', '.join(feeds) or 'one'}"
            raise ParameterError(KEY, what, "give inputs, each by its name, or recurrent")
        self.feeds = {name: Feed(feeds[name], contract) for name in free}
        self._looks = any(feed.looks for feed in self.feeds.values())
        carried = [state.output for state in contract.recurrent]
        outputs = [name for name in network.outputs if name not in carried]
        action = contract.action
        if action.output is None and len(outputs) != 1:
            raise ParameterError(KEY, f"the network has outputs {', '.join(outputs)}", "name one as action.output")
        self._output = action.output or outputs[0]
        if self._output not in network.outputs:
            raise ParameterError(KEY, f"the network has no output '{self._output}'", nearest(self._output, outputs))
        moved = action.joints or contract.joints
        self._moved = self.joints.named[indices(moved, contract.joints, "action.joints")]
        usual: PerJoint = 0.0 if action.kind == "torque" else tuple(self.joints.posture[self._moved].tolist())
        self._scale = spread(action.scale, moved, "action.scale")
        self._offset = spread(usual if action.offset is None else action.offset, moved, "action.offset")
        self._limits = None if action.limits is None else np.array(action.limits, dtype=np.float64)
        if self._limits is not None and self._limits.shape != (len(moved), 2):
            what = f"action.limits has {len(self._limits)} pairs for {len(moved)} joints"
            raise ParameterError(KEY, what, "give one for each")

    def _check_sizes(self) -> None:
        """Hold the sizes of the network against those of the contract, term by term."""
        for name, feed in self.feeds.items():
            values = feed.values(self._at_rest())
            size, wanted = len(feed.observe(values)), self.network.inputs[name]
            feed.reset()
            if wanted and size != wanted:
                table = ", ".join(f"{term.term} {len(value)}" for term, value in zip(feed.terms, values, strict=True))
                what = (
                    f"input '{name}' takes {wanted} numbers, and the terms make {size} ({table}, each with its history)"
                )
                raise ParameterError(KEY, what, "mend terms, joints or history of the contract")
        size = self.network.outputs[self._output]
        if size and size != len(self._moved):
            what = f"output '{self._output}' has {size} numbers, and action moves {len(self._moved)} joints"
            raise ParameterError(KEY, what, "mend joints or action.joints of the contract")

    def _at_rest(self) -> Seen:
        """Observation of a robot that stands still in its default posture."""
        still = RobotState(np.concatenate((_UPRIGHT, self.posture)), np.zeros(6 + len(self.posture)))
        return self._seen(0.0, still)

    def reset(self, q: Array | None) -> None:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        if q is not None:
            self._senses = senses_of(placed(self.walk, q) if self.reads else self.walk, Parts())
        self._begin, self._next = math.nan, -math.inf
        self._action, self.target = np.zeros(len(self._moved)), self._offset.copy()
        self._command = JointCommand(np.zeros(len(self.posture)))
        self._states = {
            state.input: self.network.shaped(state.input, np.zeros(max(self.network.inputs[state.input], 1)))
            for state in self.contract.recurrent
        }
        for feed in self.feeds.values():
            feed.reset()
        self.followed, self._marches = STANDING, False
        self._walked = self._since = 0.0
        self.told: Mapping[str, Array] | None = None

    def step(self, readings: Readings | Measurement, command: Command | None = None) -> JointCommand:
        """See `surefoot.scenarios.run.seat.SeatedController`."""
        if math.isnan(self._begin):
            self._begin = readings.time
        now = readings.time - self._begin
        if command is not None:
            self.followed, self._marches = self._within(command.twist or STANDING), command.march
        estimate = self._senses(readings)
        state = estimate.state
        if now >= self._next:
            rate = self.contract.rate
            self._next = (math.floor(now * rate + _ROUNDING) + 1.0 - _ROUNDING) / rate
            self._count()
            self._command = self._decided(now, state)
        if self._senses.listens:
            self._tell(state, estimate.contact)
        return self._command

    def _count(self) -> None:
        """Count how long it has walked by the decision that is due."""
        if self.followed.is_zero and not self._marches:
            self._since = 0.0
        else:
            self._walked, self._since = self._walked + 1.0 / self.contract.rate, self._since + 1.0 / self.contract.rate

    def drive(self, joints: NDArray[np.bool_]) -> None:
        """Tell which joints somebody else drives from now on; the contract says what is observed of them.

        Args:
            joints: of the robot, shape (nj,).
        """
        self._driven = joints[self.joints.named]

    def _within(self, twist: Twist) -> Twist:
        """A velocity within those that the policy was trained for."""
        ranges = self.contract.command
        pairs = zip(twist[:3], (ranges.v_x, ranges.v_y, ranges.yaw_rate), strict=True)
        return Twist(*(value if pair is None else min(max(value, pair[0]), pair[1]) for value, pair in pairs))

    def _decided(self, now: float, state: RobotState) -> JointCommand:
        """The decision of the network on the state."""
        seen = self._seen(now, state)
        reported: dict[str, Array] = {}
        given = dict(self._states)
        for name, feed in self.feeds.items():
            observed = feed.observe(feed.values(seen))
            reported["observation" if len(self.feeds) == 1 else f"observation_{name}"] = observed
            given[name] = self.network.shaped(name, observed)
        found = self.network.run(given)
        for one in self.contract.recurrent:
            self._states[one.input] = found[one.output]
        output = np.asarray(found[self._output], dtype=np.float64).ravel()
        if len(output) != len(self._moved) or not np.isfinite(output).all():
            raise PartError(f"the network of {self.network.path.name} gave no finite action at {now:.3f} s", "mend it")
        self._action = output
        self.told = {**reported, "action": output}
        return self._commanded(output)

    def _commanded(self, output: Array) -> JointCommand:
        """The command that an output means."""
        action, joints = self.contract.action, self.joints
        used = output if action.clip is None else np.clip(output, *action.clip)
        target = self._offset + self._scale * used
        if self._limits is not None:
            target = np.clip(target, self._limits[:, 0], self._limits[:, 1])
        self.target = target
        torque, position = np.zeros_like(joints.posture), joints.posture.copy()
        stiffness = joints.stiffness
        if action.kind == "torque":
            torque[self._moved] = target
            stiffness = stiffness.copy()
            stiffness[self._moved] = 0.0
        else:
            position[self._moved] = target
        return JointCommand(torque, Servo(position, np.zeros_like(position), stiffness, joints.damping))

    def _seen(self, now: float, state: RobotState) -> Seen:
        q, v = state.q, state.v
        x, y, z, w = q[3:7].tolist()
        R, spin = pin.Quaternion(w, x, y, z).matrix(), v[3:6]
        torso, torso_spin, height = self._looked_at(state) if self._looks else (R, spin, math.nan)
        stands = self.followed.is_zero and not self._marches
        position, velocity = self._joints_seen(q[7:], v[6:])
        joints, times = (position, self.joints.default, velocity), (now, self._walked, self._since)
        return Seen(*times, R, torso, spin, torso_spin, v[:3], height, *joints, self._action, self.followed, stands)

    def _joints_seen(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Angles and speeds of the contract's joints, of those that somebody else drives as the contract says."""
        named, driven = self.joints.named, self._driven
        kind = self.contract.driven
        if kind == "as_is" or not driven.any():
            return position[named], velocity[named]
        told = self.joints.posture.copy()
        if kind == "as_commanded" and self.contract.action.kind == "position":
            told[self._moved] = self.target
        return np.where(driven, told[named], position[named]), np.where(driven, 0.0, velocity[named])

    def _looked_at(self, state: RobotState) -> tuple[Array, Array, float]:
        """Orientation and angular velocity of the torso, in its frame, and height of the base over the lower sole."""
        model, data = self._body.model, self._data
        pin.forwardKinematics(model, data, state.q, state.v)
        R = pin.updateFramePlacement(model, data, self._torso).rotation
        spin = pin.getFrameVelocity(model, data, self._torso, pin.ReferenceFrame.LOCAL).angular
        soles = [pin.updateFramePlacement(model, data, sole).translation.item(2) for sole in self._soles]
        return R, spin, state.q.item(2) - min(soles)

    def _tell(self, state: RobotState, contact: tuple[bool, bool] | None) -> None:
        """Give an estimator what was decided; of a policy no acceleration is known."""
        torque = self._command.torque_at(state.q[7:], state.v[6:])
        self._senses.decided(Planned(np.zeros_like(state.v), torque, contact or (True, True), -1))


CONTROLLERS.filled(None, {"policy": Policy})
