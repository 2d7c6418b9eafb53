"""The colour of every quantity, the same in figures, replays, the paper's page and the scenes inside a log.

The colours are those of Okabe and Ito, "Color universal design", 2008, which differ for any colour vision, and greys.
A log's scenes hold them as they stand here, so that a change of a digit changes logs.
"""

Color = tuple[float, float, float]
"""Red, green and blue from 0 to 1."""

BLACK: Color = (0.0, 0.0, 0.0)
DARK: Color = (0.34, 0.34, 0.34)
GREY: Color = (0.5, 0.5, 0.5)
WHITE: Color = (1.0, 1.0, 1.0)
ORANGE: Color = (0.90, 0.62, 0.00)
SKY: Color = (0.34, 0.71, 0.91)
GREEN: Color = (0.00, 0.62, 0.45)
BLUE: Color = (0.00, 0.45, 0.70)
VERMILION: Color = (0.84, 0.37, 0.00)
PURPLE: Color = (0.80, 0.47, 0.65)
RED: Color = (0.84, 0.10, 0.10)

COM, ZMP, DCM = ORANGE, VERMILION, BLUE
COM_PLANNED, ZMP_PLANNED, DCM_PLANNED = DARK, BLACK, SKY
FEET = (GREEN, PURPLE)
"""Left and right: footprints, soles and the forces on them."""
SUPPORT = GREEN
FOOTSTEP = BLUE
"""Colour of the place where a foot is planned to land."""
PUSH = RED
PASS, FAIL = GREEN, VERMILION


def paler(color: Color, share: float = 0.5) -> Color:
    """Mix a colour with white."""
    red, green, blue = ((1 - share) * channel + share for channel in color)
    return red, green, blue


def hexadecimal(color: Color) -> str:
    """The colour as ``#RRGGBB``."""
    return "#" + "".join(f"{round(255 * channel):02X}" for channel in color)
