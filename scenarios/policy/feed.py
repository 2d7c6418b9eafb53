"""Inputs of a network: terms of an observation, scaled, clipped, and side by side with what they were before."""

import inspect
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError, PartError
from surefoot.scenarios.errors import nearest
from surefoot.scenarios.policy.contract import KEY, Contract, Term
from surefoot.scenarios.policy.history import Stack
from surefoot.scenarios.policy.joints import indices, within
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
        functions = [_function(term) for term in terms]
        joints = [
            None if term.joints is None else indices(term.joints, contract.joints, f"term {term.term}")
            for term in terms
        ]
        self._functions = list(zip(functions, joints, strict=True))
        self._sizes: list[int] | None = None
        lengths = [term.history or history.length for term in terms]
        try:
            self._kept = Stack(lengths, history.order == "newest_first", history.interleaved, history.begin == "zero")
        except ValueError as error:
            raise ParameterError(KEY, str(error), "give all the same, or history.interleaved false") from None

    def reset(self) -> None:
        """Forget what was observed."""
        self._kept.reset()

    def values(self, seen: Seen) -> list[Array]:
        """The newest values of each term, as they are; joints of what is seen are those of the contract."""
        return [_numbers(function(seen if at is None else _of(seen, at))) for function, at in self._functions]

    def observe(self, values: Sequence[Array]) -> Array:
        """The input: values of each term, clipped and scaled, with what was observed before.

        Raises:
            ParameterError: a term has other numbers than its scale.
            PartError: a term has other numbers than before.
        """
        if self._sizes is None:
            self._sizes = [len(one) for one in values]
            self._scale = np.concatenate([*map(_scales, self.terms, self._sizes)])
            self._bounds = _bounds(self.terms, self._sizes)
        newest = np.concatenate(values)
        if len(newest) != len(self._scale):
            what = f"observation terms have {len(newest)} numbers, and had {len(self._scale)} before"
            raise PartError(what, "give as many at each decision")
        if self._bounds is not None:
            newest = within(newest, *self._bounds)
        return self._kept.add(newest * self._scale, self._sizes)


def _numbers(values: Any) -> Array:
    """The numbers that a term tells, shape (k,)."""
    return np.asarray(values, dtype=np.float64).ravel()


def _of(seen: Seen, at: NDArray[np.intp]) -> Seen:
    """The same with some joints alone."""
    return replace(seen, position=seen.position[at], default=seen.default[at], velocity=seen.velocity[at])


def _scales(term: Term, size: int) -> Array:
    """Scale of each number of a term."""
    scale = np.asarray(term.scale, dtype=np.float64)
    if scale.size not in (1, size):
        what = f"term {term.term} has {size} numbers, and {scale.size} scales"
        raise ParameterError(KEY, what, "give one for all, or one for each")
    return np.full(size, scale)


def _bounds(terms: Sequence[Term], sizes: Sequence[int]) -> tuple[Array, Array] | None:
    """Bounds of the numbers of all terms; None where nothing is clipped."""
    if all(term.clip is None for term in terms):
        return None
    pairs = [np.tile(term.clip or (-np.inf, np.inf), (size, 1)) for term, size in zip(terms, sizes, strict=True)]
    lower, upper = np.concatenate(pairs).T
    return lower.copy(), upper.copy()


def _function(term: Term) -> Any:
    try:
        function = TERMS[term.term]
    except KeyError:
        raise ParameterError(KEY, f"no observation is called '{term.term}'", nearest(term.term, list(TERMS))) from None
    try:
        inspect.signature(function).bind(None, **(term.options or {}))
    except TypeError as error:
        raise ParameterError(KEY, f"term {term.term}: {error}", "give it the options that it has") from None
    return TERMS.guard(term.term).function(partial(function, **(term.options or {})))
