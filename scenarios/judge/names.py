"""The names of all metrics; those of this package, whose functions need numpy, are imported when one is asked for."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from surefoot.parts.plugins import Declared, Own

if TYPE_CHECKING:
    from surefoot.scenarios.judge.metric import Metric


@dataclass(frozen=True, slots=True)
class _Decorated:
    """A metric, whose decorator has made all that is known of it."""

    metric: "Metric[Any]"

    @property
    def said(self) -> str:
        """Its meaning, in one line."""
        return self.metric.meaning

    def load(self) -> "Metric[Any]":
        """The metric."""
        return self.metric


class _Gathered(Mapping[str, Own]):
    """The metrics of this package in their order; a function of a module is one by its decorator, on no other list."""

    def __getitem__(self, name: str) -> Own:
        return _Decorated(_own()[name])

    def __iter__(self) -> Iterator[str]:
        return iter(_own())

    def __len__(self) -> int:
        return len(_own())


def _own() -> "Mapping[str, Metric[Any]]":
    from surefoot.scenarios.judge.metrics import OWN

    return OWN


METRICS: "Declared[Metric[Any]]" = Declared("surefoot.metrics", "surefoot.scenarios.judge.metric:Metric", _Gathered())
"""All by name: ours, then those of other packages."""
