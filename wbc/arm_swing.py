"""Arms that swing against the legs: a posture that moves with the stride and takes up the legs' yaw momentum."""

import numpy as np

from surefoot.values import dataclass
from surefoot.wbc.model import RobotTerms


@dataclass(frozen=True, slots=True)
class ArmSwing:
    """Shoulder pitch that follows the stride.

    An arm goes back while the foot of its side is ahead of the other: q = q_0 ± a s with the stride s, how far the left
    sole is ahead of the right one along the pelvis. It needs no phase: it starts, stops and turns with the feet.

    Attributes:
        joints: indices of the left and right shoulder pitch among the actuated joints.
        gain: a [rad/m].
        back: sign of the angles that swing the left and the right arm back.
    """

    joints: tuple[int, int]
    gain: float
    back: tuple[float, float] = (1.0, 1.0)

    def offset(self, terms: RobotTerms) -> tuple[float, float]:
        """How far the left arm is swung back from the posture, and its rate [rad, rad/s]; the right one mirrors it."""
        x, y = terms.base_rotation.item(0, 0), terms.base_rotation.item(1, 0)
        length = float(np.hypot(x, y))
        (lx, ly, _), (rx, ry, _) = terms.sole_position.tolist()
        velocity = np.matmul(terms.contact_rotation, terms.sole_velocity[:, :3, None])
        vx, vy, _, wx, wy, _ = velocity.ravel().tolist()
        scale = self.gain / max(length, 1e-3)
        return scale * (x * (lx - rx) + y * (ly - ry)), scale * (x * (vx - wx) + y * (vy - wy))
