"""A check as one JSON object: what a program reads, a history keeps and CI stores."""

import math
from collections.abc import Sequence
from typing import Any

from surefoot.scenarios.check.baseline import Move
from surefoot.scenarios.check.check import Checked, exit_code
from surefoot.scenarios.check.signs import Parting
from surefoot.scenarios.output import shown
from surefoot.scenarios.record.provenance import versions

FORMAT = 1
"""Version of the object; it grows when a field goes or changes its meaning, and not when one comes."""


def to_json(found: Sequence[Checked]) -> dict[str, Any]:
    """All of a check: what ran it, what came of it, and an object for each scenario in their order."""
    return {
        "format": FORMAT,
        "versions": dict(versions()),
        "passed": all(one.passed for one in found),
        "exit_code": exit_code(found),
        "took": math.fsum(one.took for one in found),
        "scenarios": [scenario_json(one) for one in found],
    }


def scenario_json(one: Checked) -> dict[str, Any]:
    """One scenario of a check; values in SI units."""
    return {
        "scenario": one.case.scenario.name,
        "reference": shown(one.case.reference),
        "baseline": shown(one.case.baseline),
        "settings": one.case.settings,
        "status": one.status,
        "passed": one.passed,
        "reasons": list(one.reasons),
        "moves": [_move(move) for move in one.moves],
        "partings": [_parting(parting) for parting in one.partings],
        "metrics": dict(one.metrics),
        "log": None if one.log is None else shown(one.log),
        "took": one.took,
    }


def _move(move: Move) -> dict[str, Any]:
    told = {"metric": move.name, "before": move.before, "now": move.now, "allowed": move.allowed, "unit": move.unit}
    return {**told, "direction": move.direction, "far": move.far}


def _parting(parting: Parting) -> dict[str, Any]:
    """A parting; what is infinite, since a stage is missing or the last one, is null."""
    told = {"text": parting.text, "stage": parting.stage, "figure": parting.figure, "begin": parting.begin}
    return {**told, "end": _finite(parting.end), "excess": _finite(parting.excess)}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
