from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.model.leg_body import Body
from surefoot.planner.model.leg_chain import LegChain, Link

pytestmark = pytest.mark.unit

T = 0.005
HIPS, KNEES, ANKLES, TRUNK = slice(0, 2), slice(2, 4), slice(4, 6), 8  # of the points of a body
THIGH, SHANK = Link(0.43, 0.1, 0.33, 1.7e-3), Link(0.41, 0.04, 0.4, 6e-4)
CHAIN = LegChain(0.1, (0.01, 0.0, 0.3), THIGH, SHANK, 0.02, (0.02, 0.0, -0.04), (-0.02, 0.0, 0.08))


def walking(n=41):
    """CoM (n, 3) and soles (2, n, 3) of a walk-like motion."""
    t = T * np.arange(n)
    com = np.column_stack([t + 0.01 * np.sin(9.0 * t), 0.03 * np.cos(6.0 * t), 0.95 + 0.01 * np.sin(12.0 * t)])
    stance = np.tile([0.05, 0.1, 0.0], (n, 1))
    swing = np.column_stack([-0.3 + 2.5 * t, np.full(n, -0.1), 0.05 * np.sin(15.0 * t) ** 2])
    return com, np.stack([stance, swing])


def axes(heading):
    """Forward, left and up at each sample, shape (..., n, 3, 3)."""
    c, s, zero = np.cos(heading), np.sin(heading), np.zeros_like(heading)
    rows = (c, s, zero), (-s, c, zero), (zero, zero, zero + 1.0)
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def posture(chain, ankles, heading):
    """Hips and knees, shape (2, n, 3) each, and the middle of the pelvis, shape (n, 3)."""
    soles = ankles - np.array(chain.ankle) @ axes(heading)
    points = chain.body(np.zeros(ankles.shape[1:]), soles, heading).points.swapaxes(1, 2)
    np.testing.assert_allclose(points[ANKLES], ankles, atol=1e-12)
    middle = points[TRUNK] - np.array(chain.trunk) @ axes(heading.mean(axis=0))
    return points[HIPS], points[KNEES], middle


def bent(ways, sample_time):
    """Accelerations of points of shape (points, n, 3), by differences less their error to fourth order."""
    bends = np.diff(ways, 2, axis=1)
    rest = np.pad(np.diff(bends, 2, axis=1), ((0, 0), (1, 1), (0, 0)), mode="edge")
    return (bends - rest / 12.0) / sample_time**2


def felt(ways, sample_time):
    """Accelerations of one point of shape (1, n, 3), as a body has them."""
    count = ways.shape[1]
    body = Body(CHAIN, 0.0, count)
    body.points[0] = ways[0].T
    body.turn_momentum(count, sample_time, 3)
    return body.bends[:1, :, : count - 2].swapaxes(1, 2) / sample_time**2


def bodies(chain, com, soles, heading):
    """Point masses (points, masses) that are equimomental to the chain's rods, feet and trunk."""
    frame, legs = axes(heading.mean(axis=0)), axes(heading)
    ankles = soles - com + np.array(chain.ankle) @ legs
    hips, knees, middle = posture(chain, ankles, heading)
    outward = legs[..., 1, :] * np.array([1.0, -1.0])[:, None, None]
    points, masses = [], []
    for upper, lower, link in ((hips, knees, chain.thigh), (knees, ankles, chain.shank)):
        # A rod's mass sits at its CoM but for two equal masses at a distance d either side, 2 m d² = I.
        half = 0.25 * link.mass
        d = np.sqrt(link.inertia / (2.0 * half)) / link.length
        for share, mass in ((link.centre, link.mass - 2 * half), (link.centre - d, half), (link.centre + d, half)):
            beside = link.outward * outward + link.ahead * np.cross(lower - upper, legs[..., 1, :])
            points.append(upper + share * (lower - upper) + beside)
            masses.append(np.full(2, mass))
    points.append(ankles + np.array(chain.foot_centre) @ legs + chain.foot_outward * outward)
    masses.append(np.full(2, chain.foot_mass))
    trunk = middle + np.array(chain.trunk) @ frame
    points.append(np.stack([trunk, trunk]))
    masses.append(np.full(2, 0.5 - chain.thigh.mass - chain.shank.mass - chain.foot_mass))
    return np.concatenate(points), np.concatenate(masses)


