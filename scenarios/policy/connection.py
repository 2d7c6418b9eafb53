"""A contract connected to a robot: what is observed of its state, and what an output means for its joints."""

import math
from collections.abc import Mapping

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand, Servo
from surefoot.planner.types import Twist
from surefoot.scenarios.policy.contract import KEY, Contract, PerJoint
from surefoot.scenarios.policy.feed import Feed
from surefoot.scenarios.policy.joints import Joints, indices, spread, within
from surefoot.scenarios.policy.terms import Seen
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.seat import STANDING
from surefoot.scenarios.setup.walk import Walk
from surefoot.wbc.types import RobotState

Array = NDArray[np.float64]

_UPRIGHT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""A base at the origin, its quaternion x y z w."""

ROUNDING = 1e-6
"""Times of decisions are compared with this tolerance, a share of their period [-]."""


class Connection:
    """Link between a robot and its network, or somebody who trains one.

    Args:
        walk: what is walked.
        contract: of the network.
        inputs: names of what it observes; those of the contract, or ``observation``, if None.
        file: of the contract, for messages.
        known_as: name of the robot in contracts; None for its own.

    Attributes:
        contract: of the network.
        joints: of the contract in those of the robot.
        posture: of all joints at the start, shape (nj,) [rad].
        feeds: what each input is made of, by its name.
        moved: places of the joints that it moves, shape (m,).
        action: last output, zero at first, shape (m,).
        target: of these joints, as last decided, shape (m,) [rad, N·m].
        followed: the velocity that it follows, within those that the contract allows.
        driven: true for the joints of the contract that somebody else drives.
        walked: time of all decisions that followed a velocity [s].
        since: time of those since it last stood [s].

    Raises:
        ParameterError: contract, robot and rates do not fit together.
    """

    def __init__(
        self,
        walk: Walk,
        contract: Contract,
        inputs: tuple[str, ...] | None = None,
        file: str = "the contract",
        known_as: str | None = None,
    ) -> None:
        self.contract, robot = contract, walk.robot
        called = known_as or robot.name
        if contract.robot is not None and contract.robot != called:
            what = f"{file} is the contract of robot {contract.robot}, and this is {called}"
            raise ParameterError(KEY, what, "run it with its own robot")
        if contract.rate > walk.rates.control * (1.0 + ROUNDING):
            what = f"{file} decides {contract.rate:g} times a second, under rates.control {walk.rates.control} Hz"
            raise ParameterError(KEY, what, "raise rates.control")
        self.joints, self._body = Joints(contract, robot), body_of(robot)
        self.driven = np.zeros(len(contract.joints), dtype=bool)
        self.posture = self.joints.posture
        model, frames = self._body.model, self._body.frames
        self._data, self._torso = model.createData(), model.getFrameId(frames.torso)
        self._soles = [model.getFrameId(name) for name in frames.soles]
        self.feeds = self._fed(inputs)
        self._looks = any(feed.looks for feed in self.feeds.values())
        action = contract.action
        moved = action.joints or contract.joints
        self.moved = self.joints.named[indices(moved, contract.joints, "action.joints")]
        usual: PerJoint = 0.0 if action.kind == "torque" else tuple(self.joints.posture[self.moved].tolist())
        self._scale = spread(action.scale, moved, "action.scale")
        self._offset = spread(usual if action.offset is None else action.offset, moved, "action.offset")
        self._limits = None if action.limits is None else np.array(action.limits, dtype=np.float64)
        if self._limits is not None and self._limits.shape != (len(moved), 2):
            what = f"action.limits has {len(self._limits)} pairs for {len(moved)} joints"
            raise ParameterError(KEY, what, "give one for each")
        self._still, self._stiffness = np.zeros_like(self.posture), self.joints.stiffness.copy()
        if action.kind == "torque":
            self._stiffness[self.moved] = 0.0
        self.reset()

    def _fed(self, inputs: tuple[str, ...] | None) -> dict[str, Feed]:
        """Feeds of the inputs, by their names."""
        contract = self.contract
        names = tuple(contract.inputs) or ("observation",) if inputs is None else inputs
        fed = contract.inputs or ({names[0]: contract.observations} if len(names) == 1 else {})
        if sorted(fed) != sorted(names):
            what = f"the network has inputs {', '.join(names)}, and the contract tells {', '.join(fed) or 'one'}"
            raise ParameterError(KEY, what, "give inputs, each by its name, or recurrent")
        return {name: Feed(fed[name], contract) for name in names}

    def reset(self) -> None:
        """Forget what was observed, decided and commanded."""
        self.action, self.target = np.zeros(len(self.moved)), self._offset.copy()
        self.followed, self._marches = STANDING, False
        self.walked = self.since = 0.0
        for feed in self.feeds.values():
            feed.reset()

    def follow(self, twist: Twist, march: bool) -> None:
        """Follow a velocity, within those that it was trained for, from now on; march in place where it is zero."""
        ranges = self.contract.command
        pairs = zip(twist[:3], (ranges.v_x, ranges.v_y, ranges.yaw_rate), strict=True)
        self.followed = Twist(*(one if pair is None else min(max(one, pair[0]), pair[1]) for one, pair in pairs))
        self._marches = march

    def drive(self, joints: NDArray[np.bool_]) -> None:
        """Tell which joints somebody else drives from now on; the contract says what is observed of them.

        Args:
            joints: of the robot, shape (nj,).
        """
        self.driven = joints[self.joints.named]

    def sizes(self) -> dict[str, tuple[int, list[tuple[str, int]]]]:
        """Count the numbers of each input, and of each of its terms without history."""
        still = RobotState(np.concatenate((_UPRIGHT, self.posture)), np.zeros(6 + len(self.posture)))
        seen, found = self._seen(0.0, still), {}
        for name, feed in self.feeds.items():
            values = feed.values(seen)
            terms = [(term.term, len(one)) for term, one in zip(feed.terms, values, strict=True)]
            found[name] = len(feed.observe(values)), terms
            feed.reset()
        return found

    def due(self, now: float) -> float:
        """Time at which the next decision after one at an instant is due [s]."""
        rate = self.contract.rate
        return (math.floor(now * rate + ROUNDING) + 1.0 - ROUNDING) / rate

    def observe(self, now: float, state: RobotState) -> dict[str, Array]:
        """Observe a state for the decision at an instant since the reset [s], once for each decision.

        Each input's values are joined to its history, and the clocks of the walk go on by a period.
        """
        self._count()
        seen = self._seen(now, state)
        return {name: feed.observe(feed.values(seen)) for name, feed in self.feeds.items()}

    def command(self, output: Array) -> JointCommand:
        """Command of all joints that an output, shape (m,), means."""
        action, joints = self.contract.action, self.joints
        self.action = output
        used = output if action.clip is None else within(output, *action.clip)
        target = self._offset + self._scale * used
        if self._limits is not None:
            target = within(target, self._limits[:, 0], self._limits[:, 1])
        self.target = target
        if action.kind == "torque":
            torque = self._still.copy()
            torque[self.moved] = target
            return JointCommand(torque, Servo(joints.posture, self._still, self._stiffness, joints.damping))
        position = joints.posture.copy()
        position[self.moved] = target
        return JointCommand(self._still, Servo(position, self._still, self._stiffness, joints.damping))

    def reported(self, observed: Mapping[str, Array]) -> dict[str, Array]:
        """A decision for the log, by name."""
        alone = len(observed) == 1
        named = {"observation" if alone else f"observation_{name}": values for name, values in observed.items()}
        return {**named, "action": self.action}

    @property
    def _stands(self) -> bool:
        """True if the robot is to stand."""
        return self.followed.is_zero and not self._marches

    def _count(self) -> None:
        """Count how long it has walked by the decision that is due."""
        period = 1.0 / self.contract.rate
        if self._stands:
            self.since = 0.0
        else:
            self.walked, self.since = self.walked + period, self.since + period

    def _seen(self, now: float, state: RobotState) -> Seen:
        q, v = state.q, state.v
        x, y, z, w = q[3:7].tolist()
        R, spin = pin.Quaternion(w, x, y, z).matrix(), v[3:6]
        torso, torso_spin, height = self._looked_at(state) if self._looks else (R, spin, math.nan)
        position, velocity = self._joints_seen(q[7:], v[6:])
        joints, times = (position, self.joints.default, velocity), (now, self.walked, self.since)
        demand = self.action, self.followed, self._stands
        return Seen(*times, R, torso, spin, torso_spin, v[:3], height, *joints, *demand)

    def _joints_seen(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Angles and speeds of the contract's joints, of those that somebody else drives as the contract says."""
        named, driven = self.joints.named, self.driven
        kind = self.contract.driven
        if kind == "as_is" or not driven.any():
            return position[named], velocity[named]
        shown = self.joints.posture.copy()
        if kind == "as_commanded" and self.contract.action.kind == "position":
            shown[self.moved] = self.target
        return np.where(driven, shown[named], position[named]), np.where(driven, 0.0, velocity[named])

    def _looked_at(self, state: RobotState) -> tuple[Array, Array, float]:
        """Orientation and angular velocity of the torso, in its frame, and height of the base over the lower sole."""
        model, data = self._body.model, self._data
        pin.forwardKinematics(model, data, state.q, state.v)
        R = pin.updateFramePlacement(model, data, self._torso).rotation
        spin = pin.getFrameVelocity(model, data, self._torso, pin.ReferenceFrame.LOCAL).angular
        soles = [pin.updateFramePlacement(model, data, sole).translation.item(2) for sole in self._soles]
        return R, spin, state.q.item(2) - min(soles)
