import numpy as np
import pytest

from surefoot.models.actuator import Actuator, Motor, available_torque

pytestmark = pytest.mark.unit


def test_gear_trades_speed_for_torque_at_constant_power() -> None:
    motor = Motor(rotor_inertia=1e-4, peak_torque=5.0, no_load_speed=300.0)
    low, high = Actuator(motor, gear_ratio=10.0), Actuator(motor, gear_ratio=20.0)
    assert high.torque_limit * high.velocity_limit == pytest.approx(low.torque_limit * low.velocity_limit)
    assert high.torque_limit == 2 * low.torque_limit


def test_armature_keeps_the_rotor_energy() -> None:
    actuator = Actuator(Motor(rotor_inertia=1e-4, peak_torque=5.0, no_load_speed=300.0), gear_ratio=12.0)
    joint_speed = 3.0
    rotor_energy = 0.5 * actuator.motor.rotor_inertia * (joint_speed * actuator.gear_ratio) ** 2
    assert 0.5 * actuator.armature * joint_speed**2 == pytest.approx(rotor_energy)


def test_a_turning_motor_has_less_torque_to_drive_with_and_all_of_it_to_brake() -> None:
    peak, free = np.full(5, 10.0), np.full(5, 4.0)
    speed = np.array([0.0, 2.0, 3.0, 4.0, 5.0])
    driving = available_torque(np.full(5, 50.0), speed, peak, free, 0.5)
    np.testing.assert_allclose(driving, [10.0, 10.0, 5.0, 0.0, 0.0])
    np.testing.assert_allclose(available_torque(np.full(5, -50.0), speed, peak, free, 0.5), -10.0)
    np.testing.assert_allclose(available_torque(np.full(5, -50.0), -speed, peak, free, 0.5), -driving)
    np.testing.assert_allclose(available_torque(np.full(5, 1.0), speed, peak, free, 0.0), [1.0, 1.0, 1.0, 0.0, 0.0])
