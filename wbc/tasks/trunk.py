"""Pelvis and torso stay upright and turn with the heading."""

import math

import numpy as np
import pinocchio as pin

from surefoot.maths import algebra, linear
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.parameters import TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks import law
from surefoot.wbc.tasks.law import TaskLaw
from surefoot.wbc.types import Array

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
        found = []
        for column, sign in _rolls(model, frames):
            lower, upper = float(limits.lower[column - 6]), float(limits.upper[column - 6])
            spared = min(SPARED, 0.25 * (upper - lower))
            found.append((column, sign, lower + spared, upper - spared))
        self.hips, self._softened = tuple(found), SOFTENED
        self._columns = np.array([hip[0] for hip in found], dtype=np.int64)
        self._sign, self._lower, self._upper = np.array([hip[1:] for hip in found]).T.copy()

    def roll(self, terms: RobotTerms) -> tuple[float, float]:
        """Roll of the pelvis, left side up, and its rate [rad, rad/s].

        Args:
            terms: of the state.
        """
        now, turning = math.atan2(terms._R_base[2, 1], terms._R_base[2, 2]), terms._w_base[0]
        roll, rate = 0.0, 0.0
        for i in range(self._columns.shape[0]):
            column = self._columns[i]
            sign = self._sign[i]
            lower = self._lower[i]
            upper = self._upper[i]
            angle = terms._q[column + 1] + sign * now
            above = angle > 0.5 * (lower + upper)
            excess = angle - upper if above else lower - angle
            slope = self._slope(excess)
            if slope != 0.0:
                roll += (sign if above else -sign) * self._taken(excess)
                rate += slope * (sign * terms._v[column] + turning)
        return roll, rate

    def _taken(self, excess: float) -> float:
        """Part of an excess that the pelvis takes, setting in smoothly about zero [rad]."""
        if excess <= -self._softened:
            return 0.0
        if excess >= self._softened:
            return excess
        return (excess + self._softened) * (excess + self._softened) / (4.0 * self._softened)

    def _slope(self, excess: float) -> float:
        """Derivative of that part by the excess [-]."""
        if excess <= -self._softened:
            return 0.0
        return 1.0 if excess >= self._softened else (excess + self._softened) / (2.0 * self._softened)


def _rolls(model: pin.Model, frames: BodyFrames) -> tuple[tuple[int, float], ...]:
    """The roll joints of the left and the right hip: column of the generalised velocity, sign of the axis ahead."""
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


class Upright(TaskLaw):
    """Angular acceleration of a body towards upright at the heading of the reference.

    While a step catches the body its heading counts for less. A push beside the CoM, and a leg that is swung hard, turn
    the body. One sole holds that by friction alone, the better the harder it is pressed down. So it was cheap to jump,
    and to tilt and miss the landing as well. The steps after it turn the body back. Its uprightness counts for less,
    too: the trunk is the flywheel by which the ground pushes the body back harder than a CoP in the sole does (Pratt,
    Carff, Drakunov and Goswami, Capture point: a step toward humanoid push recovery, Humanoids 2006).
    """

    size = 3

    def __init__(self, weights: TaskWeights, gains: TaskGains) -> None:
        self.weight = weights.orientation
        upright, turning = weights.upright_catching, weights.turning_catching
        self.catching_weight = np.array([upright, upright, turning])
        self._k, self._d = gains.orientation
        self._R_d = np.eye(3)

    def turn(
        self, reference: WbcReference, yaw: algebra.Vector, roll: algebra.Vector, R: Array, velocity: Array
    ) -> algebra.Vector:
        """Angular acceleration of a body, in its frame [rad/s^2].

        It is to turn with ω = ψ' z + ρ' x_d, x_d ahead of it and level, with ψ = heading + yaw.

        Args:
            reference: of the tick.
            yaw: angle to the left of the heading, its rate and acceleration [rad, rad/s, rad/s^2].
            roll: angle ρ by which its left side is up, its rate and acceleration [rad, rad/s, rad/s^2].
            R: orientation of the body, shape (3, 3).
            velocity: angular, in its frame, shape (3,) [rad/s].
        """
        angle, spin = reference.heading + yaw[0], reference.heading_rate + yaw[1]
        cosine, sine = math.cos(angle), math.sin(angle)
        level, tilt = math.cos(roll[0]), math.sin(roll[0])
        algebra.put_row(self._R_d, 0, (cosine, -sine * level, sine * tilt))
        algebra.put_row(self._R_d, 1, (sine, cosine * level, -cosine * tilt))
        algebra.put_row(self._R_d, 2, (0.0, tilt, level))
        along, across, up = self._d * roll[1] + roll[2], spin * roll[1], self._d * spin + yaw[2]
        ahead = algebra.rotate_back(R, (cosine * along - sine * across, sine * along + cosine * across, up))
        return law.angular_feedback(self._k, self._d, R, algebra.vector(velocity), self._R_d, ahead)


class Pelvis(Upright):
    """Angular acceleration of the floating base, which is the pelvis: rows of the identity.

    It rolls where the hips need it (see `HipStops`).
    """

    name = "pelvis"

    def __init__(self, weights: TaskWeights, gains: TaskGains, stops: HipStops | None = None) -> None:
        """Set up the task; without stops the hips end nowhere."""
        super().__init__(weights, gains)
        self._stops = stops

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``."""
        for i in range(3):
            rows[i, 3 + i] = scale[i]
        turned = self.turn(reference, reference.pelvis_yaw, reference.pelvis_list, terms._R_base, terms._w_base)
        algebra.put(target, turned)
        if self._stops is not None:
            roll, rate = self._stops.roll(terms)
            target[0] += self._k * roll + self._d * rate


class Torso(Upright):
    """Angular acceleration of the torso."""

    name = "torso"

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``."""
        still = 0.0, 0.0, 0.0
        wanted = self.turn(reference, still, still, terms._R_torso, terms._w_torso)
        linear.scale_rows(rows, 0, 1.0, scale, terms._J_torso, 0)
        algebra.put(target, algebra.subtract(wanted, algebra.vector(terms._bias_torso)))
