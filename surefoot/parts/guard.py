"""A guard around the calls of parts that are not Surefoot's own, so that their faults are named."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from traceback import walk_tb
from types import TracebackType
from typing import Any

from surefoot.errors import ParameterError, PartError

OWN_PACKAGE = "surefoot"
"""The package of what is in no entry point."""


class MisfitError(Exception):
    """A value from a part is not what its protocol says; the message goes on after the part's name."""


LONGEST_SAID = 300
"""Characters of what a part says of itself that are shown."""


def said(error: BaseException) -> str:
    """Type and message of what a part raised, in one line, whatever its message is made of."""
    return error.args[0] if isinstance(error, MisfitError) else _line(error, str, f"{type(error).__name__}: ")


def shown(thing: object) -> str:
    """The text by which an object shows itself, in one line, whatever it does instead."""
    return _line(thing, repr, "")


def _line(thing: object, text: Callable[[Any], str], before: str) -> str:
    """A text that an object of others makes of itself, or its type alone."""
    try:
        line = " ".join(text(thing).split())
    except KeyboardInterrupt:
        raise
    except BaseException:
        line = "" if before else f"<{type(thing).__name__} that cannot be shown>"
    if len(line) > LONGEST_SAID:
        line = f"{line[:LONGEST_SAID]} ..."
    return f"{before}{line}".removesuffix(": ")


def _as_given(answer: Any, *_: Any, **__: Any) -> Any:
    return answer


@dataclass(frozen=True, slots=True)
class Guard:
    """Stands around calls of a part: whatever that raises, a `SystemExit` too, becomes a `PartError` with its name.

        with Guard("task 'arm-up' of package hop"):
            task = make(model, frames)

    A KeyboardInterrupt goes through, as does the error of a guard within.

    Attributes:
        who: kind, name and package of the part; empty for one of Surefoot's own, whose errors are defects.
        through: errors that go through, too.
    """

    who: str
    through: tuple[type[Exception], ...] = ()

    @classmethod
    def of_program(cls, kind: str, part: object) -> "Guard":
        """Around a part that the running program has handed over, a function or a class as a rule; none around ours."""
        if str(getattr(part, "__module__", "")).partition(".")[0] == OWN_PACKAGE:
            return OWN_GUARD
        return cls(f"{kind} '{getattr(part, '__qualname__', type(part).__qualname__)}' of this program")

    @property
    def making(self) -> "Guard":
        """The guard while the part is made, when it may refuse with a `ParameterError` what it is made of."""
        return replace(self, through=(ParameterError,))

    def function(self, function: Callable[..., Any], take: Callable[..., Any] = _as_given) -> Callable[..., Any]:
        """A function of the part with the guard around it.

        Args:
            function: of the part.
            take: is given its answer and its arguments, and returns what is to be taken for the answer; raises
                `MisfitError` where that is not what the protocol says.
        """
        if not self.who:
            return function

        def call(*given: Any, **named: Any) -> Any:
            try:
                return take(function(*given, **named), *given, **named)
            except BaseException as error:
                if self._lets(error):
                    raise
                raise self._blame(error, function) from error

        return call

    def __enter__(self) -> None:
        """Enter; nothing is to be done."""

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        """Name the part in what it raised.

        Raises:
            PartError: in its place.
        """
        if self.who and error is not None and not self._lets(error):
            raise self._blame(error) from error

    def lacks(self, error: AttributeError) -> "LackingError":
        """The error of an attribute that is not there, named as all that the part raises."""
        blamed = self._blame(error)
        return LackingError(blamed.what, blamed.right)

    def _lets(self, error: BaseException) -> bool:
        return isinstance(error, (KeyboardInterrupt, PartError, *self.through))

    def _blame(self, error: BaseException, function: Callable[..., Any] | None = None) -> PartError:
        place = _authors_line(error.__traceback__) or _definition(function)
        return PartError(f"{self.who}: {said(error)}" + (f", {place}" if place else ""), "mend or remove it")


OWN_GUARD = Guard("")
"""Around parts of Surefoot: none."""


class LackingError(PartError, AttributeError):
    """A part has not got what was asked of it, which `hasattr` understands."""


class Guarded:
    """A part of others behind its guard: each attribute is looked up, and each method called, under it.

    Args:
        part: the part.
        guard: that names it.
        take: by the names of methods, what is taken for their answers; see `Guard.function`.
    """

    def __init__(self, part: Any, guard: Guard, take: Mapping[str, Callable[..., Any]] | None = None) -> None:
        self._part, self._guard, self._take = part, guard, take or {}

    def __getattr__(self, name: str) -> Any:
        """An attribute of the part."""
        if name.startswith("_"):
            raise AttributeError(name)
        with self._guard:
            try:
                found = getattr(self._part, name)
            except AttributeError as error:
                raise self._guard.lacks(error) from error
        return self._guard.function(found, self._take.get(name, _as_given)) if callable(found) else found


def taken_for(kind: type) -> Callable[..., Any]:
    """Classes that are taken for an answer that must be of a class; see `Guard.function`."""

    def take(answer: Any, *_: Any) -> Any:
        if not isinstance(answer, kind):
            raise MisfitError(f"gave {shown(answer)}, which is no {kind.__name__}")
        return answer

    return take


def _authors_line(trace: TracebackType | None) -> str:
    """File and line at which the part's author has something to look at; empty where no frame is of theirs.

    That is the innermost frame of the first package that is neither Surefoot's nor Python's own.
    """
    places = [
        (str(frame.f_globals.get("__name__", "")).partition(".")[0], f"{frame.f_code.co_filename}:{line}")
        for frame, line in walk_tb(trace)
    ]
    author = next((root for root, _ in places if root not in _NOT_AUTHORS), None)
    return next((place for root, place in reversed(places) if root == author), "")


_NOT_AUTHORS = {OWN_PACKAGE, *sys.stdlib_module_names}


def _definition(function: Callable[..., Any] | None) -> str:
    """File and line of a function, as far as they are known."""
    code = getattr(function, "__code__", None)
    return "" if code is None else f"{code.co_filename}:{code.co_firstlineno}"
