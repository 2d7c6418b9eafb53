"""The range of a criterion, for the checks and for editors, whose JSON Schema is made here.

Each must be able to fail, on a value that the run will have.
"""

from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

from surefoot.scenarios.errors import Problem, nearest
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import KIND_GROUPS, Scenario, own_models
from surefoot.scenarios.judge.metric import TRUTH, Metric
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.judge.names import METRICS
from surefoot.scenarios.judge.verdict import applies
from surefoot.scenarios.setup.robot.robots import Robots


def criteria_problems(criteria: Mapping[str, Bound], walker: str) -> list[Problem]:
    """List criteria that check nothing of a kind of walker, a fault each; names that are no metrics others tell."""
    found = [(name, bound, known(name)) for name, bound in criteria.items()]
    metrics = [metric for _, _, metric in found if metric is not None]
    problems = [
        problem for name, bound, metric in found if metric for problem in islice(_faults(name, bound, metric), 1)
    ]
    if walker == "seat":
        problems += _of_a_planner(criteria)
    elif metrics and not any(metric.applies(walker) for metric in metrics):
        what = f"none of these criteria can be measured on a {walker}, so nothing would be checked"
        problems.append(Problem(("criteria",), what, "use fidelity full, or bound a metric that it has"))
    return problems


def _of_a_planner(criteria: Mapping[str, Bound]) -> Iterator[Problem]:
    """Name criteria that no run of a controller without a planner can be held to."""
    for name, bound in criteria.items():
        if not applies(name, bound, "seat"):
            what = f"criteria.{name} is of a planner, and a controller has its seat"
            yield Problem(("criteria", name), what, "leave it out")


def comparable(name: str, metric: Metric[Any]) -> tuple[str, ...]:
    """Names of metrics that a metric, or its part, may be required to equal: of its kind, one of both always there."""
    if name != metric.name or metric.size > 1:
        return ()
    others = ((other, known(other)) for other in METRICS if other != name)
    return tuple(other for other, found in others if found is not None and _alike(metric, found))


def _alike(metric: Metric[Any], other: Metric[Any]) -> bool:
    kinds = [(one.unit, one.size, one.parts) for one in (metric, other)]
    same = metric.kind == other.kind or not (metric.kind and other.kind)
    return same and kinds[0] == kinds[1] and not (metric.optional and other.optional)


def _faults(name: str, bound: Bound, metric: Metric[Any]) -> Iterator[Problem]:
    sides = [(side, limit) for side, limit in (("min", bound.min), ("max", bound.max)) if limit is not None]
    if metric.kind == TRUTH and sides:
        what = f"criteria.{name} bounds what is true or false"
        yield Problem(("criteria", name), what, f"write '{name}: false' or '{name}: true'")
    if bound.equals is not None:
        yield from _unequal(name, bound.equals, metric)
    for side, limit in sides:
        if isinstance(limit, tuple) and len(limit) != metric.size:
            what = f"criteria.{name}.{side} has {len(limit)} elements"
            right = f"give one number, or {metric.size} of them" if metric.size > 1 else "give one number"
            yield Problem(("criteria", name, side), what, right)
    for low, high in zip(_each(bound.min, metric), _each(bound.max, metric), strict=True):
        if low is not None and high is not None and low > high:
            yield Problem(("criteria", name), f"criteria.{name}: min {low} exceeds max {high}", "swap them")
    yield from _met_by_all(name, bound, metric)


def _unequal(name: str, value: bool | float | str, metric: Metric[Any]) -> Iterator[Problem]:
    key = ("criteria", name)
    if metric.size > 1:
        yield Problem(key, f"criteria.{name} has {metric.size} elements, which equal no one value", "give min and max")
    elif isinstance(value, str):
        other = known(value)
        if value == name:
            yield Problem(key, f"criteria.{name} compares the metric with itself", "give another metric, or a bound")
        elif other is None or value != other.name or name != metric.name or not _alike(metric, other):
            names = comparable(name, metric)
            right = nearest(value, names) if names else "give a bound"
            right = right if metric.kind != TRUTH else f"write '{name}: false' or '{name}: true'"
            yield Problem(key, f"criteria.{name} cannot be compared with '{value}'", right)
    elif metric.kind and isinstance(value, bool) != (metric.kind == TRUTH):
        kind, right = (
            ("true or false", f"{name}: false") if metric.kind == TRUTH else ("a number", f"{name}: {{max: 1}}")
        )
        yield Problem(key, f"criteria.{name} is {kind}, never {_word(value)}", f"write for example '{right}'")


