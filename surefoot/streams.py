"""Random numbers of a run, by what they are for: all follow from one seed, and none moves when another is drawn."""

from enum import IntEnum

import numpy as np


class Stream(IntEnum):
    """What has random numbers of its own, whatever else is drawn with the same seed.

    The pose at the start has none: it is drawn from the seed itself.
    """

    MEASUREMENT = 1
    GROUND = 2
    MASSES = 3
    TILES = 4
    HEIGHTS = 5


def generator(seed: int, stream: Stream | None = None) -> np.random.Generator:
    """Draws the numbers of a stream; those of the seed itself where it is None."""
    return np.random.default_rng(seed if stream is None else np.random.SeedSequence(seed, spawn_key=(stream,)))
