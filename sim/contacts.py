"""Contacts: of the ground with the feet, of the ground with anything else, of the robot with itself."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco

_TERRAIN, _FOOT, _BODY = 0, 1, 3
"""Codes of geoms: the sum over a contact's two tells its kind; 3 is a body other than a foot on the terrain."""


class ContactSense:
    """Sorts the contacts of the latest physics step."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, feet: Sequence[int]) -> None:
        """Look at a model's contacts; ``feet`` are the ids of the two foot bodies."""
        self._contact = data.contact
        body, (left, right) = model.geom_bodyid, feet
        code = np.where((body == left) | (body == right), _FOOT, _BODY)  # numpy.isin takes thirty times as long
        self._code: NDArray[np.intp] = np.where(body == 0, _TERRAIN, code)
        self._geoms, self._touches = b"", (False, False)

    def read(self) -> tuple[bool, bool]:
        """Read two flags: anything but a foot touches the terrain, and the robot touches itself."""
        geoms = self._contact.geom
        pairs = geoms.tobytes()
        # The same geoms touch for many steps; to compare them takes a tenth of the time of sorting them.
        if pairs != self._geoms:
            codes = self._code[geoms]
            self._geoms = pairs
            self._touches = bool((codes.sum(axis=1) == _BODY).any()), bool(codes.all(axis=1).any())
        return self._touches
