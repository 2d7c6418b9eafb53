"""Checks, before a walk begins, that the joints reach its stances and hold them.

Between touchdown and lift-off both feet stand, far apart: there joints come to the ends of their ranges. The place of
the CoM then is that of a pendulum on its periodic walk. Its ZMP goes evenly from one foot to the other in double
support, of duration T_d. It stands still in single support, of duration T_s. At the ends of a double support the CoM is
(1/2 + k) of the way between the feet from their middle:

    along the walk  k = -S_d / (ω T_d (C_d + S_d C_s / S_s)),  sideways  k = -S_d / (ω T_d (C_d + S_d S_s / C_s)),

with C, S = cosh, sinh of ω T / 2. Place and velocity match where the supports meet. There one foot bears all, with a
force that goes from its sole through the CoM (`surefoot.wbc.body.statics.bearing_torque`).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.models.facts import knee_turn
from surefoot.planner.geometry.plane import frame_rotation, sole_angles, sole_pose
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.rolling import FootRoll, RollSpan, heel_strike, pivot_of, strides, toe_off
from surefoot.planner.types import GRAVITY, Array, Foot, Footstep
from surefoot.scenarios.file.group import RecoverySettings
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.robot.body import Body, body_of
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.wbc.body.ik import PostureIk, PostureResult, PostureTarget
from surefoot.wbc.body.statics import bearing_torque

MISSING = 0.01
"""Lack of a stance up to which a walk is not refused: the controller lets trunk and CoM give way by it [m, rad]."""

SPARE = 0.06
"""Distance of the legs' joints from the ends of their ranges in these stances [rad].

The walk itself needs some way beside what its periodic likeness does.
"""

_LOOKED_AT = 1000
"""Footsteps that are looked at; equal ones once."""

_EXACTLY = 1e-4
"""Lack of a stance whose knees are measured [m, rad]."""

_AT_END = 0.01
"""A joint that is nearer to the end of its range is at it [rad]."""


@dataclass(frozen=True, slots=True)
class Stance:
    """Both feet on the ground at an end of a double support.

    Attributes:
        number: of the footstep that begins it.
        soles: left and right sole, x y z, heading, pitch and roll, shape (2, 6) [m, rad].
        com: where the CoM is, shape (3,) [m].
        heading: of the trunk [rad].
        landing: whether the foot has just landed, or the other one is about to leave.
        bearing: the foot that bears all, 0 the left one.
        rolled: whether the other one stands on its toe edge.
    """

    number: int
    soles: Array
    com: Array
    heading: float
    landing: bool
    bearing: int
    rolled: bool

    @property
    def moment(self) -> str:
        """Moment of its footstep."""
        return "lands" if self.landing else "bears the other one's lift-off"


def check_stances(walk: Walk, body: Body, q: Array) -> None:
    """Refuse a walk some stance of which a body's joints do not reach or hold; ``q`` is its start, shape (nq,).

    Raises:
        ParameterError: says at which footstep, and which joint is at the end of its range or would need more than its
            largest torque.
    """
    spare = np.where(body.leg_joints, SPARE, 0.0)
    limits = replace(body.limits, lower=body.limits.lower + spare, upper=body.limits.upper - spare)
    ik = replace(body, limits=limits).ik(body.robot.nominal_joint_positions)
    for stance in _stances(walk):
        found = _taken(ik, walk, stance, q)
        if not found.reached and stance.rolled:
            continue  # how far ankles come while a foot rolls is for the rehearsal to say
        if not found.reached:
            raise _unreached(walk, body, stance, found.q, found.error)
        _check_torque(walk, body, stance, found.q)


def least_bend(walk: Walk, body: Body) -> float | None:
    """Least bend of the straighter knee in a walk's stances [rad]; None where none is known beforehand.

    Raises:
        ParameterError: the legs do not reach where it begins.
    """
    q, ik = start_posture(walk, body), body.ik(body.robot.nominal_joint_positions)
    knees = list(body.robot.joint_indices(body.robot.roles.knees))
    straight, turn = body.robot.straight_joint_positions[knees], np.array([knee_turn(body.robot, k) for k in (0, 1)])
    taken = [_taken(ik, walk, stance, q, _EXACTLY).q for stance in _stances(walk)]
    return min((float((turn * np.abs(one[7:][knees] - straight)).min()) for one in taken), default=None)


_WAYS = (-0.06, 0.03)
"""Least and greatest height at which it is sought, of the leg's length [-]."""

_DECIMALS = 4
"""Decimals of a height [m]."""


