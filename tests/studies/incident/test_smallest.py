"""Delta debugging: what it leaves has the property, and loses it without any single member."""

import random

import pytest

from surefoot.studies.incident.smallest import smallest

pytestmark = pytest.mark.unit


def without_any(part, holds):
    return [holds(tuple(one for one in part if one != left)) for left in part]


@pytest.mark.parametrize("seed", range(40))
def test_what_is_left_is_needed_one_by_one(seed):
    rng = random.Random(seed)
    members = tuple(range(rng.randint(1, 12)))
    cores = [set(rng.sample(members, rng.randint(1, len(members)))) for _ in range(rng.randint(1, 3))]
    asked = []

    def holds(part):
        asked.append(part)
        return any(core <= set(part) for core in cores)

    left = smallest(members, holds, members[: rng.randint(0, len(members))])
    assert set(left) in cores
    assert not any(without_any(left, holds))
    assert list(left) == sorted(left)


@pytest.mark.parametrize("seed", range(20))
def test_that_holds_for_properties_that_come_and_go_too(seed):
    rng = random.Random(seed)
    members, luck = tuple(range(8)), {}

    def holds(part):
        whole = part == members
        return luck.setdefault(part, whole or rng.random() < 0.3)

    left = smallest(members, holds)
    assert holds(left)
    assert not any(without_any(left, holds)) or not left


def test_each_part_is_tried_once_and_a_good_guess_saves_runs():
    counts = []
    for guess in ((), (11, 30)):
        asked = []

        def holds(part, asked=asked):
            asked.append(part)
            return {11, 30} <= set(part)

        assert smallest(tuple(range(40)), holds, guess) == (11, 30)
        assert len(asked) == len(set(asked))
        counts.append(len(asked))
    assert counts[1] <= 4 < counts[0]


def test_what_needs_nothing_is_found_at_once():
    asked = []

    def always(part):
        asked.append(part)
        return True

    assert smallest((1, 2, 3), always) == ()
    assert asked == [()]
    assert smallest((), always) == ()
