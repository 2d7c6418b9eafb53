"""Inverse kinematics: the walking posture for given feet, CoM and heading."""

from dataclasses import dataclass

import daqp
import numpy as np
import pinocchio as pin

from surefoot.wbc.body.leaning import FREE, line_frame
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames
from surefoot.wbc.types import Array


@dataclass(frozen=True, slots=True)
class PostureTarget:
    """The targets of the posture; world frame.

    Attributes:
        sole_position: sole centres, or centres of the lines on which leaning soles stand, shape (2, 3) [m].
        sole_yaw: headings of the soles, shape (2,) [rad].
        com: CoM, shape (3,) [m]; None leaves it free.
        heading: yaw of the upright pelvis and torso [rad]; None leaves both free.
        sole_tilt: pitch, then roll of the soles, in that order after their yaw, shape (2, 2) [rad]; None: level.
        rolling: whether the pelvis may roll under the torso.
    """

    sole_position: Array
    sole_yaw: Array
    com: Array | None = None
    heading: float | None = None
    sole_tilt: Array | None = None
    rolling: bool = False

    def sole_rotation(self, k: int) -> Array:
        """Orientation of sole k, shape (3, 3) [-]."""
        turned: Array = pin.utils.rotate("z", float(self.sole_yaw[k]))
        if self.sole_tilt is None:
            return turned
        pitch, roll = self.sole_tilt[k].tolist()
        tilted: Array = turned @ pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", roll)
        return tilted


@dataclass(frozen=True, slots=True)
class PostureResult:
    """Outcome of the search.

    Attributes:
        q: configuration, shape (nq,) [m, -, rad].
        error: largest remaining error over sole positions and CoM [m] and sole, pelvis and torso rotations [rad].
        reached: whether the error is within the tolerance.
        iterations: Gauss-Newton steps taken.
    """

    q: Array
    error: float
    reached: bool
    iterations: int


@dataclass(frozen=True, slots=True)
class PostureStep:
    """QP of one step: minimise 1/2 dqᵀ H dq + gᵀ dq subject to lower <= dq <= upper.

    Attributes:
        H: shape (nv, nv), positive definite.
        g: shape (nv,).
        lower, upper: shape (nv,) [m, rad].
        q: where it begins, shape (nq,).
        error: largest error there [m, rad].
    """

    H: Array
    g: Array
    lower: Array
    upper: Array
    q: Array
    error: float


