"""The Pinocchio terms of one state, computed once and shared by every task, contact and limit."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import Dynamics, JointColumns
from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.maths import algebra, linear
from surefoot.wbc.body import soles
from surefoot.wbc.body.frame import Frame
from surefoot.wbc.body.leaning import line_centre, line_frame
from surefoot.wbc.qp.data import WRENCH_UNIT
from surefoot.wbc.types import GRAVITY, Array

_LOCAL = pin.ReferenceFrame.LOCAL

VERTICAL = np.array([[0.0, 0.0, 1.0]] * 2)
"""Normals of level ground under both feet [-]."""


@dataclass(frozen=True, slots=True)
class BodyFrames:
    """Names of the frames that the controller steers.

    Attributes:
        soles: frames at the centres of the soles, (left, right), x forward and z up.
        torso: frame of the torso.
        leaning: half width of soles that lean with their shanks (see `surefoot.wbc.body.leaning`); None for soles that
            the legs can turn as they like [m].
    """

    soles: tuple[str, str]
    torso: str
    leaning: float | None = None


class RobotTerms:
    """Dynamics, centroidal quantities and frame kinematics of the current state.

    The pelvis is the floating base. Frame Jacobians, velocities and bias accelerations are local to their frame and
    classical: what an accelerometer at the frame would add to gravity. So one sole Jacobian serves the contact
    constraint, the swing task and the map from sole wrenches to generalised forces. Every array is a buffer that
    ``update`` overwrites.

    A foot may be seen from another frame fixed to it (see ``shift_foot``): the arrays that begin with ``contact_``, the
    sole Jacobians, velocities and biases, and the wrench map, are then of that frame.

    A robot may be heavier than its model, and pulled at (see ``bear``): total mass, mass matrix and bias are then of
    that; all else stays the model's.

    Attributes:
        model: Pinocchio's.
        data: Pinocchio's, as ``pin.computeAllTerms`` leaves it, but for a load.
        columns: of its Jacobian, one for each velocity.
        q: configuration of the last update, shape (nq,) [m, -, rad].
        v: velocity of the last update, shape (nv,) [m/s, rad/s].
        model_mass: total mass of the model [kg].
        mass: total mass [kg].
        load: what else acts on the robot.
        is_finite: whether q and v of the last update are.
        is_shifted: whether a foot is seen from elsewhere than its sole.
        wrench_unit: of the QP's wrench variables [N, N·m].
        mass_matrix: M, shape (nv, nv) [kg, kg·m, kg·m^2].
        bias: Coriolis, centrifugal, gravity and load terms h, shape (nv,) [N, N·m].
        com: in the world frame, shape (3,) [m].
        com_velocity: in the world frame, shape (3,) [m/s].
        angular_momentum: about the CoM, in the world frame, shape (3,) [kg·m^2/s].
        base_rotation: orientation of the pelvis in the world, shape (3, 3).
        torso_rotation: orientation of the torso in the world, shape (3, 3).
        base_angular_velocity: in the base frame, shape (3,) [rad/s].
        sole_position: sole centres in the world frame, shape (2, 3) [m].
        sole_rotation: orientations of the soles in the world, shape (2, 3, 3).
        sole_pose: x y z qx qy qz qw of the soles in the world, shape (2, 7) [m, -].
        contact_position: sole_position unless shifted, shape (2, 3) [m].
        contact_rotation: sole_rotation unless shifted, shape (2, 3, 3).
        sole_jacobian: from v to the soles' velocities, linear and angular, shape (2, 6, nv).
        contact_jacobian: the same memory, shape (12, nv).
        sole_velocity: linear and angular, each in the frame of its sole, shape (2, 6) [m/s, rad/s].
        sole_bias: accelerations of the soles with v' = 0, shape (2, 6) [m/s^2, rad/s^2].
        sole_wrench_map: from both sole wrenches to their force and moment about the world's origin, shape (6, 12).
        torso_position: in the world frame, shape (3,) [m].
        leaning: half width of soles that lean (see `BodyFrames`); None for others [m].
        waist: whether the torso can move against the pelvis.
        torso_jacobian: from v to the torso's angular velocity, shape (3, nv).
        torso_velocity: angular, in its frame, shape (3,) [rad/s].
        torso_bias: angular acceleration with v' = 0, shape (3,) [rad/s^2].
    """

    def __init__(self, model: pin.Model, frames: BodyFrames, wrench_unit: float = WRENCH_UNIT) -> None:
        """Allocate all terms; the wrench unit is the reference robot's unless given.

        Raises:
            ValueError: if a frame does not exist or the model's gravity is not ``GRAVITY`` downwards.
        """
        if not np.allclose(model.gravity.linear, [0.0, 0.0, -GRAVITY], atol=1e-12):
            raise ValueError(
                f"gravity of model '{model.name}' is {model.gravity.linear}; it must be [0, 0, -{GRAVITY}]"
            )
        self.model = model
        self.data = data = model.createData()
        self.columns, self._dynamics = JointColumns(model, data), Dynamics(model, data)
        left, right = frames.soles
        soles = _frame_id(model, left), _frame_id(model, right)
        self._torso_frame = torso = _frame_id(model, frames.torso)
        self.leaning = frames.leaning
        self.waist = model.frames[torso].parentJoint != 1
        self.mass = self.model_mass = float(sum(inertia.mass for inertia in model.inertias))
        self.nv, self.wrench_unit = model.nv, wrench_unit
        self._view(data, torso)
        self._allocate(model)
        J = self.columns.values
        self._left, self._right = (
            Frame(model, data, sole, J, self.sole_jacobian[k], self.sole_velocity[k], self.sole_bias[k])
            for k, sole in enumerate(soles)
        )
        motion = np.zeros((6, model.nv)), np.zeros(6), np.zeros(6)
        self._torso = Frame(model, data, torso, J, *motion)
        self.torso_jacobian, self.torso_velocity, self.torso_bias = (part[3:] for part in motion)
        self._name()

    def _view(self, data: pin.Data, torso: int) -> None:
        """Views of Pinocchio's own memory, which need no copy."""
        # M is symmetric and column-major: its transpose is contiguous.
        self.mass_matrix: Array = data.M.T
        self._mass_diagonal: Array = np.einsum("ii->i", data.M)
        self.bias: Array = data.nle
        self.com: Array = data.com[0]
        self.angular_momentum: Array = data.hg.angular
        self._linear_momentum: Array = data.hg.linear
        self._momentum: Array = data.h[0].vector
        self.base_rotation: Array = data.oMi[1].rotation
        self.torso_rotation: Array = data.oMf[torso].rotation
        self.torso_position: Array = data.oMf[torso].translation

    def _allocate(self, model: pin.Model) -> None:
        nv = model.nv
        self.q: Array = pin.neutral(model)
        self.v: Array = np.zeros(nv)
        self.com_velocity, self.base_angular_velocity = np.zeros(3), np.zeros(3)
        self.sole_position, self.sole_rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self.sole_pose = np.zeros((2, 7))
        self.contact_position, self.contact_rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self.contact_jacobian = np.zeros((12, nv))
        self.sole_jacobian = self.contact_jacobian.reshape(2, 6, nv)
        self.sole_velocity, self.sole_bias = np.zeros((2, 6)), np.zeros((2, 6))
        self.sole_wrench_map = np.zeros((6, 12))
        self.load, self._load_force, self._load_moment = NO_LOAD, np.zeros(3), np.zeros(3)
        self._to_sole = np.zeros((6, 6))
        self._shifted_left = self._shifted_right = self.is_shifted = False
        self.is_finite = True

    def _name(self) -> None:
        """Name the same memory for compiled laws."""
        self._q = self.q
        self._v = self.v
        self._c = self.com
        self._c_dot = self.com_velocity
        self._L, self._h = self.angular_momentum, self.bias
        self._M, self._J, self._W = self.mass_matrix, self.contact_jacobian, self.sole_wrench_map
        self._R_base, self._w_base = self.base_rotation, self.base_angular_velocity
        self._R_torso, self._w_torso = self.torso_rotation, self.torso_velocity
        self._J_torso, self._bias_torso = self.torso_jacobian, self.torso_bias
        self._p_sole, self._R_sole, self._pose = self.sole_position, self.sole_rotation, self.sole_pose
        self._p_contact, self._R_contact = self.contact_position, self.contact_rotation
        self._v_sole, self._bias_sole = self.sole_velocity, self.sole_bias

    def update(self, q: Array, v: Array) -> None:
        """Compute every term at configuration q, shape (nq,), and velocity v, shape (nv,)."""
        self.q[...], self.v[...] = q, v  # numpy.copyto goes through Python first
        # Leaves in data.a the velocity-product accelerations, those of zero generalised acceleration.
        self._dynamics.all_terms(q, v)
        self.columns.update()
        if self.load is not NO_LOAD:
            self.mass = self.model_mass
            self._carry(NO_LOAD)
        self._shifted_left = self._shifted_right = self.is_shifted = False
        self._update()

    def _update(self) -> None:
        """Work out what follows from Pinocchio's terms."""
        self.is_finite = math.isfinite(linear.dot(self._q, self._q)) and math.isfinite(linear.dot(self._v, self._v))
        for i in range(3):
            self._c_dot[i] = self._linear_momentum[i] / self.model_mass
            self._w_base[i] = self._v[3 + i]
        self._update_sole(0)
        self._update_sole(1)
        self._torso.update()

    def place(self, q: Array, v: Array) -> None:
        """Compute where the robot is, as `update` does, in less than half its time.

        That is all that a record takes of a state: CoM, its velocity, angular momentum, orientations of pelvis and
        torso, and places of the soles. What else is there stays that of the last update.

        Args:
            q: configuration, shape (nq,) [m, -, rad].
            v: velocity, shape (nv,) [m/s, rad/s].
        """
        self.q[...], self.v[...] = q, v
        # The CoM of computeAllTerms is that of ccrba, and its momentum that of the other, about another CoM; on
        # processors of x86-64 to the bit.
        pin.computeCentroidalMomentum(self.model, self.data, q, v)
        pin.ccrba(self.model, self.data, q, v)
        self._place()

    def _place(self) -> None:
        """Work out what follows: the momentum of the one about the CoM of the other."""
        h = self._momentum
        p = (h[0], h[1], h[2])
        turn = algebra.cross(p, algebra.vector(self._c))
        for i in range(3):
            self._c_dot[i] = h[i] / self.model_mass
        self._L[0], self._L[1], self._L[2] = h[3] + turn[0], h[4] + turn[1], h[5] + turn[2]
        self._left.place()
        self._right.place()
        self._torso.place()
        self._place_sole(0)
        self._place_sole(1)

    def bear(self, load: ExternalLoad) -> None:
        """Count with a load until the next update.

        What a robot is heavier than its model all its bodies share, but for the rotors' inertia. Where a force acts
        nobody knows: on the torso, at the point that gives its moment.

        Args:
            load: what acts on the robot.
        """
        if load is NO_LOAD:
            return
        scale = load.mass_scale
        if scale != 1.0:
            self.mass = scale * self.model_mass
            self.mass_matrix *= scale
            self._mass_diagonal += (1.0 - scale) * self.model.armature
            self.bias *= scale
        R = self.torso_rotation
        arm = algebra.subtract(algebra.vector(self.com), algebra.vector(self.torso_position))
        moment = load.moment + np.array(algebra.cross(arm, algebra.vector(load.force)))
        torso = pin.getFrameJacobian(self.model, self.data, self._torso_frame, _LOCAL)
        self.bias -= np.concatenate((load.force @ R, moment @ R)) @ torso
        self._carry(load)

    def _carry(self, load: ExternalLoad) -> None:
        self.load, force, moment = load, load.force, load.moment
        self._load_force[:], self._load_moment[:] = force, moment

    def _sole(self, k: int) -> Frame:
        return self._right if k else self._left

    def _update_sole(self, k: int) -> None:
        """All of a sole, seen from its centre."""
        self._sole(k).update()
        self._place_sole(k)
        self._p_contact[k, :] = self._p_sole[k]
        self._R_contact[k, :, :] = self._R_sole[k]
        algebra.see_wrench(self._R_sole[k], algebra.vector(self._p_sole[k]), self._W[:, 6 * k : 6 * k + 6])

    def _place_sole(self, k: int) -> None:
        """Place a sole, of a frame that is in its place."""
        frame, pose = self._sole(k), self._pose[k]
        self._R_sole[k, :, :] = frame.rotation
        self._p_sole[k, :] = frame.position
        pose[:3] = frame.position
        algebra.quaternion(self._R_sole[k], pose[3:])

    def level_soles(self, toe: float, heel: float, normal: Array = VERTICAL) -> Array:
        """Centres of the soles if each foot turned flat on the ground about an edge of it, shape (2, 3) [m].

        Of leaning soles, the centres of the lines on which they stand.

        Args:
            toe: line about which a foot turns whose heel is up, ahead of the sole's centre [m].
            heel: that about which one turns whose toes are up [m].
            normal: of the ground under each of them, shape (2, 3) [-].
        """
        position = self.sole_position
        if self.leaning is not None:
            position = np.array([line_centre(k, position[k], self.sole_rotation[k], self.leaning) for k in (0, 1)])
        return soles.level(position, self.sole_rotation, toe, heel, normal)

    def shift_foot(self, k: int, forward: float, pitch: float) -> Array:
        """See foot k from a frame at a point ahead of its sole's centre, turned back by a pitch, until it is unshifted.

        Of a leaning sole, ahead of the centre of the line on which it stands, and turned back to level with it.

        Args:
            k: foot.
            forward: from the sole's centre along its x axis [m].
            pitch: angle by which the foot is to be turned, heel up; the frame of a foot turned so is level [rad].

        Returns:
            What takes a wrench from the new frame to the sole's, shape (6, 6) [-, m].
        """
        self.unshift(k)
        self._mark(k, True)
        c, s = math.cos(pitch), math.sin(pitch)
        R, p = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]), np.array([forward, 0.0, 0.0])
        if self.leaning is not None:
            line = line_frame(k, self.sole_rotation[k], self.leaning)
            R, p = line.rotation @ R, line.act(p)
        self._shift(k, R, p)
        return self._to_sole.copy()

    def _shift(self, k: int, R: Array, p: Array) -> None:
        """See a foot from a frame with rotation R and origin p in that of its sole."""
        there, R_sole = algebra.vector(p), self._R_sole[k]
        self._sole(k).shift(R, p)
        at = algebra.add(algebra.rotate(R_sole, there), algebra.vector(self._p_sole[k]))
        algebra.put(self._p_contact[k], at)
        algebra.compose(R_sole, R, self._R_contact[k])
        algebra.see_wrench(self._R_contact[k], at, self._W[:, 6 * k : 6 * k + 6])
        algebra.see_wrench(R, there, self._to_sole)

    def unshift(self, k: int) -> None:
        """See foot k from its sole again, as after an update."""
        if self._shifted_right if k else self._shifted_left:
            self._mark(k, False)
            self._update_sole(k)

    def _mark(self, k: int, shifted: bool) -> None:
        if k:
            self._shifted_right = shifted
        else:
            self._shifted_left = shifted
        self.is_shifted = self._shifted_left or self._shifted_right


def _frame_id(model: pin.Model, name: str) -> int:
    if not model.existFrame(name):
        raise ValueError(f"robot '{model.name}' has no frame '{name}'")
    return int(model.getFrameId(name))
