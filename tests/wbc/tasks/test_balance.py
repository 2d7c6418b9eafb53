import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.wbc.parameters import BalanceGains
from surefoot.wbc.tasks.balance import BalanceLaw, SupportRegion

pytestmark = pytest.mark.unit

SQUARE = 0.0375


def com_acceleration(reference, com, com_velocity, region, gains):
    return BalanceLaw(gains, region).acceleration(reference, com, com_velocity)


def region(half_length=SQUARE, half_width=SQUARE, feet=((0.0, 0.1), (0.0, -0.1)), yaws=(0.0, 0.0), active=(True, True)):
    made = SupportRegion(half_length, half_width, 1.0)
    positions = np.array([[x, y, 0.0] for x, y in feet])
    rotations = np.array([[[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]] for a in yaws])
    made.rebuild(positions, rotations, active)
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * [half_length, half_width]
    points = np.concatenate([positions[k, :2] + corners @ rotations[k, :2, :2].T for k in (0, 1) if active[k]])
    return made, points[ConvexHull(points).vertices]


def nearest_by_sampling(vertices, point):
    ends = np.roll(vertices, -1, axis=0)
    share = np.linspace(0, 1, 2001)[:, None, None]
    border = ((1 - share) * vertices + share * ends).reshape(-1, 2)
    return border[np.argmin(np.linalg.norm(border - point, axis=1))]


SHAPES = {
    "one sole": {"active": (True, False)},
    "collinear edges": {},
    "feet apart and turned": {"feet": ((0.2, 0.15), (-0.1, -0.1)), "yaws": (0.3, -0.5)},
    "feet on the same spot": {"feet": ((0.0, 0.0), (0.0, 0.0))},
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_projection_is_the_nearest_point(shape, rng):
    made, vertices = region(**shape)
    sides = np.roll(vertices, -1, axis=0) - vertices
    normals = np.column_stack([sides[:, 1], -sides[:, 0]]) / np.linalg.norm(sides, axis=1)[:, None]
    inside_count = 0
    for point in vertices.mean(axis=0) + rng.uniform(-1, 1, (300, 2)) * rng.choice([0.05, 0.4], (300, 1)):
        found = np.array(made.project(*point))
        if ((point - vertices) * normals).sum(axis=1).max() <= 0.0:
            inside_count += 1
            assert tuple(found) == tuple(point)
        else:
            expected = np.linalg.norm(point - nearest_by_sampling(vertices, point))
            assert np.linalg.norm(point - found) == pytest.approx(expected, abs=1e-4)
            assert ((found - vertices) * normals).sum(axis=1).max() <= 1e-12
        onward = point - found
        beyond = found + onward * min(1.0, 0.05 / max(np.hypot(*onward), 1e-9))
        np.testing.assert_allclose(made.project(*point, 0.05), beyond, atol=1e-12)
    assert inside_count > 0


def test_only_a_share_of_the_sole_is_used():
    made = SupportRegion(0.1, 0.05, 0.9)
    made.rebuild(np.zeros((2, 3)), np.array([np.eye(3)] * 2), (True, False))
    assert made.project(1.0, 0.0) == pytest.approx((0.09, 0.0))
    assert made.project(0.0, -1.0) == pytest.approx((0.0, -0.045))


@pytest.fixture
def moving(references):
    """A reference whose CoM accelerates in all axes; its ZMP is the one of that motion."""
    com, acceleration, stiffness = np.array([0.01, -0.02, 1.0]), np.array([0.1, -0.3, 0.2]), 10.01
    return references[0](
        com=com, com_velocity=np.array([0.1, 0.2, -0.05]), com_acceleration=acceleration, stiffness=stiffness,
        omega=3.2, zmp=com[:2] - acceleration[:2] / stiffness,
    )  # fmt: skip


def test_on_the_reference_its_own_acceleration_comes_back(moving):
    found = com_acceleration(moving, moving.com, moving.com_velocity, region()[0], BalanceGains())
    np.testing.assert_allclose(found, moving.com_acceleration, atol=1e-14)


def test_the_dcm_error_decays_at_the_stated_rate(references):
    """With constant λ = ω²: e' = -(k - 1) ω e."""
    gains, omega, reference = BalanceGains(dcm=3.0), np.sqrt(9.81), references[0]()
    made, _ = region(0.5, 0.5)
    c, v, h = np.array([0.004, -0.003, 1.0]), np.array([0.0, 0.01, 0.0]), 1e-4
    start, steps = (c + v / omega)[:2], 4000
    for _ in range(steps):
        a = np.array(com_acceleration(reference, c, v, made, gains))
        c, v = c + h * v + 0.5 * h * h * a, v + h * a
    expected = start * np.exp(-(gains.dcm - 1.0) * omega * steps * h)
    np.testing.assert_allclose((c + v / omega)[:2], expected, rtol=1e-2)


def test_it_is_the_zmp_that_stays_in_the_region(references):
    made, vertices = region()
    com, offset = np.array([0.3, 0.0, 1.0]), np.array([0.01, 0.0])
    reference = references[0](zmp_offset=offset)
    found = com_acceleration(reference, com, np.zeros(3), made, BalanceGains())
    assert com[0] - found[0] / 9.81 + offset[0] == pytest.approx(vertices[:, 0].max())
    at_rest = com_acceleration(reference, reference.com, np.zeros(3), made, BalanceGains())
    np.testing.assert_allclose(at_rest, 0.0, atol=1e-12)


def test_without_feedback_the_dcm_error_grows(references):
    reference, (made, _) = references[0](), region(0.5, 0.5)
    found = com_acceleration(reference, np.array([0.01, 0, 1.0]), np.zeros(3), made, BalanceGains(dcm=0.0))
    assert found[0] == pytest.approx(9.81 * 0.01)


def test_a_large_error_leaves_the_zmp_on_the_border(references):
    made, vertices = region()
    com = np.array([0.3, 0.0, 1.0])
    found = com_acceleration(references[0](), com, np.zeros(3), made, BalanceGains())
    assert com[0] - found[0] / 9.81 == pytest.approx(vertices[:, 0].max())


@pytest.mark.parametrize("way", [(0.3, 0.0), (0.0, -0.3), (0.2, 0.25)])
def test_while_a_step_catches_the_body_it_may_lie_beyond_the_border(references, way):
    """As far as is allowed, on the way to where the law without a region has it."""
    made, _ = region(feet=((0.0, 0.0), (0.0, 0.0)))
    com, gains = np.array([*way, 1.0]), BalanceGains(beyond_catching=0.05)
    found = [
        com - np.array(com_acceleration(references[0](catching=catching), com, np.zeros(3), made, gains)) / 9.81
        for catching in (False, True)
    ]
    beyond, onward = (found[1] - found[0])[:2], gains.dcm * np.array(way) - found[0][:2]
    np.testing.assert_allclose(beyond, 0.05 * onward / np.hypot(*onward), atol=1e-12)
    near = np.array([0.5 * SQUARE, 0.0, 1.0]) / gains.dcm
    a, b = (com_acceleration(references[0](catching=how), near, np.zeros(3), made, gains) for how in (False, True))
    assert a == b


def test_the_height_law_is_a_spring_and_a_damper(moving):
    gains = BalanceGains(height_stiffness=60.0, height_damping=15.0)
    com, velocity = moving.com.copy(), moving.com_velocity.copy()
    com[2] += 0.01
    velocity[2] -= 0.02
    found = com_acceleration(moving, com, velocity, region()[0], gains)
    assert found[2] == pytest.approx(moving.com_acceleration[2] - 60 * 0.01 + 15 * 0.02)
