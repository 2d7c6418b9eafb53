"""What a log says about itself: verdict, health, topics and rates."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from scenarios.log import Log
from scenarios.verdict import Verdict, judge, scenario_of


@dataclass(frozen=True, slots=True)
class TopicRate:
    """How much of a topic there is.

    Attributes:
        topic: its name.
        messages: how many.
        rate: over the time of the log [Hz].
    """

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
        health: what is wrong with the log, in words.
        topics: what it holds.
        versions: that made it.
    """

    log: str
    scenario: str
    verdict: Verdict
    truncated: bool
    start: float
    end: float
    health: tuple[str, ...]
    topics: tuple[TopicRate, ...]
    versions: dict[str, str]

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object: the verdict's names, and beside them those of this class."""
        rest = {name: value for name, value in asdict(self).items() if name != "verdict"}
        return {**self.verdict.to_json(), **rest}


def inspect(log: Log) -> Inspection:
    """Inspect a log, also a truncated one.

    Raises:
        LogError: it does not describe a run.
    """
    verdict = judge(log)
    log.verify()
    start, end = log.time_range()
    health = []
    if log.truncated:
        health.append(f"the file is truncated: it can be read up to {end:.3f} s, `surefoot recover` makes it whole")
    if "recovered" in log.metadata:
        health.append("recovered from a truncated or damaged log")
    span = max(end - start, 1e-9)
    topics = ((topic, log.count(topic)) for topic in log.topics)
    return Inspection(
        log=str(log.path),
        scenario=scenario_of(log).name,
        verdict=verdict,
        truncated=log.truncated,
        start=start,
        end=end,
        health=(*health, *dict.fromkeys(log.damage)),
        topics=tuple(TopicRate(topic, count, max(count - 1, 0) / span) for topic, count in topics),
        versions=dict(log.metadata.get("versions", {})),
    )


def topic_summary(log: Log, topic: str) -> dict[str, dict[str, Any]]:
    """Summarise every field of a topic: shape, count of values that are not finite, least, mean, greatest.

    Raises:
        LogError: there is no such topic, or its messages are not of a fixed layout.
    """
    channel = log[topic]
    summary: dict[str, dict[str, Any]] = {}
    for field in channel.fields:
        values = channel.field(field.name).astype(float)
        sound = values[np.isfinite(values)]
        spread = (float(sound.min()), float(sound.mean()), float(sound.max())) if sound.size else (None, None, None)
        summary[field.name] = {
            "shape": list(field.shape),
            "messages": len(values),
            "not_finite": int(values.size - sound.size),
            **dict(zip(("min", "mean", "max"), spread, strict=True)),
        }
    return summary