_NO_STANCE: dict[str, Any] = dict.fromkeys(("name", "pushes", "faults", "criteria", "requirements"), True) | {
    "planner": {"recovery": set(RecoverySettings.model_fields) - {"sole_gap"}}
}
"""Keys of a scenario that change none of the stances that its gait goes through."""


def bent_once(before: Scenario, after: Scenario, robots: Robots) -> float:
    """The height of `bent_alike`, sought once for each pair of walks: the points of a campaign ask for the same two."""
    key = before.model_dump_json(exclude=_NO_STANCE), after.model_dump_json(exclude=_NO_STANCE)
    if key not in robots.heights:
        robots.heights[key] = bent_alike(before, after, robots)
    return robots.heights[key]


def bent_alike(before: Scenario, after: Scenario, robots: Robots) -> float:
    """CoM height with which the straightest knee is bent as that of another robot on its walk [m].

    Equal legs alone do not say it. The hips' place over the feet depends on the CoM beside the hips, on the mass of the
    legs, on the length of the soles and on the distance of the hips. So both robots stand as they would.

    Args:
        before: the walk of the other one.
        after: the same walk of the one in question, at about that height.
        robots: that they name.

    Returns:
        The height; as it is where no stance is known beforehand, or none near it makes them alike.

    Raises:
        ParameterError: the other one cannot stand so.
    """
    from scipy.optimize import brentq

    of, walk = (resolve(one, robots.description(one.robot, one.robot_options)) for one in (before, after))
    body, leg, height = body_of(walk.robot), walk.robot.leg_length, walk.gait.com_height

    def bend(tried: float) -> float:
        """Bend of the knees with the CoM at a height; none where the legs do not reach."""
        gait = after.gait.model_copy(update={"com_height": tried})
        try:
            return least_bend(replace(walk, keys=after.model_copy(update={"gait": gait})), body) or 0.0
        except ParameterError:
            return 0.0

    wanted = least_bend(of, body_of(of.robot))
    if wanted is None:
        return height
    low, high = (height + leg * way for way in _WAYS)
    try:
        found = brentq(lambda tried: bend(tried) - wanted, low, high, xtol=0.5 * 10.0**-_DECIMALS)
    except ValueError:  # nowhere between them
        return height
    return round(float(found), _DECIMALS)


def _taken(ik: PostureIk, walk: Walk, stance: Stance, q: Array, tolerance: float = MISSING) -> PostureResult:
    """A stance, from where the walk begins, to a tolerance [m, rad]."""
    begin, soles = q.copy(), stance.soles
    begin[:2] = stance.com[:2]
    begin[2] += stance.com[2] - walk.start_com_height
    begin[3:7] = 0.0, 0.0, math.sin(0.5 * stance.heading), math.cos(0.5 * stance.heading)
    target = PostureTarget(soles[:, :3], soles[:, 3], stance.com, stance.heading, soles[:, 4:])
    return ik.solve(target, begin, tolerance=tolerance)


def _check_torque(walk: Walk, body: Body, stance: Stance, q: Array) -> None:
    robot = body.robot
    needed = np.where(body.leg_joints, np.abs(bearing_torque(body.model, body.frames, q, stance.bearing)), 0.0)
    worst = int(np.argmax(needed / robot.torque_limit))
    if needed[worst] > robot.torque_limit[worst]:
        raise _refusal(
            walk,
            stance,
            f"joint '{robot.joint_names[worst]}' of robot '{robot.name}' would need {needed[worst]:.0f} N m when "
            f"footstep {stance.number} {stance.moment}, its limit is {robot.torque_limit[worst]:.0f} N m",
            "take shorter steps, or a higher gait.com_height",
        )


def _unreached(walk: Walk, body: Body, stance: Stance, q: Array, error: float) -> ParameterError:
    robot = body.robot
    left = np.minimum(q[7:] - robot.position_lower, robot.position_upper - q[7:])
    ends = [robot.joint_names[j] for j in np.flatnonzero((left < SPARE + _AT_END) & body.leg_joints)]
    what = (
        f"robot '{robot.name}' cannot stand as it would when footstep {stance.number} {stance.moment}: "
        f"{error:.3f} m or rad are missing"
    )
    if ends:
        what += f" with {' and '.join(repr(name) for name in ends)} at the end of their range"
    return _refusal(walk, stance, what, "take shorter or narrower steps, or another gait.com_height")


