"""The legs of a model: chains, knees, hips, ankles, soles, and the angles of a leg that is straight or bent."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import pinocchio as pin

from surefoot.models.inertia import LEAST_MASS
from surefoot.models.joints import meeting_point, members, pivot, turn_of, world_axis
from surefoot.models.robot_file.reduced import Reduced, points_of
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.robot_file.soles import SolePlate, sole_of
from surefoot.models.types import WITHOUT_ROLL, Array, RobotError

SIDES = ("left", "right")
FEWEST, MOST = WITHOUT_ROLL, 7
_LATERAL = 0.7
_STEPS, _DAMPING = 60, 1e-6
_ENDS = 0.02
"""Distance of solved angles from the ends of a joint [rad]."""

_GRID, _SLOPE, _HALVINGS = 181, 1e-4, 60
"""Angles at which a knee with followers is tried, half of the span of its slope [rad], and halvings of an interval."""

_BENT, _MADE = 0.65, 0.02
"""Bend of a knee with which it is seen what a leg can do [rad], and least share of a twist that it has to make [-]."""


@dataclass(frozen=True, slots=True)
class Leg:
    """One leg.

    Attributes:
        chain: all joints from hip to ankle, indices in the model.
        joints: those that have a coordinate.
        knee: its place among these.
        bend: sign of the knee's angle that bends it.
        turn: by how much the shank turns for an angle of the knee, more than 1 with joints that follow it [-].
        straight: angle of the knee that makes the leg longest [rad].
        sole: what touches the ground.
        hip: hip centre from the base [m].
        shank: the joint whose body is the shank; where that has several, the last of them.
    """

    chain: tuple[int, ...]
    joints: tuple[int, ...]
    knee: int
    bend: float
    turn: float
    straight: float
    sole: SolePlate
    hip: Array
    shank: int

    @property
    def thigh(self) -> int:
        """The joint whose body is the thigh."""
        return self.chain[self.chain.index(self.joints[self.knee]) - 1]

    def bent(self, bend: float) -> float:
        """Angle of the knee at which thigh and shank are bent by an angle [rad]."""
        return self.straight + self.bend * bend / abs(self.turn)

    @property
    def leans(self) -> bool:
        """True if no joint is left to roll the foot, which leans sideways with its shank."""
        return len(self.joints) == WITHOUT_ROLL


def find_legs(reduced: Reduced, file: RobotFile) -> tuple[Leg, Leg]:
    """Both legs.

    Raises:
        RobotError: a leg has too few or too many joints, no knee or no sole, or the feet are swapped.
    """
    model = reduced.model
    chains = [tuple(j for j in model.supports[model.frames[frame].parentJoint] if j > 1) for frame in reduced.feet]
    feet = file.soles()
    shared = sorted(set(chains[0]) & set(chains[1]))
    if shared:
        what = f"both feet of {file.name} hang on joint '{model.names[shared[0]]}'"
        raise RobotError(("feet",), what, "the floating base must be the body between the legs")
    for side, chain in zip(SIDES, chains, strict=True):
        own = len(_own(model, chain))
        if not FEWEST <= own <= MOST:
            what = f"the {side} leg of {file.name}, to link '{getattr(feet, side)}', has {_counted(model, chain)}"
            right = f"legs need {FEWEST} to {MOST}, so that a sole can be put anywhere, with {FEWEST} but for its roll"
            raise RobotError(("feet", side), what, right)
    legs = [_leg(reduced, file, side, chain) for side, chain in enumerate(chains)]
    _check_sides(reduced, file, legs)
    _check_rolls(reduced, file, legs)
    return legs[0], legs[1]


def at(model: pin.Model, angles: Array) -> pin.Data:
    """Placements of all joints with the base at the origin and joints at angles, shape (nj,) [rad]."""
    data, q = model.createData(), pin.neutral(model)
    q[7:] = angles
    pin.forwardKinematics(model, data, q)
    return data


def rest(model: pin.Model) -> Array:
    """Zero, or the nearest angle of each joint, shape (nj,) [rad]."""
    return np.asarray(np.clip(0.0, model.lowerPositionLimit[7:], model.upperPositionLimit[7:]))


def _leg(reduced: Reduced, file: RobotFile, side: int, chain: tuple[int, ...]) -> Leg:
    model, data = reduced.model, at(reduced.model, rest(reduced.model))
    candidates, joints = {}, _own(model, chain)
    for place in range(1, len(joints) - 1):
        axis = world_axis(model, data, joints[place])
        if abs(axis[1]) < _LATERAL:
            continue
        on = pivot(model, data, joints[place])
        ends = (meeting_point(model, data, group) - on for group in (joints[:place], joints[place + 1 :]))
        above, below = (float(np.linalg.norm(end - axis * (end @ axis))) for end in ends)
        candidates[place] = above * below
    if not candidates:
        what = f"the {SIDES[side]} leg of {file.name} has no joint between its ends that turns about the lateral axis"
        raise RobotError(
            ("feet", SIDES[side]), what, "name the links of the feet, below ankle and knee, and check forward"
        )
    knee = max(candidates, key=candidates.__getitem__)
    straight = _longest(model, joints, knee)
    lower, upper = _ends_of(model, joints[knee])
    bend = 1.0 if upper - straight >= straight - lower else -1.0
    sole = _sole(reduced, file, side, data, chain[-1])
    behind = chain[chain.index(max(members(model, joints[knee]))) :]
    shank = next(joint for joint in behind if model.inertias[joint].mass > LEAST_MASS)
    turn, hip = turn_of(model, data, joints[knee]), meeting_point(model, data, joints[:knee])
    return Leg(chain, joints, knee, bend, turn, straight, sole, hip, shank)


def _own(model: pin.Model, chain: tuple[int, ...]) -> tuple[int, ...]:
    """Joints of a chain that have a coordinate."""
    return tuple(joint for joint in chain if model.nvs[joint])


def _counted(model: pin.Model, chain: tuple[int, ...]) -> str:
    """Number of joints of a chain, and those that follow others, in words."""
    following = [f"'{model.names[joint]}'" for joint in chain if not model.nvs[joint]]
    count = f"{len(_own(model, chain))} joints"
    follow = "follow" if following[1:] else "follows"
    return f"{count} with a motor, one of which {' and '.join(following)} {follow}" if following else count


def coordinate(model: pin.Model, joint: int) -> int:
    """Place of a joint's angle, or of that which it follows, among the angles of a robot."""
    return int(model.idx_qs[joint]) - 7


