"""What compiled kernels of recovery are given: legs, the next step with the state to be captured, and the window."""

from typing import TYPE_CHECKING

import numpy as np

from surefoot.native.library import Bound, Library
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.window import Window
from surefoot.planner.swing.leg_reach import AROUND, AT_REST, DEARER, MOVING, LegReach
from surefoot.planner.types import Array

if TYPE_CHECKING:
    from surefoot.planner.recovery.step_adjustment import StepProblem


class CompiledStep:
    """Legs and the next step as kernels take them.

    Args:
        kernels: the library.
        legs: what they can do.

    Attributes:
        legs: as kernels take them.
        bound: the step, likewise.
    """

    def __init__(self, kernels: Library, legs: LegReach) -> None:
        self._legs = legs
        self.legs = kernels.fill(
            "Legs",
            radius=legs.radius,
            stride=legs.stride,
            hip_width=legs.hip_width,
            crosses=legs.across is not None,
            across=legs.across or 0.0,
            acceleration=np.array(legs.acceleration, dtype=np.float64),
            touchdown_lead=legs.parameters.touchdown_lead,
            sample_time=legs.parameters.sample_time,
            shares=len(DEARER),
            at_rest=AT_REST,
            moving=MOVING,
            around=AROUND,
            dearer=DEARER,
        )
        self.bound, self._numbers = kernels.buffer("Landing")
        self._told: tuple[StepProblem, Array, Array, float] | None = None

    def tell(self, com: Array, dcm: Array, omega: float, step: "StepProblem") -> None:
        """Let kernels count with a step and a state; arguments as of `CaptureMargin.margins`.

        What was told last is not told again.
        """
        told = self._told
        if told is not None and told[0] is step and told[1] is com and told[2] is dcm and told[3] == omega:
            return
        self._told = step, com, dcm, omega
        (x, y), (u, v), ((a, b), (c, d)) = com.tolist(), dcm.tolist(), step.swing.tolist()
        times = step.double, step.single, step.cycle, step.shortest
        now = x, y, u, v, omega, a, b, c, d, *times, step.crosses, step.last, step.adapted
        self._numbers[: len(now)] = now
        if told is None or told[0].place is not step.place or told[0].face is not step.face:
            legs, face = self._legs.turned(step.place.yaw), step.face.ravel().tolist()
            self._numbers[len(now) :] = *step.nominal.tolist(), step.place.foot.side, *face, legs.near, legs.clear


class CompiledOutlook:
    """A window as kernels take it.

    Args:
        kernels: the library.
        parameters: of the planner.

    Attributes:
        bound: the window.
        count: samples that it has.
    """

    def __init__(self, kernels: Library, parameters: PlannerParameters) -> None:
        self.count = n = parameters.horizon + parameters.preview + 1
        names = {"stiffness": (n,), "omega": (n,), "point": (n, 2), "gain": (n, 2), "half_size": (n, 2)}
        self._arrays = {name: np.zeros(shape) for name, shape in names.items()}
        self._nominal = np.zeros(2)
        made = {"decay": np.zeros(n), "nominal": self._nominal}
        self.bound: Bound = kernels.fill("Outlook", count=n, sample_time=parameters.sample_time, **made, **self._arrays)
        self._margin, self._decay, self._mean = (
            kernels.bind(f"outlook_{name}", self.bound) for name in ("margin", "decay", "nominal")
        )
        self._window: Window | None = None

    def margin(self, dcm: Array, window: Window, foot_margin: float) -> float:
        """See `planner.recovery.capture_margin.planned_margin`."""
        found: float = self._margin(*dcm.tolist(), foot_margin, self._tell(window))
        return found

    def nominal(self, window: Window) -> Array:
        """The DCM now that a window's ZMP keeps bounded, shape (2,) [m]."""
        self._mean(self._tell(window))
        found: Array = self._nominal.copy()
        return found

    def tell(self, window: Window) -> None:
        """Let kernels look at a window, which has as many samples."""
        if self._tell(window):
            self._decay()

    def _tell(self, window: Window) -> bool:
        """The same but for what decays; whether that is to be found anew."""
        if window is self._window:
            return False
        self._window, arrays, driving = window, self._arrays, window.driving
        arrays["stiffness"][...] = window.stiffness
        arrays["omega"][...] = window.omega
        arrays["point"][...] = driving.point
        arrays["gain"][...] = driving.gain
        arrays["half_size"][...] = driving.half_size
        return True


