"""Parametrisation of the jerk over the horizon: how few moves stand for many samples."""

import numpy as np

from planner.types import Array

BLOCK_STARTS = (0, 1, 2, 4, 7, 11, 16, 22, 29, 37)
"""Ten blocks over fifty samples, short at first: the repaired parametrisation (the paper's own is (0, 1), N_c = 2)."""


def block_moves(starts: tuple[int, ...], horizon: int) -> Array:
    """Basis of piecewise constant jerk.

    Args:
        starts: first sample of each block, increasing from 0; a block lasts until the next begins, the last one until
            the end of the horizon (the paper's "last controller output is kept").
        horizon: number of samples N.

    Returns:
        Matrix M, shape (N, len(starts)), with jerk = M moves.

    Raises:
        ValueError: the starts do not increase from 0 inside the horizon.
    """
    if not starts or starts[0] != 0 or list(starts) != sorted(set(starts)) or starts[-1] >= horizon:
        raise ValueError(f"The move blocks start at {starts}, but they must increase from 0 and stay below {horizon}.")
    block = np.searchsorted(np.array(starts), np.arange(horizon), side="right") - 1
    return np.eye(len(starts))[block]