def _ends_of(model: pin.Model, joint: int) -> tuple[float, float]:
    """Range of a joint [rad]."""
    at = model.idx_qs[joint]
    return float(model.lowerPositionLimit[at]), float(model.upperPositionLimit[at])


def _longest(model: pin.Model, joints: tuple[int, ...], knee: int) -> float:
    """Angle of the knee at which hip and ankle are farthest apart.

    The distance squared is a + b cos + c sin of the angle of a knee of one joint; with followers it is sought.
    """
    ends, squares = _ends_of(model, joints[knee]), partial(_distance_squared, model, joints, knee)
    if len(members(model, joints[knee])) > 1:
        grid = np.linspace(*ends, _GRID)
        best = int(np.argmax([squares(angle) for angle in grid]))
        around = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, _GRID - 1)])
        return round(_extreme(squares, *around), 9) + 0.0  # 0.0 and not -0.0
    ahead, aside, behind = (squares(angle) for angle in (0.0, np.pi / 2, np.pi))
    middle = (ahead + behind) / 2
    return float(np.clip(np.arctan2(aside - middle, ahead - middle), *ends))


def _distance_squared(model: pin.Model, joints: tuple[int, ...], knee: int, angle: float) -> float:
    """From hip to ankle, the other joints at rest [m^2]."""
    angles = rest(model)
    angles[coordinate(model, joints[knee])] = angle
    data = at(model, angles)
    hip, ankle = (meeting_point(model, data, group) for group in (joints[:knee], joints[knee + 1 :]))
    return float((hip - ankle) @ (hip - ankle))


def _extreme(value: Callable[[float], float], lower: float, upper: float) -> float:
    """Argument at which a smooth function has its maximum between two ends: by bisection of its slope."""

    def slope(at: float) -> float:
        return value(at + _SLOPE) - value(at - _SLOPE)

    if slope(lower) <= 0.0:
        return lower
    if slope(upper) >= 0.0:
        return upper
    for _ in range(_HALVINGS):
        middle = 0.5 * (lower + upper)
        lower, upper = (middle, upper) if slope(middle) > 0.0 else (lower, middle)
    return 0.5 * (lower + upper)


def _sole(reduced: Reduced, file: RobotFile, side: int, data: pin.Data, joint: int) -> SolePlate:
    """The sole in the file, or of the shapes of everything that the last joint of the leg moves."""
    upright = np.asarray(data.oMi[joint].rotation.T)
    link = getattr(file.soles(), SIDES[side])
    if file.sole is not None:
        x, y, z = file.sole.centre
        frame = reduced.model.frames[reduced.feet[side]].placement
        centre = frame.act(np.array([x, y if side == 0 else -y, z]))
        return SolePlate(pin.SE3(upright, centre), file.sole.length, file.sole.width)
    shapes = reduced.collision[joint] or reduced.visual[joint]
    return sole_of(points_of(shapes), upright, link, file.name)


def _check_sides(reduced: Reduced, file: RobotFile, legs: list[Leg]) -> None:
    """Refuse feet that are swapped: the legs would stand the right way round, but toes and knees point backward.

    Raises:
        RobotError: they are, or the axis ahead is a wrong one.
    """
    data = at(reduced.model, rest(reduced.model))
    ahead = []
    for leg in legs:
        ankle = meeting_point(reduced.model, data, leg.joints[leg.knee + 1 :])
        toe = data.oMi[leg.chain[-1]].act(leg.sole.placement.translation)[0] - ankle[0]
        knee = world_axis(reduced.model, data, leg.joints[leg.knee])[1] * leg.bend * leg.turn
        ahead.append(toe / leg.sole.length if abs(toe) > 0.05 * leg.sole.length else knee)
    if max(ahead) >= 0.0:
        return
    feet = file.soles()
    if file.forward is not None:
        what = f"forward of {file.name} is {file.forward}, but toes and knees point the other way"
        raise RobotError(("forward",), what, "leave it out, or give the opposite axis")
    what = f"feet of {file.name} look swapped: with '{feet.left}' on the left, toes and knees point backward"
    raise RobotError(("feet",), what, f"write feet: {{left: {feet.right}, right: {feet.left}}}, or give forward")