def test_a_rods_mass_matrix_gives_its_kinetic_energy():
    rng = np.random.default_rng(0)
    upper, lower = np.zeros(2), np.array([0.0, -THIGH.length])
    velocity = rng.normal(size=2)
    spin = rng.normal()
    turn = spin * np.array([THIGH.length, 0.0])
    ends = np.stack([velocity, velocity + turn])
    centre = velocity + THIGH.centre * turn
    energy = 0.5 * THIGH.mass * centre @ centre + 0.5 * THIGH.inertia * spin**2
    assert 0.5 * np.einsum("ij,ix,jx", THIGH.mass_matrix(), ends, ends) == pytest.approx(energy, rel=1e-12)
    assert np.linalg.norm(upper - lower) == THIGH.length


def test_links_keep_their_lengths_and_knees_bend_forward():
    com, soles = walking()
    ankles = soles - com + np.array(CHAIN.ankle)
    hips, knees, _ = posture(CHAIN, ankles, np.zeros((2, len(com))))
    np.testing.assert_allclose(np.linalg.norm(knees - hips, axis=-1), THIGH.length, rtol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(knees - ankles, axis=-1), SHANK.length, rtol=0.02)
    assert np.all(knees[..., 0] > np.minimum(hips[..., 0], ankles[..., 0]))


def test_posture_has_the_com_it_was_asked_for():
    com, soles = walking()
    points, masses = bodies(CHAIN, com, soles, np.zeros((2, len(com))))
    assert masses.sum() == pytest.approx(1.0)
    found = np.einsum("k,kni->ni", masses, points)
    assert np.abs(found).max() < 2e-3
    assert np.ptp(found, axis=0).max() < 1e-3


def test_heavy_legs_take_more_corrections():
    """Legs that weigh three quarters of the body leave the CoM where it was asked for, as light ones do."""
    thigh, shank = replace(THIGH, mass=0.2), replace(SHANK, mass=0.15)
    chain = replace(CHAIN, thigh=thigh, shank=shank)
    com, soles = walking()
    points, masses = bodies(chain, com, soles, np.zeros((2, len(com))))
    found = np.einsum("k,kni->ni", masses, points)
    assert chain.carried < CHAIN.carried
    assert np.abs(found).max() < 3e-3


def test_a_heavy_leg_whose_mass_lies_ahead_leaves_the_com_where_it_was_asked_for():
    thigh, shank = replace(THIGH, mass=0.17, ahead=0.05), replace(SHANK, mass=0.15, ahead=0.1)
    chain = replace(CHAIN, thigh=thigh, shank=shank)
    com, soles = walking()
    points, masses = bodies(chain, com - np.array([0.0, 0.0, 0.2]), soles, np.zeros((2, len(com))))
    assert np.abs(np.einsum("k,kni->ni", masses, points)).max() < 1e-3


@pytest.mark.parametrize(("degrees", "most"), [(10.0, 4.5), (20.0, 1.5), (40.0, 0.5)])
def test_a_knee_near_straight_is_hardly_bent_more_than_it_is(degrees, most):
    angle = np.radians(degrees)
    reach = np.sqrt(THIGH.length**2 + SHANK.length**2 + 2.0 * THIGH.length * SHANK.length * np.cos(angle))
    thigh, shank, none = replace(THIGH, mass=0.0), replace(SHANK, mass=0.0), (0.0, 0.0, 0.0)
    chain = LegChain(0.1, none, thigh, shank, 0.0, none, none)
    soles = np.array([[[0.0, 0.1, -reach]], [[0.0, -0.1, -reach]]])
    (hip, knee, _) = (joint[0, 0] for joint in chain.joints(np.zeros((1, 3)), soles, np.zeros((2, 1))))
    np.testing.assert_allclose(hip, [0.0, 0.1, 0.0], atol=1e-12)
    lean = np.arcsin(SHANK.length * np.sin(angle) / reach)  # of the thigh, in the triangle of hip, knee and ankle
    assert 0.0 <= 2.0 * np.degrees(np.arctan2(knee[0], -knee[2]) - lean) < most


