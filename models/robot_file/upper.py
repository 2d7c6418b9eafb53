"""The upper body of a model: torso, waist and arms, and how the arms hang."""

from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from surefoot.models.joints import world_axis
from surefoot.models.robot_file.legs import Leg, at, rest
from surefoot.models.robot_file.reduced import Reduced
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.shapes import placed
from surefoot.models.robot_file.turning import turn
from surefoot.models.types import Array, RobotError

_ASIDE, _ALIKE = 0.02, 0.1
_LATERAL = 0.8
_SHARE = 0.5
_ROOM = 0.25
"""Angle that relaxed arms stay from the ends of their joints, or a sixth of the range if that is less [rad]."""

_SAME = 1e-5
"""Angle below which a frame is upright but for the digits of its model [rad]."""

_STEPS, _NEARNESS = 100, 0.02


Arms = tuple[tuple[int, ...], tuple[int, ...]] | tuple[()]


@dataclass(frozen=True, slots=True)
class Upper:
    """Everything but the legs, by joint index.

    Attributes:
        torso: joint whose body is the torso, 1 for the floating base.
        waist: joints from the base to the torso.
        arms: joints of the left and the right arm, in the order of the chain; empty without arms.
    """

    torso: int
    waist: tuple[int, ...]
    arms: Arms


def find_upper(reduced: Reduced, file: RobotFile, legs: tuple[Leg, Leg]) -> Upper:
    """Torso, waist and arms.

    Arms are the heaviest two alike branches of one body on either side; that body is the torso. Without arms it is the
    heaviest body above the legs.

    Raises:
        RobotError: the file names a torso that is none.
    """
    model = reduced.model
    below = {joint for leg in legs for joint in leg.chain}
    others = [joint for joint in range(2, model.njoints) if joint not in below]
    arms = _arms(model, others, legs)
    if file.torso is not None:
        torso = reduced.joint_of(file.torso, "torso")
        if torso in below:
            what = f"torso of {file.name} is '{file.torso}', which is part of a leg"
            raise RobotError(("torso",), what, "name a link above the legs")
    elif arms:
        torso = int(model.parents[arms[0][0]])
    else:
        torso = max([1, *others], key=lambda joint: model.inertias[joint].mass)
    return Upper(torso, tuple(j for j in model.supports[torso] if j > 1), arms)


def _arms(model: pin.Model, others: list[int], legs: tuple[Leg, Leg]) -> Arms:
    data, q = model.createData(), pin.neutral(model)
    q[7:] = rest(model)
    pin.centerOfMass(model, data, q)
    height = float(np.linalg.norm(legs[0].hip - legs[0].sole.placement.translation))
    best = 0.0
    arms: Arms = ()
    for left in others:
        for right in others:
            if model.parents[left] != model.parents[right]:
                continue
            one, other = (data.oMi[joint].act(data.com[joint])[1] for joint in (left, right))
            masses = data.mass[left], data.mass[right]
            alike = abs(one + other) < _ALIKE * abs(one) and abs(masses[0] - masses[1]) < _ALIKE * masses[0]
            if one > _ASIDE * height and alike and masses[0] > best:
                best, arms = masses[0], (_main(model, data, left), _main(model, data, right))
    return arms


def _main(model: pin.Model, data: pin.Data, root: int) -> tuple[int, ...]:
    """The chain from a joint along the heavier branches."""
    chain = [root]
    while model.children[chain[-1]]:
        chain.append(max(model.children[chain[-1]], key=lambda joint: data.mass[joint]))
    return tuple(chain)


