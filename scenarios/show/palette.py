"""Colours of the marks, the same in every output; distinguishable with any colour vision (Okabe and Ito, 2008)."""

from surefoot.scenarios.show.replay.content import Color

ORANGE: Color = (0.902, 0.624, 0.0)
SKY: Color = (0.337, 0.706, 0.914)
GREEN: Color = (0.0, 0.62, 0.451)
YELLOW: Color = (0.941, 0.894, 0.259)
BLUE: Color = (0.0, 0.447, 0.698)
VERMILION: Color = (0.835, 0.369, 0.0)
PURPLE: Color = (0.8, 0.475, 0.655)
WHITE: Color = (1.0, 1.0, 1.0)

FEET = (BLUE, VERMILION)
"""Left and right."""


def paler(color: Color, share: float = 0.5) -> Color:
    """Mix a colour with white."""
    red, green, blue = ((1 - share) * channel + share for channel in color)
    return red, green, blue
