"""Scenarios of the catalogue, hurt at random: what a hurried or hostile hand makes of a good file."""

import random
from typing import Any

import yaml

from surefoot.scenarios import catalogue
from surefoot.scenarios.file.schema import Scenario

GROUPS = [Scenario, *(type(value) for _, value in Scenario() if hasattr(type(value), "model_fields"))]
KEYS = sorted(
    {name for group in GROUPS for name in group.model_fields} | {"steps_taken", "cop_ratio_max", "wbc", "stepz"}
)
TEXTS = (
    "",
    "flat",
    "25 cm",
    "200 ms",
    "15 deg",
    "-3 furlongs",
    "1e3 N",
    "2026-11-21",
    "1:30",
    "no",
    "été ☃ \u202e",
    "a" * 5000,
)
NUMBERS = (0, 1, -1, 3.5, 0.02, 25, 700, 5.0, 1e-9, -1e9, 1e300, 2**31, 10**18, True, False, None)
ALIEN = (float("nan"), float("inf"), -float("inf"), 10**400)
"""Numbers that YAML has and JSON has not."""


def trial(seed: int, alien: bool = True) -> Any:
    """Plain values of a scenario of the catalogue with one to five wounds.

    Args:
        seed: of what is done to which.
        alien: whether numbers occur that JSON has not.
    """
    rng = random.Random(seed)
    value = yaml.safe_load(catalogue.text(rng.choice(catalogue.names()))[0])
    for _ in range(rng.randint(1, 5)):
        place = _place(rng, value)
        if place is not None:
            _wound(rng, *place, alien)
    return value


def text_of(seed: int) -> str:
    """The text of a trial, now and then hurt itself: lines given twice, signs that do not belong."""
    rng = random.Random(f"text {seed}")
    text = yaml.safe_dump(trial(seed), allow_unicode=True, sort_keys=False)
    lines = text.splitlines(keepends=True)
    if rng.random() < 0.3:
        lines.insert(rng.randrange(len(lines)), rng.choice(lines))
    if rng.random() < 0.2:
        at = rng.randrange(len(lines))
        sign = rng.choice(
            ["\t", "\0", "!!python/object:os.system ", "&a ", "*a", "<<: *a\n", "{", "]", "'", "\ufffe", "---\n"]
        )
        lines[at] = lines[at][: rng.randrange(len(lines[at]))] + sign + lines[at]
    return "".join(lines)


def _place(rng: random.Random, value: Any) -> tuple[Any, Any] | None:
    """A group or list inside the value, and a key or index of it."""
    found = []

    def walk(inside: Any) -> None:
        if isinstance(inside, dict | list):
            keys = list(inside) if isinstance(inside, dict) else range(len(inside))
            found.extend((inside, key) for key in keys)
            for key in keys:
                walk(inside[key])

    walk(value)
    return rng.choice(found) if found else None


def _wound(rng: random.Random, group: Any, key: Any, alien: bool) -> None:
    way = rng.choice(("drop", "rename", "add", "value", "value", "value", "nest", "swap"))
    if way == "drop":
        del group[key]
    elif way == "rename" and isinstance(group, dict):
        group[rng.choice(KEYS)] = group.pop(key)
    elif way == "add" and isinstance(group, dict):
        group[rng.choice(KEYS)] = _value(rng, alien)
    elif way == "nest":
        for _ in range(rng.choice((1, 2, 30))):
            group[key] = rng.choice(({"equals": group[key]}, [group[key]], {"max": group[key]}))
    elif way == "swap" and isinstance(group[key], int | float):
        group[key] = rng.choice((-1, 0.1, 10, 1000)) * group[key]
    else:
        group[key] = _value(rng, alien)


def _value(rng: random.Random, alien: bool) -> Any:
    choices = [
        rng.choice(TEXTS),
        rng.choice(NUMBERS),
        [],
        {},
        [rng.choice(NUMBERS)],
        {rng.choice(KEYS): rng.choice(NUMBERS)},
    ]
    return rng.choice([*choices, {"min": rng.choice(NUMBERS), "max": 3}, *((rng.choice(ALIEN),) if alien else ())])
