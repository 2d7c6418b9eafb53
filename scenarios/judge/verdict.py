"""From a log to a verdict: its metrics against the criteria of its scenario, and what to know beside it."""

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import islice
from pathlib import Path
from typing import Any

from surefoot.scenarios import palette
from surefoot.scenarios.errors import hinted_once, nearest
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.acted import bent_commands, contradictions, idle_commands, not_there, unmet_ground
from surefoot.scenarios.judge.digest import AbsentError, Digest, RunView, always
from surefoot.scenarios.judge.metrics import OWN, digest, known, measure
from surefoot.scenarios.judge.partial import is_measured, kept_note, unmeasured
from surefoot.scenarios.judge.pushed import unacted_pushes
from surefoot.scenarios.judge.scenario import known_part
from surefoot.scenarios.judge.walking import steps_added
from surefoot.scenarios.log import Log
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import END_RECORD, Agenda, Event

_SAME_TIME = 1e-8
"""Times of ticks are sums and carry rounding [s]."""

FIRST_METRICS = (
    "steps_taken",
    "zmp_inside_fraction",
    "cop_ratio_p99",
    "zmp_error_rms",
    "com_error_rms",
    "footstep_error_max",
    "foot_slip_max",
    "torque_ratio_max",
    "speed_mean",
    "real_time_factor",
)
"""The ten metrics that a walking engineer asks for first."""


def shown_unit(name: str) -> str:
    """Unit in which a metric, or the part of one after a dot, is shown."""
    metric = known(name)
    return metric.shown if metric else ""


def value_text(name: str, value: Any) -> str:
    """A metric's value in its shown unit."""
    if isinstance(value, list):
        return "  ".join(value_text(name, element) for element in value)
    if isinstance(value, Mapping):
        return "  ".join(f"{key} {value_text(name, element)}" for key, element in value.items())
    if value is None:
        return "-"
    scale = _scale(name)
    counted = isinstance(value, bool | str) or (isinstance(value, int) and scale == 1.0)
    return str(value).lower() if counted else _number(name, scale * value)


def bound_text(name: str, bound: Bound | None) -> str:
    """A criterion in its metric's shown unit; empty when there is none."""
    if bound is None:
        return ""
    parts = [] if bound.equals is None else [f"= {value_text(name, bound.equals)}"]
    for sign, limit in ((">=", bound.min), ("<=", bound.max)):
        if limit is not None:
            parts.append(f"{sign} {value_text(name, list(limit) if isinstance(limit, tuple) else limit)}")
    return ", ".join(parts)


def _scale(name: str) -> float:
    metric = known(name)
    return metric.scale if metric else 1.0


def _number(name: str, shown: float) -> str:
    """Three digits; the share of the time inside is rounded down, so that it shows 100 % only when it is."""
    if name == "zmp_inside_fraction":
        return f"{math.floor(shown * 100 + 1e-6) / 100:.6g}"
    return f"{shown:.0f}" if abs(shown) >= 1000 else f"{shown:.3g}"


_WALKERS = {"full": "a body", "pendulum": "a pendulum", "seat": "a controller without a planner"}
"""Kinds of walkers in words."""


def asked(criteria: Mapping[str, Bound], walker: str) -> dict[str, Bound]:
    """The criteria on metrics that a kind of walker has; the others are in the notes."""
    return {name: bound for name, bound in criteria.items() if applies(name, bound, walker)}


def applies(name: str, bound: Bound, walker: str) -> bool:
    """Return true if a kind of walker has the metric of a criterion, and that which it is compared with, if known."""
    others = (bound.equals,) if isinstance(bound.equals, str) else ()
    metrics = (known(one) for one in (name, *others))
    return all(metric is None or metric.applies(walker) for metric in metrics)


def _degraded(metrics: Mapping[str, Any], added: int) -> Iterator[str]:
    if added > 0:
        yield f"{added} step{'s were' if added > 1 else ' was'} added by a recovery"
    softened = metrics.get("planner_infeasible_fraction")
    if softened:
        yield f"the planner's hard constraints had no solution in {100 * softened:.1f} % of the plans and were softened"
    if missed := metrics.get("touchdowns_missed"):
        yield f"steps whose foot never touched the ground, so that they do not count: {missed}"
    failures, fallbacks = metrics.get("qp_failures"), metrics.get("wbc_fallbacks")
    if fallbacks:
        yield f"the whole-body QP had no solution at {fallbacks} ticks, which used the fallback torque"
    elif failures:
        yield f"the whole-body QP needed its second solver at {failures} ticks"


