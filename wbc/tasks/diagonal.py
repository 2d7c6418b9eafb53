"""Terms of the cost that weigh single variables: posture, regularisation and the distribution of forces.

Each costs Σ weight_i (x_i - target_i)², which adds the weights to the diagonal of H and weight_i target_i to -g.
"""

import numpy as np
from numpy.typing import NDArray

from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.arm_swing import ArmSwing
from surefoot.wbc.types import GRAVITY, Array


class DiagonalTerm:
    """A cost on single variables."""

    def weigh(self, diagonal: Array) -> None:
        """Add the weights of the variables, shape (nv + 12,)."""
        raise NotImplementedError

    def put(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """Write weight times target of its variables into ``linear``, shape (nv + 12,), zero at first.

        Where the target is zero, that is nothing.
        """


class Regularisation(DiagonalTerm):
    """No generalised acceleration without a reason: what keeps H positive definite."""

    def __init__(self, weights: TaskWeights, length: float) -> None:
        """``length``: size of the robot, by which a rotation counts [-]."""
        self._weight = weights.acceleration, weights.acceleration * length**2

    def weigh(self, diagonal: Array) -> None:
        """See ``DiagonalTerm.weigh``."""
        diagonal[:3] += self._weight[0]
        diagonal[3:-12] += self._weight[1]


class Posture(DiagonalTerm):
    """Joint accelerations that return the joints to a posture, in which the arms may swing.

    K (q_0 + q_a - q) + D (q_a' - q') + q_a'' with the swing q_a of `ArmSwing`, which is zero for all but the shoulders.
    """

    def __init__(
        self,
        weights: TaskWeights,
        gains: TaskGains,
        posture: Array,
        leg_joints: NDArray[np.bool_],
        arms: ArmSwing | None = None,
        driven: NDArray[np.bool_] | None = None,
    ) -> None:
        """Prepare what never changes.

        Args:
            weights: of the joints.
            gains: stiffness and damping.
            posture: joint positions to return to, shape (nj,) [rad].
            leg_joints: which joints are leg joints, bool, shape (nj,).
            arms: how the arms swing; None for arms that keep the posture.
            driven: which joints somebody else drives, and keep none, bool, shape (nj,); None for none.
        """
        weight = np.where(leg_joints, weights.leg_posture, weights.upper_posture)
        weight = weight if driven is None else np.where(driven, 0.0, weight)
        stiffness, damping = gains.posture
        self._W, self._K, self._D = weight, stiffness * weight, damping * weight
        self._arms = arms
        self._pull = self._K * posture

    def weigh(self, diagonal: Array) -> None:
        """See ``DiagonalTerm.weigh``."""
        diagonal[6:-12] += self._W

    def put(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """See ``DiagonalTerm.put``."""
        for j in range(self._K.shape[0]):
            linear[6 + j] = self._pull[j] - self._K[j] * terms._q[7 + j] - self._D[j] * terms._v[6 + j]
        if self._arms is None:
            return
        arms = self._arms
        angle, rate, acceleration = arms.offset(terms, reference)
        left = self._K[arms.left] * angle + self._D[arms.left] * rate + self._W[arms.left] * acceleration
        right = self._K[arms.right] * angle + self._D[arms.right] * rate + self._W[arms.right] * acceleration
        linear[6 + arms.left] += arms.left_back * left
        linear[6 + arms.right] -= arms.right_back * right


class ForceDistribution(DiagonalTerm):
    """Sole forces near their planned share of the weight, moments near zero."""

    def __init__(self, weights: TaskWeights, wrench_unit: float) -> None:
        """``wrench_unit``: of the wrench variables [N, N·m]."""
        self._force = weights.force
        self._moment = weights.moment
        self._unit = wrench_unit
        self._g = GRAVITY

    def weigh(self, diagonal: Array) -> None:
        """See ``DiagonalTerm.weigh``."""
        diagonal[-12:] += np.tile([self._force] * 3 + [self._moment] * 3, 2) * self._unit**2

    def put(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """See ``DiagonalTerm.put``."""
        # The diagonal weighs forces in wrench units, their targets are shares of the weight.
        weight = self._force * terms.wrench_unit * terms.mass * self._g
        linear[terms.nv + 2] = weight * reference.load_share[0]
        linear[terms.nv + 8] = weight * reference.load_share[1]
