"""How far a leg reaches: the geometric bound on the step length."""

import math


def longest_step(leg_length: float, hip_height: float, hip_width: float, step_width: float) -> float:
    """Longest step with flat soles, the CoM halfway between the feet at touchdown.

    Each straight leg then spans half the step forward, half the difference of foot and hip spacing sideways and the hip
    height upward.

    Args:
        leg_length: hip centre to sole with the knee straight [m].
        hip_height: hip centre above the soles at touchdown [m].
        hip_width: distance between the hip centres [m].
        step_width: lateral distance between the soles' centres [m].

    Returns:
        forward distance between the soles' centres [m]; NaN when the hips are out of reach of feet side by side.
    """
    sideways = (step_width - hip_width) / 2
    square = leg_length**2 - hip_height**2 - sideways**2
    return 2 * math.sqrt(square) if square >= 0 else math.nan
