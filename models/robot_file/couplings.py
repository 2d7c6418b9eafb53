"""Joints of a leg that turn as one: which followers of a model stay, and what their leader has of them.

A joint with its followers is one joint with one motor. Its position q is that of the first of them, q_j = k_j q + b_j
those of the others. Torques add up by virtual work, τ = Σ k_j τ_j, speeds and ranges are those that all of them allow,
and a rotor at q_j is felt as k_j² times its inertia.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
import pinocchio as pin

from surefoot.models.coupling import coupled
from surefoot.models.joints import is_revolute, world_axis
from surefoot.models.robot_file.bindings import Follower
from surefoot.models.types import Array, Coupling, RobotError

_PARALLEL, _TURN = 1e-3, 0.1
"""Sine of the angle between axes above which joints do not turn as one; least turn of all for that of the first [-]."""


def kept(model: pin.Model, legs: Iterable[Sequence[int]], followers: Mapping[str, Follower]) -> tuple[Coupling, ...]:
    """Couplings of joints that turn one after the other about parallel axes in a leg; others cannot be driven.

    Args:
        model: a tree of joints.
        legs: joints of each leg, from hip to ankle.
        followers: joints that follow others, by name.
    """
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    found: list[Coupling] = []
    for leg in legs:
        names = [str(model.names[joint]) for joint in leg]
        for group in _groups(names, followers):
            if _as_one(model, data, leg, {leg[names.index(name)]: ratio for name, (ratio, _) in group.items()}):
                found += _from_first(names, group)
    return tuple(found)


_Law = tuple[float, float]
"""Ratio and offset of an angle, for that of a leader [-, rad]."""


def _groups(names: Sequence[str], followers: Mapping[str, Follower]) -> Iterator[dict[str, _Law]]:
    """Joints that move together by name, each by the law that gives its angle for that of the one that leads all."""
    groups: dict[str, dict[str, _Law]] = {}
    for name in names:
        root, law = _root(name, followers)
        if root in names and law is not None:
            groups.setdefault(root, {})[name] = law
    yield from (group for group in groups.values() if len(group) > 1)


def _root(name: str, followers: Mapping[str, Follower]) -> tuple[str, _Law | None]:
    """The joint that leads another one in the end, by what stands between them; no law where there is none."""
    ratio, offset, seen = 1.0, 0.0, {name}
    while name in followers:
        one = followers[name]
        if one.leader is None or one.ratio is None or one.leader in seen:
            return name, None
        ratio, offset, name = ratio * one.ratio, offset + ratio * one.angle, one.leader
        seen.add(name)
    return name, (ratio, offset)


def _as_one(model: pin.Model, data: pin.Data, leg: Sequence[int], ratios: Mapping[int, float]) -> bool:
    """Return true if joints of a leg, with their ratios, follow one another and turn what is below about one axis."""
    joints = sorted(ratios)
    first = leg.index(joints[0])
    if joints != list(leg[first : first + len(joints)]) or not all(is_revolute(model, one) for one in joints):
        return False
    axes = [world_axis(model, data, joint) for joint in joints]
    if any(float(np.linalg.norm(np.cross(axes[0], axis))) > _PARALLEL for axis in axes[1:]):
        return False
    turn = sum(ratios[joint] * float(axes[0] @ axis) for joint, axis in zip(joints, axes, strict=True))
    return abs(turn) > _TURN * abs(ratios[joints[0]])


def _from_first(names: Sequence[str], group: dict[str, _Law]) -> Iterator[Coupling]:
    """The laws of a group for the angle of the joint that is the first in its leg."""
    leader = next(name for name in names if name in group)
    k, b = group[leader]
    for name in names:
        if name in group and name != leader:
            ratio, offset = group[name]
            yield Coupling(name, leader, ratio / k, offset - ratio * b / k)


def joined(model: pin.Model, couplings: Sequence[Coupling]) -> pin.Model:
    """The model in which joints follow others, with their limits and rotors at the leaders.

    Raises:
        RobotError: there is no angle of a leader at which all are within their ranges.
    """
    if not couplings:
        return model
    ends, at = [np.array(end) for end in (model.lowerPositionLimit, model.upperPositionLimit)], model.idx_qs
    effort, speed, rate = np.array(model.upperEffortLimit), np.array(model.upperVelocityLimit), model.idx_vs
    for one in couplings:
        leader, follower = (model.getJointId(name) for name in (one.leader, one.follower))
        p = at[leader]
        q = at[follower]
        u = rate[leader]
        v = rate[follower]
        reached = sorted((float(end[q]) - one.offset) / one.ratio for end in ends)
        ends[0][p], ends[1][p] = max(ends[0][p], reached[0]), min(ends[1][p], reached[1])
        if not ends[0][p] < ends[1][p]:
            what = f"joint '{one.follower}' of {model.name} follows '{one.leader}' to where its range does not go"
            raise RobotError(("model",), what, "give both joints ranges that they reach together")
        effort[u] += abs(one.ratio) * effort[v]
        speed[u] = _slower(speed[u], speed[v] / abs(one.ratio))
    model.lowerPositionLimit, model.upperPositionLimit = ends
    model.upperEffortLimit, model.lowerEffortLimit = effort, -effort
    model.upperVelocityLimit, model.lowerVelocityLimit = speed, -speed
    return coupled(model, couplings)


def _slower(speed: float, other: float) -> float:
    """The smaller one of two speed limits, of which 0 stands for none [rad/s]."""
    known = [one for one in (speed, other) if one > 0.0]
    return min(known, default=0.0)


def coupling_notes(model: pin.Model, couplings: Iterable[Coupling]) -> Iterator[str]:
    """A line for each joint that follows another one, with what drives both."""
    for one in couplings:
        leader = model.getJointId(one.leader)
        offset = f" from {one.offset:.4g} rad on" if one.offset else ""
        limits: Array = np.array([model.upperEffortLimit[model.idx_vs[leader]]])
        yield (
            f"coupled: {one.follower} turns by {one.ratio:.4g} times {one.leader}{offset}; both are one joint, of "
            f"{limits[0]:.4g} N m at {one.leader}"
        )
