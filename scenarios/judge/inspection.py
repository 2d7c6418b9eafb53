"""What a log says about itself: verdict, health, topics and rates."""

from dataclasses import asdict
from typing import Any

import numpy as np

from surefoot.scenarios.judge.finding import Finding
from surefoot.scenarios.judge.health import findings
from surefoot.scenarios.judge.metrics import digest
from surefoot.scenarios.judge.verdict import Verdict, judge, scenario_of
from surefoot.scenarios.log import ChannelData, Log
from surefoot.scenarios.log.reader import RECOVERED
from surefoot.values import dataclass


@dataclass(frozen=True, slots=True)
class TopicRate:
    """How many messages there are of a topic, and how many over the time of the log [Hz]."""

    topic: str
    messages: int
    rate: float


@dataclass(frozen=True, slots=True)
class Inspection:
    """What was found in a log.

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
        return {**self.verdict.to_json(), **rest}


def inspect(log: Log, strict: bool = False) -> Inspection:
    """Inspect a log, also a truncated one; ``strict`` as of `judge`.

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
    """What is wrong with the file itself."""
    causes = [*log.losses(), *(f"not proven to be whole: {absent}" for absent in log.unproven())]
    if RECOVERED in log.metadata:
        causes.insert(0, "recovered from a truncated or damaged log")
    if log.truncated:
        right = "`surefoot recover` makes it whole"
        causes.insert(0, f"the file is truncated: it can be read up to {end:.3f} s, {right}")
    if not causes:
        return [Finding("file", "ok", None, None)]
    return [Finding("file", "warning", end if log.truncated else None, None, cause) for cause in causes]


def topic_summary(channel: ChannelData) -> dict[str, dict[str, Any]]:
    """Summarise every field of a channel: what it is, how many values are not finite, least, mean and greatest."""
    summary: dict[str, dict[str, Any]] = {}
    for field in channel.fields:
        values = channel.field(field.name).astype(float)
        sound = values[np.isfinite(values)]
        spread = (float(sound.min()), float(sound.mean()), float(sound.max())) if sound.size else (None, None, None)
        summary[field.name] = {
            "shape": list(field.shape),
            "unit": field.unit,
            "frame": field.frame,
            "doc": field.doc,
            "messages": len(values),
            "not_finite": int(values.size - sound.size),
            **dict(zip(("min", "mean", "max"), spread, strict=True)),
        }
    return summary
