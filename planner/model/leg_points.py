"""The points of a walking body by their rows, and the type of one of them."""

HIPS, KNEES, ANKLES, FEET, TRUNK, BESIDE = 0, 2, 4, 6, 8, 9
"""First rows of points of a body: of the left and then of the right leg each; `BESIDE` are ways from rods to CoMs, of
thighs and then of shanks [-]."""

LEFT, RIGHT, MIDDLE = 0, 1, 2
"""Rows of what is turned: both legs, and the trunk [-]."""

Vector = tuple[float, float, float]
