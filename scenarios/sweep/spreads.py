"""How what was drawn, and what the criteria bound, spread over the runs of a campaign."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.sweep.figures import Spread, is_number, text, with_unit
from surefoot.scenarios.sweep.points import Point, Record
from surefoot.scenarios.sweep.repeats import Runs
from surefoot.scenarios.sweep.table import as_float


def drawn(key: str, choice: bool, judged: Runs) -> Spread:
    """What was drawn; of a choice by its words."""

    def values(run: tuple[Point, Record]) -> list[Any]:
        value = run[0].labels[key]
        return [text(value) if choice else value]

    return _spread(with_unit(key), judged, values)


def _spread(heading: str, judged: Runs, values: Any, bounds: Sequence[float] = ()) -> Spread:
    groups: dict[str, list[Any]] = {"pass": [], "fail": []}
    for run in judged:
        groups[run[1].status] += values(run)
    return Spread(heading, groups["pass"], groups["fail"], bounds)


def of_criteria(judged: Runs) -> Iterator[Spread]:
    """Every metric that a criterion bounds, in the unit that a person is shown."""
    for name, bounds in criteria(judged).items():
        metric = known(name)
        scale = metric.scale if metric else 1.0
        limits = {scale * one for bound in bounds for one in _numbers((bound.min, bound.max, bound.equals))}
        heading = f"{name} [{metric.shown}]" if metric and metric.shown else name

        def values(run: tuple[Point, Record], name: str = name, scale: float = scale) -> list[Any]:
            value = run[1].metrics.get(name)
            return [str(value).lower()] if isinstance(value, bool) else [scale * one for one in _numbers((value,))]

        spread = _spread(heading, judged, values, sorted(limits))
        if spread.passed or spread.failed:
            yield spread


def criteria(runs: Runs) -> dict[str, list[Bound]]:
    """Every bound on a metric in some runs; those of one scenario are asked once, and refused ones have none."""
    asked = {
        (point.base.reference, str([(k, v) for k, v in point.settings.items() if k.startswith("criteria")])): point
        for point, _ in runs
    }
    found: dict[str, list[Bound]] = {}
    for point in asked.values():
        try:
            for name, bound in read_scenario(*point.base.written, point.settings).criteria.items():
                found.setdefault(name, []).append(bound)
        except ScenarioError:
            continue
    return found


def _numbers(values: Iterable[Any]) -> list[float]:
    """Numbers among values and among the elements of lists of them."""
    found: list[float] = []
    for value in values:
        several = (
            value if isinstance(value, list | tuple) else list(value.values()) if isinstance(value, dict) else [value]
        )
        found += [as_float(one) for one in several if is_number(one)]
    return found
