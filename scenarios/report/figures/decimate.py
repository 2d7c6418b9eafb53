"""Fewer points than were logged, without losing an extreme."""

import numpy as np
from numpy.typing import NDArray

BUCKETS = 800
"""Stretches of a curve of which the least and the greatest value are kept: about one per pixel."""


def kept(values: NDArray[np.float64], buckets: int = BUCKETS) -> NDArray[np.intp]:
    """Rows of a curve to draw: of each bucket the first, the least, the greatest and a gap, and the last of all.

    Args:
        values: shape (n,); NaN where the curve has a gap.
        buckets: into which the rows are divided.

    Returns:
        ascending rows, at most 4 per bucket and one more; all of them when there are no more than that.
    """
    n = len(values)
    if n <= 4 * buckets:
        return np.arange(n)
    size = -(-n // buckets)
    padded = np.full(buckets * size, np.nan)
    padded[:n] = values
    table = padded.reshape(buckets, size)
    gaps = np.isnan(table)
    picks = (
        np.zeros(buckets, np.intp),
        np.argmin(np.where(gaps, np.inf, table), axis=1),
        np.argmax(np.where(gaps, -np.inf, table), axis=1),
        np.argmax(gaps, axis=1),
    )
    rows = np.unique(np.concatenate([[n - 1], *(np.arange(buckets) * size + pick for pick in picks)]))
    return rows[rows < n]


def kept_of_path(points: NDArray[np.float64]) -> NDArray[np.intp]:
    """Rows of a path in the plane to draw, shape (n, 2) of points: the extremes of both coordinates."""
    return np.union1d(kept(points[:, 0]), kept(points[:, 1]))


def steps(*bounds: NDArray[np.float64]) -> NDArray[np.intp]:
    """Rows at which any of several piecewise constant curves changes, with the first and the last row."""
    table = np.stack(bounds, axis=1)
    changed = np.flatnonzero(np.any(table[1:] != table[:-1], axis=1)) + 1
    rows = np.unique(np.concatenate([[0], changed, [len(table) - 1]]))
    return rows.astype(np.intp)
