"""The free base of a model: what holds a robot in the world of its model is no part of the robot.

Models come with joints between the world and the robot: a floating or a planar joint, or slides and hinges whose links
have no mass. Each model that is read has a floating base before all that. A link without mass bears no force, so a
joint between it and the robot can neither hold nor drive anything: it repeats the motion of the floating base. A
floating joint inside of a model holds nothing either, whatever mass is above it. The base is the first link with mass
behind all these, or the link from which several chains with mass part.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio as pin

from surefoot.models.inertia import LEAST_MASS

_DUMMY = 5e-3
"""Share of the whole mass up to which a link between world and robot counts as one without mass [-]."""

_FREE, _LEGS = 6, 8
"""Degrees of freedom of a floating joint, and joints that two legs have at least."""

_SAME = 1e-12
"""Difference of placements below which two frames are one [m, -]."""


def held_by(model: pin.Model) -> list[int]:
    """Joints between the floating base and the robot, the one that moves the robot's own base last.

    Args:
        model: joint 1 is the floating base.
    """
    data = model.createData()
    pin.computeSubtreeMasses(model, data)
    at = max(_floating(model), key=lambda joint: data.mass[joint])
    chain = [int(joint) for joint in model.supports[at] if joint > 1]
    light = _DUMMY * data.mass[at]
    while model.inertias[at].mass <= light:
        heavy = [int(child) for child in model.children[at] if data.mass[child] > light]
        if len(heavy) != 1:
            break
        at = heavy[0]
        chain.append(at)
    return chain


def _floating(model: pin.Model) -> list[int]:
    """The innermost floating joints, behind which are joints enough for two legs; else the floating base alone."""
    floating = [
        joint
        for joint in range(2, model.njoints)
        if model.joints[joint].nv == _FREE and len(model.subtrees[joint]) > _LEGS
    ]
    return [joint for joint in floating if not set(floating) & set(list(model.subtrees[joint])[1:])] or [1]


def base_frame(model: pin.Model, joint: int, masses: Mapping[str, float]) -> pin.Frame:
    """The frame of the first link with mass that a joint moves, or else of its first link.

    Args:
        model: with all its links.
        joint: that moves the base.
        masses: of links by name, those without left out [kg].
    """
    light = _DUMMY * model.inertias[joint].mass
    links = [frame for frame in model.frames if frame.type == pin.FrameType.BODY and frame.parentJoint == joint]
    return next((link for link in links if masses.get(link.name, 0.0) > light), links[0])


def moved(model: pin.Model, joint: int, base: pin.Frame) -> bool:
    """Return true if a base is other than what joint 1 moves, or has another frame."""
    return joint != 1 or not np.allclose(base.placement.homogeneous, np.eye(4), rtol=0.0, atol=_SAME)


def based_on(model: pin.Model, joint: int, base: pin.Frame) -> pin.Model:
    """The part of a model that a joint moves, with a floating base in the place of the joint.

    Args:
        model: joint 1 is the floating base.
        joint: that moves the base.
        base: link of the base, whose frame the floating base gets; it comes first among the links.
    """
    found, back = pin.Model(), base.placement.inverse()
    found.name = model.name
    joints = {joint: found.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), model.names[1])}
    found.addJointFrame(1)
    found.appendBodyToJoint(1, back.act(model.inertias[joint]), pin.SE3.Identity())
    for below in list(model.subtrees[joint])[1:]:
        parent = model.parents[below]
        place = model.jointPlacements[below]
        joints[below] = _add(found, model, below, joints[parent], back * place if parent == joint else place)
    own = [frame for frame in model.frames if frame.parentJoint in joints]
    for frame in sorted(own, key=lambda one: one.name != base.name):
        if frame.type != pin.FrameType.JOINT or frame.parentJoint != joint:
            there = back * frame.placement if frame.parentJoint == joint else frame.placement
            found.addFrame(pin.Frame(frame.name, joints[frame.parentJoint], 0, there, frame.type), False)
    return found


def _add(into: pin.Model, model: pin.Model, joint: int, parent: int, place: pin.SE3) -> int:
    """Add a joint with its limits, rotor and inertia; returns its index."""
    one = model.joints[joint]
    v, q = slice(one.idx_v, one.idx_v + one.nv), slice(one.idx_q, one.idx_q + one.nq)
    motor = model.upperEffortLimit[v], model.upperVelocityLimit[v]
    ends = model.lowerPositionLimit[q], model.upperPositionLimit[q]
    added = int(into.addJoint(parent, one, place, model.names[joint], *motor, *ends))
    armature = np.array(into.armature)
    armature[into.joints[added].idx_v : into.joints[added].idx_v + one.nv] = model.armature[v]
    into.armature = armature
    into.appendBodyToJoint(added, model.inertias[joint], pin.SE3.Identity())
    return added


def base_note(names: Sequence[str], dropped: float) -> str:
    """A note on joints that are left out.

    Args:
        names: of the joints.
        dropped: mass of the links that go with them [kg].
    """
    mass = f", and links of {dropped:.3g} kg with them" if dropped > LEAST_MASS else ""
    return f"the base is free; joints by which the model holds it in its world are left out{mass}: {', '.join(names)}"
