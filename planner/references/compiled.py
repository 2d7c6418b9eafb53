"""The compiled kernels of what a plan sees of the walk ahead, and where they write."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from surefoot.native.library import Bound, Library
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
from surefoot.planner.references.zmp_reference import Support, ZmpReference
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import GRAVITY, Array

if TYPE_CHECKING:
    from surefoot.planner.references.window import Sight


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
        self._made, self._course = np.zeros(1, self._layout), np.zeros(9)
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
            **{name: self._made[name][0] for name in self._layout.names or ()},
        )
        self._look, self._weigh, self.soonest_calm = (
            kernels.bind(name, self._bound) for name in ("preview_look", "preview_weigh", "preview_transition")
        )
        self._support: Support | None = None
        self._sight: Bound | None = None

    def sight(self, execution: Execution, support: Support, moved: Callable[[Execution, Array], Array]) -> "Sight":
        """See `ReferencePreview._sight`; the height that `moved` gets is where the kernels read it."""
        clock, steady = execution.clock, execution.clock.steady
        if support is not self._support:
            self._turn_to(execution, support)
        if not steady:
            self._course[:] = clock.begun, clock.elapsed, clock.length, *clock.coefficients
        self._look(steady, clock.now, self._smooth is not None)
        height = self._made["height"][0]
        if self._smooth is None:
            samples = self._samples(execution, self._copy())
            np.copyto(height, self._profile.height(self._gait, samples, support.heights)[:, 1:-1])
        found = moved(execution, height)
        if found is not height:
            np.copyto(height, found)
        self._weigh()
        made = self._copy()
        reference = ZmpReference(made["point"], made["gain"], made["half_size"], made["ground"])
        preview = HeightPreview(made["height"], made["stiffness"])
        samples, stiffness, load = self._samples(execution, made), made["softened"], made["load_left"]
        return samples, reference, preview, stiffness, made["omega"], load[: self._count]

    def _turn_to(self, execution: Execution, support: Support) -> None:
        """Look at other steps from now on."""
        schedule = execution.schedule
        table = schedule.phase_table
        self._sight = self._kernels.fill(
            "Sight",
            phases=len(table.phases),
            start=table.start,
            length=table.length,
            rest=table.rest,
            kind=table.kind,
            support=table.support,
            contacts=table.contacts.astype(np.int64),
            first=schedule.first_support,
            points=len(support.heights),
            table=support.table,
            heights=np.ascontiguousarray(support.heights),
            on_left=support.on_left,
        )
        self._bound.point(sight=self._sight)
        self._support = support

    def _copy(self) -> Any:
        """What the kernels have made, by name, in memory of its own."""
        return self._made.view(np.uint8).copy().view(self._layout).reshape(())

    def _samples(self, execution: Execution, made: Any) -> PhaseSamples:
        return PhaseSamples(
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
