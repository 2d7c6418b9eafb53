"""The asymmetry of a network between left and right, which separates orders of joints without a run.

A walker is built alike on both sides, and a network that has learnt to walk it treats both nearly alike. Its action on
a mirrored observation is the mirror image of its action. Under names in a wrong order it is not.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.policy.contract import Contract
from surefoot.scenarios.policy.history import Stack
from surefoot.scenarios.policy.mends import other_side
from surefoot.scenarios.policy.network import Network

Array = NDArray[np.float64]

SAMPLES = 6
"""Observations that are mirrored."""

_SIZES = {"angular_velocity": 0.5, "gravity": 0.1, "command": 0.3, "joint_position": 0.1, "joint_velocity": 0.5}
"""Spread of observations that are drawn around rest, by term; of others 0.3 [SI]."""

_SIGNS = {"angular_velocity": (-1, 1, -1), "gravity": (1, -1, 1), "command": (1, -1, -1), "linear_velocity": (1, -1, 1)}
"""Signs that a mirror gives the parts of vectors."""

_JOINTS = ("joint_position", "joint_velocity", "last_action")
_UNTURNED = ("constant", "moving")
"""Terms that a mirror leaves as they are."""


class Mirror:
    """Observations of a contract, drawn once, that are mirrored under one order of its joints after another.

    Args:
        contract: with one input, and an action of all its joints.
        network: that is asked.

    Raises:
        ValueError: it has more inputs, or terms whose mirror image is not known.
    """

    def __init__(self, contract: Contract, network: Network) -> None:
        terms, states = contract.observations, {state.input for state in contract.recurrent}
        free = [name for name in network.inputs if name not in states]
        known = (*_SIGNS, *_JOINTS, *_UNTURNED)
        is_known = all(term.term in known and not (term.options and term.term in _SIGNS) for term in terms)
        if len(free) != 1 or not is_known:
            raise ValueError("its mirror image is not known")
        self._contract, self._network, self._input = contract, network, free[0]
        moved = contract.action.joints or contract.joints
        self._moved = [contract.joints.index(name) for name in moved]
        self._indices = [[contract.joints.index(name) for name in term.joints or contract.joints] for term in terms]
        self._states = {name: network.shaped(name, np.zeros(max(network.inputs[name], 1))) for name in states}
        outputs = [name for name in network.outputs if name not in {state.output for state in contract.recurrent}]
        self._output = contract.action.output or outputs[0]
        self._lengths = [term.history or contract.history.length for term in terms]
        rng = np.random.default_rng(0)
        self._drawn = [[self._frames(number, rng) for number in range(len(terms))] for _ in range(SAMPLES)]
        self._plain = [self._asked(frames) for frames in self._drawn]

    def _frames(self, number: int, rng: np.random.Generator) -> Array:
        """Values of a term over time, a row each, the newest one last."""
        term, length = self._contract.observations[number], max(self._lengths)
        if term.term in _UNTURNED:
            rest = (term.options or {}).get("values", [0.0])
            return np.asarray(np.tile(np.asarray(rest, dtype=np.float64) * np.asarray(term.scale), (length, 1)))
        size = len(self._joints(number)) if term.term in _JOINTS else len(_SIGNS[term.term])
        values = _SIZES.get(term.term, 0.3) * rng.standard_normal((1, size))
        values = values + 0.2 * _SIZES.get(term.term, 0.3) * rng.standard_normal((length, size))
        if term.term == "gravity":
            values[:, 2] -= 1.0
        return np.asarray(values * np.asarray(term.scale))

    def _joints(self, number: int) -> list[int]:
        """Places, among the joints of the contract, of those that a term tells."""
        return self._moved if self._contract.observations[number].term == "last_action" else self._indices[number]

    def _asked(self, frames: Sequence[Array]) -> Array:
        history = self._contract.history
        stack = Stack(self._lengths, history.order == "newest_first", history.interleaved, zero=False)
        sizes = [values.shape[1] for values in frames]
        for newest in np.concatenate(frames, axis=1):
            observed = stack.add(newest, sizes)
        found = self._network.run({**self._states, self._input: self._network.shaped(self._input, observed)})
        return np.asarray(found[self._output], dtype=np.float64).ravel()

    def error(self, names: Sequence[str]) -> float:
        """Distance of actions of mirrored observations from mirrored actions, over the size of both [-]."""
        partner, sign = _image([names[index] for index in self._moved])
        off = size = 0.0
        for frames, plain in zip(self._drawn, self._plain, strict=True):
            images = [self._mirrored(number, values, names) for number, values in enumerate(frames)]
            found, wanted = self._asked(images), plain[partner] * sign
            off += float(np.sum((found - wanted) ** 2))
            size += float(np.sum(found**2) + np.sum(wanted**2))
        return off / max(size, 1e-12)

    def _mirrored(self, number: int, values: Array, names: Sequence[str]) -> Array:
        """The mirror image of a term's values under names of the joints."""
        term = self._contract.observations[number].term
        if term in _JOINTS:
            partner, sign = _image([names[index] for index in self._joints(number)])
            return np.asarray(values[:, partner] * sign)
        return values if term in _UNTURNED else np.asarray(values * np.array(_SIGNS[term]))

    def better(self, most: int = 8, share: float = 0.9) -> list[tuple[int, int]]:
        """Pairs of joints under whose change left and right are treated more alike, the best first."""
        names = list(self._contract.joints)
        least, found = share * self.error(names), []
        for i, j in combinations(range(len(names)), 2):
            names[i], names[j] = names[j], names[i]
            found.append((self.error(names), (i, j)))
            names[i], names[j] = names[j], names[i]
        return [pair for error, pair in sorted(found)[:most] if error < least]


def _image(names: Sequence[str]) -> tuple[NDArray[np.intp], Array]:
    """Counterpart of each joint, and the sign that a mirror gives its angle, by their names."""
    places = {name: index for index, name in enumerate(names)}
    partner = [places.get(other_side(name), index) for index, name in enumerate(names)]
    turns = [-1.0 if "roll" in name or "yaw" in name else 1.0 for name in names]
    return np.array(partner, dtype=np.intp), np.array(turns)
