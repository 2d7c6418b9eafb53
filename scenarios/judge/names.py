"""The names of all metrics; those of this package, whose functions need numpy, are imported when one is asked for."""

from typing import TYPE_CHECKING, Any

from surefoot.parts.plugins import Declared

if TYPE_CHECKING:
    from surefoot.scenarios.judge.metric import Metric

METRICS: "Declared[Metric[Any]]" = Declared("surefoot.metrics", None, "surefoot.scenarios.judge.metrics")
"""All by name: ours, then those of other packages."""