class CompiledMargins:
    """Kernel beside `CaptureMargin.margins`.

    Args:
        kernels: the library.
        legs: what they can do.
        parameters: of the planner.
        cycle: shortest time from a landing to the next one [s].
        edges: half of the sole, and what `CaptureMargin` has of distances apart and their middle, shape (4,) each [m].
    """

    def __init__(
        self,
        kernels: Library,
        legs: LegReach,
        parameters: PlannerParameters,
        cycle: float,
        edges: tuple[Array, Array, Array],
    ) -> None:
        numbers, (half, apart, middle) = parameters.recovery, edges
        self.step, self._margins = CompiledStep(kernels, legs), np.zeros(numbers.most_steps)
        self._run = kernels.bind(
            "capture_margins",
            legs=self.step.legs,
            step=self.step.bound,
            cycle=cycle,
            timing=parameters.step_adaptation.timing,
            half=half,
            apart=apart,
            middle=middle,
            time_count=len(numbers.margin_times),
            times=np.array(numbers.margin_times),
            least_double=numbers.least_double,
            least_single=numbers.least_single,
            longer=numbers.longer,
            captured=np.zeros((numbers.most_steps, 4)),
            margins=self._margins,
        )

    def margins(self, com: Array, dcm: Array, omega: float, step: "StepProblem", steps: int, fixed: bool) -> Array:
        """See `CaptureMargin.margins`, for no more steps than the planner counts with."""
        self.step.tell(com, dcm, omega, step)
        self._run(steps, fixed)
        return self._margins[:steps].copy()


class CompiledAdjustment:
    """Kernel beside `StepAdjustment.solve`.

    Args:
        kernels: the library.
        legs: what they can do.
        parameters: of the planner.
        outlook: where windows are told to kernels; None for a place of its own.
        step: where steps are told to them, likewise.
    """

    def __init__(
        self,
        kernels: Library,
        legs: LegReach,
        parameters: PlannerParameters,
        outlook: CompiledOutlook | None,
        step: CompiledStep | None,
    ) -> None:
        numbers = parameters.recovery
        self._step, self._outlook = step or CompiledStep(kernels, legs), outlook or CompiledOutlook(kernels, parameters)
        self._result, self.count = np.zeros(7), self._outlook.count
        names = (
            "shift_weight", "second_weight", "time_weight", "stretch_weight", "swing_weight", "cross_factor",
            "least_saving", "cop_share", "landing_share", "landing_spare", "tolerance", "unheld_share", "stand_share",
            "least_double", "least_single",
        )  # fmt: skip
        self._run = kernels.bind(
            "adjustment_solve",
            legs=self._step.legs,
            step=self._step.bound,
            ahead=self._outlook.bound,
            timing=parameters.step_adaptation.timing,
            authority=np.array(parameters.cop_authority, dtype=np.float64),
            change_count=len(numbers.time_changes),
            changes=np.array(numbers.time_changes),
            longest_cut=numbers.longest_cut,
            times=np.zeros((2, len(numbers.time_changes) + 1)),
            result=self._result,
            **{name: getattr(numbers, name) for name in names},
        )

    def solve(
        self, com: Array, dcm: Array, window: Window, step: "StepProblem", unsure: float
    ) -> tuple[float, Array, bool, float] | None:
        """See `StepAdjustment.solve`: time left, box, whether there is more to catch, and cost."""
        self._step.tell(com, dcm, float(window.omega[0]), step)
        self._outlook.tell(window)
        if not self._run(unsure):
            return None
        left, *box, more, cost = self._result.tolist()
        return left, np.array(box).reshape(2, 2), bool(more), cost
