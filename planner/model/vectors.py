"""Vectors at the samples of a window, whose components come before the samples.

So numpy's inner loops go over the samples, not over three numbers, which takes half the time.
"""

from collections.abc import Sequence

import numpy as np

from surefoot.planner.types import Array


def bend(ways: Array, sample_time: float) -> Array:
    """Accelerations of points at all samples but the first and the last, shape (..., 3, n - 2) [m/s^2].

    Second differences alone are a mean over two samples, which takes a tenth off what a leg swings in a double support.
    Their error to fourth order is subtracted. At either end it is that of the sample beside it.
    """
    bends = _second_differences(ways)
    if bends.shape[-1] > 2:
        rest = _second_differences(bends) / 12.0
        bends[..., 1:-1] -= rest
        bends[..., 0] -= rest[..., 0]
        bends[..., -1] -= rest[..., -1]
    bends /= sample_time**2
    return bends


def _second_differences(ways: Array) -> Array:
    steps = ways[..., 1:] - ways[..., :-1]
    return np.asarray(steps[..., 1:] - steps[..., :-1])


def headings(heading: Array) -> Array:
    """Forward and left at each sample of headings of shape (..., n), shape (..., 2, 3, n)."""
    frame = np.zeros((*heading.shape[:-1], 2, 3, heading.shape[-1]))
    c, s = np.cos(heading), np.sin(heading)
    frame[..., 0, 0, :], frame[..., 0, 1, :], frame[..., 1, 0, :], frame[..., 1, 1, :] = c, s, -s, c
    return frame


def turned(frame: Array, vector: Sequence[float] | Array) -> Array:
    """A vector in a frame that is level, as of `headings`, shape (..., 3, n)."""
    x, y, z = vector
    there = x * frame[..., 0, :, :] + y * frame[..., 1, :, :]
    there[..., 2, :] += z
    return np.asarray(there)


def pitched(frame: Array, vector: Array, pitch: Array) -> Array:
    """A vector of a foot that is pitched heel up, shape (2, 3, n)."""
    c, s = np.cos(pitch), np.sin(pitch)
    x, y, z = vector
    there = (c * x + s * z)[:, None] * frame[:, 0] + y * frame[:, 1]
    there[:, 2] += c * z - s * x
    return np.asarray(there)


def dot(a: Array, b: Array) -> Array:
    """Inner products of vectors of shape (2, 3, n), shape (2, n)."""
    x, y, z = (a * b).swapaxes(0, 1)
    return np.asarray(x + z + y)


def cross(a: Array, b: Array) -> Array:
    """Cross products of vectors of shape (..., 3, n)."""
    a, b = _cyclic(a), _cyclic(b)
    return np.asarray(a[..., 1:4, :] * b[..., 2:, :] - a[..., 2:, :] * b[..., 1:4, :])


def crossed(points: Array, rates: Array) -> Array:
    """Sum over the points, of shape (..., points, 3, n), of their cross products, shape (..., 3, n)."""
    points, rates = _cyclic(points), _cyclic(rates)
    there, back = points[..., 1:4, :] * rates[..., 2:, :], points[..., 2:, :] * rates[..., 1:4, :]
    return np.asarray(there.sum(axis=-3) - back.sum(axis=-3))


def _cyclic(vectors: Array) -> Array:
    """Their components x, y, z, x, y, shape (..., 5, n): any three in cyclic order are neighbours."""
    return np.concatenate((vectors, vectors[..., :2, :]), axis=-2)
