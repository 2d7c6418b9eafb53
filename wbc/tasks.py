"""Tasks of the whole-body QP: each gives the acceleration it wants and the rows that produce it."""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from wbc.model import RobotTerms
from wbc.qp import QpData, QpLayout
from wbc.types import GRAVITY, Array, WbcReference

LINEAR, ANGULAR, PELVIS, TORSO, SWING = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 18)
TASK_ROWS = 18


@dataclass(frozen=True, slots=True)
class TaskWeights:
    """Cost of a squared residual of each task.

    Attributes:
        com_horizontal, com_vertical: CoM acceleration [s^4/m^2].
        angular_momentum: rate of angular momentum over mass [s^4/m^4].
        orientation: angular acceleration of pelvis and torso [s^4].
        swing: linear [s^4/m^2] and angular [s^4] acceleration of the swing foot.
        upper_posture, leg_posture: joint acceleration of waist, arms and head, and of the legs [s^4].
        acceleration: any generalised acceleration.
        force, moment: deviation of a sole wrench from its planned share of the weight [1/N^2, 1/(N·m)^2].
    """

    com_horizontal: float = 10.0
    com_vertical: float = 2.5
    angular_momentum: float = 2.0
    orientation: float = 1.0
    swing: float = 10.0
    upper_posture: float = 0.5
    leg_posture: float = 1e-3
    acceleration: float = 1e-4
    force: float = 1e-6
    moment: float = 1e-4


@dataclass(frozen=True, slots=True)
class TaskGains:
    """Feedback of each task: stiffness [1/s^2] and damping [1/s].

    Attributes:
        orientation: of pelvis and torso.
        swing: of the swing foot, position and rotation.
        posture: of the joints towards the posture.
        angular_momentum: decay of the angular momentum [1/s].
    """

    orientation: tuple[float, float] = (40.0, 13.0)
    swing: tuple[float, float] = (400.0, 40.0)
    posture: tuple[float, float] = (20.0, 9.0)
    angular_momentum: float = 3.0


