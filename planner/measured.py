"""The measured values of a tick, as the planner takes them."""

import math
from dataclasses import dataclass

from surefoot.planner.model.dcm import dcm
from surefoot.planner.types import CentroidalState, FeetState


@dataclass(frozen=True)
class Measured:
    """CoM and feet of a tick; world frame.

    Attributes:
        body: the CoM, and since when it is so.
        feet: both of them.

    Raises:
        ValueError: the CoM or the feet are not finite.
    """

    body: CentroidalState
    feet: FeetState

    def __post_init__(self) -> None:
        """Refuse what is not finite."""
        body, feet = self.body, self.feet
        numbers = (*body.com.tolist(), *body.com_velocity.tolist(), *feet.position.ravel().tolist(), *feet.yaw.tolist())
        if not all(map(math.isfinite, numbers)):
            raise ValueError(f"The measured CoM or feet are not finite at {self.time:g} s.")

    @property
    def time(self) -> float:
        """Instant of the measurement [s]."""
        return self.body.time

    def dcm(self, omega: float) -> tuple[float, float, float]:
        """DCM in the world frame, of that rate [1/s], and the rate [m, 1/s]."""
        x, y = dcm(self.body.com[:2], self.body.com_velocity[:2], omega).tolist()
        return x, y, omega

    def dcm_uncertainty(self, omega: float) -> float:
        """Two standard deviations of the DCM, of that rate [1/s, m]."""
        com, velocity = self.body.deviation
        return 2.0 * math.hypot(com, velocity / omega) if com or velocity else 0.0
