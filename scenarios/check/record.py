"""A check as one JSON object: what a program reads, a history keeps and CI stores."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from surefoot.scenarios.check.baseline import Move
from surefoot.scenarios.check.check import Checked, exit_code
from surefoot.scenarios.check.findings import Finding
from surefoot.scenarios.check.requirements import Requirements
from surefoot.scenarios.check.sampled import Sampled
from surefoot.scenarios.check.signs import Parting
from surefoot.scenarios.output import shown
from surefoot.scenarios.record.provenance import versions

FORMAT = 1
"""Version of the object; it grows when a field goes or changes its meaning, and not when one comes."""


def to_json(found: Sequence[Checked], requirements: Requirements) -> dict[str, Any]:
    """All of a check: what ran it, what came of it, and an object for each scenario in their order."""
    return {
        "format": FORMAT,
        "versions": dict(versions()),
        "passed": all(one.passed for one in found),
        "exit_code": exit_code(found),
        "took": math.fsum(one.took for one in found),
        "scenarios": [scenario_json(one) for one in found],
        "requirements": requirements.to_json(),
    }


def scenario_json(one: Checked) -> dict[str, Any]:
    """One scenario of a check; values in SI units."""
    return {
        "scenario": one.case.scenario.name,
        "reference": shown(one.case.reference),
        "baseline": shown(one.case.baseline),
        "settings": one.case.settings,
        "requirements": list(one.case.scenario.requirements or ()),
        "status": one.status,
        "passed": one.passed,
        "reasons": list(one.reasons),
        "moves": [_move(move) for move in one.moves],
        "partings": [_parting(parting) for parting in one.partings],
        "metrics": dict(one.metrics),
        "seeds": None if one.sampled is None else _seeds(one.sampled),
        "log": None if one.log is None else shown(one.log),
        "took": one.took,
        "beside": None if one.beside is None else asdict(one.beside),
    }


def _seeds(sampled: Sampled) -> dict[str, Any]:
    """Runs of several seeds: of each what it measured, the pass rate, and what is held against the baseline."""
    common = {"seeds": list(sampled.sample.seeds), "passed": list(sampled.sample.passed), "asked": sampled.asked}
    values = {name: list(column) for name, column in sampled.sample.values.items()}
    before = sampled.rate_before
    return {
        **common,
        "random": sampled.random,
        "rate": sampled.rate._asdict(),
        "rate_before": None if before is None else before._asdict(),
        "missed": {str(seed): reason for seed, reason in sampled.reasons.items()},
        "decided": sampled.decided,
        "findings": [_finding(one) for one in sampled.findings],
        "values": values,
    }


def _finding(one: Finding) -> dict[str, Any]:
    common = {"name": one.name, "verdict": one.verdict, "before": one.before, "now": one.now, "pairs": one.pairs}
    interval = {"difference": one.difference.value, "low": one.difference.low, "high": one.difference.high}
    return {**common, **interval, "allowed": one.margin, "deciding": one.deciding, "needs": one.needs}


def _move(move: Move) -> dict[str, Any]:
    common = {"metric": move.name, "before": move.before, "now": move.now, "allowed": move.allowed, "unit": move.unit}
    return {**common, "direction": move.direction, "far": move.far}


def _parting(parting: Parting) -> dict[str, Any]:
    """A parting; what is infinite, since a stage is missing or the last one, is null."""
    common = {"text": parting.text, "stage": parting.stage, "figure": parting.figure, "begin": parting.begin}
    return {**common, "end": _finite(parting.end), "excess": _finite(parting.excess)}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
