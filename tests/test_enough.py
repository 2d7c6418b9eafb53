"""Outcomes are counted until they decide, and no further."""

from itertools import count

import pytest
from enough import at_least

pytestmark = pytest.mark.unit


def test_so_many_are_true():
    assert at_least(2, (True, False, True))
    assert at_least(0, ())


def test_fewer_are_true():
    assert not at_least(2, (True, False, False))
    assert not at_least(1, ())


def test_none_is_looked_at_that_comes_after_those_that_decide():
    numbers = count()
    assert at_least(3, (number % 2 for number in numbers))
    assert next(numbers) == 6
