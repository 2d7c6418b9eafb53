import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from surefoot.planner.geometry.orientation import sole_rates, sole_rotation
from surefoot.planner.geometry.plane import sole_angles
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit

START = np.array([0.0, 0.1, 0.0, 0.1, -0.17, 0.05])
TARGET = np.array([0.5, 0.1, 0.08, -0.2, 0.12, -0.14])


def test_the_sole_lies_flat_and_keeps_its_heading():
    rng = np.random.default_rng(3)
    for yaw in rng.uniform(-np.pi, np.pi, 20):
        normal = np.append(rng.uniform(-0.3, 0.3, 2), 1.0)
        normal /= np.linalg.norm(normal)
        R = sole_rotation(yaw, *sole_angles(normal, yaw))
        np.testing.assert_allclose(R[:, 2], normal, atol=1e-14)
        np.testing.assert_allclose(R, Rotation.from_matrix(R).as_matrix(), atol=1e-14)
        assert np.arctan2(R[1, 0], R[0, 0]) == pytest.approx(yaw, abs=1e-12)


def test_uphill_the_toes_point_up():
    pitch, roll = sole_angles(np.array([-np.sin(0.2), 0.0, np.cos(0.2)]), 0.0)
    assert (pitch, roll) == (pytest.approx(-0.2), pytest.approx(0.0))
    assert sole_rotation(0.0, pitch, roll)[2, 0] == pytest.approx(np.sin(0.2))


def test_on_level_ground_the_rotation_is_exactly_the_heading():
    yaw = 0.7
    c, s = np.cos(yaw), np.sin(yaw)
    R = sole_rotation(yaw, *sole_angles(np.array([0.0, 0.0, 1.0]), yaw))
    np.testing.assert_array_equal(R, [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def test_a_swing_turns_the_sole_smoothly_from_one_face_to_the_other():
    """Angular velocity and acceleration against differences of the rotation and of each other."""
    swing = start_swing(
        Foot.LEFT,
        (START, TARGET),
        (0.0, 40),
        SwingCourse(0.5, 0.125, 0.875, 0.05),
        PlannerParameters(touchdown_lead=0.0),
    )
    step = 1e-4
    motion = np.array([swing.evaluate(t)[:, 3:] for t in np.arange(0.0, 0.8, step)])
    R = np.array([sole_rotation(*angles) for angles in motion[:, 0]])
    velocity, acceleration = (np.array(part) for part in zip(*(sole_rates(*m) for m in motion), strict=True))
    turned = Rotation.from_matrix(R[2:] @ R[:-2].transpose(0, 2, 1)).as_rotvec() / (2.0 * step)
    np.testing.assert_allclose(turned, velocity[1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(velocity, step, axis=0)[1:-1], acceleration[1:-1], atol=2e-2)
    assert np.abs(np.diff(acceleration, axis=0)).max() < 0.1
    for index, pose in ((0, START), (-1, TARGET)):
        np.testing.assert_allclose(R[index], sole_rotation(*pose[3:]), atol=1e-9)
        np.testing.assert_allclose([velocity[index], acceleration[index]], 0.0, atol=1e-9)
