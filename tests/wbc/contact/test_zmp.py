import numpy as np
import pytest

from surefoot.wbc.contact.zmp import centre_of_pressure, measured_zmp

pytestmark = pytest.mark.unit


def sole_wrench(points, forces):
    """Wrench at the sole centre of forces (n, 3) at points of the sole (n, 3), both in the sole frame."""
    return np.concatenate([forces.sum(0), np.cross(points, forces).sum(0)])


@pytest.fixture
def contact(rng):
    """Random corner forces of both soles: (points, forces) in the world, wrenches, positions and rotations."""
    corners = np.array([[x, y, 0.0] for x in (-0.1, 0.1) for y in (-0.05, 0.05)])
    positions, yaws = np.array([[100.2, 50.1, 0.3], [100.0, 49.9, 0.15]]), (0.4, -0.2)
    rotations = np.array([[[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]] for a in yaws])
    forces = rng.uniform([-40, -40, 20], [40, 40, 200], (2, 4, 3))
    wrench = np.array([sole_wrench(corners, f) for f in forces])
    points = np.concatenate([positions[k] + corners @ rotations[k].T for k in (0, 1)])
    return points, np.concatenate([forces[k] @ rotations[k].T for k in (0, 1)]), wrench, positions, rotations


def test_centre_of_pressure_is_the_mean_of_points_by_load(rng):
    points = np.column_stack([rng.uniform(-0.1, 0.1, (5, 2)), np.zeros(5)])
    forces = rng.uniform([-30, -30, 10], [30, 30, 100], (5, 3))
    expected = forces[:, 2] @ points[:, :2] / forces[:, 2].sum()
    np.testing.assert_allclose(centre_of_pressure(sole_wrench(points, forces)), expected, atol=1e-14)


def test_the_zmp_has_no_horizontal_moment(contact):
    points, forces, wrench, positions, rotations = contact
    zmp = np.array(measured_zmp(wrench, positions, rotations))
    moment = np.cross(points - zmp, forces).sum(0)
    np.testing.assert_allclose(moment[:2], 0.0, atol=1e-9)
    load = wrench[:, 2]
    assert zmp[2] == pytest.approx(load @ positions[:, 2] / load.sum())


def test_at_one_height_the_zmp_is_the_mean_of_points_by_load(contact):
    points, forces, wrench, positions, rotations = contact
    positions[:, 2] = 0.0
    zmp = measured_zmp(wrench, positions, rotations)
    np.testing.assert_allclose(zmp[:2], forces[:, 2] @ points[:, :2] / forces[:, 2].sum(), atol=1e-10)


def test_without_load_there_is_neither():
    assert np.isnan(centre_of_pressure(np.zeros(6))).all()
    assert np.isnan(measured_zmp(np.zeros((2, 6)), np.zeros((2, 3)), np.array([np.eye(3)] * 2))).all()
