"""Geared torque motors: the physical origin of joint torque limits, speed limits and armatures."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


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

    The peak torque is taken as available at every speed unless `available_torque` is asked; friction and torque ripple
    are no part of it.

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


def available_torque(
    torque: NDArray[np.float64], speed: NDArray[np.float64], peak: NDArray[np.float64],
    no_load_speed: NDArray[np.float64], knee: float,
) -> NDArray[np.float64]:  # fmt: skip
    """Available part of a torque of motors at a bus voltage: driving, less the faster they turn; braking, their peak.

    Up to the knee the drive current is the limit. Beyond it the limit is the voltage that the turning motor leaves,
    which falls to none at the no-load speed (Seok et al., "Actuator design for high force proprioceptive control in
    fast legged locomotion", IROS 2012).

    Args:
        torque: wanted, shape (nj,) [N·m].
        speed: of the joints, shape (nj,) [rad/s].
        peak: torque at stall, shape (nj,) [N·m].
        no_load_speed: at which no torque is left, shape (nj,) [rad/s].
        knee: share of that speed up to which the peak is available, from 0 to less than 1 [-].
    """
    left = np.clip((1.0 - np.abs(speed) / no_load_speed) / (1.0 - knee), 0.0, 1.0)
    most = np.where(torque * speed > 0.0, left, 1.0) * peak
    return np.asarray(np.clip(torque, -most, most))
