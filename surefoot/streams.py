"""Random numbers of a run, by what they are for: all follow from one seed, and none moves when another is drawn."""

from enum import IntEnum, unique

import numpy as np


@unique
class Stream(IntEnum):
    """A stream of random numbers of its own, whatever else is drawn with the same seed.

    The pose at the start has none: it is drawn from the seed itself.
    """

    MEASUREMENT = 1
    GROUND = 2
    MASSES = 3
    TILES = 4
    HEIGHTS = 5
    ENCODER = 6
    JOINT_TORQUE = 7
    GYRO = 8
    ACCELEROMETER = 9
    IMU = 10
    WRENCH = 11
    MOTOR = 12
    DRIVEN = 13
    LINE = 14
    TOUR = 15
    INSTRUMENT = 16


def generator(seed: int, stream: Stream | None = None, part: int | None = None) -> np.random.Generator:
    """Draws the numbers of a stream, or of one of its parts; those of the seed itself where the stream is None."""
    if stream is None:
        return np.random.default_rng(seed)
    key = (stream,) if part is None else (stream, part)
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
