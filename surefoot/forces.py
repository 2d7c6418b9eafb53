"""External forces on a robot: a push, which is soon over, and a load, which lasts. World frame, SI units."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force on a body's CoM for a time.

    Attributes:
        time: when it begins [s].
        duration: how long it acts [s].
        force: shape (3,) [N].
        body: name of the body; empty where there is but one, the point mass.
    """

    time: float
    duration: float
    force: Array
    body: str = ""


@dataclass(frozen=True)
class ExternalLoad:
    """The lasting forces on the robot beside gravity and the ground, and its weight.

    Attributes:
        force: at the CoM, of which the vertical part counts as weight, shape (3,) [N].
        moment: about the CoM, shape (3,) [N·m].
        mass_scale: true mass over the model's [-].
    """

    force: Array
    moment: Array
    mass_scale: float = 1.0

    def per_mass(self, mass: float) -> "ExternalLoad":
        """The same of a robot that weighs one kilogram: force [m/s^2] and moment [m^2/s^2].

        Args:
            mass: true mass of the robot [kg].
        """
        return ExternalLoad(self.force / mass, self.moment / mass)


NO_LOAD = ExternalLoad(np.zeros(3), np.zeros(3))
"""A robot as heavy as its model, on which nothing acts."""
