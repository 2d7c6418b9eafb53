"""Inputs of a network: terms of an observation, scaled, clipped, and side by side with what they were before."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import nearest
from surefoot.scenarios.policy.contract import KEY, Contract, Term
from surefoot.scenarios.policy.history import Stack
from surefoot.scenarios.policy.joints import indices
from surefoot.scenarios.policy.terms import TERMS, Seen

Array = NDArray[np.float64]


class Feed:
    """What an input of a network is made of.

    Args:
        terms: in order.
        contract: that they are of.

    Raises:
        ParameterError: a term is not known, or its joints or history do not fit.
    """

    def __init__(self, terms: Sequence[Term], contract: Contract) -> None:
        history = contract.history
        self.terms = tuple(terms)
        self._functions = [_function(term) for term in terms]
        self._joints = [indices(term.joints or contract.joints, contract.joints, f"term {term.term}") for term in terms]
        self._scales = [np.asarray(term.scale, dtype=np.float64) for term in terms]
        lengths = [term.history or history.length for term in terms]
        try:
            self._kept = Stack(lengths, history.order == "newest_first", history.interleaved, history.begin == "zero")
        except ValueError as error:
            raise ParameterError(KEY, str(error), "give all the same, or history.interleaved false") from None

    def reset(self) -> None:
        """Forget what was observed."""
        self._kept.reset()

    def values(self, seen: Seen, position: Array, default: Array, velocity: Array) -> list[Array]:
        """The newest values of each term; joints in the order of the contract, shape (k,)."""
        return [self._value(number, seen, position, default, velocity) for number in range(len(self.terms))]

    def _value(self, number: int, seen: Seen, position: Array, default: Array, velocity: Array) -> Array:
        term, at = self.terms[number], self._joints[number]
        told = replace(seen, position=position[at], default=default[at], velocity=velocity[at])
        try:
            found = np.asarray(self._functions[number](told, **(term.options or {})), dtype=np.float64).ravel()
        except TypeError as error:
            raise ParameterError(KEY, f"term {term.term}: {error}", "give it the options that it has") from None
        if term.clip is not None:
            found = np.clip(found, *term.clip)
        if self._scales[number].size not in (1, len(found)):
            what = f"term {term.term} has {len(found)} numbers, and {self._scales[number].size} scales"
            raise ParameterError(KEY, what, "give one for all, or one for each")
        return np.array(self._scales[number] * found)

    def observe(self, values: Sequence[Array]) -> Array:
        """The input, with what was observed before."""
        return self._kept.add(values)


def _function(term: Term) -> Any:
    try:
        return TERMS.guard(term.term).function(TERMS[term.term])
    except KeyError:
        raise ParameterError(KEY, f"no observation is called '{term.term}'", nearest(term.term, list(TERMS))) from None
