"""The JSON Schema of scenario files, for editors: the keys with what is known only where all rooms are known."""

from typing import Any

from surefoot.scenarios.errors import Key
from surefoot.scenarios.file.group import loadable
from surefoot.scenarios.file.schema import Scenario, TerrainSettings, model_of
from surefoot.scenarios.judge.metric import TRUTH, Metric
from surefoot.scenarios.judge.metrics import METRICS, known
from surefoot.scenarios.setup.checks import AVAILABLE
from surefoot.scenarios.setup.criteria_checks import comparable
from surefoot.scenarios.setup.robot import RegisteredRobots
from surefoot.scenarios.setup.terrain import KINDS

DIALECT = "https://json-schema.org/draft/2020-12/schema"

DESCRIPTION = (
    "A walk to simulate and the criteria it must meet. Bare numbers are in SI units and radians; where a key "
    "has a unit, a string such as '25 cm' may be given instead. `surefoot run` also refuses what a JSON Schema "
    "cannot tell: a number with a unit that is out of the range of its key; numbers under wbc that the "
    "controller refuses; rates that do not divide; pushes without a begin or with two, both by force and by "
    "impulse, in a step that is not walked, or on a body that the robot has not got; gaits and grounds that the "
    "legs cannot reach or stand on; criteria with min above max, that any run meets, or that the fidelity cannot "
    "measure; keys given twice; more than 20 levels or half a megabyte."
)


def published() -> dict[str, Any]:
    """The schema of what `surefoot run` accepts, with the names that installed packages bring."""
    schema = {"$schema": DIALECT, **Scenario.model_json_schema(), "description": DESCRIPTION}
    keys = schema["properties"]
    files = {"type": "string", "pattern": r"\.ya?ml$"}
    keys["robot"] = {**keys["robot"], "anyOf": [{"enum": list(RegisteredRobots().names())}, files]}
    keys["robot"].pop("type")
    for key, values in AVAILABLE.items():
        _narrow(schema, key, list(values))
    ground = schema["$defs"]["TerrainSettings"]
    for kind in loadable(KINDS):
        own = model_of(TerrainSettings, {"kind": kind}).model_json_schema()
        ground["properties"] = own["properties"] | ground["properties"]
        schema["$defs"] = own.get("$defs", {}) | schema["$defs"]
    bounds = {name: _criterion(name, metric) for metric in filter(None, map(known, METRICS)) for name in metric.bounded}
    keys["criteria"] |= {"properties": bounds, "additionalProperties": False}
    schema["$defs"].pop("Bound")
    return schema


def _narrow(schema: dict[str, Any], key: Key, values: list[Any]) -> None:
    """Leave only some values of a key: of the others the format knows, and this version not."""
    *groups, name = map(str, key)
    properties = schema["properties"]
    for group in groups:
        properties = schema["$defs"][properties[group]["$ref"].rpartition("/")[2]]["properties"]
    described = {
        part: properties[name][part] for part in ("default", "description", "unit") if part in properties[name]
    }
    properties[name] = {"enum": values, **described}


def _criterion(name: str, metric: Metric[Any]) -> dict[str, Any]:
    """What may stand behind a metric's name."""
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
