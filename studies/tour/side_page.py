"""Walkers beside each other as a page: who wins where, the table of all numbers, and one figure of pushes."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Found = Mapping[str, Any]

CLOSE = 0.05
"""Share of the best within which others are as good [-]."""


def markdown(found: Found) -> str:
    """Tables of a result, and who is best in each line."""
    return "\n".join((*_table(found), "", *_pushes(found), "", *_winners(found))) + "\n"


def _table(found: Found) -> Iterator[str]:
    names = [row["row"] for row in found["rows"]]
    yield _line(("less is better", *(f"`{name}`" for name in names)))
    yield "|" + "---|" * (1 + len(names))
    for name, words in found["measures"].items():
        values = [row[name]["value"] for row in found["rows"]]
        best = _best(values, least=True)
        yield _line((words, *(_cell(value, number in best) for number, value in enumerate(values))))
    yield _line(("fell", *(f"{row['fell'][0]} of {row['fell'][1]}" for row in found["rows"])))


def _pushes(found: Found) -> Iterator[str]:
    names = [row["row"] for row in found["rows"]]
    yield _line(("largest push survived [N·s/kg]", *(f"`{name}`" for name in names)))
    yield "|" + "---|" * (1 + len(names))
    for number, (phase, direction) in enumerate(found["pushes"]):
        values = [row["thresholds"][number] for row in found["rows"]]
        best = _best(values, least=False)
        yield _line((f"{direction}, {phase}", *(_cell(value, at in best) for at, value in enumerate(values))))


def _winners(found: Found) -> Iterator[str]:
    yield "Best in so many lines, those within 5 % of the best among them:"
    yield ""
    rows = found["rows"]
    walking, pushed = [0] * len(rows), [0] * len(rows)
    for name in found["measures"]:
        for at in _best([row[name]["value"] for row in rows], least=True):
            walking[at] += 1
    for number in range(len(found["pushes"])):
        for at in _best([row["thresholds"][number] for row in rows], least=False):
            pushed[at] += 1
    for row, walks, pushes in zip(rows, walking, pushed, strict=True):
        of = f"{walks} of {len(found['measures'])} of walking, {pushes} of {len(found['pushes'])} pushes"
        yield f"- `{row['row']}`: {of}"


def _best(values: Sequence[float | None], least: bool) -> set[int]:
    """Values that are the best, or as good."""
    known = {at: value for at, value in enumerate(values) if value is not None}
    if not known:
        return set()
    best = min(known.values()) if least else max(known.values())
    share = 1.0 + CLOSE if least else 1.0 - CLOSE
    return {at for at, value in known.items() if (value <= best * share if least else value >= best * share)}


def _cell(value: float | None, best: bool) -> str:
    if value is None:
        return ""
    text = f"{value:.2g}" if abs(value) < 10.0 else f"{value:.0f}"
    return f"**{text}**" if best else text


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def figure(found: Found) -> "Figure":
    """The largest push survived by direction, a panel for each phase and a curve for each walker."""
    from matplotlib.projections.polar import PolarAxes

    from surefoot.scenarios.show.kit.figures import CYCLE, in_style, panels
    from surefoot.studies.tour.drill import DIRECTIONS, PHASES

    around = sorted((angle % math.tau, name) for name, angle in DIRECTIONS.items())
    with in_style():
        drawn, every = panels(len(PHASES), 2, 5.0, "polar")
        for axes, phase in zip(every, PHASES, strict=True):
            assert isinstance(axes, PolarAxes)
            for color, row in zip(CYCLE * len(found["rows"]), found["rows"], strict=False):
                known = {
                    direction: value
                    for (of, direction), value in zip(found["pushes"], row["thresholds"], strict=True)
                    if of == phase
                }
                radii = [math.nan if known.get(name) is None else known[name] for _, name in around]
                angles = [angle for angle, _ in around]
                axes.plot([*angles, angles[0]], [*radii, radii[0]], color=color, marker="o", label=row["row"])
            axes.set_title(f"{phase}\nlargest push survived [N·s/kg]", fontsize=9)
            axes.set_theta_zero_location("N")
            axes.set_xticks([angle for angle, _ in around], [name for _, name in around])
            axes.set_ylim(bottom=0.0)
            axes.set_rlabel_position(45)
        handles, labels = every[0].get_legend_handles_labels()
        drawn.legend(handles, labels, loc="outside lower center", ncols=6)
    return drawn
