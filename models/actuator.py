"""Geared torque motors: the physical origin of joint torque limits, speed limits and armatures."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Motor:
    """A frameless torque motor, before its gear.

    Attributes:
        rotor_inertia: about the spin axis [kg m^2].
        peak_torque: at stall, limited by the drive current [N m].
        no_load_speed: at bus voltage [rad/s].
    """

    rotor_inertia: float
    peak_torque: float
    no_load_speed: float


@dataclass(frozen=True, slots=True)
class Actuator:
    """A motor behind a loss-free gear; what the joint sees follows from the gear ratio.

    The peak torque is taken as available at every speed; friction and torque ripple are not modelled.

    Attributes:
        motor: the motor.
        gear_ratio: motor turns per joint turn [-].
    """

    motor: Motor
    gear_ratio: float

    @property
    def torque_limit(self) -> float:
        """Peak joint torque [N m]."""
        return self.motor.peak_torque * self.gear_ratio

    @property
    def velocity_limit(self) -> float:
        """No-load joint speed [rad/s]."""
        return self.motor.no_load_speed / self.gear_ratio

    @property
    def armature(self) -> float:
        """Rotor inertia reflected to the joint [kg m^2]."""
        return self.motor.rotor_inertia * self.gear_ratio**2
