"""The boxes around a stance foot in which legs let a foot land. See `planner.swing.leg_reach` for the legs."""

from surefoot.planner.types import Array


def landing_boxes(
    low: Array,
    high: Array,
    extents: tuple[float, float, float, float],
    across: float,
    side: float,
    face: Array,
    count: int,
) -> None:
    """Write the boxes in one of which a foot may land; one that is empty has its corners crossed.

    The first is beside the stance foot, those after it are beyond, ahead and behind.

    Args:
        low: lower corners, shape (boxes, 2) [m].
        high: upper corners, shape (boxes, 2) [m].
        extents: greatest stride, distance of the hips, least distance beside and ahead of the stance foot [m].
        across: how far beyond its stance foot a foot may land [m].
        side: +1 for a left foot, -1 for a right one.
        face: lower and upper corner of where its sole stays on the ground that was chosen, shape (2, 2) [m].
        count: of boxes, 1 or 3.
    """
    most, hip_width, beside, clear = extents
    far = side * (most + hip_width)
    for box in range(count):
        near = side * (-across if box > 0 else beside)
        low[box, 0] = max(clear if box == 1 else -most, face[0, 0])
        high[box, 0] = min(-clear if box == 2 else most, face[1, 0])
        low[box, 1] = max(min(near, far), face[0, 1])
        high[box, 1] = min(max(near, far), face[1, 1])
