"""What `surefoot robot check` says, for a person and as JSON."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from surefoot.models.robot_file.build import Explanation
from surefoot.models.types import RobotDescription
from surefoot.scenarios.apps.robots.examine import PARITY, CatalogueRow, Examination, Watcher
from surefoot.scenarios.setup.stance import TorqueMargin
from surefoot.scenarios.show.console import TerminalLine, plain_table

_STYLES = {"walks": "bold green", "fails": "bold red", "refused": "yellow", "accepted": None}


def print_examination(console: Console, explained: Explanation, found: Examination) -> None:
    """Print what the robot is, what was derived and what was measured."""
    robot = explained.description
    table = plain_table("robot", robot.name)
    for name, value in _facts(robot):
        table.add_row(name, value)
    console.print(table)
    for title, lines in (
        ("derived", explained.derived),
        ("note", (*explained.notes, *found.notes)),
        ("fault", found.faults),
    ):
        for line in lines:
            console.print(f"{title}: {line}", style="bold red" if title == "fault" else None)
    table = plain_table("measured", "value")
    for name, value in _measured(found):
        table.add_row(name, value)
    console.print(table)


def _facts(robot: RobotDescription) -> Iterator[tuple[str, str]]:
    yield "mass", f"{robot.mass:.2f} kg"
    yield "joints", f"{len(robot.joint_names)}, {len(robot.roles.legs)} of them in the legs"
    for side, leg in (("left", robot.roles.left_leg), ("right", robot.roles.right_leg)):
        yield f"{side} leg", ", ".join(leg)
    yield "knees", ", ".join(robot.roles.knees)
    yield "waist", ", ".join(robot.roles.waist) or "none"
    yield "arm swing", ", ".join(robot.roles.arm_swing or ()) or "none"
    yield "pelvis, torso", f"{robot.pelvis_body}, {robot.torso_body}"
    yield "leg length, hip width", f"{robot.leg_length:.3f} m, {robot.hip_width:.3f} m"
    yield "soles", f"{robot.sole_length:.3f} x {robot.sole_width:.3f} m"
    yield "CoM height in walking", f"{robot.com_height:.3f} m"


def _measured(found: Examination) -> Iterator[tuple[str, str]]:
    yield "MuJoCo against Pinocchio", f"{found.parity:.1e}, at most {PARITY:.0e}"
    yield (
        "soles in the nominal posture",
        f"{1e3 * found.sole_height:.2f} mm apart in height, tilted by at most {_deg(found.sole_tilt)}",
    )
    yield "torque on both feet", _margin(found.both_feet)
    yield "torque on one foot", _margin(found.one_foot)
    yield "longest step with flat soles", f"{found.longest_step:.2f} m"
    yield "touching in the stance", ", ".join(" and ".join(pair) for pair in found.touching) or "none"


def _margin(margin: TorqueMargin) -> str:
    if not margin.joint:
        return "no such stance"
    return f"{margin.share:.0%} of its limit in '{margin.joint}', {margin.needed:.1f} N m"


def _deg(angle: float) -> str:
    return f"{math.degrees(angle):.3f} deg"


class CatalogueBar(TerminalLine, Watcher):
    """Prints each row as it is known, and on a terminal how much simulated time is left and how long that takes.

    Args:
        console: gets the rows; None where nobody is to see them.
        names: of the scenarios.
    """

    def __init__(self, console: Console | None, names: Sequence[str]) -> None:
        left = (TextColumn("left"), TimeRemainingColumn(elapsed_when_finished=True))
        super().__init__(TextColumn("{task.fields[state]}"), BarColumn(), TimeElapsedColumn(), *left)
        self._console, self._width = console, max(map(len, names))
        self._task = self._bar.add_task("", total=None, state=f"looking at {len(names)} scenarios")
        self._left = 0

    def begun(self, runs: int, duration: float) -> None:
        """See `Watcher`."""
        self._left = runs
        self._bar.update(self._task, total=duration, state=f"{runs} runs, {duration:.0f} s of simulated time")

    def done(self, row: CatalogueRow) -> None:
        """See `Watcher`."""
        if row.outcome in ("walks", "fails"):
            self._left -= 1
            self._bar.update(self._task, advance=row.duration, state=f"{self._left} runs left")
        if self._console is not None:
            with self.hidden():
                print_row(self._console, row, self._width)


def print_row(console: Console, row: CatalogueRow, width: int) -> None:
    """Print what became of a scenario."""
    console.print(f"{row.scenario:<{width}}  ", end="")
    console.print(row.outcome, style=_STYLES[row.outcome])
    for reason in row.why:
        console.print(f"  - {reason}")


def summary(rows: Sequence[CatalogueRow]) -> str:
    """All rows in a sentence."""
    counts = {
        outcome: sum(row.outcome == outcome for row in rows) for outcome in ("walks", "accepted", "fails", "refused")
    }
    told = ", ".join(f"{count} {outcome}" for outcome, count in counts.items() if count)
    return f"{len(rows)} scenarios: {told}"


def to_json(explained: Explanation, found: Examination, rows: Sequence[CatalogueRow]) -> dict[str, Any]:
    """Everything as one object; what could not be measured is null."""
    return {
        "robot": explained.description.name,
        "facts": dict(_facts(explained.description)),
        "derived": list(explained.derived),
        "notes": [*explained.notes, *found.notes],
        "faults": list(found.faults),
        "measured": _finite(asdict(found)),
        "scenarios": [
            {
                "scenario": row.scenario,
                "outcome": row.outcome,
                "why": list(row.why),
                "log": None if row.log is None else str(row.log),
            }
            for row in rows
        ],
    }


def _finite(value: Any) -> Any:
    """The same without numbers that JSON has not."""
    if isinstance(value, dict):
        return {name: _finite(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
