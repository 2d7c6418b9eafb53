"""Arms that swing against the legs: a posture that moves with the stride and takes up the legs' yaw momentum."""

import math

from surefoot.maths import algebra
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.reference import WbcReference


class ArmSwing:
    """Shoulder pitch that follows the stride.

    An arm goes back while the foot of its side is ahead of the other: q = q_0 ± a s with the stride s, how far the left
    sole is ahead of the right one along the pelvis. It needs no phase: it starts, stops and turns with the feet. Its
    acceleration is that of the planned swing. An arm without it follows its leg 80 ms late. Its momentum then adds to
    the leg's where the leg is braked. At 1.4 m/s a sole would have to hold a moment of 77 N·m in place of 49.

    Args:
        joints: indices of the left and right shoulder pitch among the actuated joints.
        gain: a [rad/m].
        back: sign of the angles that swing the left and the right arm back.
    """

    def __init__(self, joints: tuple[int, int], gain: float, back: tuple[float, float] = (1.0, 1.0)) -> None:
        (self.left, self.right), self.gain = joints, gain
        self.left_back, self.right_back = back

    def offset(self, terms: RobotTerms, reference: WbcReference) -> algebra.Vector:
        """Angle of the left arm back from the posture, and its derivatives [rad, rad/s, rad/s^2]; the right mirrors it.

        Angle and rate are those of the soles as they are, the acceleration is that of the reference's swing foot. It
        counts none while a step catches the body: such a foot is thrown, and the arms with it would spin the neck.
        """
        x, y = terms._R_base[0, 0], terms._R_base[1, 0]
        scale = self.gain / max(math.hypot(x, y), 1e-3)
        left = algebra.rotate(terms._R_contact[0], algebra.vector(terms._v_sole[0]))
        right = algebra.rotate(terms._R_contact[1], algebra.vector(terms._v_sole[1]))
        swing, p, ahead = reference._s_ddot, terms._p_sole, 0.0
        if reference.swing_foot >= 0 and not reference.catching:
            ahead = scale * (x * swing[0] + y * swing[1])
        return (
            scale * (x * (p[0, 0] - p[1, 0]) + y * (p[0, 1] - p[1, 1])),
            scale * (x * (left[0] - right[0]) + y * (left[1] - right[1])),
            -ahead if reference.swing_foot == 1 else ahead,
        )