def _refusal(walk: Walk, stance: Stance, what: str, right: str) -> ParameterError:
    if np.any(stance.soles[:, 4:]):
        return ParameterError(("terrain", "angle"), what, "give less steep ground, or another gait.com_height")
    if walk.ground.terrain.has_edges and abs(float(np.ptp(stance.soles[:, 2]))) > 1e-3:
        right = "give lower stairs, another gait.com_height, or feet that roll (gait.heel_off)"
        return ParameterError(("terrain", "riser"), what, right)
    return ParameterError(("gait", "step_length"), what, right)


def _stances(walk: Walk) -> Iterator[Stance]:
    """Both ends of each double support between two steps; of alike ones the first."""
    gait = replace(walk.gait, steps=min(walk.gait.steps, _LOOKED_AT)) if not walk.gait.bouts else walk.gait
    footsteps = plan_footsteps(gait, walk.ground.stance, walk.ground.terrain)
    seen: set[tuple[float, ...]] = set()
    for row in range(2, min(len(footsteps), _LOOKED_AT + 2)):
        stands, lands, lifted = (footsteps[one] for one in (row - 1, row, row - 2))
        way, lead = lands.position - stands.position, 0.5 * (lands.position - lifted.position)
        R = frame_rotation(stands.yaw)
        tilts = (tilt for step in (stands, lands) for tilt in sole_angles(step.normal, step.yaw))
        kind = (*way[:2] @ R, way[2], *lead[:2] @ R, lands.yaw - stands.yaw, lands.foot, *tilts)
        key = tuple(round(float(value), 3) for value in kind)
        if key in seen:
            continue
        seen.add(key)
        last = row == len(footsteps) - 1
        for landing in (True,) if last else (True, False):
            yield _stance(walk, stands, lands, (way, lead), row - 1, landing)


def _stance(
    walk: Walk, stands: Footstep, lands: Footstep, ways: tuple[Array, Array], number: int, landing: bool
) -> Stance:
    (way, lead), gait, toe = ways, walk.gait, 0.5 * walk.sole[0]
    low = min(float(stands.position[2]), float(lands.position[2]))
    ahead, aside = (0.5 + share for share in _shares(gait))
    off = ahead * lead[:2] + aside * (way - lead)[:2]
    middle = 0.5 * (stands.position + lands.position)[:2]
    com = np.append(middle + (-off if landing else off), low + gait.com_height)
    span = None
    if strides(stands, lands, toe):
        strike = _strike(walk, stands, lands)
        span = strike if landing else _leave(gait, stands.foot, strike is not None)
    poses = {step.foot: sole_pose(step.position, step.yaw, step.normal) for step in (stands, lands)}
    heading = float(np.mean([pose[3] for pose in poses.values()]))
    if span is not None:
        poses[span.foot] = _on_edge(poses[span.foot], span, toe)
    soles = np.array([poses[foot] for foot in sorted(poses)])
    return Stance(
        number, soles, com, heading, landing, int((stands if landing else lands).foot), not landing and span is not None
    )


def _leave(gait: GaitParameters, foot: Foot, on_heel: bool) -> RollSpan | None:
    """The roll of a foot that leaves the ground now, after a landing on the heel; None of one that stays level [s]."""
    if not gait.heel_off:
        return None
    return toe_off(foot, gait.double_support, 0.0, gait.single_support, gait.heel_off, on_heel)


def _strike(walk: Walk, stands: Footstep, lands: Footstep) -> RollSpan | None:
    """The roll of a foot that lands now; None of one that lands flat [s]."""
    gait, climb = walk.gait, float(lands.position[2] - stands.position[2])
    if not gait.heel_strike or walk.ground.terrain.footholds.edged(climb):
        return None
    return heel_strike(lands.foot, 0.0, gait.single_support, gait.double_support, gait.heel_strike)


def _on_edge(sole: Array, span: RollSpan, half_length: float) -> Array:
    """A sole turned about its edge as far as it is at time 0 of its roll, shape (6,) [m, rad]."""
    roll = FootRoll(span.foot, span.start, span.end, span.angle, pivot_of(span.angle, half_length))
    centre, _ = roll.centre(0.0, sole, np.zeros(6))
    return np.concatenate((centre, (sole[3], sole[4] + roll.evaluate(0.0)[0], sole[5])))


def _shares(gait: GaitParameters) -> tuple[float, float]:
    """The two k of the module's equation, along the walk and sideways [-]."""
    omega = math.sqrt(GRAVITY / gait.com_height)
    double, single = (0.5 * omega * time for time in (gait.double_support, gait.single_support))
    C, S, t = math.cosh(double), math.sinh(double), math.tanh(min(single, 50.0))
    return -S / (2.0 * double * (C + S / t)), -S / (2.0 * double * (C + S * t))
