"""Ankles at the end of their range let a swinging foot turn with its shank, in that sense alone."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.scenarios.setup.stance import Body, body_of
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.tasks.swing import YIELDING, AnkleStops

pytestmark = pytest.mark.unit

ANKLE = "left_ankle_pitch"


@pytest.fixture(scope="module")
def body() -> Body:
    return body_of(describe("humanoid100", RobotOptions()))


def terms_at(body: Body, left: float, speed: float = 0.0) -> RobotTerms:
    """A robot whose left ankle pitch is that far from the upper end of its range."""
    terms = RobotTerms(body.model, body.frames)
    q, v = pin.neutral(body.model), np.zeros(body.model.nv)
    joint = body.robot.joint_names.index(ANKLE)
    q[2] = 1.0
    q[7 + joint], v[6 + joint] = body.limits.upper[joint] - left, speed
    terms.update(q, v)
    return terms


def pitched(terms: RobotTerms, angle: float) -> np.ndarray:
    """Orientation of the left sole turned by an angle about its own y axis, which is the ankle's."""
    return terms.contact_rotation[0] @ pin.utils.rotate("y", angle)


def test_an_ankle_in_the_middle_of_its_range_turns_the_foot(body: Body) -> None:
    terms = terms_at(body, 2.0 * YIELDING)
    stops = AnkleStops(body.model, body.frames, body.limits)
    assert stops.yielding(terms, 0, pitched(terms, 0.5)) == []


def test_at_its_end_it_yields_about_its_own_axis_and_only_towards_the_end(body: Body) -> None:
    terms = terms_at(body, 0.0)
    stops = AnkleStops(body.model, body.frames, body.limits)
    [(axis, share)] = stops.yielding(terms, 0, pitched(terms, 0.1))
    np.testing.assert_allclose(axis, [0.0, 1.0, 0.0], atol=1e-9)
    assert share == pytest.approx(1.0)
    assert stops.yielding(terms, 0, pitched(terms, -0.1)) == []
    assert stops.yielding(terms, 1, terms.contact_rotation[1] @ pin.utils.rotate("y", 0.1)) == []


def test_it_yields_the_more_the_nearer_it_will_be(body: Body) -> None:
    stops = AnkleStops(body.model, body.frames, body.limits)
    shares = []
    for speed in (0.0, 0.5, 1.0):
        terms = terms_at(body, 0.5 * YIELDING, speed)
        shares.append(sum(share for _, share in stops.yielding(terms, 0, pitched(terms, 0.1))))
    assert shares[0] == pytest.approx(0.5)
    assert shares == sorted(shares) and shares[-1] == pytest.approx(1.0)


def test_a_wider_range_does_not_yield(body: Body) -> None:
    wide = replace(body.limits, lower=body.limits.lower - 1.0, upper=body.limits.upper + 1.0)
    terms = terms_at(body, 0.0)
    assert AnkleStops(body.model, body.frames, wide).yielding(terms, 0, pitched(terms, 0.1)) == []
