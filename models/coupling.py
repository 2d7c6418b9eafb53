"""Joints that follow others, in a model of Pinocchio: the follower gives its coordinate up, and its leader has all."""

from collections.abc import Iterable

import numpy as np
import pinocchio as pin

from surefoot.models.types import Coupling


def coupled(model: pin.Model, couplings: Iterable[Coupling]) -> pin.Model:
    """The model in which joints follow others; a rotor at a follower is felt at its leader, with the ratio squared.

    Args:
        model: a tree of joints, each with a coordinate.
        couplings: whose leaders stand before their followers in the tree.
    """
    armature = {model.names[joint]: float(model.armature[model.idx_vs[joint]]) for joint in range(2, model.njoints)}
    for one in couplings:
        leader, follower = (model.getJointId(name) for name in (one.leader, one.follower))
        model = pin.transformJointIntoMimic(model, leader, follower, one.ratio, one.offset)
        armature[one.leader] += one.ratio**2 * armature[one.follower]
        values = np.array(model.armature)
        values[model.idx_vs[leader]] = armature[one.leader]
        model.armature = values
    return model
