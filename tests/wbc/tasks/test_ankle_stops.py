"""Ankles at the end of their range let a swinging foot turn with its shank, in that sense alone."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.scenarios.setup.robot.body import Body, body_of
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.swing import YIELDING, AnkleStops, SwingFoot

pytestmark = pytest.mark.unit

ANKLE = "left_ankle_pitch"


@pytest.fixture(scope="module")
def body() -> Body:
    return body_of(describe("humanoid100", RobotOptions()))


UP, DOWN = 1.0, -1.0


def terms_at(body: Body, left: float, speed: float = 0.0, end: float = UP, name: str = ANKLE) -> RobotTerms:
    """A robot whose left ankle pitch, or another joint, is that far from an end, and as fast on its way there."""
    terms = RobotTerms(body.model, body.frames)
    q, v = pin.neutral(body.model), np.zeros(body.model.nv)
    joint = body.robot.joint_names.index(name)
    q[2] = 1.0
    stop = body.limits.upper if end == UP else body.limits.lower
    q[7 + joint], v[6 + joint] = stop[joint] - end * left, end * speed
    terms.update(q, v)
    return terms


def pitched(terms: RobotTerms, angle: float) -> np.ndarray:
    """Orientation of the left sole turned by an angle about its own y axis, which is the ankle's."""
    return terms.contact_rotation[0] @ pin.utils.rotate("y", angle)


def yielding(stops: AnkleStops, terms: RobotTerms, k: int, desired: np.ndarray) -> list[tuple[int, np.ndarray, float]]:
    """Joints that are not to turn sole k any further: column, axis in the frame of the sole, and share of it."""
    shares = [stops.yielding(terms, k, n, desired) for n in range(stops.joints)]
    return [(stops.columns[k][n], np.array(stops.axis(terms, k, n)), s) for n, s in enumerate(shares) if s > 0.0]


def test_an_ankle_in_the_middle_of_its_range_turns_the_foot(body: Body) -> None:
    terms = terms_at(body, 2.0 * YIELDING)
    stops = AnkleStops(body.model, body.frames, body.limits)
    assert yielding(stops, terms, 0, pitched(terms, 0.5)) == []


@pytest.mark.parametrize("end", [UP, DOWN])
def test_at_its_end_it_yields_about_its_own_axis_and_only_towards_the_end(body: Body, end: float) -> None:
    terms = terms_at(body, 0.0, end=end)
    stops = AnkleStops(body.model, body.frames, body.limits)
    [(column, axis, share)] = yielding(stops, terms, 0, pitched(terms, end * 0.1))
    assert column == 6 + body.robot.joint_names.index(ANKLE)
    np.testing.assert_allclose(axis, [0.0, 1.0, 0.0], atol=1e-9)
    assert share == pytest.approx(1.0)
    assert yielding(stops, terms, 0, pitched(terms, -end * 0.1)) == []
    # One that keeps to its target does, lest its shank push the end of the range ahead of it.
    assert [share for *_, share in yielding(stops, terms, 0, pitched(terms, 0.0))] == [pytest.approx(1.0)]
    assert yielding(stops, terms, 1, terms.contact_rotation[1] @ pin.utils.rotate("y", end * 0.1)) == []


@pytest.mark.parametrize("back", [0.01, 0.025, 0.04])
@pytest.mark.parametrize("end", [UP, DOWN])
def test_the_farther_a_foot_has_turned_beyond_its_target_the_less_its_ankle_yields(
    body: Body, end: float, back: float
) -> None:
    terms, stops = terms_at(body, 0.0, end=end), AnkleStops(body.model, body.frames, body.limits)
    [(*_, share)] = yielding(stops, terms, 0, pitched(terms, -end * back))
    assert share == pytest.approx(1.0 - back / 0.05)


@pytest.mark.parametrize("end", [UP, DOWN])
def test_it_yields_the_more_the_nearer_it_will_be(body: Body, end: float) -> None:
    stops = AnkleStops(body.model, body.frames, body.limits)
    shares = []
    for speed in (0.0, 0.5, 1.0):
        terms = terms_at(body, 0.5 * YIELDING, speed, end)
        shares.append(sum(share for *_, share in yielding(stops, terms, 0, pitched(terms, end * 0.1))))
    assert shares[0] == pytest.approx(0.5)
    assert shares == sorted(shares) and shares[-1] == pytest.approx(1.0)


