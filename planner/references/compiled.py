"""The compiled kernels of what a plan sees of the walk ahead, and where they write."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from surefoot.native.library import Library
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import (
    CLIMB_SHARE,
    DESCENT_SHARE,
    HeightPreview,
    HeightProfile,
    Rise,
    SmoothHeight,
    preview_limits,
)
from surefoot.planner.references.height_transition import LOOKED_AT
from surefoot.planner.references.zmp_reference import Sole, Support, ZmpReference, hulls_of
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import GRAVITY, Array
from surefoot.polygon import FLAT, ROUNDING
from surefoot.values import maker

if TYPE_CHECKING:
    from surefoot.planner.references.window import Beyond, Sight


_some_samples, _a_reference, _a_height = maker(PhaseSamples), maker(ZmpReference), maker(HeightPreview)

_ROOM = 64
"""Phases, steps and support points for which there is memory from the start; a walk that sees more takes more [-]."""


class CompiledPreview:
    """Kernels beside the plain methods of a `ReferencePreview`.

    Args:
        kernels: the library.
        gait: the walk.
        profile: law of its CoM height; one that is none of this package's is asked in Python.
        parameters: of the planner.
        counts: samples of a window, and those that are looked at.
        softening: see `planner.references.leg_offset.softening`.
    """

    def __init__(
        self,
        kernels: Library,
        gait: GaitParameters,
        profile: HeightProfile,
        parameters: PlannerParameters,
        counts: tuple[int, int],
        softening: float,
    ) -> None:
        self._kernels, self._gait, self._profile = kernels, gait, profile
        self._count, reach = counts
        n, self._sample_time = reach + 2, parameters.sample_time
        shapes: dict[str, tuple[int, ...]] = {"contacts": (n, 2), "height": (3, reach), "omega": (self._count,)}
        shapes |= dict.fromkeys(("which", "kind", "index"), (n,))
        shapes |= dict.fromkeys(("clock", "rate", "bend", "elapsed", "length", "fraction", "fraction_rate"), (n,))
        shapes |= dict.fromkeys(("point", "gain", "half_size"), (reach, 2))
        shapes |= dict.fromkeys(("ground", "load_left", "stiffness", "softened"), (reach,))
        whole = ("which", "kind", "index", "contacts")
        self._layout = np.dtype([(k, np.int64 if k in whole else np.float64, shape) for k, shape in shapes.items()])
        self._memory, self._course = np.zeros(self._layout.itemsize, np.uint8), np.zeros(9)
        self._made, self._window = np.ndarray((), self._layout, self._memory), _window_of(self._layout, self._count)
        self._height = self._made["height"]
        # A subclass may have a height of its own.
        own = getattr(type(profile), "height", None) is SmoothHeight.height
        self._smooth = cast(SmoothHeight, profile) if own else None
        limit, least = preview_limits(profile, parameters.size.length)
        self._bound = kernels.fill(
            "Preview",
            sight=kernels.fill("Sight"),
            samples=n,
            counted=self._count,
            sample_time=self._sample_time,
            gravity=GRAVITY,
            standing=profile.standing(gait),
            apexes=np.array(self._smooth.apexes(gait) if self._smooth else (0.0, 0.0, 0.0)),
            early=self._smooth is not None and self._smooth.rise is Rise.SINGLE,
            early_shares=np.array([CLIMB_SHARE, DESCENT_SHARE]),
            least_pressing=limit,
            least_height=least,
            softening=softening,
            looked_at=len(LOOKED_AT),
            course=self._course,
            **{name: self._made[name] for name in self._layout.names or ()},
        )
        self._look, self._weigh, self.soonest_calm = (
            kernels.bind(name, self._bound) for name in ("preview_look", "preview_weigh", "preview_transition")
        )
        self._support: Support | None = None
        self._make_room(_ROOM)
        self.support_table, self.sole_hulls = CompiledTable(kernels).fill, CompiledHulls(kernels).find

    def sight(
        self, execution: Execution, support: Support, moved: Callable[[Execution, Array], Array | None]
    ) -> "Sight":
        """See `ReferencePreview._sight`; the height that `moved` gets is where the kernels read it."""
        clock, steady = execution.clock, execution.clock.steady
        if support is not self._support:
            self.turn_to(execution.schedule, support)
        if not steady:
            self._course[:] = clock.begun, clock.elapsed, clock.length, *clock.coefficients
        self._look(steady, clock.now, self._smooth is not None)
        if self._smooth is None:
            samples = self._beyond(execution, self._memory.copy())[0]
            self._height[...] = self._profile.height(self._gait, samples, support.heights)[:, 1:-1]
        found = moved(execution, self._height)
        if found is not None:
            self._height[...] = found
        if found is not None or self._smooth is None:
            self._weigh()
        memory = self._memory.copy()
        made, height = np.ndarray((), self._window, memory), np.ndarray((), self._layout, memory)["height"]
        reference = _a_reference(made["point"], made["gain"], made["half_size"], made["ground"])
        preview, contacts = _a_height(height[:, : self._count], made["stiffness"]), made["contacts"] != 0
        tell = partial(self._beyond, execution, memory)
        return reference, preview, made["softened"], made["omega"], made["load_left"], contacts, tell

    def _beyond(self, execution: Execution, memory: NDArray[Any]) -> "Beyond":
        """The walk at all samples that are looked at, which few plans need to know."""
        made = np.ndarray((), self._layout, memory)
        return self._samples(execution, made), made["point"], _a_height(made["height"], made["stiffness"])

    def turn_to(self, schedule: Schedule, support: Support) -> None:
        """Look at other steps from now on."""
        table = schedule.phase_table
        size = max(len(table.phases), len(support.heights))
        if size > self._room:
            self._make_room(2 * size)
        phases, points, struct = len(table.phases), len(support.heights), self._sight.struct
        struct.phases, struct.points, struct.first = phases, points, schedule.first_support
        for name in ("start", "length", "rest", "kind", "support", "contacts"):
            self._rows[name][:phases] = getattr(table, name)
        self._rows["values"][:points], self._rows["steps"][:points] = support.table
        self._rows["heights"][:points], self._rows["on_left"][:points] = support.heights, support.on_left
        self._support = support

    def _make_room(self, size: int) -> None:
        """Memory for so many phases and support points in sight."""
        shapes: dict[str, tuple[int, ...]] = dict.fromkeys(("kind", "support"), (size,)) | {"contacts": (size, 2)}
        self._rows: dict[str, NDArray[Any]] = {name: np.zeros(shape, np.int64) for name, shape in shapes.items()}
        self._rows |= {name: np.zeros(size) for name in ("start", "length", "rest", "heights", "on_left")}
        self._rows |= {name: np.zeros((size, 7)) for name in ("values", "steps")}
        self._room, self._sight = size, self._kernels.fill("Sight", phases=0, first=0, points=0, **self._rows)
        self._bound.point(sight=self._sight)

    def _samples(self, execution: Execution, made: Any) -> PhaseSamples:
        return _some_samples(
            phases=execution.schedule.phases,
            which=made["which"],
            kind=made["kind"],
            clock=made["clock"],
            rate=None if execution.clock.steady else (made["rate"], made["bend"]),
            elapsed=made["elapsed"],
            length=made["length"],
            index=made["index"],
            fraction=made["fraction"],
            fraction_rate=made["fraction_rate"],
            contacts=made["contacts"] != 0,
            sample_time=self._sample_time,
            first=execution.schedule.first_support,
        )


def _window_of(layout: np.dtype[Any], count: int) -> np.dtype[Any]:
    """The samples of the window in arrays of all that is looked at, of which the contacts have one before it."""
    names = "point", "gain", "half_size", "ground", "stiffness", "softened", "omega", "load_left", "contacts"
    kinds, fields = [layout[name] for name in names], dict(layout.fields or {})
    return np.dtype(
        {
            "names": names,
            "formats": [(kind.base, (count, *kind.shape[1:])) for kind in kinds],
            "offsets": [fields[name][1] + (name == "contacts") * 2 * layout[name].base.itemsize for name in names],
            "itemsize": layout.itemsize,
        }
    )


class CompiledTable:
    """Kernel beside `planner.references.zmp_reference.support_table`.

    Args:
        kernels: the library.
    """

    def __init__(self, kernels: Library) -> None:
        self._kernels = kernels
        self._make_room(_ROOM)

    def fill(
        self, schedule: Schedule, landed: int, free: tuple[bool, bool], half_size: Array, stay: bool = False
    ) -> Array:
        """See `support_table`."""
        steps, points = len(schedule.steps), len(schedule.supports)
        if max(steps, points) > len(self._yaws):
            self._make_room(2 * max(steps, points))
        struct = self._bound.struct
        struct.points, struct.stance, struct.stay = points, schedule.index(landed), stay
        self._free[:], self._half_size[:] = free, half_size
        self._positions[:steps], self._yaws[:steps] = schedule.positions, schedule.yaws
        self._supports[:points] = schedule.supports
        self._run()
        return self._table[:, :points].copy()

    def _make_room(self, size: int) -> None:
        """Memory for so many steps and support points."""
        self._free, self._half_size, self._positions = np.zeros(2), np.zeros(2), np.zeros((size, 3))
        self._yaws, self._supports, self._table = np.zeros(size), np.zeros((size, 2), np.int64), np.zeros((2, size, 7))
        self._bound = self._kernels.fill(
            "SupportTable",
            points=0,
            stance=0,
            stay=False,
            free=self._free,
            positions=self._positions,
            yaws=self._yaws,
            supports=self._supports,
            half_size=self._half_size,
            values=self._table[0],
            steps=self._table[1],
        )
        self._run = self._kernels.bind("support_table_fill", self._bound)


class CompiledHulls:
    """Kernel beside `planner.references.zmp_reference.hulls_of`.

    Args:
        kernels: the library.
    """

    def __init__(self, kernels: Library) -> None:
        self._corners, self._hulls, self._counts = np.zeros((2, 8, 2)), np.zeros((2, 8, 2)), np.zeros(2, np.int64)
        self._find = kernels.bind(
            "sole_hulls_find",
            flat=FLAT,
            rounding=ROUNDING,
            corners=self._corners,
            hulls=self._hulls,
            counts=self._counts,
        )

    def find(self, soles: tuple[Sole, ...]) -> tuple[Array, Array]:
        """See `hulls_of`; that of a single sole is its corners."""
        if len(soles) != 2:
            return hulls_of(soles)
        (one, other), corners = soles, self._corners
        corners[0, :4], corners[0, 4:], corners[1, :4], corners[1, 4:] = one.outer, other.outer, one.inner, other.inner
        self._find()
        (outer, inner), hulls = self._counts.tolist(), self._hulls.copy()
        return hulls[0, :outer], hulls[1, :inner]
