"""Write the numbers of the worked example of docs/falling.md.

    python docs/falling.py

It runs the two walks of the page for real. Each number or table stands between `<!-- fall: name -->` and
`<!-- end -->`. `docs/images/make.py falling.png` draws the figure from the same walk.
"""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import surefoot
from surefoot.scenarios.judge import inspection
from surefoot.scenarios.judge.verdict import shown_unit, value_text
from surefoot.scenarios.log import Log
from surefoot.scenarios.record.foxglove.views import events

PAGE = Path(__file__).with_suffix(".md")
PUSH = {"step": 4, "phase": "single", "fraction": 0.5, "duration": 0.1, "impulse": 0.4}
TRUTH: dict[str, Any] = {"sensing.source": "truth", "pushes": [PUSH]}
SETTINGS = {"planner.step_adaptation": "none", **TRUTH}
"""Settings of the walk that falls; the other one is without the first of them."""

_PLACE = re.compile(r"(?s)(<!-- fall: ([\w-]+) -->).*?(<!-- end -->)")


@dataclass(frozen=True, slots=True)
class Pair:
    """The walk that falls, what is found in it, and the walk that goes on."""

    fell: Log
    found: inspection.Inspection
    walked: Log
    other: inspection.Inspection


def pair(folder: Path) -> Pair:
    """Run both walks."""
    walks = (surefoot.load("walk-level", settings) for settings in (SETTINGS, TRUTH))
    fell, walked = (surefoot.read(surefoot.run(walk, out=folder).log) for walk in walks)
    return Pair(fell, inspection.inspect(fell), walked, inspection.inspect(walked))


def numbers(found: Pair) -> dict[str, str]:
    """Values at each place, by name."""
    fell, verdict, plan = found.fell, found.found.verdict, found.fell["/plan"]
    said = list(events(fell))
    begin, end = (event.time for event in said if event.kind == "push")
    landed = next(event.time for event in said if event.kind == "touchdown" and event.time > end)
    known = next(event.time for event in said if event.kind == "falling")
    margin = plan.field("capture_margin")[:, 0]
    negative = float(plan.time[(plan.time > begin) & (margin < 0.0)][0])
    metrics = {"fall_warning", "capture_margin_min", "torque_ratio_max"}
    return {
        "reasons": str(len(verdict.reasons)),
        "reason": f"`{verdict.reasons[0].partition(',')[0]}`",
        "push": f"{begin:.3f} to {end:.3f} s",
        "landed": f"{landed:.2f} s",
        "clearance": f"{value_text('swing_clearance_min', verdict.metrics['swing_clearance_min'])} mm",
        "negative": f"{negative:.2f} s",
        "known": f"{known:.2f} s",
        "health": "\n".join(_health(found.found)),
        "margin": "\n".join(_margin(found, (begin + 0.03, end - 0.03, negative, known))),
        "compared": "\n".join(_compared(found, end + 0.05)),
        **{name: _with_unit(name, verdict.metrics[name]) for name in metrics},
    }


def _with_unit(name: str, value: Any) -> str:
    return f"{value_text(name, value)} {shown_unit(name)}"


def _health(found: inspection.Inspection) -> Iterator[str]:
    """Rows of the warnings that have a time, and of the fall."""
    rows = [(one.time, f"`{one.check}`", one.relation or "", one.found) for one in found.health if one.time is not None]
    fall = (found.verdict.metrics["fall_time"], "the verdict", "effect", "it fell")
    rows.insert(sum(row[0] <= fall[0] for row in rows), fall)
    yield from ("| from [s] | check | | finding |", "|---|---|---|---|")
    yield from (f"| {time:.3f} | {check} | {relation} | {what} |" for time, check, relation, what in rows)


def _at(log: Log, topic: str, field: str, time: float) -> Any:
    """A field of a topic at a time, or just before it [s]."""
    channel = log[topic]
    return channel.field(field)[np.searchsorted(channel.time, time + 1e-6) - 1]


def _margin(found: Pair, times: tuple[float, ...]) -> Iterator[str]:
    yield from ("| time | `capture_margin`, steps as planned | `falling` |", "|---|---|---|")
    for time in times:
        margin, falling = (_at(found.fell, "/plan", name, time) for name in ("capture_margin", "falling"))
        yield f"| {time:.2f} s | {1e3 * margin[0]:.0f} mm | {falling:.0f} |"


def _compared(found: Pair, time: float) -> Iterator[str]:
    """Rows of what the walk that goes on does otherwise."""
    yield from ("| | fell | walked |", "|---|---|---|")
    shift = [1e3 * _at(log, "/plan", "step_shift", time)[0] for log in (found.fell, found.walked)]
    yield f"| `step_shift` of the next landing at {time:.2f} s | {shift[0]:.0f} mm | {shift[1]:.0f} mm forward |"
    margin = [1e3 * _at(log, "/plan", "capture_margin", time)[1] for log in (found.fell, found.walked)]
    yield f"| `capture_margin`, steps moved, at {time:.2f} s | {margin[0]:.0f} mm | {margin[1]:.0f} mm |"
    landing = [log["/footstep"].field("actual")[PUSH["step"] - 1, 0] for log in (found.fell, found.walked)]
    yield f"| landing of step {PUSH['step']}, x | {landing[0]:.3f} m | {landing[1]:.3f} m |"
    taken = [one.verdict.metrics for one in (found.found, found.other)]
    cells = " | ".join(f"{metrics['steps_taken']} of {metrics['steps_planned']}" for metrics in taken)
    yield f"| `steps_taken` | {cells} |"


def updated(text: str, values: dict[str, str]) -> str:
    """The text of the page with its numbers written anew."""

    def written(place: re.Match[str]) -> str:
        text = values[place[2]]
        return f"{place[1]}\n{text}\n{place[3]}" if "\n" in text else f"{place[1]}{text}{place[3]}"

    return _PLACE.sub(written, text)


def main() -> None:
    """Update the page."""
    with tempfile.TemporaryDirectory() as folder:
        values = numbers(pair(Path(folder)))
    PAGE.write_text(updated(PAGE.read_text(encoding="utf-8"), values), encoding="utf-8")


if __name__ == "__main__":
    main()
