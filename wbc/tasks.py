"""Tasks of the whole-body QP: each gives the acceleration it wants and the rows that produce it."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.wbc.arm_swing import ArmSwing
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.qp import QpData, QpLayout
from surefoot.wbc.types import GRAVITY, Array, WbcReference

LINEAR, ANGULAR, PELVIS, TORSO, SWING = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 18)
TASK_ROWS = 18

Vector = tuple[float, float, float]


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
    leg_posture: float = 1e-5
    acceleration: float = 1e-5
    force: float = 1e-6
    moment: float = 1e-4


@dataclass(frozen=True, slots=True)
class TaskGains:
    """Feedback of each task: stiffness [1/s^2] and damping [1/s].

    Attributes:
        orientation: of pelvis and torso; 40 / s^2 let a trunk fold at the waist whose mass sits 0.2 m higher than the
            model says, more than 250 / s^2 pays for 1 degree of start noise with a ZMP at the edge.
        swing: of the swing foot, position and rotation.
        posture: of the joints towards the posture.
        angular_momentum: decay of the angular momentum [1/s].
    """

    orientation: tuple[float, float] = (250.0, 32.0)
    swing: tuple[float, float] = (400.0, 40.0)
    posture: tuple[float, float] = (20.0, 9.0)
    angular_momentum: float = 3.0


class TaskStack:
    """All tasks as one weighted least-squares cost.

    Rows (before weighting) and their sources:
    CoM from the sole forces, c'' = Σ R_k f_k / m - g; angular momentum over mass,
    L'/m = Σ [(p_k - c) x R_k f_k + R_k τ_k] / m (Newton-Euler of the whole body, e.g. Orin, Goswami and Lee, Autonomous
    Robots 2013); pelvis and torso angular acceleration; swing foot acceleration; then diagonal terms for posture and
    regularisation. The two momentum tasks act on forces, which the floating-base rows tie to the accelerations.

    With weighted rows T and targets t, a diagonal D and its linear term d: H = TᵀT + D and g = -(Tᵀt + d).
    """

    def __init__(
        self,
        qp: QpData,
        layout: QpLayout,
        mass: float,
        weights: TaskWeights,
        gains: TaskGains,
        posture: Array,
        leg_joints: NDArray[np.bool_],
        arms: ArmSwing | None = None,
        toe: float = 0.0,
    ) -> None:
        """Prepare what never changes.

        Args:
            qp: whose H and g this writes.
            layout: of the QP.
            mass: of the robot [kg].
            weights: of the tasks.
            gains: of the tasks.
            posture: joint positions to return to, shape (nj,) [rad].
            leg_joints: which joints are leg joints, bool, shape (nj,).
            arms: how the arms swing; None for arms that keep the posture.
            toe: toe edge from the sole's centre [m].
        """
        self._arms, self._toe = arms, toe
        self._gains, self._unit, self._force_weight = gains, layout.wrench_unit, weights.force
        scale = self._scale = np.sqrt(_row_weights(weights))
        self._unscale = np.divide(1.0, scale, out=np.zeros(TASK_ROWS), where=scale > 0.0)
        self._orientation_scale, self._swing_scale = float(scale[9]), float(scale[12])
        self._rows, self._target = np.zeros((TASK_ROWS, layout.variables)), np.zeros(TASK_ROWS)
        self._rows[PELVIS, 3:6] = np.diag(scale[PELVIS])
        self._upright = np.eye(3)
        self._from_origin = np.diag(scale[:6] * (self._unit / mass))
        self._moment_scale = float(self._from_origin[5, 5])
        posture_weight = np.where(leg_joints, weights.leg_posture, weights.upper_posture)
        self._diagonal, self._linear = _diagonal(layout, weights, posture_weight), np.zeros(layout.variables)
        self._stiffness, self._damping = gains.posture[0] * posture_weight, gains.posture[1] * posture_weight
        self._pull = self._stiffness * posture
        self._bind(qp, layout)

    def _bind(self, qp: QpData, layout: QpLayout) -> None:
        # A view costs as much to make as to use, so the parts of rows and cost get their names once.
        nv, rows = layout.nv, self._rows
        self._momentum_rows, self._torso_rows, self._swing_rows = rows[:6, nv:], rows[TORSO, :nv], rows[SWING, :nv]
        self._joint_linear, self._loads = self._linear[6:nv], self._linear[nv + 2 :: 6]
        self._H, self._g, self._H_diagonal = qp.H, qp.g, qp.H.reshape(-1)[:: layout.variables + 1]
        self._lever = self._from_origin[3:, :3]

    def write(self, terms: RobotTerms, q: Array, v: Array, com_acceleration: Vector, reference: WbcReference) -> None:
        """Write H and g of the QP for this state and reference; q (nq,), v (nv,), com_acceleration [m/s^2]."""
        momentum = self._momentum(terms, com_acceleration)
        trunk = self._trunk(terms, reference)
        self._target[:] = momentum + trunk + self._swing(terms, reference)
        self._target *= self._scale
        self._regularisation(terms, q, v, reference)
        np.matmul(self._rows.T, self._rows, out=self._H)
        self._H_diagonal += self._diagonal
        np.matmul(self._target, self._rows, out=self._g)
        self._g += self._linear
        np.negative(self._g, out=self._g)

    def residual(self, x: Array) -> Array:
        """Unweighted residuals of the tasks at the solution x, shape (18,); rows of absent tasks are zero."""
        residual: Array = self._rows @ x
        residual -= self._target
        residual *= self._unscale
        return residual

    def _momentum(self, terms: RobotTerms, com_acceleration: Vector) -> tuple[float, ...]:
        """Rows of force F and moment M - c x F about the CoM, M being about the origin; returns their targets."""
        scale = self._moment_scale
        x, y, z = terms.com.tolist()
        x, y, z = scale * x, scale * y, scale * z
        self._lever[:] = ((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))
        np.matmul(self._from_origin, terms.sole_wrench_map, out=self._momentum_rows)
        decay = -self._gains.angular_momentum / terms.mass
        lx, ly, lz = terms.angular_momentum.tolist()
        ax, ay, az = com_acceleration
        return ax, ay, az + GRAVITY, decay * lx, decay * ly, decay * lz

    def _trunk(self, terms: RobotTerms, reference: WbcReference) -> tuple[float, ...]:
        """Rows of the torso; returns the targets of pelvis and torso."""
        np.multiply(terms.torso_jacobian, self._orientation_scale, out=self._torso_rows)
        _turn(self._upright, reference.heading)
        gains = self._gains.orientation
        turn = np.array((0.0, 0.0, gains[1] * reference.heading_rate))
        pelvis = _angular(gains, terms.base_rotation, terms.base_angular_velocity, self._upright, turn)
        x, y, z = _angular(gains, terms.torso_rotation, terms.torso_velocity, self._upright, turn)
        bx, by, bz = terms.torso_bias.tolist()
        return (*pelvis, x - bx, y - by, z - bz)

    def _swing(self, terms: RobotTerms, reference: WbcReference) -> tuple[float, ...]:
        """Rows of the swing foot; returns its targets."""
        k = reference.swing_foot
        if k < 0:
            self._swing_rows[:] = 0.0
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        np.multiply(terms.sole_jacobian[k], self._swing_scale, out=self._swing_rows)
        (stiffness, damping), R, velocity = self._gains.swing, terms.contact_rotation[k], terms.sole_velocity[k]
        wanted = reference.swing_position - terms.contact_position[k]
        pitching = 0.0
        if k == reference.rolling_foot:
            wanted += self._toe * reference.swing_rotation[:, 0]
            pitching = damping * reference.roll[1] + reference.roll[2]
        wanted *= stiffness
        wanted += damping * reference.swing_velocity
        wanted += reference.swing_acceleration
        x, y, z = (wanted @ R).tolist()
        turning = reference.swing_angular_acceleration + damping * reference.swing_angular_velocity
        ax, ay, az = _angular(self._gains.swing, R, velocity[3:], reference.swing_rotation, turning)
        vx, vy, vz = velocity[:3].tolist()
        bx, by, bz, px, py, pz = terms.sole_bias[k].tolist()
        linear = (x - damping * vx - bx, y - damping * vy - by, z - damping * vz - bz)
        return (*linear, ax - px, ay + pitching - py, az - pz)

    def _regularisation(self, terms: RobotTerms, q: Array, v: Array, reference: WbcReference) -> None:
        linear = self._joint_linear
        np.multiply(self._stiffness, q[7:], out=linear)
        np.subtract(self._pull, linear, out=linear)
        linear -= self._damping * v[6:]
        if self._arms is not None:
            self._swing_arms(self._arms, terms)
        # The diagonal weighs forces in wrench units, their targets are shares of the weight.
        weight = self._force_weight * self._unit * terms.mass * GRAVITY
        self._loads[:] = (weight * reference.load_share[0], weight * reference.load_share[1])

    def _swing_arms(self, arms: ArmSwing, terms: RobotTerms) -> None:
        angle, rate = arms.offset(terms)
        for joint, sign in zip(arms.joints, (1.0, -1.0), strict=True):
            self._linear[6 + joint] += sign * float(self._stiffness[joint] * angle + self._damping[joint] * rate)


def _angular(gains: tuple[float, float], R: Array, velocity: Array, desired: Array, feedforward: Array) -> Vector:
    """Angular acceleration, in the frame of R, towards ``desired``; feedforward, shape (3,) [rad/s^2], in the world."""
    stiffness, damping = gains
    ex, ey, ez = pin.log3(R.T @ desired).tolist()
    wx, wy, wz = velocity.tolist()
    ux, uy, uz = (feedforward @ R).tolist()
    return (
        stiffness * ex - damping * wx + ux,
        stiffness * ey - damping * wy + uy,
        stiffness * ez - damping * wz + uz,
    )


def _turn(rotation: Array, yaw: float) -> None:
    """Make ``rotation`` a turn about the vertical."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    rotation[:2, :2] = ((cosine, -sine), (sine, cosine))


def _diagonal(layout: QpLayout, weights: TaskWeights, posture_weight: Array) -> Array:
    nv = layout.nv
    diagonal = np.full(layout.variables, weights.acceleration)
    diagonal[6:nv] += posture_weight
    diagonal[nv:] = np.tile([weights.force] * 3 + [weights.moment] * 3, 2) * layout.wrench_unit**2
    return diagonal


def _row_weights(weights: TaskWeights) -> Array:
    horizontal, vertical = weights.com_horizontal, weights.com_vertical
    linear = [horizontal, horizontal, vertical]
    trunk = [weights.orientation] * 6
    return np.array([*linear, *[weights.angular_momentum] * 3, *trunk, *[weights.swing] * 6])