def test_a_wider_range_does_not_yield(body: Body) -> None:
    wide = replace(body.limits, lower=body.limits.lower - 1.0, upper=body.limits.upper + 1.0)
    terms = terms_at(body, 0.0)
    assert yielding(AnkleStops(body.model, body.frames, wide), terms, 0, pitched(terms, 0.1)) == []


def rows_and_target(
    body: Body, limits: JointLimits, terms: RobotTerms, reference: WbcReference
) -> tuple[np.ndarray, np.ndarray]:
    stops = AnkleStops(body.model, body.frames, limits)
    task = SwingFoot(TaskWeights(), TaskGains(), (0.11, 0.055), 1.0, stops)
    rows = np.zeros((6, body.model.nv + 12))
    target = task.write(terms, reference, np.ones((6, 1)), rows)
    return rows[:, :-12], np.array(target)


def test_a_foot_that_yields_is_seen_from_its_ankle(body: Body, references) -> None:
    """Turning the ankle does not move it, and a foot that turns as it should is asked for the same motion."""
    rng, terms = np.random.default_rng(5), terms_at(body, 0.0)
    terms.update(terms.q.copy(), terms.v + 0.3 * rng.normal(size=body.model.nv))
    R, bend = terms.contact_rotation[0].copy(), rng.normal(size=(2, 3))
    reference = references[1](
        swing_foot=0, swing_position=terms.sole_position[0] + 0.01 * bend[0], swing_rotation=R,
        swing_angular_velocity=R @ terms.sole_velocity[0, 3:], swing_angular_acceleration=bend[1],
    )  # fmt: skip
    wide = replace(body.limits, lower=body.limits.lower - 1.0, upper=body.limits.upper + 1.0)
    of_sole, wanted = rows_and_target(body, wide, terms, reference)
    of_ankle, asked = rows_and_target(body, body.limits, terms, reference)
    column = 6 + body.robot.joint_names.index(ANKLE)
    assert np.abs(of_sole[:3, column]).max() > 0.03
    np.testing.assert_allclose(of_ankle[:3, column], 0.0, atol=1e-9)
    motion = np.linalg.lstsq(of_sole, wanted, rcond=None)[0]
    np.testing.assert_allclose(of_ankle[:3] @ motion, asked[:3], atol=1e-8)


@pytest.mark.parametrize("speed", [0.0, 0.4])
def test_while_a_step_catches_the_body_an_ankle_that_yields_is_to_rest(body: Body, references, speed: float) -> None:
    """About its axis one joint alone is asked for, and no row is left empty that the QP could turn the foot by."""
    terms, column = terms_at(body, 0.0, speed), 6 + body.robot.joint_names.index(ANKLE)
    reference = references[1](
        swing_foot=0, swing_position=terms.sole_position[0].copy(), swing_rotation=pitched(terms, 0.1),
        swing_angular_velocity=np.zeros(3), swing_angular_acceleration=np.zeros(3), catching=True,
    )  # fmt: skip
    stops = AnkleStops(body.model, body.frames, body.limits)
    [(_, axis, share)] = yielding(stops, terms, 0, reference.swing_rotation)
    rows, target = rows_and_target(body, body.limits, terms, reference)
    asked = axis @ rows[3:]
    assert share == pytest.approx(1.0) and asked[column] > 0.1
    np.testing.assert_allclose(np.delete(asked, column), 0.0, atol=1e-9)
    assert axis @ target[3:] == pytest.approx(-2.0 * speed / stops.ahead * asked[column])
    # Otherwise it is free: a fast walk brings ankles to their ends in each step.
    rows, target = rows_and_target(body, body.limits, terms, replace(reference, catching=False))
    np.testing.assert_allclose(axis @ rows[3:], 0.0, atol=1e-9)
    assert axis @ target[3:] == pytest.approx(0.0)