def _check_rolls(reduced: Reduced, file: RobotFile, legs: list[Leg]) -> None:
    """Refuse legs of five joints that lack something else than the roll of the foot, or that have unlike feet.

    The twist of a sole that five joints cannot make is known up to its size; without the row of the roll they must make
    the other five, and not only just.

    Raises:
        RobotError: says what no joint does.
    """
    feet = file.soles()
    if legs[0].leans != legs[1].leans:
        lacking = SIDES[0 if legs[0].leans else 1]
        what = f"no joint rolls the {lacking} foot of {file.name}, but one rolls the other"
        raise RobotError(("feet", lacking), what, "both legs must have such a joint, or neither")
    for side, leg in zip(SIDES, legs, strict=True):
        resting, level = _made(reduced.model, leg)
        if leg.leans and min(resting["rolls"], level["rolls"]) < _MADE:
            lacks = max(("pitches", "yaws"), key=resting.__getitem__)
            what = (
                f"the {side} leg of {file.name}, to link '{getattr(feet, side)}', has "
                f"{_counted(reduced.model, leg.chain)}, none of which {lacks} the foot"
            )
            raise RobotError(("feet", side), what, "a leg of five joints can do without the roll of its foot only")


def _made(model: pin.Model, leg: Leg) -> list[dict[str, float]]:
    """Least share of a twist of the sole that the joints make if it need not roll, pitch or yaw, knee bent [-].

    With all other joints at rest, and with the sole level: either may hide what a leg lacks.
    """
    resting = rest(model)
    resting[coordinate(model, leg.joints[leg.knee])] = leg.bent(_BENT)
    columns, made = [model.joints[joint].idx_v for joint in leg.joints], []
    for angles in (resting, solved(model, leg, rest(model), _BENT)):
        data, q = model.createData(), pin.neutral(model)
        q[7:] = angles
        pin.computeJointJacobians(model, data, q)
        foot = data.oMi[leg.chain[-1]]
        J = pin.getJointJacobian(model, data, leg.chain[-1], pin.ReferenceFrame.LOCAL)[:, columns]
        J = pin.SE3(foot.rotation.T, leg.sole.placement.translation).toActionMatrixInverse() @ J
        J[:3] /= np.linalg.norm(leg.hip - foot.translation)
        kept = {name: np.delete(J, 3 + row, axis=0) for row, name in enumerate(("rolls", "pitches", "yaws"))}
        made.append({name: float(np.linalg.svd(rows, compute_uv=False)[-1]) for name, rows in kept.items()})
    return made


def solved(model: pin.Model, leg: Leg, angles: Array, bend: float) -> Array:
    """Angles with the knee bent, the ankle right below the hip, the sole level and pointing ahead, shape (nj,) [rad].

    A sole that leans is level as well, since its shank is upright; its ankle need not be right below the hip, then.
    Damped Gauss-Newton; what the leg's joints and limits do not allow stays as near as it gets.
    """
    found = angles.copy()
    lower, upper = model.lowerPositionLimit[7:], model.upperPositionLimit[7:]
    free = [coordinate(model, joint) for place, joint in enumerate(leg.joints) if place != leg.knee]
    knee = coordinate(model, leg.joints[leg.knee])
    found[knee] = np.clip(leg.bent(bend), lower[knee], upper[knee])
    margin = np.minimum(_ENDS, 0.25 * (upper - lower))
    low, high = (lower + margin)[free], (upper - margin)[free]
    for _ in range(_STEPS):
        error = _misplaced(model, leg, found)
        if np.abs(error).max() < 1e-13:
            break
        J = np.empty((len(error), len(free)))
        for column, joint in enumerate(free):
            step = found.copy()
            step[joint] += 1e-6
            ahead = _misplaced(model, leg, step)
            step[joint] -= 2e-6
            J[:, column] = (ahead - _misplaced(model, leg, step)) / 2e-6
        change = -np.linalg.solve(J.T @ J + _DAMPING * np.eye(len(free)), J.T @ error)
        found[free] = np.clip(found[free] + np.clip(change, -0.3, 0.3), low, high)
    return found


def _misplaced(model: pin.Model, leg: Leg, angles: Array) -> Array:
    """Directions that should be zero, shape (5,): ankle aside of the hip, sole off the level, toes off ahead.

    Of a leaning foot four: its ankle may be beside the hip.
    """
    data = at(model, angles)
    down = meeting_point(model, data, leg.joints[leg.knee + 1 :]) - leg.hip
    R = (data.oMi[leg.chain[-1]] * leg.sole.placement).rotation
    aside = down[:1] if leg.leans else down[:2]
    return np.concatenate((aside / np.linalg.norm(down), R[:2, 2], R[1:2, 0]))
