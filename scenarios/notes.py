"""What to know beside a verdict: criteria that could not be asked, keys without effect, fallbacks."""

from collections.abc import Iterator, Mapping
from typing import Any

from scenarios.file.commands import EQUAL_STEPS, commanded
from scenarios.file.criteria import BODY_METRICS, Bound
from scenarios.file.schema import Gait, Scenario, TerrainSettings
from scenarios.file.timeline import gait_duration

_NO_CONTACT = (
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("start", "angle_noise"),
    ("errors", "friction"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""

_SHAPED: Mapping[str, tuple[str, ...]] = {
    "flat": (),
    "stairs": ("riser", "tread", "count", "direction", "start", "landing", "height_noise"),
    "slope": ("angle", "start", "height_noise"),
    "blocks": ("riser", "angle", "tread", "height_noise"),
}
"""Keys that shape each kind of terrain; friction is of all."""

_POINT_ONLY = (("pendulum", "plant"), ("pendulum", "feedback"))
"""Keys of the pendulum alone."""


def asked(criteria: Mapping[str, Bound], fidelity: str) -> dict[str, Bound]:
    """The criteria on metrics that a fidelity has; the others are in the notes."""
    return {name: bound for name, bound in criteria.items() if not _bodiless(name, fidelity)}


def notes(scenario: Scenario, metrics: Mapping[str, Any]) -> tuple[str, ...]:
    """List them, one sentence each.

    Args:
        scenario: as run.
        metrics: of its log.
    """
    return (*_skipped(scenario), *_without_effect(scenario), *_cut_short(scenario), *_degraded(metrics))


def _bodiless(criterion: str, fidelity: str) -> bool:
    return fidelity == "pendulum" and criterion.partition(".")[0] in BODY_METRICS


def _skipped(scenario: Scenario) -> Iterator[str]:
    for name in scenario.criteria:
        if _bodiless(name, scenario.fidelity):
            yield f"criterion {name} is not asked: a pendulum has no such metric"


def _without_effect(scenario: Scenario) -> Iterator[str]:
    for name in EQUAL_STEPS if commanded(scenario.gait) else ():
        if getattr(scenario.gait, name) != Gait.model_fields[name].default:
            yield f"gait.{name} has no effect beside gait.{'velocity' if scenario.gait.velocity else 'footsteps'}"
    yield from _unshaped(scenario.terrain)
    point = scenario.fidelity == "pendulum"
    for group, name in _NO_CONTACT if point else _POINT_ONLY:
        settings = getattr(scenario, group)
        if getattr(settings, name) != type(settings).model_fields[name].default:
            yield f"{group}.{name} has no effect on a {'pendulum' if point else 'whole body'}"


def _unshaped(terrain: TerrainSettings) -> Iterator[str]:
    for name, field in TerrainSettings.model_fields.items():
        elsewhere = name not in ("kind", "friction", *_SHAPED[terrain.kind])
        if elsewhere and getattr(terrain, name) != field.default:
            yield f"terrain.{name} has no effect on terrain.kind {terrain.kind}"


def _cut_short(scenario: Scenario) -> Iterator[str]:
    whole = gait_duration(scenario.gait)
    if scenario.duration is not None and scenario.duration < whole:
        yield f"duration {scenario.duration:g} s ends before the gait does, which takes {whole:g} s"


def _degraded(metrics: Mapping[str, Any]) -> Iterator[str]:
    softened = metrics.get("planner_infeasible_fraction")
    if softened:
        yield f"the planner's hard constraints had no solution in {100 * softened:.1f} % of the plans and were softened"
    failures, fallbacks = metrics.get("qp_failures"), metrics.get("wbc_fallbacks")
    if fallbacks:
        yield f"the whole-body QP had no solution at {fallbacks} ticks, which used the fallback torque"
    elif failures:
        yield f"the whole-body QP needed its second solver at {failures} ticks"
