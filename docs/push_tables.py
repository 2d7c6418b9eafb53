"""Tables of pushes that are survived: thresholds of searches, pushes that were drawn, and two walkers side by side."""

import math
import re
from collections.abc import Iterator, Sequence
from itertools import product
from statistics import fmean
from typing import Any

from measured import limit_of, rows, searches
from page_table import table

from surefoot.studies.campaigns.spec import text
from surefoot.studies.campaigns.thresholds import Found


def _shown(found: Found) -> str:
    """A threshold in two digits, with the sign of one beyond the range."""
    return {"below": "< ", "above": "≥ "}.get(found.threshold.side, "") + f"{found.shown:.2f}"


def push_table(name: str) -> str:
    """Thresholds of all adaptations in one cell, and the limit of the last, by phase and direction."""
    found, axes = searches(name)
    *_, columns, shades, groups = axes
    cells: dict[str, dict[Any, list[str]]] = {}
    for one in sorted(found, key=lambda one: shades.values.index(one.labels[shades.name])):
        limit = limit_of(name, one.labels) if one.labels[shades.name] == shades.values[-1] else None
        shown = _shown(one) + ("" if limit is None else f" ({limit:.2f})")
        cells.setdefault(text(one.labels[groups.name]), {}).setdefault(one.labels[columns.name], []).append(shown)
    lines = ([phase, *(", ".join(by[column]) for column in columns.values)] for phase, by in cells.items())
    return table(["N·s/kg", *map(text, columns.values)], lines)


def gains_table(name: str) -> str:
    """Table of the factors by which each adaptation raises the threshold of the one before it, by direction."""
    found, axes = searches(name)
    *_, columns, shades, groups = axes
    inside = {
        tuple(one.labels[axis.name] for axis in (columns, shades, groups)): one.shown for one in found if not one.beyond
    }
    lines = []
    for before, after in zip(shades.values, shades.values[1:], strict=False):
        cells = []
        for column in columns.values:
            pairs = [
                (inside.get((column, before, group)), inside.get((column, after, group))) for group in groups.values
            ]
            ratios = [b / a for a, b in pairs if a and b]
            cells.append(f"{min(ratios):.1f} to {max(ratios):.1f}" if ratios else "")
        lines.append([f"`{after}`", f"`{before}`", *cells])
    return table(["adaptation", "over", *columns.values], lines)


def search_table(name: str, head: str = "N·s/kg") -> str:
    """Thresholds of a search by two axes, the first down, the second across."""
    found, (down, across) = searches(name)
    shown = {(one.labels[down.name], one.labels[across.name]): _shown(one) for one in found}
    lines = [[str(row), *(shown[row, column] for column in across.values)] for row in down.values]
    return table([head, *across.values], lines)


def gaits_table(*names: str) -> str:
    """Thresholds of searches by direction and phase, of their gaits beside each other, and the mean of each gait.

    A cell that survives all of the range counts as its end.
    """
    by: dict[Any, dict[tuple[Any, ...], Found]] = {}
    for name in names:
        found, (gaits, *where) = searches(name)
        for one in found:
            place = tuple(one.labels[axis.name] for axis in where)
            by.setdefault(one.labels[gaits.name], {})[place] = one
    places = product(*(axis.values for axis in where))
    lines = [[*place, *(_shown(of[place]) for of in by.values())] for place in places]
    lines.append(["mean", "", *(f"{fmean(one.shown for one in of.values()):.2f}" for of in by.values())])
    return table(["N·s/kg", "phase", *map(text, by)], lines)


def rules_table() -> str:
    """Mean and least threshold over all directions and phases, with one rule left out at a time; the dearest first."""
    found, (rules, *_) = searches("rules")
    by = {one: [each.shown for each in found if each.labels[rules.name] == one] for one in rules.values}
    plain, *others = by
    order = [plain, *sorted(others, key=lambda one: fmean(by[one]))]
    lines = ([f"`{one.removeprefix('rule ')}`" if one.startswith("rule ") else one, f"{fmean(by[one]):.3f}",
              f"{min(by[one]):.3f}"] for one in map(str, order))  # fmt: skip
    return table(["left out", "mean, N·s/kg", "least, N·s/kg"], lines)


def numbers_table() -> str:
    """Table of the thresholds that a number of the recovery moves, halved and doubled."""
    found, (cases, numbers) = searches("recovery-numbers")
    shown = {(one.labels["case"], one.labels["number"]): _shown(one) for one in found}
    plain, *changed = numbers.values
    as_is = [shown[case, plain] for case in cases.values]
    lines, still = [["as they are", "", *as_is]], []
    for number in changed:
        name, _, change = number.partition(" ")
        cells = [shown[case, number] for case in cases.values]
        if cells == as_is:
            still.append(name)
        else:
            moved = ("-" if cell == plain else cell for cell, plain in zip(cells, as_is, strict=True))
            lines.append([f"`{name}`", change, *moved])
    none = ", ".join(f"`{name}`" for name in dict.fromkeys(still) if still.count(name) == 2)
    return table(["number", "changed", *cases.values], lines) + f"\n\nNo threshold is moved by {none}."


def random_table() -> str:
    """Table of how many of the pushes and punches that were drawn are survived, weak ones and strong ones."""
    lines = [
        ["humanoid100", "the truth", "torso", *_survived(rows("random-pushes"))],
        ["G1", "the truth", "torso", *_survived(rows("random-pushes-g1"))],
        ["G1", "`good` sensors", "torso", *_survived(rows("random-pushes-g1-good"))],
    ]
    punches = rows("random-punches")
    arms = [row for row in punches if re.search("shoulder|elbow|wrist", row["pushes.0.body"])]
    upward = [row for row in punches if float(row["pushes.0.elevation"]) >= math.pi / 4]
    by_link = {"any link": punches, "of these, arms": arms, "of these, upward by 45° or more": upward}
    lines += [["G1", "`good` sensors", link, *_survived(some)] for link, some in by_link.items()]
    return table(["robot", "walked from", "pushed", "below 0.5 N·s/kg", "0.5 N·s/kg or more"], lines)


def _survived(some: Sequence[dict[str, str]]) -> Iterator[str]:
    for strong in (False, True):
        runs = [row["status"] for row in some if (float(row["pushes.0.impulse"]) >= 0.5) is strong]
        yield f"{runs.count('pass')} of {len(runs)}"


def beside_table() -> str:
    """The largest push that each of two walkers survives, by direction and phase; the larger one bold."""
    found: dict[tuple[str, str], dict[str, float]] = {}
    for row in rows("ladder-beside"):
        found.setdefault((row["direction"], row["phase"]), {})[row["walker"]] = float(row["threshold [N·s/kg]"])
    phases = list(dict.fromkeys(phase for _, phase in found))
    names = list(dict.fromkeys(row["walker"] for row in rows("ladder-beside")))
    lines = []
    for direction in dict.fromkeys(direction for direction, _ in found):
        pairs = (found[direction, phase] for phase in phases)
        lines.append([direction, *(", ".join(_larger(pair, name) for name in names) for pair in pairs)])
    return table([f"{' and '.join(f'`{name}`' for name in names)} [N·s/kg]", *phases], lines)


def _larger(pair: dict[str, float], name: str) -> str:
    text = f"{pair[name]:.2f}"
    return f"**{text}**" if pair[name] == max(pair.values()) else text
