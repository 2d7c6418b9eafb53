"""The state of a simulated world before a step, to come back to where the step diverges."""

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.maths import algebra, linear
from surefoot.sim.measurement import Array

ACCELERATION_LIMIT = 1e10
"""Norm of the generalised acceleration beyond which a state counts as diverged; MuJoCo's own bound."""


class Checkpoint:
    """The last state of a world that was sound.

    Args:
        data: MuJoCo's state of the world.
    """

    def __init__(self, data: mujoco.MjData) -> None:
        self._qpos, self._qvel, self._qacc = data.qpos, data.qvel, data.qacc
        self._last_qpos, self._last_qvel = np.array(data.qpos), np.array(data.qvel)

    def keep(self) -> None:
        """Keep the state as it is."""
        self._last_qpos[:] = self._qpos
        self._last_qvel[:] = self._qvel

    def restore(self) -> None:
        """Make the state what it was."""
        self._qpos[:] = self._last_qpos
        self._qvel[:] = self._last_qvel

    def diverged(self) -> bool:
        """Return true if the acceleration is beyond the limit, or no number."""
        return not linear.dot(self._qacc, self._qacc) < ACCELERATION_LIMIT * ACCELERATION_LIMIT


def is_finite(values: Array) -> bool:
    """Return true if all numbers are finite, and the sum of their squares."""
    return linear.dot(values, values) < algebra.INFINITY
