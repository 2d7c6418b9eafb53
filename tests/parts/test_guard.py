"""Around parts of others: whatever they raise is named with its author's line, and nothing else is touched."""

import pickle
import sys
from pathlib import Path

import pytest

from surefoot.errors import ParameterError, PartError
from surefoot.parts.guard import OWN_GUARD, Guard, Guarded, MisfitError, said, shown, taken_for

pytestmark = pytest.mark.unit

WHO = "task 'arm-up' of package hop"
GUARD = Guard(WHO)


class Own(BaseException):
    """An error of an author who derives from the root of all."""


class MuteError(Exception):
    """Cannot say what it is."""

    def __str__(self):
        sys.exit(0)


def bottomless():
    return bottomless()


def leave():
    sys.exit(0)


def divide():
    return 1 / 0


def given_up(error):
    raise error


def line_of(text):
    lines = Path(__file__).read_text(encoding="utf-8").splitlines()
    return f"{__file__}:{next(number for number, line in enumerate(lines, 1) if line.strip() == text)}"


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (SystemExit(0), "SystemExit: 0"),
        (SystemExit(), "SystemExit"),
        (GeneratorExit(), "GeneratorExit"),
        (Own("one\n two"), "Own: one two"),
        (MuteError(), "MuteError"),
        (ParameterError(("gain",), "gain is 0", "use more"), "ParameterError: gain is 0; use more"),
        (ValueError("x" * 1000), f"ValueError: {'x' * 300} ..."),
    ],
)
def test_whatever_is_raised_is_named_with_the_line_of_its_author(error, words):
    told = f"{WHO}: {words}, {line_of('raise error')}"
    with pytest.raises(PartError) as within, GUARD:
        given_up(error)
    with pytest.raises(PartError) as called:
        GUARD.function(given_up)(error)
    for caught in (within.value, called.value):
        assert (caught.what, caught.right) == (told, "mend or remove it")
        assert caught.__cause__ is error
        assert str(pickle.loads(pickle.dumps(caught))) == f"{told}; mend or remove it"


def test_a_part_without_a_bottom_is_named():
    with pytest.raises(PartError, match=r"RecursionError: maximum recursion depth exceeded.*, .*test_guard\.py:\d+;"):
        GUARD.function(bottomless)()


def test_the_authors_line_is_the_innermost_of_the_authors_own_package():
    """One part asks numpy and fails there, and one is called through Python's own library."""
    from functools import singledispatch

    import numpy as np

    dispatched = singledispatch(lambda matrix: np.linalg.inv(matrix))  # here
    with pytest.raises(PartError) as caught:
        GUARD.function(dispatched)(np.zeros((2, 2)))
    assert caught.value.what == f"{WHO}: LinAlgError: Singular matrix, {_here()}"


def _here():
    return line_of("dispatched = singledispatch(lambda matrix: np.linalg.inv(matrix))  # here")


def test_ctrl_c_goes_through_and_an_inner_name_stays():
    with pytest.raises(KeyboardInterrupt), GUARD:
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        GUARD.function(given_up)(KeyboardInterrupt())
    with pytest.raises(PartError, match=r"^law 'x'"), GUARD, Guard("law 'x'"):
        divide()


def test_while_it_is_made_it_may_refuse_what_it_is_made_of():
    with pytest.raises(ParameterError), GUARD.making:
        given_up(ParameterError(("gain",), "gain is 0", "use more"))
    with pytest.raises(PartError), GUARD.making:
        given_up(ValueError("no"))


def test_around_a_part_of_surefoot_there_is_nothing():
    assert OWN_GUARD.function(divide, taken_for(str)) is divide
    with pytest.raises(ZeroDivisionError), OWN_GUARD:
        divide()


def test_an_answer_of_another_kind_is_told_with_the_place_where_the_function_is_written():
    with pytest.raises(PartError) as caught:
        GUARD.function(lambda: 5, taken_for(str))()
    assert caught.value.what.startswith(f"{WHO}: gave 5, which is no str, {__file__}:")

    def take(answer, given):
        if answer != given:
            raise MisfitError(f"gave {answer} for {given}")
        return -answer

    assert GUARD.function(lambda given: given, take)(3) == -3
    with pytest.raises(PartError, match="gave 4 for 3"):
        GUARD.function(lambda given: given + 1, take)(3)


class Part:
    name = "hand"

    @property
    def size(self):
        leave()

    def write(self, rows):
        return rows / 0


def test_all_that_a_guarded_part_has_is_looked_up_and_called_under_its_guard():
    part = Guarded(Part(), GUARD, {"write": taken_for(int)})
    assert part.name == "hand"
    for ask in (lambda: part.size, lambda: part.write(1), lambda: part.absent):
        with pytest.raises(PartError, match=WHO):
            ask()
    with pytest.raises(AttributeError):
        _ = part.__deepcopy__


def test_what_cannot_be_shown_is_its_type():
    class Odd:
        def __repr__(self):
            leave()

    assert shown(Odd()) == "<Odd that cannot be shown>"
    assert shown(10**5000) == "<int that cannot be shown>"
    assert shown([1, 2]) == "[1, 2]"
    assert said(ValueError("a\n  b")) == "ValueError: a b"


def test_a_part_of_the_running_program_is_called_by_its_name():
    assert Guard.of_program("task", Part).who == "task 'Part' of this program"
    assert Guard.of_program("task", Part()).who == "task 'Part' of this program"


def test_who_asks_whether_a_part_has_something_is_told():
    part = Guarded(object(), GUARD)
    assert not hasattr(part, "control_tick")
    with pytest.raises(PartError, match=f"{WHO}: AttributeError: 'object' object has no attribute 'control_tick'"):
        _ = part.control_tick