OUTWARD = replace(CHAIN, thigh=replace(THIGH, outward=0.05), shank=replace(SHANK, outward=0.03), foot_outward=0.02)
AHEAD = replace(CHAIN, thigh=replace(THIGH, ahead=0.1), shank=replace(SHANK, ahead=0.2))


@pytest.mark.parametrize("chain", [CHAIN, OUTWARD, AHEAD])
@pytest.mark.parametrize(("turned", "splay"), [(0.0, 0.0), (0.7, 0.0), (0.7, 0.3)])
def test_momentum_rate_is_that_of_the_point_masses(chain, turned, splay):
    com, soles = walking()
    c, s = np.cos(turned), np.sin(turned)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    com, soles = com @ R.T, soles @ R.T
    heading = np.array([[turned + splay], [turned - splay]]).repeat(len(com), axis=1)
    points, masses = bodies(chain, com, soles, heading)
    expected = np.einsum("k,kni->ni", masses, np.cross(points[:, 1:-1], bent(points, T)))
    rate = chain.momentum_rate(com, soles, heading, T)
    # What a CoM ahead of its rod does to the rod's inertia is meant about the pitch axis alone.
    np.testing.assert_allclose(rate, expected, atol=0.02 * np.abs(expected).max() if chain is AHEAD else 1e-9)
    assert np.abs(rate).max() > 0.5


def test_a_knee_goes_where_its_foot_turns():
    """Feet that turn where they stand carry the knees over sideways, one and the other way."""
    com, soles = walking(1)
    com, soles = np.repeat(com - [0.0, 0.0, 0.05], 41, axis=0), np.repeat(soles, 41, axis=1)
    turning = 0.3 * np.sin(9.0 * T * np.arange(41))
    one, other, both = (
        CHAIN.momentum_rate(com, soles, np.stack(k), T)
        for k in ((turning, 0.0 * turning), (0.0 * turning, turning), (turning, turning))
    )
    assert np.abs(one[:, 0]).max() > 0.05
    np.testing.assert_allclose(one + other, both, atol=0.2 * np.abs(both).max())


@pytest.mark.parametrize("sample", [slice(0, 1), slice(10, 11), slice(-1, None)], ids=["first", "within", "last"])
def test_accelerations_are_exact_to_more_than_second_order(sample):
    """Accelerations of a swing, at either end too: half the sample time leaves an eighth of the error at most."""

    def error(step, derivative):
        t = 0.3 + step * (np.arange(21) - (0 if sample.start == 0 else 20 if sample.stop is None else 11))
        ways = np.stack((np.sin(9.0 * t), np.exp(2.0 * t), t), axis=1)[None]
        exact = np.stack((-81.0 * np.sin(9.0 * t), 4.0 * np.exp(2.0 * t), 0.0 * t), axis=1)[1:-1]
        return np.abs(derivative(ways, step)[0] - exact)[sample].max()

    def second(ways, step):
        return np.diff(ways, 2, axis=1) / step**2

    assert error(0.02, felt) < 0.7 * error(0.02, second)
    assert error(0.01, felt) < error(0.02, felt) / 6.0


