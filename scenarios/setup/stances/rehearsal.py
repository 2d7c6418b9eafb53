"""The first steps of a walk, gone through by the planner's chain of links: it finds what the legs cannot do."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from surefoot.errors import ParameterError, at_most
from surefoot.maths.polygon import convex_hull
from surefoot.models.facts import ankle_pitch, knee_turn, pitch_joints, shank_outline, yaw_joint
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.plants import IdealFeet
from surefoot.planner.types import Array, CentroidalState, FeetState, Foot, PhaseKind
from surefoot.scenarios.setup.walk import Walk

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription
    from surefoot.planner.parameters import LegInertia

STEPS = 3
"""Steps that are gone through: the first, and one of each foot in the rhythm of the walk [-]."""

SWING_PEAK = 1.9
"""Largest over mean speed of what turns with a foot in single support [-]."""

FAST = 0.35
"""Share of a joint's no-load speed that a leg's mean turn of the hip needs at least to be looked at [-]."""

_GRID = 0.002
"""Distance of the points at which the ground is looked at, for the reference robot [m]."""

_HALVINGS = 5
"""Halvings of that distance to find an edge in it [-]."""

_CLEAR = 0.002
"""Distance of a shank from an edge that is too small to be sure of, of the reference robot [m]."""


@dataclass(frozen=True, slots=True)
class Rehearsed:
    """A walk as it is planned, at the n ticks of the planner.

    Attributes:
        sample_time: between them [s].
        com: shape (n, 3) [m].
        soles: left and right as if they were level, shape (2, n, 3) [m].
        heading: of the feet, shape (2, n) [rad].
        pitch: of the feet, heel up about their toe edges, negative about their heel edges, shape (2, n) [rad].
        standing: whether a foot stands, shape (2, n).
    """

    sample_time: float
    com: Array
    soles: Array
    heading: Array
    pitch: Array
    standing: Array


Outline = Callable[["RobotDescription", int], Array]
"""Gives the corners of the shank of a foot as `shank_outline` does."""


def check_legs(walk: Walk, feet: FeetState, leg: "LegInertia", outline_of: Outline = shank_outline) -> None:
    """Refuse a walk whose first steps the legs cannot make from where the feet stand at the start.

    Args:
        walk: that is looked at.
        feet: where they stand.
        leg: masses and lengths of a leg.
        outline_of: gives the outline of a shank.

    Raises:
        ParameterError: a joint would have to be faster than it can, or go farther, or a shank would meet an edge.
    """
    chain = leg.chain
    fast, rolls = _fast(walk), walk.gait.heel_off > 0.0 or walk.gait.heel_strike > 0.0
    if (
        chain is None
        or walk.formulation.profile.planner is not None
        or not (fast or rolls or walk.ground.terrain.has_edges)
    ):
        return
    way = rehearsed(walk, feet, leg)
    toe = 0.5 * walk.robot.sole_length
    joints = chain.joints(way.com, way.soles, way.heading, way.pitch, toe)
    angles = joint_angles(joints, way)
    if fast:
        _check_speeds(walk.robot, angles, way.sample_time)
    if rolls:
        _check_ankles(walk.robot, angles[2], way)
    if walk.ground.terrain.has_edges:
        _check_shanks(walk, way, joints, outline_of)


def check_turns(walk: Walk) -> None:
    """Refuse a walk that turns faster than the hips do.

    Raises:
        ParameterError: says which joint is too slow, and the largest turn.
    """
    turn, key = _largest_turn(walk)
    for foot in Foot:
        name, robot = yaw_joint(walk.robot, foot), walk.robot
        limit = float(robot.velocity_limit[robot.joint_names.index(name)])
        speed = SWING_PEAK * turn / walk.gait.single_support
        if speed > limit:
            raise ParameterError(
                key,
                f"joint '{name}' of robot '{robot.name}' would need {speed:.2g} rad/s to turn by {turn:.2g} rad in a "
                f"step, its no-load speed is {limit:g} rad/s",
                f"use a yaw_rate of at most {at_most(turn / walk.gait.period * limit / speed)} rad/s",
            )


def _largest_turn(walk: Walk) -> tuple[float, tuple[str, ...]]:
    """Largest turn of the trunk in a step [rad], and its keys; a foot turns by twice that, a hip by as much."""
    turn = max((abs(stride.yaw) for stride in walk.gait.strides), default=0.0)
    most, commands = walk.region.turn, walk.commands
    if any(command.places for command in commands):
        return most, ("gait", "waypoints")
    rates = [abs(command.twist.yaw) for command in commands if command.twist is not None]
    asked = min(most, max(rates, default=0.0) * walk.gait.period)
    return (asked, ("commands",)) if asked > turn else (turn, ("gait", "velocity" if walk.gait.bouts else "turn"))


def _fast(walk: Walk) -> bool:
    """Return true if the legs of a walk are anywhere near as fast as their joints can."""
    gait, robot = walk.gait, walk.robot
    longest = max((abs(stride.x) for bout in gait.bouts for stride in bout.strides), default=abs(gait.step_length))
    least = min(robot.velocity_limit[k] for k in robot.joint_indices(robot.roles.legs))
    return bool(2.0 * longest / gait.single_support > FAST * least * robot.leg_length)


def rehearsed(walk: Walk, feet: FeetState, leg: "LegInertia") -> Rehearsed:
    """The first steps of a walk, with a CoM and feet that do what is planned."""
    planner, ideal = walk.planner(feet, leg), IdealFeet(feet)
    com, velocity = np.array([walk.start.x, walk.start.y, walk.start_com_height]), np.zeros(3)
    t, rows, tick = planner.parameters.sample_time, [], 0
    while True:
        plan = planner.update(CentroidalState(tick * t, com, velocity), ideal.state)
        pitch = np.zeros(2)
        for roll in plan.rolls:
            if roll.rolling(plan.time):
                pitch[roll.foot] = roll.evaluate(plan.time)[0]
        rows.append((com, ideal.state.position, ideal.state.yaw, pitch, np.array(plan.contacts[0])))
        stands = plan.phase.kind is PhaseKind.STAND and math.isinf(plan.phase.duration)
        if plan.phase.step > STEPS or (stands and tick > 0) or tick * t > walk.duration:
            break
        com, velocity, tick = plan.com[1], plan.com_velocity[1], tick + 1
        ideal.follow(PlanSampler(plan), tick * t)
    coms, soles, yaws, pitches, standing = (np.array(column) for column in zip(*rows, strict=True))
    return Rehearsed(t, coms, soles.transpose(1, 0, 2), yaws.T, pitches.T, standing.T)


def joint_angles(joints: tuple[Array, Array, Array], way: Rehearsed) -> Array:
    """Pitch angles of hip, knee and ankle, left and right, shape (3, 2, n) [rad]."""
    hips, knees, ankles = joints
    ahead = np.stack((np.cos(way.heading), np.sin(way.heading)), axis=-1)
    lean = [
        np.arctan2(np.einsum("kni,kni->kn", (upper - lower)[..., :2], ahead), (upper - lower)[..., 2])
        for upper, lower in ((hips, knees), (knees, ankles))
    ]
    return np.stack((lean[0], lean[1] - lean[0], lean[1] - way.pitch))


def _check_speeds(robot: "RobotDescription", angles: Array, sample_time: float) -> None:
    speed = np.abs(np.gradient(angles, sample_time, axis=2)).max(axis=2)
    speed[1] /= [knee_turn(robot, foot) for foot in Foot]
    names = [pitch_joints(robot, foot) for foot in Foot]
    limits = np.array([[robot.velocity_limit[robot.joint_names.index(names[k][j])] for k in (0, 1)] for j in range(3)])
    joint, foot = np.unravel_index(np.argmax(speed / limits), speed.shape)
    if speed[joint, foot] > limits[joint, foot]:
        name, limit = names[foot][joint], limits[joint, foot]
        raise ParameterError(
            ("gait", "single_support"),
            f"joint '{name}' of robot '{robot.name}' would need {speed[joint, foot]:.1f} rad/s, its no-load speed is "
            f"{limit:g} rad/s",
            "take shorter or slower steps",
        )


def _check_ankles(robot: "RobotDescription", angles: Array, way: Rehearsed) -> None:
    """Check the ankles of feet that roll, at whose lift-off `check_stances` does not look; angles (2, n) [rad].

    The rehearsal is the walk itself, so that nothing is to spare as in the stances of a walk's periodic likeness.
    """
    for foot in Foot:
        index, zero, sign = ankle_pitch(robot, foot)
        position = np.where(way.standing[foot], zero + sign * angles[foot], robot.nominal_joint_positions[index])
        ends = robot.position_lower[index], robot.position_upper[index]
        left = np.minimum(position - ends[0], ends[1] - position)
        at = int(np.argmin(left))
        if left[at] < 0.0:
            end = min(ends, key=lambda limit: abs(float(limit - position[at])))
            raise ParameterError(
                ("gait", "step_length"),
                f"joint '{robot.joint_names[index]}' of robot '{robot.name}' would come to {position[at]:.2f} rad "
                f"{at * way.sample_time:.2f} s after the start, its range ends at {end:.2f} rad",
                "take shorter steps, lower risers or a larger gait.heel_off",
            )


def _check_shanks(walk: Walk, way: Rehearsed, joints: tuple[Array, Array, Array], outline_of: Outline) -> None:
    _, knees, ankles = joints
    for foot in Foot:
        outline = outline_of(walk.robot, foot)
        if len(outline) < 3:
            continue
        depth, at = _overlap(walk, way, foot, convex_hull(outline), knees[foot], ankles[foot])
        if depth > -_CLEAR * walk.size.length:
            near = f"{depth:.3f} m into" if depth > 0.0 else f"within {-depth:.3f} m of"
            raise ParameterError(
                ("terrain", "riser"),
                f"the {foot.name.lower()} shank of '{walk.robot.name}' would come {near} the edge ahead "
                f"{at * way.sample_time:.2f} s after the start",
                "use lower risers or deeper treads",
            )


def _overlap(walk: Walk, way: Rehearsed, foot: int, outline: Array, knees: Array, ankles: Array) -> tuple[float, int]:
    """Greatest depth of a standing foot's shank in an edge ahead, negative outside, and its time [m, ticks].

    The outline is convex and anticlockwise.
    """
    sides = np.roll(outline, -1, axis=0) - outline
    outward = np.column_stack((sides[:, 1], -sides[:, 0])) / np.linalg.norm(sides, axis=1)[:, None]
    room = np.einsum("ij,ij->i", outward, outline)
    worst, when, known = -math.inf, 0, (math.nan, math.nan)
    edges = np.zeros((0, 2))
    for k in np.flatnonzero(way.standing[foot]):
        sole, heading = way.soles[foot, k], np.array([math.cos(way.heading[foot, k]), math.sin(way.heading[foot, k])])
        if (sole[0], sole[1]) != known:
            known, edges = (sole[0], sole[1]), edges_ahead(walk, sole, heading)
        if not len(edges):
            continue
        up = np.array([(knees[k] - ankles[k])[:2] @ heading, (knees[k] - ankles[k])[2]])
        up /= np.linalg.norm(up)
        ankle = np.array([(ankles[k] - sole)[:2] @ heading, ankles[k, 2] - sole[2]])
        R = np.array([[up[1], up[0]], [-up[0], up[1]]])  # columns: ahead, along the shank
        local = (edges - ankle) @ R
        inside = (room[:, None] - outward @ local.T).min(axis=0)
        if inside.max() > worst:
            worst, when = float(inside.max()), int(k)
    return worst, when


def edges_ahead(walk: Walk, sole: Array, heading: Array) -> Array:
    """Upper edges ahead of a sole that are higher than it, shape (m, 2): ahead and up from its centre [m]."""
    grid = _GRID * walk.size.length
    ahead = np.arange(0.0, 0.6 * walk.robot.leg_length, grid)
    heights = walk.ground.terrain.heights(sole[:2] + ahead[:, None] * heading) - sole[2]
    rises = np.flatnonzero(np.diff(heights) > grid)
    before, behind, upper = ahead[rises], ahead[rises + 1], heights[rises + 1]
    for _ in range(_HALVINGS):
        middle = 0.5 * (before + behind)
        low = walk.ground.terrain.heights(sole[:2] + middle[:, None] * heading) - sole[2] < upper - 0.5 * grid
        before, behind = np.where(low, middle, before), np.where(low, behind, middle)
    return np.column_stack((behind, upper))