_FEW = 20
"""Reasons of one kind that are shown."""


def _few(reasons: Iterable[str]) -> Iterator[str]:
    """The first reasons of a kind, and how many more there are."""
    found = iter(reasons)
    yield from islice(found, _FEW)
    yield from _more(sum(1 for _ in found))


def _more(count: int) -> Iterator[str]:
    """A note that there are more reasons of a kind than those given, if there are."""
    if count > 0:
        yield f"and {count} more like these"


_LOSSES_SAID = 3
_ACCEPTED_ENDS = ("completed", "fall")


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a run by its criteria.

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
            LogError: it exists or cannot be written.
        """
        with write_whole(path) as temporary:
            temporary.write_text(json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n", encoding="utf-8")


def judge(log: Log, gathered: Digest | None = None, strict: bool = False) -> Verdict:
    """Judge a run by its log alone.

    Args:
        log: of the run.
        gathered: the digest of it that was gathered before, if there is one.
        strict: a log that cannot be proven to be whole fails for that; else a note says it.

    Raises:
        LogError: the log does not describe a run.
    """
    (scenario, absent), gathered = known_part(log), gathered or digest(log)
    measured = measure(gathered)
    criteria = asked(scenario.criteria, scenario.walker)
    run = RunView(gathered)
    size = run.constants.similarity
    without = [f"it has no topic {topic}" for topic in always(scenario.walker) if topic not in log]
    unproven = _listed("the log is not proven to be whole", (*log.unproven(), *without))
    untrue = (*_unfinished(log), *_incomplete(log), *(unproven if strict else ())) or contradictions(run)
    agenda = agenda_of(log, scenario)
    seen = run.kept is None
    idle = (
        *_unacted(log, agenda, run.constants.control_rate),
        *_few(unacted_pushes(run)),
        *idle_commands(run, scenario.commands),
        *(unmet_ground(run) if seen else ()),
        *(() if run.kept is None else unmeasured(run, run.kept, criteria, scenario, agenda)),
    )
    undone = (*idle, *not_there(measured.values, criteria, size.length))
    asked_here = {name: bound for name, bound in criteria.items() if seen or is_measured(name)}
    lacking = _lacking(run, [name for name in asked_here if _lookup(measured.values, name) is None])
    reasons = (*untrue, *lacking, *_few(map(str, hinted_once(absent))), *undone, *missed(measured.values, asked_here))
    skipped = [*(name for name in scenario.criteria if name not in criteria), *scenario.left_out]
    idle_keys = [note for note in agenda.notes if note not in agenda.standing or not run.has("/command")]
    unasked = (f"criterion {name} is not asked: {_WALKERS[scenario.walker]} has no such metric" for name in skipped)
    part = () if run.kept is None else (kept_note(run.kept),)
    beside = (*part, *(() if strict else unproven), *unasked, *idle_keys, *bent_commands(run))
    said = (*beside, *_degraded(measured.values, steps_added(run)), *measured.notes)
    return Verdict(not reasons, reasons, said, measured.values, criteria)


def _lacking(run: RunView, names: Sequence[str]) -> list[str]:
    """Report the topics that the log lacks, without which metrics of some names have no value."""
    found: list[str] = []
    for name in names:
        metric, own = known(name), OWN.get(name.partition(".")[0])
        found += [topic for topic in metric.needs if not run.has(topic)] if metric else []
        if own is not None and run.has(*own.needs):
            try:
                own(run)
            except AbsentError as absent:
                found.append(absent.topic)
            except Exception:  # its note tells that already
                continue
    topics = ", ".join(dict.fromkeys(found))
    return [f"the log has no messages of {topics}, which its verdict needs"] if topics else []


def missed(metrics: Mapping[str, Any], criteria: Mapping[str, Bound]) -> list[str]:
    """Report criteria that are not met; of those on metrics that are not known here no more than a few."""
    unknown = [name for name in criteria if name.partition(".")[0] not in metrics]
    beyond = set(unknown[_FEW:])
    named = (pair for pair in criteria.items() if pair[0] not in beyond)
    reasons = [reason for name, bound in named for reason in _missed(name, bound, metrics)]
    return [*reasons, *_more(len(beyond))]


def _missed(name: str, bound: Bound, metrics: Mapping[str, Any]) -> Iterator[str]:
    if name.partition(".")[0] not in metrics:
        yield f"{name} is not known here, so its bound cannot be checked; install the package that has this metric"
        return
    value = _lookup(metrics, name)
    if bound.equals is not None:
        expected = metrics.get(bound.equals, bound.equals) if isinstance(bound.equals, str) else bound.equals
        alike = isinstance(value, bool) == isinstance(expected, bool)  # 1 is not true
        if value is None or not alike or value != expected:
            fall = f" at {metrics['fall_time']:.3f} s" if name == "fell" and value is True else ""
            yield f"{name} is {_text(value)}{fall}, must be {_text(expected)}"
    if bound.min is None and bound.max is None:
        return
    if value is None:
        yield f"{name} is not available, so its bound cannot be checked"
        return
    values = value if isinstance(value, list) else [value]
    sizes = [len(limit) for limit in (bound.min, bound.max) if isinstance(limit, tuple)]
    if not values or any(size != len(values) for size in sizes):
        yield f"{name} has {len(values)} elements, and its bound {sizes[0] if sizes else 1}"
        return
    metric = known(name)
    unit = f" {metric.unit}" if metric and metric.unit else ""
    for index, element in enumerate(values):
        label = name if len(values) == 1 else f"{name}[{index}]"
        low, high = (_element(limit, index) for limit in (bound.min, bound.max))
        if element is None or isinstance(element, bool):
            yield f"{label} is not a number"
        elif low is not None and element < low:
            yield f"{label} is {_text(element)}{unit}, bound is at least {_text(low)}{unit}"
        elif high is not None and element > high:
            yield f"{label} is {_text(element)}{unit}, bound is at most {_text(high)}{unit}"


def _unfinished(log: Log) -> list[str]:
    """Report why a run did not come to its end, if it did not."""
    end = log.metadata.get(END_RECORD)
    if end is None:
        last = log.time_range()[1]
        return [f"the run was cut off; its log ends at {last:.3f} s"]
    if end.get("kind") in _ACCEPTED_ENDS:
        return []
    return [f"the run ended at {end.get('time', '?')} s: {end.get('reason', 'unknown reason')}"]


def agenda_of(log: Log, scenario: Scenario) -> Agenda:
    """The agenda of the run of a log; of one without it, as far as its scenario gives it.

    Raises:
        LogError: what the log tells of it cannot be read.
    """
    written = Agenda.from_metadata(log.metadata, str(log.path))
    if written is not None:
        return written
    pushes = [(f"pushes.{index}", push.time) for index, push in enumerate(scenario.pushes) if not push.live]
    events = [Event(f"{name} begins at", time) for name, time in pushes if time is not None]
    events += [Event(f"faults.{index} acts first at", fault.time) for index, fault in enumerate(scenario.faults)]
    unknown = [f"when {name} was to begin" for name, time in pushes if time is None]
    note = (
        f"its log, of an earlier version, does not tell {', nor '.join(['which of its keys have no effect', *unknown])}"
    )
    bodies = dict.fromkeys(push.body for push in scenario.pushes if push.body is not None)
    return Agenda(tuple(events), tuple(bodies), (note,))


def _unacted(log: Log, agenda: Agenda, rate: int) -> list[str]:
    """Report what was to happen after the run had ended, or does nothing; ``rate`` of the control ticks [Hz]."""
    broke_off = log.metadata.get(END_RECORD, {}).get("kind") not in _ACCEPTED_ENDS
    end = log.time_range()[1] + 1.0 / rate
    if broke_off:  # in the tick after the last of its log, in which a fault may have acted
        end += _SAME_TIME
    return [missed for event in agenda.events if (missed := event.missed(end))]


def _incomplete(log: Log) -> list[str]:
    """Report what of the log is missing, and what is damaged or contradicts the rest, if anything is."""
    return [*_listed("the log is incomplete", log.lacks()), *_listed("the log is damaged", log.faults())]


def _listed(what: str, found: Sequence[str]) -> list[str]:
    """One sentence with the first of what was found, none where there is nothing."""
    more = [f"and {len(found) - _LOSSES_SAID} more"] if len(found) > _LOSSES_SAID else []
    return [f"{what}: {'; '.join((*found[:_LOSSES_SAID], *more))}"] if found else []


def _lookup(metrics: Mapping[str, Any], name: str) -> Any:
    """A metric, or the part of one after a dot."""
    metric, _, part = name.partition(".")
    value = metrics.get(metric)
    return value.get(part) if part and isinstance(value, dict) else value


def _element(limit: float | tuple[float, ...] | None, index: int) -> float | None:
    return limit[index] if isinstance(limit, tuple) else limit


def _text(value: Any) -> str:
    if value is None:
        return "not available"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.4g}" if isinstance(value, float) else str(value)
