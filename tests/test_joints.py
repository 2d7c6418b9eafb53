"""A servo pulls its joint towards the target and brakes it, and takes no energy from nowhere."""

import numpy as np
import pytest

from surefoot.joints import JointCommand, Servo

pytestmark = pytest.mark.unit


def command():
    servo = Servo(np.array([0.3, -0.2]), np.array([0.5, 0.0]), np.array([80.0, 40.0]), np.array([4.0, 2.0]))
    return JointCommand(np.array([1.0, -2.0]), servo)


def test_at_its_targets_a_servo_adds_nothing():
    told = command()
    np.testing.assert_array_equal(told.torque_at(told.servo.position, told.servo.velocity), told.torque)
    np.testing.assert_array_equal(JointCommand(told.torque).torque_at(np.ones(2), np.ones(2)), told.torque)


def test_stiffness_and_damping_are_what_is_lost_per_angle_and_speed():
    told, still = command(), np.zeros(2)
    for change, lost in ((np.array([0.1, -0.4]), told.servo.stiffness), (np.array([-2.0, 0.3]), told.servo.damping)):
        angle = told.torque_at(change, still) - told.torque_at(still, still)
        speed = told.torque_at(still, change) - told.torque_at(still, still)
        np.testing.assert_allclose(angle if lost is told.servo.stiffness else speed, -lost * change)


def test_a_joint_on_a_servo_comes_to_rest_at_its_target():
    servo = Servo(np.array([0.3]), np.zeros(1), np.array([80.0]), np.array([4.0]))
    told, angle, speed, inertia, step = JointCommand(np.zeros(1), servo), np.zeros(1), np.ones(1), 0.5, 1e-3
    for _ in range(3000):
        speed = speed + step / inertia * told.torque_at(angle, speed)
        angle = angle + step * speed
    np.testing.assert_allclose(angle, 0.3, atol=1e-4)
    np.testing.assert_allclose(speed, 0.0, atol=1e-3)
