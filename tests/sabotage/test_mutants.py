"""Mutants of a module differ from it in one place, and tests that look at it find them."""

import pytest
from mutants import mutants

pytestmark = pytest.mark.unit

TEXT = "def clipped(x: int, low: float = 0.5) -> float:\n    return low if x < low and not False else -x + 2 * x\n"


def values(text):
    names = {}
    exec(text, names)
    return tuple(names["clipped"](x) for x in (-1.0, 0.5, 0.7, 3.0))


def test_every_operator_number_and_condition_is_hurt_once():
    found = list(mutants(TEXT))
    assert sorted((mutant.before, mutant.after) for mutant in found if len(mutant.before) < 12) == [
        ("-x", "+x"), ("-x + 2 * x", "-x - 2 * x"), ("0.5", "2.0"), ("2", "5"), ("2 * x", "2 / x"),
        ("False", "True"), ("x < low", "x <= low"),
    ]  # fmt: skip
    assert len(found) == 9  # the condition denied, and `and` made `or`
    assert len({mutant.text for mutant in found}) == 9


def test_mutants_give_other_values_unless_they_are_equivalent():
    alike = [mutant.after for mutant in mutants(TEXT) if values(mutant.text) == values(TEXT)]
    assert alike == ["x <= low"], "at x = low both branches give x"


def test_annotations_and_decorators_are_left_alone():
    assert not list(
        mutants('"""Words 1 < 2."""\nx: "int | None"\n\n\n@wrap(frozen=True)\ndef f(a: tuple[int, 3]) -> None: ...\n')
    )
