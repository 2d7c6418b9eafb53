"""Pelvis and torso stay upright and turn with the heading."""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pinocchio as pin

from surefoot.native.library import Bound
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames, RobotTerms
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.task import Vector, angular_acceleration
from surefoot.wbc.types import Array, WbcReference

SPARED, SOFTENED = 0.04, 0.02
"""Way to the end of its range that a hip keeps, and within which around it the pelvis begins to roll [rad]."""


class HipStops:
    """Hips of small range sideways: the pelvis rolls with the leg rather than against the end of a hip's range.

    Over one foot, legs lean by about half the hips' distance over their length. With the angle q of a hip's roll joint
    about an axis that points s ahead, and the roll ρ of the pelvis, q + s ρ is the angle that an upright pelvis would
    take; so much of it as lies beyond the range, less what is spared, is the pelvis's.

    Args:
        model: the robot.
        frames: its soles.
        limits: of its joints.

    Attributes:
        hips: of the left and the right hip's roll joint: column of the generalised velocity, sign of its axis ahead,
            lower and upper end of what it takes alone [-, -, rad, rad].
    """

    def __init__(self, model: pin.Model, frames: BodyFrames, limits: JointLimits) -> None:
        self.hips: list[tuple[int, float, float, float]] = []
        for column, sign in _rolls(model, frames):
            lower, upper = float(limits.lower[column - 6]), float(limits.upper[column - 6])
            spared = min(SPARED, 0.25 * (upper - lower))
            self.hips.append((column, sign, lower + spared, upper - spared))

    def roll(self, terms: RobotTerms) -> tuple[float, float]:
        """Roll of the pelvis, left side up, and its rate [rad, rad/s].

        Args:
            terms: of the state.
        """
        _, y, z = terms.base_rotation[2].tolist()
        now, turning = math.atan2(y, z), float(terms.base_angular_velocity[0])
        roll = rate = 0.0
        for column, sign, lower, upper in self.hips:
            angle = float(terms.q[column + 1]) + sign * now
            beyond, slope = _beyond(angle - upper) if angle > 0.5 * (lower + upper) else _beyond(lower - angle)
            if slope:
                toward = sign if angle > 0.5 * (lower + upper) else -sign
                roll += toward * beyond
                rate += slope * (sign * float(terms.v[column]) + turning)
        return roll, rate


@lru_cache(maxsize=8)
def _rolls(model: pin.Model, frames: BodyFrames) -> tuple[tuple[int, float], ...]:
    """Of the left and the right hip's roll joint: column of the generalised velocity, sign of its axis ahead."""
    data, found = model.createData(), []
    pin.computeJointJacobians(model, data, pin.neutral(model))
    for name in frames.soles:
        chain = [
            joint for joint in model.supports[model.frames[model.getFrameId(name)].parentJoint] if model.nvs[joint]
        ]
        above = chain[1:-2]
        ahead = {model.joints[joint].idx_v: float(data.J[3, model.idx_vExtendeds[joint]]) for joint in above}
        column = max(ahead, key=lambda column: abs(ahead[column]))
        found.append((column, math.copysign(1.0, ahead[column])))
    return tuple(found)


def _beyond(excess: float) -> tuple[float, float]:
    """What of an excess the pelvis takes, setting in smoothly about zero, and how that changes with it [rad, -]."""
    if excess <= -SOFTENED:
        return 0.0, 0.0
    if excess >= SOFTENED:
        return excess, 1.0
    return (excess + SOFTENED) ** 2 / (4.0 * SOFTENED), (excess + SOFTENED) / (2.0 * SOFTENED)


class _Upright:
    """Angular acceleration of a body towards upright at the heading of the reference.

    While a step catches the body its heading counts for less. What a push beside the CoM and a leg that is swung hard
    turn, one sole holds by friction alone, the better the harder it is pressed down. So it was cheap to jump, and to
    tilt and miss the landing as well. The steps after it turn the body back. Its uprightness counts for less, too: the
    trunk is the flywheel by which the ground pushes the body back harder than a CoP in the sole does (Pratt, Carff,
    Drakunov and Goswami, Capture point: a step toward humanoid push recovery, Humanoids 2006).
    """

    size = 3

    def __init__(self, weights: TaskWeights, gains: TaskGains) -> None:
        self.weight = weights.orientation
        upright, turning = weights.upright_catching, weights.turning_catching
        self.catching_weight = np.array([upright, upright, turning])
        self._gains = gains.orientation
        self._desired = np.eye(3)

    def _wanted(self, reference: WbcReference, R: Array, velocity: Array) -> Vector:
        cosine, sine = math.cos(reference.heading), math.sin(reference.heading)
        desired = self._desired
        desired[0, 0] = desired[1, 1] = cosine
        desired[0, 1], desired[1, 0] = -sine, sine
        turn = self._gains[1] * reference.heading_rate
        x, y, z = R[2].tolist()
        return angular_acceleration(self._gains, R, velocity, desired, (turn * x, turn * y, turn * z))


class Pelvis(_Upright):
    """Angular acceleration of the floating base, which is the pelvis: rows of the identity.

    It rolls where the hips need it (see `HipStops`).
    """

    name = "pelvis"
    _axes = np.eye(3)

    def __init__(self, weights: TaskWeights, gains: TaskGains, stops: HipStops | None = None) -> None:
        """Set up the task; without stops the hips end nowhere."""
        super().__init__(weights, gains)
        self._stops = stops

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        np.multiply(self._axes, scale, out=rows[:, 3:6])
        x, y, z = self._wanted(reference, terms.base_rotation, terms.base_angular_velocity)
        roll, rate = self._stops.roll(terms) if self._stops else (0.0, 0.0)
        return x + self._gains[0] * roll + self._gains[1] * rate, y, z

    def compiled(self, tick: CompiledTick, bench: Bound) -> Callable[[], None]:
        """See ``CompiledTask.compiled``."""
        hips = np.array(self._stops.hips if self._stops else [(0.0, 0.0, 0.0, 0.0)])
        return tick.kernels.bind(
            "task_pelvis",
            bench=bench,
            stiffness=self._gains[0],
            damping=self._gains[1],
            hip_count=len(hips) if self._stops else 0,
            hips=hips,
            softened=SOFTENED,
        )


class Torso(_Upright):
    """Angular acceleration of the torso."""

    name = "torso"

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        np.multiply(terms.torso_jacobian, scale, out=rows[:, :-12])
        x, y, z = self._wanted(reference, terms.torso_rotation, terms.torso_velocity)
        bx, by, bz = terms.torso_bias.tolist()
        return x - bx, y - by, z - bz

    def compiled(self, tick: CompiledTick, bench: Bound) -> Callable[[], None]:
        """See ``CompiledTask.compiled``."""
        stiffness, damping = self._gains
        return tick.kernels.bind("task_torso", bench=bench, stiffness=stiffness, damping=damping)
