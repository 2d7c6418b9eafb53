"""Pinocchio's models in which joints follow others, and what of Pinocchio's algorithms does not know such joints.

A joint that follows another one has the position q_f = k q_l + b. It has no coordinate of its own, so q and v are those
of the independent joints, and with v_tree = G v the tree of all joints moves. Then M = Gᵀ M_tree G, C = Gᵀ C_tree G,
h = Gᵀ h_tree and J = J_tree G, since G is constant. Pinocchio's mimic joints give that, but for four things:
`pin.computeAllTerms` refuses such a model; `pin.computeCoriolisMatrix` gives another matrix without a word; `pin.crba`
does so from the second call on the same data on; `data.J` has a column for each joint of the tree. For a model in which
no joint follows all here is Pinocchio's own.
"""

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

Array = NDArray[np.float64]


def independent(model: pin.Model) -> tuple[int, ...]:
    """Joints that have a coordinate, the floating base aside, in the order of the coordinates."""
    return tuple(joint for joint in range(2, model.njoints) if model.nvs[joint])


def names_of(model: pin.Model) -> tuple[str, ...]:
    """Names of the independent joints."""
    names = model.names
    return tuple(names[joint] for joint in independent(model))


def has_followers(model: pin.Model) -> bool:
    """Return true if a joint follows another one."""
    return bool(model.nvExtended > model.nv)


def moving_columns(model: pin.Model, joint: int) -> list[int]:
    """Velocities that move the body of a joint, each once.

    Raises:
        ValueError: the body moves with a joint and not with what follows that one, so that the column of the velocity
            in `JointColumns` is not how it moves.
    """
    above = [one for one in model.supports[joint] if one]
    for follower, leader in zip(model.mimicking_joints, model.mimicked_joints, strict=True):
        if (leader in above) != (follower in above):
            names = f"'{model.names[joint]}' between '{model.names[leader]}' and '{model.names[follower]}'"
            raise ValueError(f"joint {names}, which follows it, moves nothing that is steered; choose another body")
    # A joint that follows has the velocity of its leader.
    return list(dict.fromkeys(model.idx_vs[one] + k for one in above for k in range(max(model.nvs[one], 1))))


def joined(model: pin.Model) -> Array:
    """Mark the columns of `data.J` that belong to a velocity, shape (columns, nv): 1 or 0, since they hold k."""
    found = np.zeros((model.nvExtended, model.nv))
    for joint in range(1, model.njoints):
        first, into = model.idx_vExtendeds[joint], model.idx_vs[joint]
        found[np.arange(first, first + model.nvExtendeds[joint]), np.arange(model.nvExtendeds[joint]) + into] = 1.0
    return found


class JointColumns:
    """Columns of the joints' Jacobian, one for each velocity.

    Args:
        model: the robot.
        data: where `pin.computeJointJacobians` leaves its result.

    Attributes:
        values: linear and angular velocity about the world's origin, shape (6, nv), columns side by side in memory.
    """

    def __init__(self, model: pin.Model, data: pin.Data) -> None:
        self._data = data
        self._joined = joined(model) if has_followers(model) else None
        self.values: Array = data.J if self._joined is None else np.zeros((6, model.nv), order="F")

    def update(self) -> None:
        """Take what Pinocchio has computed; its own memory is the result where no joint follows."""
        if self._joined is not None:
            np.matmul(self._data.J, self._joined, out=self.values)


class Dynamics:
    """The terms of the dynamics that Pinocchio's own algorithms do not give for a model in which joints follow others.

    Args:
        model: the robot.
        data: where the results are, but for the Coriolis matrix of a model with followers.

    Attributes:
        data: as given.
        C: of `coriolis`, shape (nv, nv), columns side by side in memory.
    """

    def __init__(self, model: pin.Model, data: pin.Data) -> None:
        self._model, self.data = model, data
        self._tree = Tree(model) if has_followers(model) else None
        self._still = np.zeros(model.nv)
        self.C: Array = data.C if self._tree is None else np.zeros((model.nv, model.nv), order="F")

    def all_terms(self, q: Array, v: Array) -> None:
        """Compute what `pin.computeAllTerms` does, with q, shape (nq,), and v, shape (nv,)."""
        model, data = self._model, self.data
        if self._tree is None:
            pin.computeAllTerms(model, data, q, v)
            return
        self.mass_matrix(q)
        pin.nonLinearEffects(model, data, q, v)
        pin.computeJointJacobians(model, data, q)
        pin.centerOfMass(model, data, q, v)
        pin.ccrba(model, data, q, v)
        # Last, since it leaves the accelerations of the joints with v' = 0, which the others have with gravity in them.
        pin.forwardKinematics(model, data, q, v, self._still)

    def mass_matrix(self, q: Array) -> None:
        """Compute what `pin.crba` does, both triangles, in `data.M`."""
        tree = self._tree
        if tree is None:
            pin.crba(self._model, self.data, q)
            return
        upper = np.triu(pin.crba(tree.model, tree.data, tree.configuration(q)))
        M, G = upper + np.triu(upper, 1).T, tree.G
        self.data.M[:] = G.T @ M @ G + np.diag(self._model.armature)

    def coriolis(self, q: Array, v: Array) -> None:
        """Compute C of `pin.computeCoriolisMatrix`: h = C v + g with M' = C + Cᵀ, and so Cᵀ v of the momentum M v."""
        tree = self._tree
        if tree is None:
            pin.computeCoriolisMatrix(self._model, self.data, q, v)
            return
        C = pin.computeCoriolisMatrix(tree.model, tree.data, tree.configuration(q), tree.G @ v)
        self.C[:] = tree.G.T @ C @ tree.G


class Tree:
    """All joints of a model in which some follow, each with a coordinate.

    Args:
        model: in which joints follow.

    Attributes:
        model: the tree.
        data: of it.
        G: from velocities of the independent joints to those of the tree, shape (nv of the tree, nv).
    """

    def __init__(self, model: pin.Model) -> None:
        self.model = tree = pin.Model()
        tree.name, tree.gravity = model.name, model.gravity
        self.G, self._offset = joined(model), np.zeros(model.nvExtended + 1)
        for joint in range(1, model.njoints):
            one, column = model.joints[joint], model.idx_vExtendeds[joint]
            if not one.nv:
                mimic = one.extract()
                self.G[column] *= mimic.scaling
                self._offset[column + 1] = mimic.offset
                one = pin.JointModelRevoluteUnaligned(axis_of_follower(model, joint))
            added = tree.addJoint(model.parents[joint], one, model.jointPlacements[joint], model.names[joint])
            tree.inertias[added] = model.inertias[joint]
        self.data = tree.createData()

    def configuration(self, q: Array) -> Array:
        """Configuration of the tree, shape (nq of it,), from the independent joints' one, shape (nq,) [m, -, rad]."""
        found: Array = np.concatenate((q[:7], self.G[6:, 6:] @ q[7:] + self._offset[7:]))
        return found


def axis_of_follower(model: pin.Model, joint: int) -> Array:
    """Axis of a revolute joint that follows another one, in its own frame, shape (3,)."""
    one = model.joints[joint]
    data = one.createData()
    one.calc(data, pin.neutral(model))
    axis: Array = np.asarray(data.S).reshape(6)[3:] / one.extract().scaling
    return axis
