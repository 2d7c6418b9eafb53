"""The pelvis rolls with the leg at the end of a hip's range sideways, and nowhere else."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotOptions, describe
from surefoot.scenarios.setup.robot.body import Body, body_of
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.trunk import SOFTENED, SPARED, HipStops, Pelvis

pytestmark = pytest.mark.unit

HIP, ADDUCTION = "left_hip_roll", -0.15


@pytest.fixture(scope="module")
def body() -> Body:
    """A robot whose hips end at a small adduction, left and right."""
    body = body_of(describe("humanoid100", RobotOptions()))
    lower = body.limits.lower.copy()
    for side in ("left", "right"):
        lower[body.robot.joint_names.index(f"{side}_hip_roll")] = ADDUCTION
    return replace(body, limits=replace(body.limits, lower=lower))


def terms_at(body: Body, angle: float, roll: float = 0.0, speed: float = 0.0) -> RobotTerms:
    """A robot with its left hip at an angle and its pelvis rolled."""
    terms = RobotTerms(body.model, body.frames)
    q, v = pin.neutral(body.model), np.zeros(body.model.nv)
    joint = body.robot.joint_names.index(HIP)
    q[3:7] = pin.Quaternion(pin.utils.rotate("x", roll)).coeffs()
    q[7 + joint], v[6 + joint] = angle, speed
    terms.update(q, v)
    return terms


def test_the_roll_leaves_the_hip_what_is_spared_with_the_leg_where_it_is(body: Body) -> None:
    """Two robots whose left leg points alike: the second with the pelvis as the first one asks for."""
    stops = HipStops(body.model, body.frames, body.limits)
    first = terms_at(body, ADDUCTION)
    roll, _ = stops.roll(first)
    assert abs(roll) == pytest.approx(SPARED)
    joint = body.robot.joint_names.index(HIP)
    left = first.sole_rotation[0]
    turned = min(
        (terms_at(body, ADDUCTION + way * abs(roll), roll) for way in (1.0, -1.0)),
        key=lambda terms: np.abs(terms.sole_rotation[0] - left).max(),
    )
    np.testing.assert_allclose(turned.sole_rotation[0], left, atol=1e-12)
    assert turned.q[7 + joint] == pytest.approx(ADDUCTION + SPARED)
    assert stops.roll(turned)[0] == pytest.approx(roll)


@pytest.mark.parametrize("angle", [ADDUCTION + SPARED - 0.5 * SOFTENED, ADDUCTION + SPARED + 0.5 * SOFTENED])
def test_its_rate_is_its_derivative(body: Body, angle: float) -> None:
    stops, h = HipStops(body.model, body.frames, body.limits), 1e-6
    ahead, behind = (stops.roll(terms_at(body, angle + step))[0] for step in (h, -h))
    assert stops.roll(terms_at(body, angle, speed=0.3))[1] == pytest.approx(
        0.3 * (ahead - behind) / (2.0 * h), rel=1e-5
    )


def test_within_the_range_the_pelvis_stays_upright(body: Body) -> None:
    stops = HipStops(body.model, body.frames, body.limits)
    inside = terms_at(body, ADDUCTION + SPARED + SOFTENED)
    assert stops.roll(inside) == (0.0, 0.0)
    wide = replace(body.limits, lower=body.limits.lower - 1.0)
    assert HipStops(body.model, body.frames, wide).roll(terms_at(body, ADDUCTION)) == (0.0, 0.0)


def test_the_pelvis_is_brought_to_that_roll_and_its_rate(body: Body, reference: WbcReference) -> None:
    stops, gains = HipStops(body.model, body.frames, body.limits), TaskGains()
    terms = terms_at(body, ADDUCTION + 0.5 * SPARED, speed=-0.4)
    (roll, rate), (stiffness, damping) = stops.roll(terms), gains.orientation
    assert roll != 0.0 and rate != 0.0
    scale, rows = np.ones((3, 1)), np.zeros((3, body.model.nv + 12))
    with_stops, without = (
        np.array(list(Pelvis(TaskWeights(), gains, one).write(terms, reference, scale, rows))) for one in (stops, None)
    )
    np.testing.assert_allclose(with_stops - without, [stiffness * roll + damping * rate, 0.0, 0.0])
