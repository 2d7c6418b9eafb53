"""Lengths of a person of 1.80 m, in metres, with the joints standing straight.

The masses beside the bodies follow the adult male averages of de Leva (1996), scaled to 100 kg; motors and links of
the multi-axis joints take their share from the neighbouring segments.
"""

HIP_HALF_WIDTH = 0.10
THIGH = 0.43
SHANK = 0.43
ANKLE_HEIGHT = 0.08
LEG = THIGH + SHANK + ANKLE_HEIGHT
WAIST_HEIGHT = 0.12  # waist joints above the hip centres
SHOULDER_HEIGHT = 0.40  # shoulder centres above the waist joints
SHOULDER_HALF_WIDTH = 0.215
NECK_HEIGHT = 0.475  # neck joints above the waist joints
UPPER_ARM = 0.30
FOREARM = 0.26

FOOT_LENGTH = 0.075  # the paper's foot
FOOT_WIDTH = 0.075
SOLE_THICKNESS = 0.02


def sole_centre_ahead_of_ankle(foot_length: float) -> float:
    """Distance from the ankle axis forward to the sole centre [m].

    Zero for the paper's foot; 0.022 m for a human foot of 0.22 m, whose toe is longer than its heel.
    """
    return 0.15 * max(foot_length - FOOT_LENGTH, 0.0)