class PostureIk:
    """Gauss-Newton on the manifold of configurations; each step is a QP within the joint limits.

    Minimises ||J dq - e||² + μ ||dq_joints - (posture - q)||² + ν ||dq||² with J and e of all tasks in local frames.
    Tasks are consistent wherever the legs can reach, so the small μ only chooses among the solutions.
    """

    def __init__(self, model: pin.Model, frames: BodyFrames, limits: JointLimits, posture: Array) -> None:
        """Search postures.

        Args:
            model: the robot.
            frames: those of its bodies.
            limits: of its joints.
            posture: joint positions near which is searched, shape (nj,) [rad].
        """
        self._model, self._data = model, model.createData()
        self._soles = tuple(model.getFrameId(name) for name in frames.soles)
        self._torso = model.getFrameId(frames.torso)
        self._limits, self._posture = limits, posture
        self._leaning = frames.leaning

    def solve(
        self, target: PostureTarget, q: Array, tolerance: float = 1e-7, max_iterations: int = 60, nearness: float = 1e-9
    ) -> PostureResult:
        """Find a posture.

        Args:
            target: what to fulfil.
            q: where to start, shape (nq,) [m, -, rad].
            tolerance: of the error [m, rad].
            max_iterations: bound on the steps.
            nearness: weight μ of the posture against the tasks [-].

        Returns:
            The posture found; with ``reached`` False the nearest one, e.g. for a stance beyond the legs' length.
        """
        error = np.inf
        for iteration in range(max_iterations):
            step = self.build_step(target, q, nearness)
            error = step.error
            if error <= tolerance:
                return PostureResult(q, error, True, iteration)
            q = pin.integrate(self._model, q, self.solve_step(step))
        return PostureResult(q, error, False, max_iterations)

    def build_step(self, target: PostureTarget, q: Array, nearness: float = 1e-9) -> PostureStep:
        """The QP of the step from q, shape (nq,) [m, -, rad]; ``nearness`` as in ``solve``."""
        J, e = self.linearise(target, q)
        nv = self._model.nv
        H = J.T @ J + 1e-10 * np.eye(nv)
        H[6:, 6:] += nearness * np.eye(nv - 6)
        g = -J.T @ e
        g[6:] -= nearness * (self._posture - q[7:])
        # A step of at most 0.3 rad or m keeps the linearisation honest; joints stop at their limits.
        lower, upper = np.full(nv, -0.3), np.full(nv, 0.3)
        lower[6:] = np.minimum(np.maximum(lower[6:], self._limits.lower - q[7:]), 0.3)
        upper[6:] = np.maximum(np.minimum(upper[6:], self._limits.upper - q[7:]), lower[6:])
        return PostureStep(H, g, lower, upper, q, float(np.abs(e).max()))

    def solve_step(self, step: PostureStep) -> Array:
        """The step dq, shape (nv,) [m, rad].

        Raises:
            ArithmeticError: the solver finds none, since the problem is no number.
        """
        n = self._model.nv
        found, _, flag, _ = daqp.solve(
            step.H, step.g, np.zeros((0, n)), step.upper, step.lower, np.zeros(n, dtype=np.intc)
        )
        if flag <= 0:
            raise ArithmeticError(
                f"posture step of robot '{self._model.name}' has no solution: joint positions {step.q[7:]}"
            )
        return np.asarray(found, dtype=np.float64)

    def linearise(self, target: PostureTarget, q: Array) -> tuple[Array, Array]:
        """J, shape (rows, nv), and e, shape (rows,) [m, rad], of all tasks at q, shape (nq,), each in its own frame."""
        model, data = self._model, self._data
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        jacobians: list[Array] = []
        errors: list[Array] = []
        for k, frame in enumerate(self._soles):
            J, error = self._sole(k, frame, target)
            errors.append(error)
            jacobians.append(J)
        if target.heading is not None:
            self._append_trunk(jacobians, errors, target.heading, 1 if target.rolling else 0)
        if target.com is not None:
            jacobians.append(pin.jacobianCenterOfMass(model, data, q))
            errors.append(target.com - data.com[0])
        return np.vstack(jacobians), np.concatenate(errors)

    def _sole(self, k: int, frame: int, target: PostureTarget) -> tuple[Array, Array]:
        """J, shape (6, nv), and e, shape (6,), of a sole; nothing about the line on which a leaning one stands."""
        placement = self._data.oMf[frame]
        J: Array = pin.getFrameJacobian(self._model, self._data, frame, pin.ReferenceFrame.LOCAL)
        desired = pin.SE3(target.sole_rotation(k), target.sole_position[k])
        if self._leaning is None:
            return J, pin.log6(placement.actInv(desired)).vector
        line = line_frame(k, placement.rotation, self._leaning)
        J, error = line.toActionMatrixInverse() @ J, pin.log6((placement * line).actInv(desired)).vector
        J[FREE], error[FREE] = 0.0, 0.0
        return J, error

    def _append_trunk(self, jacobians: list[Array], errors: list[Array], heading: float, first: int) -> None:
        """The pelvis, upright about its axes from the first of roll, pitch and yaw on, and the torso about all."""
        model, data = self._model, self._data
        upright = pin.utils.rotate("z", float(heading))
        errors.append(pin.log3(data.oMi[1].rotation.T @ upright)[first:])
        jacobians.append(np.hstack([np.zeros((3, 3)), np.eye(3), np.zeros((3, model.nv - 6))])[first:])
        errors.append(pin.log3(data.oMf[self._torso].rotation.T @ upright))
        jacobians.append(pin.getFrameJacobian(model, data, self._torso, pin.ReferenceFrame.LOCAL)[3:])
