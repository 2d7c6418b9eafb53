"""The torques that motors make of their commands: late, noisy, and less of it the faster they turn."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from surefoot.models.actuator import available_torque
from surefoot.models.types import RobotDescription
from surefoot.sim.measurement import Array
from surefoot.streams import Stream, generator


@dataclass(frozen=True, slots=True)
class DriveErrors:
    """The errors of a motor; by default it gives its command at once and as it is.

    Attributes:
        delay: time from the command until the motor gives it [s].
        noise: standard deviation of a torque, drawn anew with each command [N·m].
        torque_speed: knee of `surefoot.models.actuator.available_torque`; None for the peak at every speed [-].
    """

    delay: float = 0.0
    noise: float = 0.0
    torque_speed: float | None = None


IDEAL = DriveErrors()


class Drives:
    """The motors of a world between two of its resets.

    Args:
        robot: whose motors they are.
        errors: what they do with commands.
        physics_rate: steps of the world in a second [Hz]; a delay is a whole number of them.
        seed: of the run.
    """

    def __init__(self, robot: RobotDescription, errors: DriveErrors, physics_rate: int, seed: int) -> None:
        self._errors = errors
        self._peak, self._no_load_speed = robot.torque_limit, robot.velocity_limit
        self._wait = round(errors.delay * physics_rate)
        self._seed = seed
        self.rewind(np.zeros(len(robot.joint_names)))

    def rewind(self, torque: Array) -> None:
        """Begin again, with motors that have given a torque until now, shape (nj,) [N·m]."""
        self._given, self._commanded = torque.copy(), deque[tuple[int, Array]]()
        self._rng = generator(self._seed, Stream.MOTOR)

    def tell(self, tick: int, torque: Array) -> None:
        """Command a torque at a physics step, shape (nj,) [N·m]."""
        noise = self._errors.noise
        meant = torque + noise * self._rng.standard_normal(len(torque)) if noise else torque.copy()
        self._commanded.append((tick + self._wait, meant))

    def torque(self, tick: int, speed: Array) -> Array:
        """Torque of the motors in a physics step at joint speeds, shape (nj,) [rad/s]; the world clips it to peaks."""
        while self._commanded and self._commanded[0][0] <= tick:
            self._given = self._commanded.popleft()[1]
        knee = self._errors.torque_speed
        if knee is None:
            return self._given
        return available_torque(self._given, speed, self._peak, self._no_load_speed, knee)