@pytest.mark.parametrize("lever", [(0.06, -0.13), (0.03, 0.0), (0.0, 0.1)])
def test_a_leg_rolls_about_an_axis_beside_it(lever):
    """Hip, knee and ankle are in a plane so far beside the axis, where a rotation about it takes them."""
    chain = replace(CHAIN, hip_half_width=0.06, hip_lever=lever)
    com, soles = walking()
    soles = soles + np.array([[[0.0, 0.08, 0.0]], [[0.0, -0.02, 0.1]]])
    heading = np.zeros((2, len(com)))
    ankles = soles - com + np.array(chain.ankle)
    hips, knees, middle = posture(chain, ankles, heading)
    for k, side in ((0, 1.0), (1, -1.0)):
        axis = middle + np.array([0.0, side * chain.hip_half_width, 0.0])
        arm = hips[k] - axis
        np.testing.assert_allclose(np.linalg.norm(arm, axis=1), np.hypot(*lever), rtol=1e-9)
        np.testing.assert_allclose(arm[:, 0], 0.0, atol=1e-12)
        # The roll that takes the lever to where the hip is leaves ankle and knee as far outward of the axis as the hip.
        roll = np.arctan2(arm[:, 2], side * arm[:, 1]) - np.arctan2(lever[1], lever[0])
        outward = np.stack((np.zeros(len(com)), side * np.cos(roll), np.sin(roll)), axis=1)
        for joint in (hips[k], knees[k], ankles[k]):
            np.testing.assert_allclose(np.einsum("ni,ni->n", joint - axis, outward), lever[0], atol=1e-6)
    points, masses = bodies(chain, com, soles, heading)
    assert np.abs(np.einsum("k,kni->ni", masses, points)).max() < 2e-3


def test_rest_has_no_momentum_rate():
    com, soles = walking(1)
    still = np.repeat(com, 5, axis=0), np.repeat(soles, 5, axis=1)
    np.testing.assert_allclose(CHAIN.momentum_rate(*still, np.zeros((2, 5)), T), 0.0, atol=1e-9)


def test_a_leg_that_comes_to_be_straight_does_not_jump():
    com, soles = walking()
    for length in np.linspace(0.3, 0.45, 7):
        chain = replace(CHAIN, thigh=replace(THIGH, length=length))
        assert np.abs(chain.momentum_rate(com, soles, np.zeros((2, len(com))), T)).max() < 20.0


@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_an_ankle_that_rolls_first_turns_the_knee_with_the_shank(heading):
    """The axis of roll, across shank and knee axis, is also across that of pitch, which is the lateral one of the foot.

    Of an ankle that pitches first it is not: there the knee bends straight ahead.
    """
    R = np.array([[np.cos(heading), -np.sin(heading), 0.0], [np.sin(heading), np.cos(heading), 0.0], [0.0, 0.0, 1.0]])
    com = R @ [0.0, 0.03, 0.9]
    soles = np.array([R @ [0.05, 0.3, 0.05], R @ [0.0, -0.1, 0.0]])
    aside = {}
    for first in (True, False):
        chain = replace(CHAIN, rolls_first=first)
        hips, knees, ankles = chain.joints(com[None], soles[:, None], np.full((2, 1), heading))
        shank, axis = (ankles - knees)[0, 0], np.cross((knees - hips)[0, 0], (ankles - knees)[0, 0])
        roll = np.cross(axis, shank)
        aside[first] = abs(float(roll @ R[:, 1])) / np.linalg.norm(roll)
    assert aside[True] < 0.2 * aside[False]
    assert aside[False] > 0.02


TURNED = LegChain(
    0.06, (0.03, 0.04, 0.3), replace(THIGH, ahead=0.1, outward=0.05), replace(SHANK, ahead=0.2, outward=0.03),
    0.02, (0.02, 0.01, -0.04), (-0.02, 0.015, 0.08), 0.02, rolls_first=True, hip_lever=(0.05, -0.06),
)  # fmt: skip
"""A body of which no part lies on an axis of its frame."""


