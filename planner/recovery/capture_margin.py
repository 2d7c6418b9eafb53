"""How far the DCM is inside what can still be captured: with every step as planned, and with steps moved.

It is the N-step capturability of Koolen et al. (International Journal of Robotics Research 2012) for a body in the
middle of a step, with feet of a size, what legs span and how hard they swing; each axis alone, so that all sets are
boxes. On one foot the DCM goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}. With k = e^{-ωT} of the shortest cycle
T, feet of half size a and steps that land near to far beside each other, who has just landed comes to rest over the
m-th foot from now exactly from

    side k (1 - (-k)^m) / (1 + k) (near + far) / 2 ± (a + k (1 - k^m) / (1 - k) (far - near) / 2),

seen from the foot that has landed, with side = 1 where the next one is a left one and -1 where it is a right one;
forward near = -far. Before that the present step lands, at the best of some times, with the best CoP until then.
"""

import math

import numpy as np

from surefoot.native.library import library
from surefoot.planner.model.dcm import nominal_dcm, viability_weights
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.compiled import CompiledMargins, CompiledOutlook
from surefoot.planner.recovery.step_adjustment import StepProblem
from surefoot.planner.references.window import Window
from surefoot.planner.swing.leg_reach import ANYWHERE, LegReach
from surefoot.planner.swing.quintics import PEAK
from surefoot.planner.types import Array


def _edges(low: Array, high: Array) -> Array:
    """Forward, left, backward and right edges of boxes, as distances in these directions, shape (..., 4) [m]."""
    return np.concatenate((high, -low), axis=-1)


def planned_margin(dcm: Array, window: Window, sample_time: float, foot_margin: float) -> float:
    """How far the DCM is inside what the CoP captures with the steps as planned: Σ w (p ± a) of all that is in sight.

    Args:
        dcm: now in the plan frame, shape (2,) [m].
        window: references.
        sample_time: theirs [s].
        foot_margin: share of the feet that the boxes of the reference take [-].
    """
    weights, reference = viability_weights(window.stiffness, window.omega, sample_time), window.driving
    half = weights @ reference.half_size / foot_margin
    return float((half - np.abs(dcm - weights @ reference.point)).min())


class PlannedMargin:
    """`planned_margin` of the windows of a planner.

    Args:
        parameters: of the planner.

    Attributes:
        outlook: where kernels are told of windows; None without kernels.
    """

    def __init__(self, parameters: PlannerParameters) -> None:
        self._sample_time, self._foot_margin, kernels = parameters.sample_time, parameters.foot_margin, library()
        self.outlook = None if kernels is None else CompiledOutlook(kernels, parameters)

    def margin(self, dcm: Array, window: Window) -> float:
        """See `planned_margin`."""
        if self.outlook is None or self.outlook.count != len(window.stiffness):
            return planned_margin(dcm, window, self._sample_time, self._foot_margin)
        return self.outlook.margin(dcm, window, self._foot_margin)

    def nominal(self, window: Window) -> Array:
        """The DCM now that a window's ZMP keeps bounded, shape (2,) [m]."""
        if self.outlook is None or self.outlook.count != len(window.stiffness):
            nominal = nominal_dcm(window.stiffness, window.omega, window.driving.point, self._sample_time)
            return np.asarray(nominal[0])
        return self.outlook.nominal(window)


