"""From a log to a verdict: its metrics against the criteria of its scenario, and what to know beside it."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from surefoot.plugins import PluginError
from surefoot.scenarios import palette
from surefoot.scenarios.errors import LogError, Problem, nearest
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.plugged import unknown
from surefoot.scenarios.file.schema import Gait, Scenario, TerrainSettings
from surefoot.scenarios.file.translate import without
from surefoot.scenarios.judge.digest import Digest
from surefoot.scenarios.judge.metrics import known, measure
from surefoot.scenarios.judge.text import FIRST_METRICS, shown_unit, value_text
from surefoot.scenarios.log import Log
from surefoot.scenarios.record.provenance import END_RECORD, SCENARIO_FILE
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.gait import EQUAL_STEPS, commanded
from surefoot.scenarios.setup.terrain import KINDS

_NO_CONTACT = (
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("start", "angle_noise"),
    ("errors", "friction"),
    ("errors", "ground"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""

_POINT_ONLY = (("pendulum", "plant"), ("pendulum", "feedback"))
"""Keys of the pendulum alone."""


def asked(criteria: Mapping[str, Bound], fidelity: str) -> dict[str, Bound]:
    """The criteria on metrics that a fidelity has; the others are in the notes."""
    return {name: bound for name, bound in criteria.items() if not _bodiless(name, fidelity)}


def notes(scenario: Scenario, metrics: Mapping[str, Any]) -> tuple[str, ...]:
    """List them, one sentence each.

    Args:
        scenario: as run.
        metrics: of its log.
    """
    return (*_skipped(scenario), *_without_effect(scenario), *_cut_short(scenario), *_degraded(metrics))


def _bodiless(criterion: str, fidelity: str) -> bool:
    metric = known(criterion)
    return metric is not None and not metric.applies(fidelity)


def _skipped(scenario: Scenario) -> Iterator[str]:
    for name in scenario.criteria:
        if _bodiless(name, scenario.fidelity):
            yield f"criterion {name} is not asked: a pendulum has no such metric"


def _without_effect(scenario: Scenario) -> Iterator[str]:
    for name in EQUAL_STEPS if commanded(scenario.gait) else ():
        if getattr(scenario.gait, name) != Gait.model_fields[name].default:
            yield f"gait.{name} has no effect beside gait.{'velocity' if scenario.gait.velocity else 'footsteps'}"
    yield from _unshaped(scenario.terrain)
    point = scenario.fidelity == "pendulum"
    for group, name in _NO_CONTACT if point else _POINT_ONLY:
        settings = getattr(scenario, group)
        if getattr(settings, name) != type(settings).model_fields[name].default:
            yield f"{group}.{name} has no effect on a {'pendulum' if point else 'whole body'}"
    if point and scenario.wbc is not None:
        yield "wbc has no effect on a pendulum"


def _unshaped(terrain: TerrainSettings) -> Iterator[str]:
    try:
        shaping = ("kind", "friction", *KINDS[terrain.kind].keys)
    except PluginError:  # a package that is broken where the log is judged, which needs nothing of it
        return
    for name, field in TerrainSettings.model_fields.items():
        elsewhere = name not in shaping
        if elsewhere and getattr(terrain, name) != field.default:
            yield f"terrain.{name} has no effect on terrain.kind {terrain.kind}"


def _cut_short(scenario: Scenario) -> Iterator[str]:
    whole = Draft(scenario).gait_duration
    if scenario.duration is not None and scenario.duration < whole:
        yield f"duration {scenario.duration:g} s ends before the gait does, which takes {whole:g} s"


def _degraded(metrics: Mapping[str, Any]) -> Iterator[str]:
    softened = metrics.get("planner_infeasible_fraction")
    if softened:
        yield f"the planner's hard constraints had no solution in {100 * softened:.1f} % of the plans and were softened"
    failures, fallbacks = metrics.get("qp_failures"), metrics.get("wbc_fallbacks")
    if fallbacks:
        yield f"the whole-body QP had no solution at {fallbacks} ticks, which used the fallback torque"
    elif failures:
        yield f"the whole-body QP needed its second solver at {failures} ticks"


_ACCEPTED_ENDS = ("completed", "fall")


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a run met its criteria.

    Attributes:
        passed: all criteria met, and the run came to its end.
        reasons: why not, one sentence each.
        notes: what else is to be known, one sentence each; they do not bear on the verdict.
        metrics: values by name.
        criteria: that were asked, by metric.
    """

    passed: bool
    reasons: tuple[str, ...]
    notes: tuple[str, ...]
    metrics: Mapping[str, Any]
    criteria: Mapping[str, Bound]

    def __getitem__(self, name: str) -> Any:
        """A metric, or the part of one after a dot, such as ``planner_time.p99``.

        Raises:
            KeyError: there is no such metric.
        """
        metric, _, part = name.partition(".")
        try:
            value = self.metrics[metric]
            return value[part] if part and value is not None else value
        except (KeyError, TypeError):
            raise KeyError(f"no metric '{name}'; {nearest(metric, self.metrics)}") from None

    def __repr__(self) -> str:
        """Pass or fail, why, and the first metrics, a line each."""
        shown = [f"  {name} {text} {unit}".rstrip() for name, text, unit in self._first()]
        return "\n".join((f"verdict {self._word}", *(f"  - {reason}" for reason in self.reasons), *shown))

    def _repr_html_(self) -> str:
        """The same for a notebook."""
        color = palette.hexadecimal(palette.PASS if self.passed else palette.FAIL)
        reasons = "".join(f"<li>{escape(reason)}</li>" for reason in self.reasons)
        rows = "".join(f"<tr><td>{name}</td><td>{escape(text)} {unit}</td></tr>" for name, text, unit in self._first())
        head = f'<b style="color:{color}">verdict {self._word}</b>'
        return f"{head}<ul>{reasons}</ul><table>{rows}</table>"

    @property
    def _word(self) -> str:
        return "pass" if self.passed else "fail"

    def _first(self) -> list[tuple[str, str, str]]:
        """Name, value and unit of the metrics that are asked for first, as far as they have a value."""
        found = {name: self.metrics.get(name) for name in FIRST_METRICS}
        return [(name, value_text(name, value), shown_unit(name)) for name, value in found.items() if value is not None]

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object with the names of the public contract."""
        judgement = {"verdict": self._word, "reasons": list(self.reasons)}
        return {**judgement, "notes": list(self.notes), **self.metrics}

    def write(self, path: Path) -> None:
        """Write as a JSON file.

        Raises:
            LogError: it cannot be written.
        """
        try:
            path.write_text(json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n", encoding="utf-8")
        except OSError as error:
            path.unlink(missing_ok=True)
            raise LogError(f"{path}: cannot be written, {(error.strerror or str(error)).lower()}") from None


def judge(log: Log, gathered: Digest | None = None) -> Verdict:
    """Judge a run by its log alone.

    Args:
        log: the log.
        gathered: its digest, where it was gathered before.

    Raises:
        LogError: the log does not describe a run.
    """
    measured, (scenario, absent) = measure(gathered or log), _known_part(log)
    criteria = asked(scenario.criteria, scenario.fidelity)
    reasons = (*_unfinished(log), *map(str, absent), *missed(measured.values, criteria))
    said = (*notes(scenario, measured.values), *measured.notes)
    return Verdict(not reasons, reasons, said, measured.values, criteria)


def scenario_of(log: Log) -> Scenario:
    """The scenario that a log carries, without the names that only packages know which are not installed here.

    Raises:
        LogError: it carries none that can be read.
    """
    return _known_part(log)[0]


def _known_part(log: Log) -> tuple[Scenario, list[Problem]]:
    """The scenario of a log, and which of its names nobody knows here."""
    try:
        keys = yaml.safe_load(log.attachments[SCENARIO_FILE])
        absent = unknown(keys)
        # Without its kind the other keys of the ground mean nothing.
        places = [replace(one, key=one.key[:1]) if one.key[0] == "terrain" else one for one in absent]
        return Scenario.model_validate(without(keys, places)), absent
    except (KeyError, ValidationError, yaml.YAMLError, ValueError, RecursionError):
        raise LogError(f"{log.path}: holds no readable scenario; its criteria are unknown") from None


def missed(metrics: Mapping[str, Any], criteria: Mapping[str, Bound]) -> list[str]:
    """Say which criteria are not met."""
    return [reason for name, bound in criteria.items() for reason in _missed(name, bound, metrics)]


def _missed(name: str, bound: Bound, metrics: Mapping[str, Any]) -> Iterator[str]:
    if name.partition(".")[0] not in metrics:
        yield f"{name} is not known here, so its bound cannot be checked; install the package that has this metric"
        return
    value = _lookup(metrics, name)
    if bound.equals is not None:
        expected = metrics.get(bound.equals, bound.equals) if isinstance(bound.equals, str) else bound.equals
        if value is None or value != expected:
            fall = f" at {metrics['fall_time']:.3f} s" if name == "fell" and value is True else ""
            yield f"{name} is {_text(value)}{fall}, must be {_text(expected)}"
    if bound.min is None and bound.max is None:
        return
    if value is None:
        yield f"{name} is not available, so its bound cannot be checked"
        return
    values = value if isinstance(value, list) else [value]
    for index, element in enumerate(values):
        label = name if len(values) == 1 else f"{name}[{index}]"
        low, high = (_element(limit, index) for limit in (bound.min, bound.max))
        if element is None:
            yield f"{label} is not a number"
        elif low is not None and element < low:
            yield f"{label} is {_text(element)}, bound is at least {_text(low)}"
        elif high is not None and element > high:
            yield f"{label} is {_text(element)}, bound is at most {_text(high)}"


def _unfinished(log: Log) -> list[str]:
    """Say why a run did not come to its end, if it did not."""
    end = log.metadata.get(END_RECORD)
    if end is None:
        last = log.time_range()[1]
        return [f"the run was cut off; its log ends at {last:.3f} s"]
    if end.get("kind") in _ACCEPTED_ENDS:
        return []
    return [f"the run ended at {end.get('time', '?')} s: {end.get('reason', 'unknown reason')}"]


def _lookup(metrics: Mapping[str, Any], name: str) -> Any:
    """A metric, or the part of one after a dot."""
    metric, _, part = name.partition(".")
    value = metrics.get(metric)
    return value.get(part) if part and isinstance(value, dict) else value


def _element(limit: float | tuple[float, ...] | None, index: int) -> float | None:
    if isinstance(limit, tuple):
        return limit[index] if index < len(limit) else None
    return limit


def _text(value: Any) -> str:
    if value is None:
        return "not available"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.4g}" if isinstance(value, float) else str(value)
