"""Do the two engines compute the same robot? Both sides of every comparison come from the same MJCF text."""

from dataclasses import astuple, dataclass

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import Dynamics
from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Array, Coordinates, mujoco_acceleration_to_pinocchio, velocity_map
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.types import RobotDescription

_CONTACTS = (
    mujoco.mjtConstraint.mjCNSTR_CONTACT_FRICTIONLESS,
    mujoco.mjtConstraint.mjCNSTR_CONTACT_PYRAMIDAL,
    mujoco.mjtConstraint.mjCNSTR_CONTACT_ELLIPTIC,
)


@dataclass(frozen=True, slots=True)
class EngineDifference:
    """Largest absolute differences between MuJoCo and Pinocchio at one state.

    Attributes:
        mass_matrix: joint-space inertia with armatures [kg, kg m, kg m^2].
        bias: Coriolis, centrifugal and gravity forces [N, N m].
        com: centre of mass [m].
        jacobian: linear and angular frame Jacobians of both soles and of the torso [1, m].
        momentum: linear and angular centroidal momentum [N s, N m s].
        others: forces that MuJoCo alone knows: of springs, losses, tendons and equalities, but for those of joints that
            follow others, which do no work in their motion [N, N m].
    """

    mass_matrix: float
    bias: float
    com: float
    jacobian: float
    momentum: float
    others: float

    @property
    def largest(self) -> float:
        """The largest of all."""
        return float(max(astuple(self)))


class EnginePair:
    """One robot in both engines.

    Attributes:
        mj_model: MuJoCo's model, compiled from the description's text.
        pin_model: Pinocchio's model of the same text.
    """

    def __init__(self, description: RobotDescription) -> None:
        self.description = description
        self.mj_model = mujoco.MjModel.from_xml_string(description.mjcf)
        self.pin_model = pinocchio_model(description)
        self._mj, self._coordinates = mujoco.MjData(self.mj_model), Coordinates(self.mj_model)
        self._pin = self.pin_model.createData()
        self._dynamics = Dynamics(self.pin_model, self._pin)

    def random_state(self, rng: np.random.Generator) -> tuple[Array, Array]:
        """A state (q, v) in Pinocchio's convention: any base pose, joints within limits, speeds of some rad/s."""
        d = self.description
        base = rng.normal(size=7)
        base[3:] /= np.linalg.norm(base[3:])
        return np.concatenate((base, rng.uniform(d.position_lower, d.position_upper))), rng.normal(
            size=self.pin_model.nv
        )

    def difference(self, q: Array, v: Array) -> EngineDifference:
        """Compare the engines at the state (q, v) in Pinocchio's convention."""
        self._forward(q, v)
        T = self._velocity_map()
        momentum = np.concatenate(
            (self.description.mass * self._mj.subtree_linvel[1], self._mj.subtree_angmom[1])
        )  # body 1 is the floating base
        return EngineDifference(
            mass_matrix=_largest(T.T @ self._mj_mass_matrix() @ T, self._pin_mass_matrix(q)),
            bias=_largest(T.T @ self._mj.qfrc_bias, self._pin_bias(q, v)),
            com=_largest(self._mj.subtree_com[1], pin.centerOfMass(self.pin_model, self._pin, q)),
            jacobian=self._jacobian_difference(q, T),
            momentum=_largest(momentum, pin.computeCentroidalMomentum(self.pin_model, self._pin, q, v).vector),
            others=_largest(T.T @ self._others(), 0.0),
        )

    def _velocity_map(self) -> Array:
        """From Pinocchio's velocities to MuJoCo's, those of joints that follow others among them."""
        T, G = velocity_map(self._mj.qpos, self.pin_model.nv), self._coordinates.G
        return T if G is None else np.asarray(G @ T)

    def _forward(self, q: Array, v: Array) -> None:
        self._coordinates.to_mujoco(q, v, self._mj.qpos, self._mj.qvel)
        mujoco.mj_forward(self.mj_model, self._mj)
        mujoco.mj_subtreeVel(self.mj_model, self._mj)

    def _mj_mass_matrix(self) -> Array:
        M = np.zeros((self.mj_model.nv, self.mj_model.nv))
        mujoco.mj_fullM(self.mj_model, self._mj, M)
        return M

    def _pin_mass_matrix(self, q: Array) -> Array:
        self._dynamics.mass_matrix(q)
        M: Array = self._pin.M
        return M

    def _others(self) -> Array:
        """Passive forces and those of constraints, contacts and joint limits aside."""
        mj, known = self._mj, (mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT, *_CONTACTS)
        rows = ~np.isin(mj.efc_type, [int(kind) for kind in known])
        forces = np.zeros(self.mj_model.nv)
        if mj.nefc:
            mujoco.mj_mulJacTVec(self.mj_model, mj, forces, np.where(rows, mj.efc_force, 0.0))
        return np.asarray(forces + mj.qfrc_passive)

    def _pin_bias(self, q: Array, v: Array) -> Array:
        """Inverse dynamics for MuJoCo's acceleration zero, which is not Pinocchio's."""
        a, base = np.zeros_like(v), np.zeros(6)
        mujoco_acceleration_to_pinocchio(self._mj.qpos[:7], self._mj.qvel[:6], np.zeros(6), base)
        a[:6] = base
        return np.asarray(pin.rnea(self.pin_model, self._pin, q, v, a))

    def _jacobian_difference(self, q: Array, T: Array) -> float:
        pin.computeJointJacobians(self.pin_model, self._pin, q)
        pin.updateFramePlacements(self.pin_model, self._pin)
        J = np.zeros((6, self.mj_model.nv))
        differences = []
        for site in self.description.sole_sites:
            mujoco.mj_jacSite(self.mj_model, self._mj, J[:3], J[3:], self.mj_model.site(site).id)
            differences.append(_largest(J @ T, self._pin_jacobian(site)))
        torso = self.description.torso_body
        mujoco.mj_jacBody(self.mj_model, self._mj, J[:3], J[3:], self.mj_model.body(torso).id)
        return max(*differences, _largest(J @ T, self._pin_jacobian(torso)))

    def _pin_jacobian(self, frame: str) -> Array:
        index = self.pin_model.getFrameId(frame)
        return np.asarray(pin.getFrameJacobian(self.pin_model, self._pin, index, pin.LOCAL_WORLD_ALIGNED))


def _largest(a: Array, b: Array | float) -> float:
    return float(np.max(np.abs(np.asarray(a) - np.asarray(b))))
