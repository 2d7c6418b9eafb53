"""Limits of a robot's legs are found before the run, by what their joints and shanks would have to do."""

from dataclasses import replace

import numpy as np
import pytest

import surefoot
from surefoot.errors import ParameterError
from surefoot.models.facts import pitch_joints, shank_outline
from surefoot.planner.types import Foot
from surefoot.scenarios.setup.robot.body import body_of, feet_at, leg_inertia
from surefoot.scenarios.setup.stances.rehearsal import check_legs, edges_ahead, joint_angles, rehearsed
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit

QUICK = {"gait.initial_stand": 0.1, "gait.steps": 3}
STAIRS = {"terrain.kind": "stairs", "terrain.riser": 0.185, "terrain.tread": 0.28, "robot_options.foot_length": 0.22}


def legs_of(walk: Walk):
    body = body_of(walk.robot)
    posture = start_posture(walk, body)
    return walk, feet_at(body, posture), leg_inertia(body.model, body.frames, posture, body.leg_joints)


def slowed(walk: Walk, share: float) -> Walk:
    """The walk of a robot whose joints are slower."""
    return replace(walk, described=replace(walk.robot, velocity_limit=share * walk.robot.velocity_limit))


@pytest.fixture(scope="module")
def brisk():
    return legs_of(resolve(surefoot.load("walk-level", QUICK)))


def test_a_joint_that_would_be_too_fast_is_named_with_the_speeds(brisk):
    walk, feet, leg = brisk
    check_legs(walk, feet, leg)
    with pytest.raises(ParameterError, match=r"joint '\w+' of robot 'humanoid100' would need \d+\.\d rad/s"):
        check_legs(slowed(walk, 0.15), feet, leg)


def test_joint_speeds_are_those_of_the_walk(brisk):
    """Within a fifth of the largest joint speed that `surefoot check` holds for this walk in full physics."""
    walk, feet, leg = brisk
    way = rehearsed(walk, feet, leg)
    joints = leg.chain.joints(way.com, way.soles, way.heading, way.pitch, 0.11)
    speed = np.abs(np.gradient(joint_angles(joints, way), way.sample_time, axis=2)).max(axis=2)
    limit = np.array(
        [
            [
                walk.robot.velocity_limit[walk.robot.joint_names.index(pitch_joints(walk.robot, foot)[j])]
                for foot in Foot
            ]
            for j in range(3)
        ]
    )
    assert (speed / limit).max() == pytest.approx(0.298, rel=0.2)


def test_slow_walks_on_level_ground_are_not_gone_through(brisk):
    """No walk could be gone through on feet that nobody knows."""
    walk, _, leg = brisk
    check_legs(walk, None, leg)
    climbing = resolve(surefoot.load("walk-level", {**QUICK, **STAIRS}))
    with pytest.raises(AttributeError):
        check_legs(climbing, None, leg)


def test_pitch_joints_are_found_by_their_axes():
    robot = resolve(surefoot.load("walk-level")).robot
    for foot, leg in zip(Foot, (robot.roles.left_leg, robot.roles.right_leg), strict=True):
        names = pitch_joints(robot, foot)
        assert names[1] == robot.roles.knees[foot]
        assert [leg.index(name) for name in names] == sorted(leg.index(name) for name in names)
        assert all("pitch" in name for name in (names[0], names[2]))


def test_a_shank_that_would_meet_the_riser_ahead_is_refused():
    walk, feet, leg = legs_of(resolve(surefoot.load("walk-level", {**QUICK, **STAIRS, "gait.single_support": 0.6})))
    check_legs(walk, feet, leg)
    outline = shank_outline(walk.robot, Foot.LEFT)
    assert np.ptp(outline[:, 0]) < 0.2 < np.ptp(outline[:, 1])
    thick = outline * np.array([2.5, 1.0])
    with pytest.raises(ParameterError, match=r"shank of 'humanoid100' would come 0\.\d+ m into the edge ahead"):
        check_legs(walk, feet, leg, lambda *_: thick)


def test_an_edge_is_where_it_is_wherever_it_is_seen_from():
    walk = resolve(surefoot.load("walk-level", {**QUICK, **STAIRS}))
    ahead = np.array([1.0, 0.0])
    seen = [x + edges_ahead(walk, np.array([x, 0.1, 0.0]), ahead)[0, 0] for x in np.linspace(0.0, 0.005, 11)]
    assert np.ptp(seen) < 1e-4


def test_a_shank_so_near_to_the_riser_that_it_may_meet_it_is_refused():
    """Two millimetres are too few to be sure of."""
    walk, feet, leg = legs_of(resolve(surefoot.load("walk-level", {**QUICK, **STAIRS, "gait.single_support": 0.6})))
    outline = shank_outline(walk.robot, Foot.LEFT)

    def said(ahead: float) -> str:
        moved = np.concatenate((outline, outline + np.array([ahead, 0.0])))
        outlines = {Foot.LEFT: moved, Foot.RIGHT: outline}
        try:
            check_legs(walk, feet, leg, lambda _, foot: outlines[foot])
        except ParameterError as error:
            return error.what
        return ""

    near, far = 0.0, 0.4
    while far - near > 2e-4:
        middle = 0.5 * (near + far)
        near, far = (near, middle) if "into the edge" in said(middle) else (middle, far)
    assert "would come within 0.001 m of the edge ahead" in said(near - 0.001)
    assert said(near - 0.003) == ""


def test_an_ankle_that_would_come_to_its_end_before_the_foot_rolls_is_named(brisk):
    """A walk whose feet roll is refused where the ankles have just less range than its first steps take."""
    walk, feet, leg = brisk
    gait = walk.keys.gait.model_copy(update={"heel_off": 0.3})
    rolls = replace(walk, keys=walk.keys.model_copy(update={"gait": gait}))
    check_legs(rolls, feet, leg)
    way = rehearsed(rolls, feet, leg)
    joints = leg.chain.joints(way.com, way.soles, way.heading, way.pitch, 0.11)
    bent = float(joint_angles(joints, way)[2][way.standing].max())
    ankles = [walk.robot.joint_names.index(f"{side}_ankle_pitch") for side in ("left", "right")]
    for more, named in ((0.005, False), (-0.005, True)):
        lower = walk.robot.position_lower.copy()
        lower[ankles] = -bent - more
        robot = replace(walk.robot, position_lower=lower)
        if not named:
            check_legs(replace(rolls, described=robot), feet, leg)
            continue
        with pytest.raises(
            ParameterError, match=r"joint '\w+_ankle_pitch' of robot 'humanoid100' would come to -0\.\d+ rad"
        ):
            check_legs(replace(rolls, described=robot), feet, leg)
        check_legs(replace(walk, described=robot), feet, leg)
