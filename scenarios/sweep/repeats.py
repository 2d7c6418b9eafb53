"""Runs of several seeds in which nothing is random: they are the same run, and one fact."""

import json
from collections.abc import Sequence
from typing import Any

from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.sweep.points import Point, Record

Runs = Sequence[tuple[Point, Record]]
"""Runs with what became of each."""


def facts(runs: Runs) -> Runs:
    """Runs without those that were judged and repeat one before them: alike but for the seed, and in every metric.

    Times on the wall's clock, which no two runs share, do not count.
    """
    found: dict[Any, tuple[Point, Record]] = {}
    for point, record in runs:
        alone = point.id if record.status in ("refused", "broken") else ""
        settings = [(key, value) for key, value in point.settings.items() if key != "seed"]
        measured = {name: value for name, value in record.metrics.items() if _is_repeatable(name)}
        same = json.dumps([settings, record.status, measured], sort_keys=True, default=str)
        found.setdefault((point.base.written, alone, same), (point, record))
    return list(found.values())


def _is_repeatable(name: str) -> bool:
    metric = known(name)
    return metric is None or metric.repeatable