class CaptureMargin:
    """How far the DCM is inside what steps that are adjusted capture.

    Args:
        legs: what they can do.
        parameters: of the planner.
        half_size: half of the sole's length and width, shape (2,) [m].

    Attributes:
        cycle: shortest time from a landing to the next one, in which a foot is swung as far as legs reach [s].
        told: where kernels are told of steps; None of plain Python.
    """

    def __init__(self, legs: LegReach, parameters: PlannerParameters, half_size: Array) -> None:
        numbers = parameters.recovery
        near, far = np.array([-legs.stride, legs.near]), legs.allowed(1.0, ANYWHERE, False)[0, 1]
        swung = np.sqrt(PEAK * (far - near) / legs.acceleration * (0.5, 1.0)).max()
        self.cycle = numbers.least_double + max(numbers.least_single, parameters.touchdown_lead + float(swung))
        self._legs, self._timing, self._numbers = legs, parameters.step_adaptation.timing, numbers
        # Columns of four edges each.
        self._half = _edges(-half_size, half_size)[:, None]
        self._hip = _edges(*2 * (np.array([0.0, 0.5 * legs.hip_width]),))[:, None]
        self._apart = 0.5 * _edges(near - far, far - near)[:, None]
        self._middle = 0.5 * _edges(near + far, near + far)[:, None]
        kernels, edges = library(), (self._half, self._apart, self._middle)
        self._compiled = None if kernels is None else CompiledMargins(kernels, legs, parameters, self.cycle, edges)
        self.told = None if self._compiled is None else self._compiled.step

    def landed(self, growth: float, side: float, count: int) -> Array:
        """Edges of what one that has just landed captures, from its last foot, with 0, ... count - 1 steps more.

        Args:
            growth: e^{ωT} of a cycle [-].
            side: +1 where the next foot is a left one, -1 where it is a right one.
            count: of sets.

        Returns:
            Shape (4, count) [m].
        """
        k, steps = 1.0 / growth, np.arange(float(count))
        wide, off = k / (1.0 - k) * (1.0 - k**steps), side * k / (1.0 + k) * (1.0 - (-k) ** steps)
        return np.asarray(self._half + wide * self._apart + off * self._middle)

    def margins(
        self, com: Array, dcm: Array, omega: float, step: StepProblem, steps: int, fixed: bool = False
    ) -> Array:
        """How far the DCM is inside what is captured within 1, ... steps landings, shape (steps,) [m].

        The body rests over the last foot, after a single landing perhaps over its stance foot as well.

        Args:
            com: now, in the plan frame, shape (2,) [m].
            dcm: now, likewise.
            omega: of the DCM now [1/s].
            step: as scheduled.
            steps: how many there are, at least 1.
            fixed: the present step is not moved any more.
        """
        if self._compiled is not None and steps <= self._numbers.most_steps:
            return self._compiled.margins(com, dcm, omega, step, steps, fixed)
        half, here, com = self._half, _edges(dcm, dcm)[:, None], _edges(com, com)[:, None]
        doubles, singles = self._times(step, fixed)
        single = np.exp(omega * singles)
        # DCM and CoM at the landing are linear in the DCM here: away + growth here, com + by here.
        growth, away = single, (1.0 - single) * half
        com = com + 0.5 * (single - 1.0) * away
        if step.double:
            behind = step.swing[0]
            double, both = np.exp(omega * doubles), _edges(np.minimum(behind, 0.0), np.maximum(behind, 0.0))
            first, growth = half + both[:, None], double * single
            com = com + 0.5 * (double - 1.0) * ((single - 1.0) * away - (growth * single - 1.0) * first)
            away = away + single * (1.0 - double) * first
        com, shrunk = com / growth, 1.0 / growth
        cycle = min(self.cycle, step.cycle) if self._timing else step.cycle
        captured = self.landed(math.exp(omega * cycle), -step.place.foot.side, steps)[:, None]
        places, alone = self._places(step, singles, fixed), ((half - away) * shrunk - here)[:, :, None]
        ahead = (((places - away[:, :, None]) * shrunk[:, None]) - here[:, :, None])[..., None]
        ahead = ahead + (captured * shrunk[:, None])[:, :, None]
        if not fixed:
            spread = 2.0 / (growth + shrunk)
            under = com + step.place.foot.side * self._hip
            spanned = ((self._legs.radius + under - away) * spread - here)[..., None] + captured * spread[:, None]
            by = 2.0 / np.maximum(growth - shrunk, 1e-9)
            near = (places + (self._legs.radius - under)[:, :, None]) * by[:, None] - here[:, :, None]
            ahead = np.minimum(np.minimum(ahead, spanned[:, :, None]), near[..., None])
        ahead[..., 0] = np.maximum(ahead[..., 0], alone)
        return np.asarray(np.maximum.accumulate(ahead.min(axis=0).reshape(-1, steps).max(axis=0)))

    def _times(self, step: StepProblem, fixed: bool) -> tuple[Array, Array]:
        """Pairs of times of double and single support, the present one last, shape (n,) each [s]."""
        if fixed or not self._timing:
            return np.array([step.double]), np.array([step.single])
        numbers = self._numbers
        least, most = min(step.single, max(numbers.least_single, step.shortest)), step.single + numbers.longer
        singles = [least + share * (most - least) for share in numbers.margin_times] + [step.single]
        if not step.double:
            return np.zeros(len(singles)), np.array(singles)
        doubles = (min(step.double, numbers.least_double), step.double)
        return np.repeat(doubles, len(singles)), np.array(2 * singles)

    def _places(self, step: StepProblem, singles: Array, fixed: bool) -> Array:
        """Edges of where the step may land in times, shape (4, n, boxes) [m]."""
        if fixed:
            return _edges(step.nominal, step.nominal)[:, None, None]
        legs = self._legs.turned(step.place.yaw)
        boxes = legs.allowed(step.place.foot.side, step.face, step.crosses)
        swung = legs.edges(step.swing, step.nominal, singles)
        return np.minimum(_edges(boxes[:, 0], boxes[:, 1]).T[:, None], swung[..., None])