class TaskStack:
    """All tasks as one weighted least-squares cost.

    Rows (before weighting) and their sources:
    CoM from the sole forces, c'' = Σ R_k f_k / m - g; angular momentum over mass, L'/m = Σ [(p_k - c) x R_k f_k + R_k τ_k] / m
    (Newton-Euler of the whole body, e.g. Orin, Goswami and Lee, Autonomous Robots 2013); pelvis and torso angular
    acceleration; swing foot acceleration; then diagonal terms for posture and regularisation. The two momentum tasks act
    on forces, which the floating-base rows tie to the accelerations.
    """

    def __init__(
        self, layout: QpLayout, weights: TaskWeights, gains: TaskGains, posture: Array, leg_joints: Array
    ) -> None:
        """Prepare constant rows.

        Args:
            layout: of the QP.
            weights: of the tasks.
            gains: of the tasks.
            posture: joint positions to return to, shape (nj,) [rad].
            leg_joints: which joints are leg joints, bool, shape (nj,).
        """
        n, nv = layout.variables, layout.nv
        self._layout, self._weights, self._gains = layout, weights, gains
        self._posture = posture
        self._rows = np.zeros((TASK_ROWS, n))
        self._target = np.zeros(TASK_ROWS)
        self._scale = np.sqrt(_row_weights(weights))
        self._rows[PELVIS, 3:6] = self._scale[PELVIS, None] * np.eye(3)
        self._diagonal = np.zeros(n)
        self._diagonal_target = np.zeros(n)
        self._posture_weight = np.where(leg_joints, weights.leg_posture, weights.upper_posture)
        self._diagonal[:nv] = weights.acceleration
        self._diagonal[6:nv] += self._posture_weight
        self._diagonal[nv:] = np.tile([weights.force] * 3 + [weights.moment] * 3, 2)
        self._skew = np.zeros((2, 3, 3))

    def write(
        self, qp: QpData, terms: RobotTerms, q: Array, v: Array, com_acceleration: Array, reference: WbcReference
    ) -> None:
        """Write H and g of the QP for this state and reference; q (nq,), v (nv,), com_acceleration (3,) [m/s^2]."""
        self._momentum(terms, com_acceleration)
        self._trunk(terms, reference)
        self._swing(terms, reference)
        self._regularisation(terms, q, v, reference)
        H, g = qp.H, qp.g
        np.matmul(self._rows.T, self._rows, out=H)
        H.reshape(-1)[:: H.shape[0] + 1] += self._diagonal
        np.matmul(self._target, self._rows, out=g)
        g += self._diagonal * self._diagonal_target
        np.negative(g, out=g)

    def residual(self, x: Array) -> Array:
        """Unweighted residuals of the tasks at the solution x, shape (18,); rows of absent tasks are zero."""
        return (self._rows @ x - self._target) / self._scale

    def _momentum(self, terms: RobotTerms, com_acceleration: Array) -> None:
        nv, rows = self._layout.nv, self._rows
        R = terms.sole_rotation / terms.mass
        _skew_into(self._skew, terms.sole_position - terms.com)
        moment = self._skew @ R
        linear, angular = self._scale[LINEAR, None], self._scale[ANGULAR, None]
        for k in (0, 1):
            force = nv + 6 * k
            rows[LINEAR, force : force + 3] = linear * R[k]
            rows[ANGULAR, force : force + 3] = angular * moment[k]
            rows[ANGULAR, force + 3 : force + 6] = angular * R[k]
        self._target[LINEAR] = com_acceleration
        self._target[2] += GRAVITY
        self._target[LINEAR] *= self._scale[LINEAR]
        decay = -self._gains.angular_momentum / terms.mass
        self._target[ANGULAR] = (decay * self._scale[ANGULAR]) * terms.angular_momentum

    def _trunk(self, terms: RobotTerms, reference: WbcReference) -> None:
        upright = _rotation_z(reference.heading)
        pelvis = self._angular_acceleration(terms.base_rotation, terms.base_angular_velocity, upright, reference)
        torso = self._angular_acceleration(terms.torso_rotation, terms.torso_velocity, upright, reference)
        self._target[PELVIS] = self._scale[PELVIS] * pelvis
        self._target[TORSO] = self._scale[TORSO] * (torso - terms.torso_bias)
        self._rows[TORSO, : self._layout.nv] = self._scale[TORSO, None] * terms.torso_jacobian

    def _angular_acceleration(self, R: Array, omega: Array, desired: Array, reference: WbcReference) -> Array:
        stiffness, damping = self._gains.orientation
        rate: Array = R[2] * reference.heading_rate
        acceleration: Array = stiffness * pin.log3(R.T @ desired) + damping * (rate - omega)
        return acceleration

    def _swing(self, terms: RobotTerms, reference: WbcReference) -> None:
        nv, k = self._layout.nv, reference.swing_foot
        if k < 0:
            self._rows[SWING] = 0.0
            self._target[SWING] = 0.0
            return
        stiffness, damping = self._gains.swing
        R, velocity = terms.sole_rotation[k], terms.sole_velocity[k]
        yaw, yaw_rate, yaw_acceleration = reference.swing_yaw
        linear = reference.swing_acceleration + stiffness * (reference.swing_position - terms.sole_position[k])
        desired = np.empty(6)
        desired[:3] = (linear + damping * reference.swing_velocity) @ R - damping * velocity[:3]
        desired[3:] = stiffness * pin.log3(R.T @ _rotation_z(yaw)) - damping * velocity[3:]
        desired[3:] += R[2] * (yaw_acceleration + damping * yaw_rate)
        self._rows[SWING, :nv] = self._scale[SWING, None] * terms.sole_jacobian[k]
        self._target[SWING] = self._scale[SWING] * (desired - terms.sole_bias[k])

    def _regularisation(self, terms: RobotTerms, q: Array, v: Array, reference: WbcReference) -> None:
        nv = self._layout.nv
        stiffness, damping = self._gains.posture
        share = self._posture_weight / self._diagonal[6:nv]
        self._diagonal_target[6:nv] = share * (stiffness * (self._posture - q[7:]) - damping * v[6:])
        weight = terms.mass * GRAVITY
        self._diagonal_target[nv + 2] = weight * reference.load_share[0]
        self._diagonal_target[nv + 8] = weight * reference.load_share[1]


def _row_weights(weights: TaskWeights) -> Array:
    horizontal, vertical = weights.com_horizontal, weights.com_vertical
    linear = [horizontal, horizontal, vertical]
    trunk = [weights.orientation] * 6
    return np.array([*linear, *[weights.angular_momentum] * 3, *trunk, *[weights.swing] * 6])


def _rotation_z(yaw: float) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _skew_into(out: Array, vectors: Array) -> None:
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 2] = -vectors[:, 2], vectors[:, 1], -vectors[:, 0]
    out[:, 1, 0], out[:, 2, 0], out[:, 2, 1] = vectors[:, 2], -vectors[:, 1], vectors[:, 0]