@pytest.mark.parametrize("catching", [False, True])
@pytest.mark.parametrize(("name", "other"), [(ANKLE, "left_ankle_roll"), ("left_ankle_roll", ANKLE)])
def test_an_ankle_takes_its_share_of_what_turns_about_its_axis_and_nothing_across_it(
    body: Body, references, name: str, other: str, catching: bool
) -> None:
    """Whatever that axis is in the sole, which the other joint of the ankle turns."""
    terms = terms_at(body, 0.4 * YIELDING, 0.1, name=name)
    q, aside = terms.q.copy(), body.robot.joint_names.index(other)
    q[7 + aside] = 0.3 * body.limits.upper[aside]
    terms.update(q, terms.v.copy())
    stops = AnkleStops(body.model, body.frames, body.limits)
    n = stops.columns[0].index(6 + body.robot.joint_names.index(name))
    R, axis = terms.contact_rotation[0], np.array(stops.axis(terms, 0, n))
    reference = references[1](
        swing_foot=0, swing_position=terms.sole_position[0].copy(), swing_rotation=R @ pin.exp3(0.1 * axis),
        swing_angular_velocity=np.array([0.3, -0.2, 0.1]), swing_angular_acceleration=np.array([1.0, 2.0, -3.0]),
        catching=catching,
    )  # fmt: skip
    [(column, _, share)] = yielding(stops, terms, 0, reference.swing_rotation)
    wide = replace(body.limits, lower=body.limits.lower - 1.0, upper=body.limits.upper + 1.0)
    (rows, target), (less, asked) = (rows_and_target(body, one, terms, reference) for one in (wide, body.limits))
    across = np.eye(3) - np.outer(axis, axis)
    assert 0.5 < share < 0.9
    assert np.abs(across @ rows[3:]).max() > 0.1
    np.testing.assert_allclose(across @ less[3:], across @ rows[3:], atol=1e-9)
    np.testing.assert_allclose(across @ asked[3:], across @ target[3:], atol=1e-9)
    rests = np.zeros(body.model.nv)
    rests[column] = 0.3 * catching
    np.testing.assert_allclose(axis @ less[3:], (1.0 - share) * axis @ rows[3:] + share * rests, atol=1e-9)
    braking = -2.0 * terms.v[column] / stops.ahead * rests[column]
    assert axis @ asked[3:] == pytest.approx((1.0 - share) * axis @ target[3:] + share * braking)


@pytest.mark.parametrize(("rolled", "catching"), [(0.0, True), (0.2, True), (0.2, False)])
@pytest.mark.parametrize(("hung", "length"), [(0.02, 1.0), (0.5, 1.0), (0.5, 0.5)])
@pytest.mark.parametrize("leant", [0.0, 0.1])
def test_a_foot_that_its_ankle_tilts_is_lifted_for_what_hangs_but_only_a_little_for_its_toe(
    body: Body, references, hung: float, length: float, rolled: float, catching: bool, leant: float
) -> None:
    """It is lifted by what its toe hangs too low, four millimetres on a robot of this size at most.

    While a step catches the body by all that its side edge hangs lower, too.
    """
    terms, toe, side = terms_at(body, 0.0), 0.11 * length, 0.055 * length
    q = terms.q.copy()
    q[3:7] = pin.Quaternion(pin.utils.rotate("x", leant) @ pin.utils.rotate("y", 0.5 * leant)).coeffs()
    terms.update(q, terms.v.copy())
    R = terms.contact_rotation[0].copy()
    # The wanted rotation differs from that of the sole by a pitch and a roll, towards which the ankle still has room.
    turned = pin.utils.rotate("x", rolled) @ pin.utils.rotate("y", hung)
    reference = references[1](
        swing_foot=0, swing_position=terms.sole_position[0].copy(), swing_rotation=R @ turned,
        swing_angular_velocity=np.zeros(3), swing_angular_acceleration=np.zeros(3), catching=catching,
    )  # fmt: skip
    wide = replace(body.limits, lower=body.limits.lower - 1.0, upper=body.limits.upper + 1.0)
    gains, targets = TaskGains(), []
    for limits in (wide, body.limits):
        task = SwingFoot(TaskWeights(), gains, (toe, side), length, AnkleStops(body.model, body.frames, limits))
        linear = np.array(task.write(terms, reference, np.ones((6, 1)), np.zeros((6, body.model.nv + 12)))[:3])
        targets.append(R @ linear)
    ankle = AnkleStops(body.model, body.frames, body.limits).ankles[0]
    of_ankle = gains.swing[0] * (reference.swing_rotation @ ankle - R @ ankle)
    low, beside, _ = (toe, side, 0.0) * np.abs(R[2] - reference.swing_rotation[2])
    lifted = (targets[1] - targets[0] - of_ankle) / gains.swing[0]
    assert low > 5e-4 and bool(beside > 0.004 * length) is (rolled > 0.0)
    np.testing.assert_allclose(lifted, [0.0, 0.0, min(low, 0.004 * length) + catching * beside], atol=1e-9)
