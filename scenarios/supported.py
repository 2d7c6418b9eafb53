"""Keys of the public contract that this version does not act on yet: they are refused, never ignored."""

from typing import Any

from scenarios.errors import Key, Problem, dotted
from scenarios.schema import BeliefErrors, Scenario, Sensing

_AVAILABLE: dict[Key, tuple[Any, ...]] = {
    ("fidelity",): ("full",),
    ("terrain", "kind"): ("flat",),
    ("planner", "profile"): ("default",),
    ("planner", "step_adaptation"): ("none", "location"),
    ("planner", "knee"): ("stretched",),
    **{("sensing", name): (field.default,) for name, field in Sensing.model_fields.items()},
    **{("errors", name): (field.default,) for name, field in BeliefErrors.model_fields.items()},
}


def unavailable(scenario: Scenario) -> list[Problem]:
    """List values that the contract allows and this version has not got."""
    found = []
    for key, values in _AVAILABLE.items():
        value: Any = scenario
        for part in key:
            value = getattr(value, str(part))
        if value not in values:
            what = f"{dotted(key)} {value!r} is not available in this version"
            found.append(Problem(key, what, f"available: {', '.join(str(v) for v in values)}"))
    return found
