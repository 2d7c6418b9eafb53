"""What goes between a controller and the joints of a robot."""

import numpy as np
from numpy.typing import NDArray

from surefoot.values import dataclass

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class JointCommand:
    """What the joints are to do until the next command; the joint order is that of the robot description.

    Attributes:
        torque: of the motors, shape (nj,) [N·m].
    """

    torque: Array
