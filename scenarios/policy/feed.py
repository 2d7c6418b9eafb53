"""Inputs of a network: terms of an observation, scaled, clipped, and side by side with what they were before."""

import inspect
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
from surefoot.scenarios.policy.terms import OF_BASE, TERMS, Seen

Array = NDArray[np.float64]


class Feed:
    """The feed of an input of a network.

    Args:
        terms: in order.
        contract: that they are of.

    Attributes:
        terms: in order.
        looks: whether a term may want to know more than base and joints: where torso and soles are.

    Raises:
        ParameterError: a term is not known, or its joints or history do not fit.
    """

    def __init__(self, terms: Sequence[Term], contract: Contract) -> None:
        history = contract.history
        self.terms = tuple(terms)
        self.looks = any(term.term not in OF_BASE or (term.options or {}).get("body") == "torso" for term in terms)
        self._functions = [_function(term) for term in terms]
        self._joints = [
            None if term.joints is None else indices(term.joints, contract.joints, f"term {term.term}")
            for term in terms
        ]
        self._scales = [np.asarray(term.scale, dtype=np.float64) for term in terms]
        lengths = [term.history or history.length for term in terms]
        try:
            self._kept = Stack(lengths, history.order == "newest_first", history.interleaved, history.begin == "zero")
        except ValueError as error:
            raise ParameterError(KEY, str(error), "give all the same, or history.interleaved false") from None

    def reset(self) -> None:
        """Forget what was observed."""
        self._kept.reset()

    def values(self, seen: Seen) -> list[Array]:
        """The newest values of each term; joints of what is seen are those of the contract."""
        return [self._value(number, seen) for number in range(len(self.terms))]

    def _value(self, number: int, seen: Seen) -> Array:
        term, at, scale = self.terms[number], self._joints[number], self._scales[number]
        if at is not None:
            seen = replace(seen, position=seen.position[at], default=seen.default[at], velocity=seen.velocity[at])
        found = np.asarray(self._functions[number](seen, **(term.options or {})), dtype=np.float64).ravel()
        if term.clip is not None:
            found = np.clip(found, *term.clip)
        if scale.size not in (1, len(found)):
            what = f"term {term.term} has {len(found)} numbers, and {scale.size} scales"
            raise ParameterError(KEY, what, "give one for all, or one for each")
        scaled: Array = found * scale
        return scaled

    def observe(self, values: Sequence[Array]) -> Array:
        """The input, with what was observed before."""
        return self._kept.add(values)


def _function(term: Term) -> Any:
    try:
        function = TERMS[term.term]
    except KeyError:
        raise ParameterError(KEY, f"no observation is called '{term.term}'", nearest(term.term, list(TERMS))) from None
    try:
        inspect.signature(function).bind(None, **(term.options or {}))
    except TypeError as error:
        raise ParameterError(KEY, f"term {term.term}: {error}", "give it the options that it has") from None
    return TERMS.guard(term.term).function(function)