@pytest.mark.parametrize("chain", [TURNED, replace(TURNED, hip_lever=(0.0, 0.0))], ids=["lever", "none"])
def test_a_body_is_the_same_whichever_way_it_walks(chain):
    """Points and momentum of a body that is turned about the vertical are those of the other one, turned."""
    com, soles = walking()
    t = T * np.arange(len(com))
    heading, pitch = np.stack((0.2 + t, -0.3 + 0.5 * t)), np.stack((0.3 - 2.0 * t, 0.2 + t))
    straight = chain.body(com, soles, heading, pitch, 0.1)
    R = axes(np.array(0.9))  # its rows are the axes of the turned frame
    turned = chain.body(com @ R, soles @ R, heading + 0.9, pitch, 0.1)
    np.testing.assert_allclose(turned.points, np.einsum("pin,ij->pjn", straight.points, R), atol=1e-12)
    rate = chain.momentum_rate(com, soles, heading, T, pitch, 0.1)
    np.testing.assert_allclose(
        chain.momentum_rate(com @ R, soles @ R, heading + 0.9, T, pitch, 0.1), rate @ R, atol=1e-8
    )
    joints = chain.joints(com @ R, soles @ R, heading + 0.9, pitch, 0.1)
    for joint, first in zip(joints, (HIPS, KNEES, ANKLES), strict=True):
        np.testing.assert_allclose(joint, turned.points[first].swapaxes(1, 2) + com @ R, atol=1e-15)


def test_a_body_in_a_mirror_stands_on_its_other_leg():
    com, soles = walking()
    heading, pitch = np.array([[0.2], [-0.3]]).repeat(41, axis=1), np.array([[0.3], [-0.2]]).repeat(41, axis=1)
    flip = np.array([1.0, -1.0, 1.0])
    # The trunk and the ways in the feet are the same for both legs: those to the side change theirs in the mirror.
    other = replace(TURNED, trunk=TURNED.trunk * flip, foot_centre=TURNED.foot_centre * flip, ankle=TURNED.ankle * flip)
    one = TURNED.body(com, soles, heading, pitch, 0.1).points
    seen = other.body(com * flip, soles[::-1] * flip, -heading[::-1], pitch[::-1], 0.1).points
    order = [1, 0, 3, 2, 5, 4, 7, 6, 8, 10, 9, 12, 11]
    np.testing.assert_allclose(seen[order] * flip[:, None], one, atol=1e-12)


@pytest.mark.parametrize("pitch", [0.4, -0.3])
def test_a_foot_is_pitched_about_the_edge_of_its_sole(pitch):
    """The edge stays where the level sole has it; ankle and CoM of the foot turn about it, heel up or toes up."""
    com, soles = walking(1)
    heading, toe = np.array([[0.7], [0.7]]), 0.1
    body = TURNED.body(com, soles, heading, np.full((2, 1), pitch), toe)
    frame, edge = axes(heading[0])[0], np.array([np.copysign(toe, pitch), 0.0, 0.0])
    c, s = np.cos(pitch), np.sin(pitch)
    rolled = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ frame
    for leg, side in ((0, 1.0), (1, -1.0)):
        ankle = edge @ frame + (np.array(TURNED.ankle) - edge) @ rolled
        outward = np.array([0.0, side * TURNED.foot_outward, 0.0])
        foot = ankle + (TURNED.foot_centre + outward) @ rolled
        np.testing.assert_allclose(body.points[4 + leg, :, 0], soles[leg, 0] + ankle - com[0], atol=1e-15)
        np.testing.assert_allclose(body.points[6 + leg, :, 0], soles[leg, 0] + foot - com[0], atol=1e-15)


def test_a_turned_body_whose_masses_lie_aside_has_the_com_it_was_asked_for():
    chain = replace(TURNED, thigh=replace(TURNED.thigh, mass=0.15), shank=replace(TURNED.shank, mass=0.1))
    com, soles = walking()
    R = axes(np.array(0.9))
    points, masses = bodies(chain, (com - [0.0, 0.0, 0.1]) @ R, soles @ R, np.full((2, len(com)), 0.9))
    assert np.abs(np.einsum("k,kni->ni", masses, points)).max() < 3e-3