def swings(model: pin.Model, upper: Upper, posture: Array) -> tuple[tuple[int, int], tuple[float, float]] | None:
    """The joint of each arm that swings it, and the sign of angles that swing it back.

    It is the first that turns about the lateral axis, if it moves at least half of the arm.
    """
    data, q = model.createData(), pin.neutral(model)
    q[7:] = posture
    pin.centerOfMass(model, data, q)
    found = []
    for arm in upper.arms:
        lateral = [j for j in arm if abs(world_axis(model, data, j)[1]) > _LATERAL]
        if not lateral or data.mass[lateral[0]] < _SHARE * data.mass[arm[0]]:
            return None
        found.append((lateral[0], float(np.sign(world_axis(model, data, lateral[0])[1]))))
    if not found:
        return None
    return (found[0][0], found[1][0]), (found[0][1], found[1][1])


def hanging(model: pin.Model, upper: Upper, posture: Array, aside: float) -> Array:
    """The posture with arms that hang down, led away from the body by an angle [rad], shape (nj,) [rad].

    Every body of an arm is sought in that direction from the shoulder, the angles near their rest.
    """
    found, data = posture.copy(), model.createData()
    for side, arm in zip((1.0, -1.0), upper.arms, strict=False):
        joints = np.array([model.idx_qs[joint] - 7 for joint in arm])
        lower, upper_limit = model.lowerPositionLimit[7:][joints], model.upperPositionLimit[7:][joints]
        room = np.minimum(_ROOM, (upper_limit - lower) / 6)
        low, high = lower + room, upper_limit - room
        calm = np.clip(0.0, low, high)
        found[joints] = calm
        target = np.array([0.0, side * np.sin(aside), -np.cos(aside)])
        for _ in range(_STEPS):
            error, J = _astray(model, data, arm, found, target)
            H = J.T @ J + _NEARNESS * np.eye(len(arm))
            change = np.linalg.solve(H, -J.T @ error - _NEARNESS * (found[joints] - calm))
            found[joints] = np.clip(found[joints] + np.clip(change, -0.3, 0.3), low, high)
    return found


def _astray(
    model: pin.Model, data: pin.Data, arm: tuple[int, ...], angles: Array, target: Array
) -> tuple[Array, Array]:
    """Directions of the arm's bodies from the shoulder off the target, weighed by mass, and their Jacobian."""
    q = pin.neutral(model)
    q[7:] = angles
    pin.computeJointJacobians(model, data, q)
    shoulder = data.oMi[arm[0]].translation.copy()
    total = sum(model.inertias[joint].mass for joint in arm)
    columns = [model.idx_vs[joint] for joint in arm]
    errors, rows = [], []
    for joint in arm:
        inertia, place = model.inertias[joint], data.oMi[joint]
        lever = place.act(inertia.lever) - shoulder
        length = max(float(np.linalg.norm(lever)), 1e-6)
        J = pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, columns]
        moves = J[:3] - pin.skew(place.rotation @ inertia.lever) @ J[3:]
        unit, weight = lever / length, np.sqrt(inertia.mass / total)
        errors.append(weight * (unit - target))
        rows.append(weight / length * (moves - np.outer(unit, unit @ moves)))
    return np.concatenate(errors), np.vstack(rows)


def with_upright(reduced: Reduced, torso: int) -> Reduced:
    """The robot with the torso's frame upright where all joints are at zero, or as near as they get, as it is held.

    Args:
        reduced: its model is altered in place.
        torso: joint that moves it.
    """
    R = np.array(at(reduced.model, rest(reduced.model)).oMi[torso].rotation)
    angle = float(np.linalg.norm(pin.log3(R)))
    if torso == 1 or angle < _SAME:
        return reduced
    turn(reduced.model, torso, R.T)
    note = f"the frame of '{reduced.bodies[torso - 1]}' is turned by {np.degrees(angle):.3g} deg"
    reduced.notes.append(f"{note}, so that it is upright at zero angles")
    back = pin.SE3(R, np.zeros(3))
    visual, collision = list(reduced.visual), list(reduced.collision)
    for shapes in (visual, collision):
        shapes[torso] = tuple(replace(one, vertices=placed(one.vertices, back)) for one in shapes[torso])
    return replace(reduced, visual=tuple(visual), collision=tuple(collision))
