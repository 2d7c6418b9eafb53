"""The inspection of a log: verdict, health, topics and rates."""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.judge.finding import Finding
from surefoot.scenarios.judge.health import findings
from surefoot.scenarios.judge.metrics import digest
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.judge.verdict import Verdict, judge
from surefoot.scenarios.log import ChannelData, FieldSpec, Log
from surefoot.scenarios.log.reader import RECOVERED


@dataclass(frozen=True, slots=True)
class TopicRate:
    """The number of messages of a topic, and their rate over the time of the log [Hz]."""

    topic: str
    messages: int
    rate: float


@dataclass(frozen=True, slots=True)
class Inspection:
    """The findings in a log.

    Attributes:
        log: its path.
        scenario: name of the scenario that was run.
        verdict: its verdict with all metrics.
        truncated: whether the end of the file is missing.
        start: first time [s].
        end: last time [s].
        health: what the checks of the run and of the file found.
        topics: what it holds.
        versions: that made it.
    """

    log: str
    scenario: str
    verdict: Verdict
    truncated: bool
    start: float
    end: float
    health: tuple[Finding, ...]
    topics: tuple[TopicRate, ...]
    versions: dict[str, str]

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object: the verdict's names, and beside them those of this class."""
        rest = {name: value for name, value in asdict(self).items() if name != "verdict"}
        return {**self.verdict.to_json(), **rest, "health": [one.to_json() for one in self.health]}


def inspect(log: Log, strict: bool = False) -> Inspection:
    """Inspect a log, also a truncated one; ``strict`` fails a log that cannot be proven to be whole.

    Raises:
        LogError: it does not describe a run.
    """
    gathered = digest(log)
    verdict = judge(log, gathered, strict)
    start, end = log.time_range()
    span = max(end - start, 1e-9)
    topics = ((topic, log.count(topic)) for topic in log.topics)
    return Inspection(
        log=str(log.path),
        scenario=scenario_of(log).name,
        verdict=verdict,
        truncated=log.truncated,
        start=start,
        end=end,
        health=(*_file_findings(log, end), *findings(gathered)),
        topics=tuple(TopicRate(topic, count, max(count - 1, 0) / span) for topic, count in topics),
        versions=dict(log.metadata.get("versions", {})),
    )


def _file_findings(log: Log, end: float) -> list[Finding]:
    """Faults of the file itself."""
    causes = [*log.losses(), *(f"not proven to be whole: {absent}" for absent in log.unproven())]
    if RECOVERED in log.metadata:
        causes.insert(0, "recovered from a truncated or damaged log")
    if log.truncated:
        right = "`surefoot recover` makes it whole"
        causes.insert(0, f"the file is truncated: it can be read up to {end:.3f} s, {right}")
    if not causes:
        return [Finding("file", "ok", None, None)]
    return [Finding("file", "warning", end if log.truncated else None, None, cause) for cause in causes]


def topic_summary(parts: Iterable[ChannelData]) -> dict[str, dict[str, Any]]:
    """Summarise every field of a channel that comes in parts, of which there is one at least.

    Returns:
        by field: what it is, how many values are not finite, least, mean and greatest.
    """
    spreads: dict[FieldSpec, _Spread] = {}
    for part in parts:
        for field in part.fields:
            spreads.setdefault(field, _Spread()).add(part.field(field.name))
    return {
        field.name: {
            "shape": list(field.shape),
            "unit": field.unit,
            "frame": field.frame,
            "doc": field.doc,
            **spread.to_json(),
        }
        for field, spread in spreads.items()
    }


class _Spread:
    """Number, least, mean and greatest of values that come in parts."""

    def __init__(self) -> None:
        self._messages = self._values = self._sound = 0
        self._least, self._greatest, self._sum = math.inf, -math.inf, 0.0

    def add(self, values: NDArray[Any]) -> None:
        """Values of more messages, shape (n, ...)."""
        sound = values[np.isfinite(values)].astype(float)
        self._messages, self._values = self._messages + len(values), self._values + values.size
        if sound.size:
            self._sound, self._sum = self._sound + sound.size, self._sum + float(sound.sum())
            self._least, self._greatest = min(self._least, sound.min()), max(self._greatest, sound.max())

    def to_json(self) -> dict[str, Any]:
        """The findings as an object for JSON."""
        statistics = (
            (float(self._least), self._sum / self._sound, float(self._greatest)) if self._sound else (None,) * 3
        )
        counts = {"messages": self._messages, "not_finite": self._values - self._sound}
        return {**counts, **dict(zip(("min", "mean", "max"), statistics, strict=True))}
