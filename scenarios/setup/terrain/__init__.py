"""The kinds of terrain that a scenario may name: what their keys mean, and what makes them impossible."""

from collections.abc import Callable, Iterable
from typing import Any, cast

from surefoot.parts.guard import Guarded, taken_for
from surefoot.parts.plugins import Registry
from surefoot.planner.ground.terrain import Terrain
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.registries import TERRAIN_KINDS
from surefoot.scenarios.setup.terrain.ground import Ground, TerrainKind

KINDS: Registry[TerrainKind] = TERRAIN_KINDS
"""Every kind of terrain by its name: ours, and those of other packages (see `surefoot.parts.plugins`)."""

__all__ = ["KINDS", "Ground", "TerrainKind", "kind_of"]


def kind_of(name: str) -> TerrainKind:
    """The kind of terrain of a name, behind its guard where another package brings it.

    Raises:
        KeyError: there is none.
        PluginError: its package cannot be used; so say all that it has, wherever it fails.
    """
    kind = KINDS[name]
    guard = KINDS.guard(name)
    return cast("TerrainKind", Guarded(kind, guard.making, _TAKEN)) if guard.who else kind


def _problems(answer: Iterable[Problem], *_: Any) -> list[Problem]:
    return [taken_for(Problem)(problem) for problem in answer]


_TAKEN: dict[str, Callable[..., Any]] = {
    "build": taken_for(Terrain),
    "completed": taken_for(Gait),
    "start_height": lambda height, *_: float(height),
    "problems": _problems,
}
