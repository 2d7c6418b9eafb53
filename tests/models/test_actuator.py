import pytest

from surefoot.models.actuator import Actuator, Motor

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