def _met_by_all(name: str, bound: Bound, metric: Metric[Any]) -> Iterator[Problem]:
    """Name a criterion that any value of the metric meets by its nature."""
    if bound.equals is not None:
        return
    low = all(
        limit is None or (metric.least is not None and limit <= metric.least) for limit in _each(bound.min, metric)
    )
    high = all(
        limit is None or (metric.most is not None and limit >= metric.most) for limit in _each(bound.max, metric)
    )
    if low and high:
        span = [f"at least {metric.least:g}"] if metric.least is not None else []
        span += [f"at most {metric.most:g}"] if metric.most is not None else []
        what = f"criteria.{name} checks nothing, since the metric is always {' and '.join(span)}"
        yield Problem(("criteria", name), what, "give a bound that a run can miss")


def _each(limit: float | tuple[float, ...] | None, metric: Metric[Any]) -> tuple[float | None, ...]:
    """A limit for each element of a metric."""
    if isinstance(limit, tuple):
        return limit if len(limit) == metric.size else (None,) * metric.size
    return (limit,) * metric.size


def _word(value: float) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:g}"


DIALECT = "https://json-schema.org/draft/2020-12/schema"

DESCRIPTION = (
    "A walk to simulate and the criteria it must meet. Bare numbers are in SI units and radians; where a key "
    "has a unit, a string such as '25 cm' may be given instead. `surefoot run` also refuses what a JSON Schema"
    " cannot tell: a number with a unit that is out of the range of its key; numbers under wbc that the "
    "controller refuses; terms of sensors beside the true state; rates that do not divide; pushes without a "
    "begin or with two, both by force and by impulse, in a step that is not walked, or on a body that the "
    "robot has not got; gaits and grounds that the legs cannot reach or stand on; criteria with min above max,"
    " that any run meets, or that the fidelity cannot measure; keys given twice; more than 20 levels or half a"
    " megabyte."
)


def published() -> dict[str, Any]:
    """The schema of what `surefoot run` accepts, with the names that installed packages bring."""
    schema = {"$schema": DIALECT, **Scenario.model_json_schema(), "description": DESCRIPTION}
    keys = schema["properties"]
    files = {"type": "string", "pattern": r"\.ya?ml$"}
    keys["robot"] = {**keys["robot"], "anyOf": [{"enum": list(Robots().names())}, files]}
    keys["robot"].pop("type")
    for group in KIND_GROUPS:
        properties = schema["$defs"][group.__name__]["properties"]
        for _, model in own_models(group):
            own = model.model_json_schema()
            for name, described in own["properties"].items():
                properties[name] = _either(properties.get(name, described), described)
            # A kind that comes leaves the order of what is there as it is.
            schema["$defs"] |= {name: one for name, one in own.get("$defs", {}).items() if name not in schema["$defs"]}
    bounds = {name: _criterion(name, metric) for metric in filter(None, map(known, METRICS)) for name in metric.bounded}
    keys["criteria"] |= {"properties": bounds, "additionalProperties": False}
    schema["$defs"].pop("Bound")
    return schema


def _either(known: Any, other: Any) -> Any:
    """The schema of what either of two allows, of kinds that have a key of one name; neither says of which it is."""
    if known == other:
        return known
    allowed = known["anyOf"] if known.keys() == {"anyOf", "description"} else [known]
    allowed = allowed if other in allowed else [*allowed, other]
    return {"anyOf": allowed, "description": "; ".join(dict.fromkeys(one["description"] for one in allowed))}


def _criterion(name: str, metric: Metric[Any]) -> dict[str, Any]:
    """The schema of the value behind a metric's name."""
    limit: dict[str, Any] = {"type": "number"}
    several = {"type": "array", "items": limit, "minItems": metric.size, "maxItems": metric.size}
    sides = {"anyOf": [limit, several]}
    bounds: dict[str, Any] = {
        "min": {**sides, "description": "least value allowed"},
        "max": {**sides, "description": "greatest value allowed"},
    }
    others, truth = comparable(name, metric), metric.kind == TRUTH
    equal: list[dict[str, Any]] = [{"enum": list(others)}] if others else []
    equal += [{"type": "boolean"}] if truth or not metric.kind else []
    equal += [] if truth else [limit]
    if metric.size == 1:
        bounds["equals"] = {"anyOf": equal, "description": "the value itself, or another metric's name"}
    if truth:
        bounds = {"equals": bounds["equals"]}
    group = {"type": "object", "properties": bounds, "additionalProperties": False, "minProperties": 1}
    unit = {"unit": metric.unit} if metric.unit else {}
    return {"anyOf": [group, *(equal if metric.size == 1 else [])], "description": metric.meaning, **unit}
