"""Errors that a user can mend, and what is said about them."""

import difflib
import importlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any

Key = tuple[str | int, ...]
"""Path of a value in a scenario: keys and list indices."""


@dataclass(frozen=True, slots=True)
class Problem:
    """The fault of one value.

    Attributes:
        key: the value's path in the scenario.
        what: the fault.
        right: what would be right, or what says it: of thousands of problems only the first are shown.
        at_key: whether the key is at fault rather than its value.
    """

    key: Key
    what: str
    right: str | Callable[[], str]
    at_key: bool = False

    def __str__(self) -> str:
        return f"{self.what}; {self._hint}"

    @property
    def _hint(self) -> str:
        return self.right if isinstance(self.right, str) else self.right()

    def __reduce__(self) -> tuple[type["Problem"], tuple[Key, str, str, bool]]:
        """Survive the way between processes, where what says what would be right may not be known."""
        return type(self), (self.key, self.what, self._hint, self.at_key)


LONGEST_HINT = 200
"""Characters of what would be right that are shown once only, where many problems have the same."""


def hinted_once(problems: Iterable[Problem]) -> Iterator[Problem]:
    """The problems; of those with the same long hint only the first has it."""
    hints: set[str] = set()
    for problem in problems:
        hint = problem._hint
        yield replace(problem, right="see the first of these" if hint in hints else hint)
        if len(hint) > LONGEST_HINT:
            hints.add(hint)


LONGEST_SENTENCE = 2000
"""Characters of a problem that are shown; names and values may be longer than anyone reads."""


class ScenarioError(Exception):
    """A scenario that cannot be run.

    Attributes:
        problems: one sentence each, with its place: ``file:line:column: what; what would be right``; what a terminal
            would obey or not show is escaped.
    """

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = tuple(map(_readable, problems))
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> tuple[type["ScenarioError"], tuple[tuple[str, ...]], dict[str, Any]]:
        """Survive the way between processes, sentences that were cut short already as they are."""
        return type(self), ((),), {"problems": self.problems, "args": self.args}


class SetupError(Exception):
    """A scenario that passed every check, but that a part of the stack refuses.

    Attributes:
        problem: which key is at fault, () when no single one is, what is wrong and what would be right.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__(str(problem))

    def __reduce__(self) -> tuple[type["SetupError"], tuple[Problem]]:
        """Survive the way between processes."""
        return type(self), (self.problem,)


class LogError(Exception):
    """A log that cannot be written or read; the message says what, where and what would be right."""


class LinkError(Exception):
    """A plant or a controller in another process that cannot be talked to; the message says what and what is right."""


class LinkClosedError(LinkError):
    """The other side has closed the connection; what it sent before may still be heard."""


def _readable(problem: str) -> str:
    if len(problem) > LONGEST_SENTENCE:
        problem = f"{problem[: LONGEST_SENTENCE // 2]} ... {problem[-LONGEST_SENTENCE // 2 :]}"
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in problem)


class MissingExtraError(LogError):
    """An output needs a package that is not installed; the message says how to install it."""


def require(module: str, extra: str, purpose: str, otherwise: str = "") -> ModuleType:
    """Import an optional package.

    Args:
        module: to import.
        extra: of the distribution that brings it.
        purpose: what needs it, for the message.
        otherwise: what one can do without it.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        from surefoot.version import install_command  # which imports what reads distributions

        right = f"install it with: {install_command(extra)}" + (f", or {otherwise}" if otherwise else "")
        raise MissingExtraError(f"{purpose} needs the package {module}; {right}") from None


def nearest(name: str, valid: Iterable[str]) -> str:
    """Name the valid one that was meant, or list them."""
    names = sorted(valid)
    close = difflib.get_close_matches(name[:100], names, n=1, cutoff=0.6)
    return f"did you mean '{close[0]}'?" if close else f"valid are {', '.join(names)}"


def dotted(key: Key) -> str:
    """Spell a path as it is written in ``--set``."""
    return ".".join(str(part) for part in key)
