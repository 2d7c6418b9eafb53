"""The freedom of footsteps on a ground: they land anywhere, or each was chosen for its face."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.types import Array


@dataclass(frozen=True, slots=True)
class Footholds:
    """Footsteps that may land elsewhere than planned, or each on its face alone.

    Attributes:
        follow: whether the steps after one that is moved go as far; on faces they stay where they are.
    """

    follow: bool

    def counted(self, ahead: int, most: int) -> int:
        """Steps with which a body can be caught, of those that are ahead; more are added where any ground will do."""
        return most if self.follow else min(ahead, most)

    def shifted(self, shift: Array, yaw: float, room: Array) -> Array:
        """Shift of a footstep that its face allows, world frame, shape (2,) [m].

        Args:
            shift: by which it is to be shifted, world frame, shape (2,) [m].
            yaw: its heading [rad].
            room: least and greatest way on its face in that heading, shape (2, 2) [m].
        """
        axes = frame_rotation(yaw)
        return shift if self.follow else np.asarray(axes @ np.clip(shift @ axes, *room))

    def crossed(self, lift: float) -> bool:
        """Return true if a foot may land beyond its stance foot, with a step that takes the body so much higher [m].

        On faces a leg that lets the body down has its knee in the way.
        """
        return self.follow or lift >= 0.0

    def edged(self, climb: float) -> bool:
        """Return true if edges are before a foot that lands so much higher than it stood [m]."""
        return not self.follow and climb != 0.0
