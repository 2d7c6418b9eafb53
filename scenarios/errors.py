"""Errors that a user can mend, and what is said about them."""

import difflib
from collections.abc import Callable, Iterable
from dataclasses import dataclass

Key = tuple[str | int, ...]
"""Path of a value in a scenario: keys and list indices."""


@dataclass(frozen=True, slots=True)
class Problem:
    """What is wrong with one value.

    Attributes:
        key: the value's path in the scenario.
        what: the fault.
        right: what would be right, or what says it: of thousands of problems only the first are told.
        at_key: whether the key is at fault rather than its value.
    """

    key: Key
    what: str
    right: str | Callable[[], str]
    at_key: bool = False

    def __str__(self) -> str:
        return f"{self.what}; {self.right if isinstance(self.right, str) else self.right()}"


LONGEST_SENTENCE = 2000
"""Characters of a problem that are told; names and values may be longer than anyone reads."""


class ScenarioError(Exception):
    """A scenario that cannot be run.

    Attributes:
        problems: one sentence each, with its place: ``file:line:column: what; what would be right``; what a terminal
            would obey or not show is escaped.
    """

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = tuple(map(_readable, problems))
        super().__init__("\n".join(self.problems))


class SetupError(Exception):
    """A scenario that passed every check, but that a part of the stack refuses.

    Attributes:
        problem: which key is at fault, () when no single one is, what is wrong and what would be right.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__(str(problem))


class LogError(Exception):
    """A log that cannot be written or read; the message says what, where and what would be right."""


def _readable(problem: str) -> str:
    if len(problem) > LONGEST_SENTENCE:
        problem = f"{problem[: LONGEST_SENTENCE // 2]} ... {problem[-LONGEST_SENTENCE // 2 :]}"
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in problem)


def nearest(name: str, valid: Iterable[str]) -> str:
    """Say which of the valid names was meant, or list them."""
    names = sorted(valid)
    close = difflib.get_close_matches(name[:100], names, n=1, cutoff=0.6)
    return f"did you mean '{close[0]}'?" if close else f"valid are {', '.join(names)}"


def dotted(key: Key) -> str:
    """Spell a path as it is written in ``--set``."""
    return ".".join(str(part) for part in key)
