"""Numbers that one may turn hold their range, in whichever group they are."""

import math
from dataclasses import dataclass, fields

import pytest

from surefoot.errors import ParameterError
from surefoot.planner.parameters import GroundSearch, PlannerParameters, RecoveryParameters
from surefoot.similarity import Similarity
from surefoot.tunable import Range, check, number, positive

pytestmark = pytest.mark.unit


@dataclass(frozen=True)
class Group:
    """One number of each kind."""

    share: float = number(0.5, "-", "share", most=1.0)
    time: float = positive(math.inf, "s", "time", endless=True)
    shift: float = number(0.0, "m", "shift", least=-math.inf)
    count: int = positive(3, "-", "count", most=10)
    pair: tuple[float, float] = number((1.0, 2.0), "m", "pair")
    several: tuple[float, ...] = number((1.0, 2.0), "m", "several")

    def __post_init__(self) -> None:
        check(self, "group")


@pytest.mark.parametrize(
    ("name", "good", "bad", "right"),
    [
        ("share", (0.0, 1.0, 1), (-0.1, 1.1, math.nan, math.inf, "1", True), "at least 0 and at most 1"),
        ("time", (1e-9, math.inf), (0.0, -math.inf, math.nan), "greater than 0"),
        ("shift", (-1e9, 0.0), (math.inf, -math.inf, math.nan), "finite"),
        ("count", (1, 10), (0, 11, 1.5, True), None),
        ("pair", ((0.0, 1.0),), (1.0, (1.0,), [1.0, 2.0], (1.0, -1.0)), None),
        ("several", ((), (1.0,), (1.0, 2.0, 3.0)), (1.0, (1.0, -1.0)), None),
    ],
)
def test_each_kind_takes_its_range_and_no_more(name, good, bad, right):
    for value in good:
        assert getattr(Group(**{name: value}), name) == value
    for value in bad:
        with pytest.raises(ParameterError, match=f"^group.{name} is ") as refused:
            Group(**{name: value})
        assert refused.value.key == ("group", name)
        if right is not None and isinstance(value, float):
            assert str(refused.value).endswith(f"it must be {right}")


def test_a_range_in_words():
    assert str(Range()) == "finite and at least 0"
    assert str(Range(most=2.0, positive=True)) == "greater than 0 and at most 2"
    assert str(Range(endless=True)) == "at least 0"


@pytest.mark.parametrize("group", [PlannerParameters(), RecoveryParameters(), GroundSearch()])
def test_every_number_of_the_planner_has_unit_meaning_and_range(group):
    for entry in fields(group):
        value = getattr(group, entry.name)
        if isinstance(value, float) or (isinstance(value, int) and not isinstance(value, bool)):
            assert {"unit", "doc", "range"} <= set(entry.metadata), entry.name
            with pytest.raises(ParameterError, match=entry.name):
                type(group)(**{entry.name: math.nan})


def test_what_is_the_same_for_all_sizes_is_not_scaled():
    scaled = Similarity(0.5, 0.3).scaled(RecoveryParameters())
    assert scaled.lifting == RecoveryParameters().lifting
    assert scaled.tolerance == pytest.approx(0.5 * RecoveryParameters().tolerance)
