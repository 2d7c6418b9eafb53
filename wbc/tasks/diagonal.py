"""Terms of the cost that weigh single variables: posture, regularisation and the distribution of forces.

Each costs Σ weight_i (x_i - target_i)², which adds the weights to the diagonal of H and weight_i target_i to -g.
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.wbc.arm_swing import ArmSwing
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.types import GRAVITY, Array, WbcReference


class DiagonalTerm(Protocol):
    """A cost on single variables."""

    def weigh(self, diagonal: Array, catching: bool) -> None:
        """Add the weights of the variables, shape (nv + 12,), and count so from now on.

        Args:
            diagonal: to be added to.
            catching: as where a step catches the body, in place of a walk.
        """

    def write(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """Write weight times target of its variables into ``linear``, shape (nv + 12,), zero at first."""

    def compiled(self, tick: CompiledTick, linear: Array) -> Callable[[], None] | None:
        """A kernel that does what ``write`` does; None where that is nothing."""


class Regularisation:
    """No generalised acceleration without a reason: what keeps H positive definite."""

    def __init__(self, weights: TaskWeights, length: float) -> None:
        """``length``: size of the robot, by which a rotation counts [-]."""
        self._weight = weights.acceleration, weights.acceleration * length**2

    def weigh(self, diagonal: Array, catching: bool) -> None:
        """See ``DiagonalTerm.weigh``."""
        diagonal[:3] += self._weight[0]
        diagonal[3:-12] += self._weight[1]

    def write(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """Nothing: the target is zero."""

    def compiled(self, tick: CompiledTick, linear: Array) -> None:
        """None is needed."""


class Posture:
    """Joint accelerations that return the joints to a posture, in which the arms may swing: K (q_0 - q) - D q'."""

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
        uppers = weights.upper_posture, weights.upper_posture_catching
        self._weights = [np.where(leg_joints, weights.leg_posture, upper) for upper in uppers]
        if driven is not None:
            self._weights = [np.where(driven, 0.0, weight) for weight in self._weights]
        self._gains, self._posture, self._arms = gains.posture, posture, arms
        # In place, since the kernel has views of them.
        self._stiffness, self._damping, self._pull = np.zeros((3, len(posture)))

    def weigh(self, diagonal: Array, catching: bool) -> None:
        """See ``DiagonalTerm.weigh``."""
        weight, (stiffness, damping) = self._weights[catching], self._gains
        np.multiply(stiffness, weight, out=self._stiffness)
        np.multiply(damping, weight, out=self._damping)
        np.multiply(self._stiffness, self._posture, out=self._pull)
        diagonal[6:-12] += weight

    def write(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """See ``DiagonalTerm.write``."""
        joints = linear[6:-12]
        np.multiply(self._stiffness, terms.q[7:], out=joints)
        np.subtract(self._pull, joints, out=joints)
        joints -= self._damping * terms.v[6:]
        if self._arms is not None:
            self._swing_arms(self._arms, terms, joints)

    def compiled(self, tick: CompiledTick, linear: Array) -> Callable[[], None]:
        """See ``DiagonalTerm.compiled``."""
        arms = self._arms or ArmSwing((0, 0), 0.0)
        return tick.kernels.bind(
            "cost_posture",
            terms=tick.terms,
            joints=len(self._pull),
            stiffness=self._stiffness,
            damping=self._damping,
            pull=self._pull,
            arm_gain=arms.gain,
            left_arm=arms.joints[0],
            right_arm=arms.joints[1],
            left_back=arms.back[0],
            right_back=arms.back[1],
            linear=linear,
        )

    def _swing_arms(self, arms: ArmSwing, terms: RobotTerms, joints: Array) -> None:
        angle, rate = arms.offset(terms)
        left, right = arms.back
        for joint, sign in zip(arms.joints, (left, -right), strict=True):
            joints[joint] += sign * (self._stiffness.item(joint) * angle + self._damping.item(joint) * rate)


class ForceDistribution:
    """Sole forces near their planned share of the weight, moments near zero."""

    def __init__(self, weights: TaskWeights, wrench_unit: float) -> None:
        """``wrench_unit``: of the wrench variables [N, N·m]."""
        self._force, self._moment, self._unit = weights.force, weights.moment, wrench_unit

    def weigh(self, diagonal: Array, catching: bool) -> None:
        """See ``DiagonalTerm.weigh``."""
        diagonal[-12:] += np.tile([self._force] * 3 + [self._moment] * 3, 2) * self._unit**2

    def write(self, terms: RobotTerms, reference: WbcReference, linear: Array) -> None:
        """See ``DiagonalTerm.write``."""
        # The diagonal weighs forces in wrench units, their targets are shares of the weight.
        weight = self._force * self._unit * terms.mass * GRAVITY
        left, right = reference.load_share
        linear[-10::6] = (weight * left, weight * right)

    def compiled(self, tick: CompiledTick, linear: Array) -> Callable[[], None]:
        """See ``DiagonalTerm.compiled``."""
        return tick.kernels.bind(
            "cost_force_distribution",
            terms=tick.terms,
            reference=tick.reference,
            force=self._force,
            gravity=GRAVITY,
            linear=linear,
        )
