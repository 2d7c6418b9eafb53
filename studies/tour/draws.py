"""Draws of a tour from its seed, by our own random numbers or by those of the benchmark."""

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.streams import Stream, generator
from surefoot.studies.tour import rules
from surefoot.studies.tour.rules import ARM_STEP, ARM_STEPS, CENTRE, DELAY, DURATION, RADIUS, SLOT, Punch, Tour, drawn

Array = NDArray[np.float64]

Steps = Callable[[int], Array]
"""Draws the next steps to a pose of an arm with so many joints, each within `ARM_STEP`, shape (steps, joints) [rad]."""


class Draws(Protocol):
    """Draws all that is random in a tour."""

    def tour(self, seed: int, joints: int) -> Tour:
        """Places and punches of a seed for a robot with so many joints."""
        ...

    def arm_steps(self, seed: int) -> Steps:
        """The source of the arms' steps of that seed."""
        ...


class OwnDraws:
    """Draws by the streams of Surefoot."""

    def tour(self, seed: int, joints: int) -> Tour:
        """See `Draws`."""
        return drawn(seed, joints)

    def arm_steps(self, seed: int) -> Steps:
        """See `Draws`."""
        rng = generator(seed, Stream.TOUR, 2)
        return lambda joints: rng.uniform(-ARM_STEP, ARM_STEP, (ARM_STEPS, joints))


class BenchmarkDraws:
    """Draws by the streams of the benchmark, whose run of the same number has the same places, punches and poses.

    A punch points in the frame of the link that it hits, or of the one that this hangs from, at random.
    """

    _TOUR, _PUNCH, _ARM = 2, 3, 4
    """Numbers of its streams."""

    def tour(self, seed: int, joints: int) -> Tour:
        """See `Draws`."""
        slots, unit = round(DURATION / SLOT), Twister(seed, self._TOUR).unit
        places = np.empty((slots, 3))
        for place in places:
            radius = RADIUS * math.sqrt(unit())
            bearing, yaw = math.tau * unit(), math.tau * unit()
            x, y = CENTRE[0] + radius * math.cos(bearing), CENTRE[1] + radius * math.sin(bearing)
            place[:] = x, y, math.remainder(yaw, math.tau)
        numbers = Twister(seed, self._PUNCH)
        punches = tuple(self._punch(SLOT * slot + DELAY, joints, numbers) for slot in range(slots))
        return Tour(seed, places, punches)

    @staticmethod
    def _punch(time: float, joints: int, numbers: "Twister") -> Punch:
        joint, of_child = numbers.below(joints), numbers.below(2) != 0
        z, turn = 2.0 * numbers.unit() - 1.0, math.tau * numbers.unit()
        level = math.sqrt(1.0 - z * z)
        direction = np.array([level * math.cos(turn), level * math.sin(turn), z])
        force = rules.greatest(time) * (rules.LEAST + (1.0 - rules.LEAST) * numbers.unit())
        return Punch(time, joint, direction, force, of_parent=not of_child)

    def arm_steps(self, seed: int) -> Steps:
        """See `Draws`."""
        numbers = Twister(seed, self._ARM)
        return lambda joints: ARM_STEP * (2.0 * numbers.units(ARM_STEPS * joints).reshape(ARM_STEPS, joints) - 1.0)


class Twister:
    """Numbers of C++'s ``std::mt19937``, seeded by ``std::seed_seq{run, stream}`` as the benchmark does.

    Args:
        run: number of the run.
        stream: number of what is drawn.
    """

    _WORDS = 624
    """Words of the state of the generator."""

    def __init__(self, run: int, stream: int) -> None:
        key = np.array(seed_sequence((run % 2**32, stream), self._WORDS), dtype=np.uint32)
        if key[0] < 2**31 and not key[1:].any():
            key[0] = 2**31  # the generator refuses a state of nothing but zeros
        self._bits = np.random.MT19937()
        self._bits.state = {"bit_generator": "MT19937", "state": {"key": key, "pos": self._WORDS}}

    def unit(self) -> float:
        """From 0 to 1, by the upper 24 bits of a word."""
        return (int(self._bits.random_raw()) >> 8) / 2**24

    def units(self, count: int) -> Array:
        """So many of them, shape (count,)."""
        words: Array = (np.asarray(self._bits.random_raw(count), dtype=np.uint64) >> np.uint64(8)) / 2.0**24
        return words

    def below(self, bound: int) -> int:
        """A whole number from 0 to below a bound, each as likely."""
        span = 2**32 // bound
        while (word := int(self._bits.random_raw())) >= span * bound:
            pass
        return word // span


def seed_sequence(given: tuple[int, ...], count: int) -> list[int]:
    """Words that ``std::seed_seq`` makes of some 32-bit words: so many others, at least 624.

    Source: ISO/IEC 14882:2020, [rand.util.seedseq], paragraph 8.
    """
    words, mask = [0x8B8B8B8B] * count, 2**32 - 1
    s, t = len(given), 11
    p = (count - t) // 2
    q, rounds = p + t, max(s + 1, count)

    def mixed(x: int) -> int:
        return x ^ (x >> 27)

    for k in range(rounds):
        at, near, far = k % count, (k + p) % count, (k + q) % count
        first = 1664525 * mixed(words[at] ^ words[near] ^ words[(k - 1) % count]) & mask
        added = s if k == 0 else at + given[k - 1] if k <= s else at
        second = (first + added) & mask
        words[near] = (words[near] + first) & mask
        words[far] = (words[far] + second) & mask
        words[at] = second
    for k in range(rounds, rounds + count):
        at, near, far = k % count, (k + p) % count, (k + q) % count
        first = 1566083941 * mixed((words[at] + words[near] + words[(k - 1) % count]) & mask) & mask
        second = (first - at) & mask
        words[near] ^= first
        words[far] ^= second
        words[at] = second
    return words


DRAWS: dict[str, Draws] = {"own": OwnDraws(), "benchmark": BenchmarkDraws()}
"""All of them, by name."""
