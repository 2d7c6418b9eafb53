"""What to know of a scenario that can be run: keys without effect, a run that ends before its gait."""

from collections.abc import Iterator

from surefoot.scenarios.file.schema import Gait, TerrainSettings
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.gait import EQUAL_STEPS

_NO_CONTACT = (
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("start", "angle_noise"),
    ("errors", "friction"),
    ("errors", "ground"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""

_POINT_ONLY = (("pendulum", "plant"), ("pendulum", "feedback"))
"""Keys of the pendulum alone."""


def notes(draft: Draft) -> tuple[str, ...]:
    """List them, one sentence each."""
    return (*_without_effect(draft), *_cut_short(draft))


def _without_effect(draft: Draft) -> Iterator[str]:
    keys = draft.keys
    for name in EQUAL_STEPS if draft.commanded else ():
        if getattr(keys.gait, name) != Gait.model_fields[name].default:
            yield f"gait.{name} has no effect beside gait.{'velocity' if keys.gait.velocity else 'footsteps'}"
    yield from _unshaped(draft)
    point = keys.fidelity == "pendulum"
    for group, name in _NO_CONTACT if point else _POINT_ONLY:
        settings = getattr(keys, group)
        if getattr(settings, name) != type(settings).model_fields[name].default:
            yield f"{group}.{name} has no effect on a {'pendulum' if point else 'whole body'}"
    if point and keys.wbc is not None:
        yield "wbc has no effect on a pendulum"


def _unshaped(draft: Draft) -> Iterator[str]:
    terrain = draft.keys.terrain
    for name, field in TerrainSettings.model_fields.items():
        elsewhere = name not in ("kind", "friction", *draft.kind.keys)
        if elsewhere and getattr(terrain, name) != field.default:
            yield f"terrain.{name} has no effect on terrain.kind {terrain.kind}"


def _cut_short(draft: Draft) -> Iterator[str]:
    duration = draft.keys.duration
    whole = draft.gait_duration
    if duration is not None and duration < whole:
        yield f"duration {duration:g} s ends before the gait does, which takes {whole:g} s"
