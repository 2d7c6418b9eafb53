"""Keys of the public contract that this version does not act on yet: they are refused, never ignored."""

from collections.abc import Iterator
from typing import Any

from scenarios.errors import Key, Problem, dotted
from scenarios.file.schema import Scenario, Sensing

_SENSED = ("zmp_noise", "com_noise")
"""Noises of what the planner measures; those of the whole-body controller's sensors need its estimator."""

_AVAILABLE: dict[Key, tuple[Any, ...]] = {
    ("fidelity",): ("full", "pendulum"),
    ("terrain", "kind"): ("flat", "stairs", "slope", "blocks"),
    ("planner", "step_adaptation"): ("none", "location"),
    **{("sensing", name): (field.default,) for name, field in Sensing.model_fields.items() if name not in _SENSED},
}

_PENDULUM_FAULTS = ("planner_freeze", "state_nan")


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
    return [*found, *_without_body(scenario)] if scenario.fidelity == "pendulum" else found


def _without_body(scenario: Scenario) -> Iterator[Problem]:
    """List what would test nothing on a pendulum."""
    for index, fault in enumerate(scenario.faults):
        if fault.kind not in _PENDULUM_FAULTS:
            what = f"fault {fault.kind!r} needs joints, which fidelity pendulum has not got"
            yield Problem(("faults", index, "kind"), what, f"use fidelity full, or {' or '.join(_PENDULUM_FAULTS)}")
    for index, push in enumerate(scenario.pushes):
        if push.force[2] != 0.0:
            what = "a vertical push on a pendulum, whose height is prescribed"
            yield Problem(("pushes", index, "force"), what, "use fidelity full, or [x, y, 0]")
