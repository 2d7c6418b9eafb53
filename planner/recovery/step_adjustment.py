"""Step adjustment: when and where the next step lands so that a pushed body is captured, as one optimisation.

Variables: T_d, T_s, times left of double and single support [s]; δ, distance of the CoP from its nominal way [m];
p, place of the next footstep from its stance foot [m]; s, DCM that is left when the footstep after it lands, by which
that one is shifted, a distance forward and one sideways, neither negative [m]; σ, s as it is priced [m].

Minimise

    shift_weight |p - p̄|²  +  second_weight |σ|²  +  time_weight ((T_d - T̄_d)² + (T_s - T̄_s)²) / T²
        +  stretch_weight r²  +  swing_weight (|u|² + v²)

with the nominal p̄, T̄_d, T̄_s, the duration T of a step, and the slacks r, u, v of three constraints, subject to

- dcm: ξ' = ω (ξ - CoP) from the measured ξ until the landing, with ω constant; a step at p adds g (p - p̄) to the DCM
  that is to stay bounded from there on;
- cop: |δ| ≤ cop_share of the ZMP box, which in double support is that of both feet;
- reach: p in one of the boxes of `LegReach.allowed`, and within `radius` of its hip then; r is what the other hip is
  farther than `radius` from the stance foot;
- swing: p where the foot can be swung to until then (`LegReach.edges`), but for u; v is what it lacks of a way round
  the stance leg (`LegReach.shortfall`);
- second: on each axis s = e^{ωT} g |p* - p| less what the CoP holds until then, where p* leaves nothing, or 0;
- cross: σ is s, with its sideways part times cross_factor where that step would have to cross, whether it may or not;
- times: T_d = T̄_d or that and a member of time_changes, and T_s likewise, each with each. What is left of a support is
  not shortened below least_double or least_single, nor below what body and foot need to come to the footstep's height.
  Of a longer support, changes count from its least time plus the longest cut. T_d ≤ T̄_d where the step is adapted.

Solver: for given times p* follows in closed form, since the CoP does what it can; p is p* brought into the limits, the
boxes and the legs' reach in turn. So times and boxes are enumerated, all at once, and the cheapest is taken.
docs/recovery.md has every formula.
"""

import math
from functools import lru_cache

import numpy as np

from surefoot.native.library import library
from surefoot.planner.geometry import seen_from, wrap_angle
from surefoot.planner.model.dcm import decays, moving_cop, nominal_dcm, pendulum_com
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.compiled import CompiledAdjustment, CompiledOutlook, CompiledStep
from surefoot.planner.references.window import Window
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.step import Step, room_left, shortest_swing
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import Array, FeetState, Footstep, PhaseKind
from surefoot.values import dataclass, maker

_NO_GAIN = 1e-9
"""Gain of a step below which it counts as this: one that lands where the window ends does nothing to its DCM [-]."""


@dataclass(frozen=True, slots=True)
class StepProblem:
    """What is known of the step that lands next, in the plan frame: its origin is the stance foot of that step.

    Attributes:
        place: where it lands as the schedule has it, seen from its stance foot.
        swing: position and velocity of its foot, shape (2, 2) [m, m/s].
        double: time until that leaves the ground, zero when it has [s].
        single: time that it swings, or swings on [s].
        cycle: duration of the step after it [s].
        shortest: time left of its swing in which the body can be lifted or lowered with it [s].
        face: lower and upper corner of where it stays on its face, shape (2, 2) [m].
        crosses: whether it may land beyond its stance foot, as far as legs may at all.
        last: whether the robot stands after it.
        adapted: whether it is being adapted already.
    """

    place: Footstep
    swing: Array
    double: float
    single: float
    cycle: float
    shortest: float
    face: Array
    crosses: bool
    last: bool
    adapted: bool

    @property
    def nominal(self) -> Array:
        """Where it lands as the schedule has it, shape (2,) [m]."""
        return self.place.position[:2]

    @classmethod
    def of(cls, time: float, execution: Execution, feet: FeetState, frame: tuple[Array, Array]) -> "StepProblem | None":
        """That of a tick; None where no step is to come.

        Args:
            time: now [s].
            execution: the clock and the steps in sight.
            feet: the measured feet.
            frame: its stance foot's, the plan frame: rotation to the world, shape (2, 2), and origin, shape (2,) [m].
        """
        phase, (rotation, origin), v, w = execution.info, frame, 0.0, 0.0
        if not phase.leads_to:
            return None
        schedule, clock, landed = execution.schedule, execution.clock, execution.landed
        step = schedule.step(landed + 1)
        swings, foot = phase.kind is PhaseKind.SINGLE, step.place.foot
        yet = min(1.0, (step.touchdown - clock.now) / step.single)
        # In plain numbers: a product of small arrays takes longer than all of this.
        (a, b), (c, d) = rotation.tolist()
        (u, o), (x, y, _) = origin.tolist(), feet.position[foot].tolist()
        if execution.swing is not None:
            v, w, *_ = execution.swing.coefficients(time)[1].tolist()
        x, y = x - u, y - o
        hips = math.inf if execution.legs is None else execution.legs.acceleration[0]
        place, face, shortest, crosses = _known(step, schedule.step(landed), schedule.ground, hips)
        return _a_step(
            place=place,
            swing=np.array(((x * a + y * c, x * b + y * d), (v * a + w * c, v * b + w * d))),
            double=0.0 if swings else phase.left,
            single=phase.left if swings else step.single * clock.sample_time,
            cycle=schedule.gait.period,
            shortest=yet * shortest,
            face=face,
            crosses=crosses,
            last=execution.stops,
            adapted=execution.adapted,
        )


_a_step, _a_footstep = maker(StepProblem), maker(Footstep)


@lru_cache(maxsize=2)
def _known(step: Step, stance: Step, ground: Ground, hips: float) -> tuple[Footstep, Array, float, bool]:
    """What of a `StepProblem` is the same from plan to plan: place, face, its whole shortest swing, whether it crosses.

    The hips swing a foot with an acceleration, infinite for legs that nobody knows [m/s^2].
    """
    numbers = ground.parameters.recovery
    seen, turn = seen_from(stance.place, step.place), wrap_angle(step.place.yaw - stance.place.yaw)
    place = _a_footstep(seen.foot, seen.position, turn, seen.normal, seen.step, seen.touchdown_time)
    face = place.position[:2] + room_left(step, stance.place, numbers.parallel)
    shortest = 0.0 if hips == math.inf else shortest_swing(step, hips, numbers.lifting)
    return place, face, shortest, ground.terrain.footholds.crossed(step.lift)


@dataclass(frozen=True, slots=True)
class StepBounds:
    """The solution for the next step: a time, and a set of places, of which the law of motion takes one.

    `Recovery.bounds` makes bounds of shifts of it, which the `StepContext` of a law carries.

    Attributes:
        left: time until the present phase is to end [s].
        box: lower and upper corner of where it may land from its stance foot, shape (2, 2) [m].
        more: whether the step after it has something to catch, too.
        cost: of it [-].
    """

    left: float
    box: Array
    more: bool
    cost: float


class StepAdjustment:
    """The program of the module's head, for one robot.

    Args:
        legs: what they can do.
        parameters: of the planner.
        outlook: where kernels are told of windows, if others have it in common; one of its own by default.
        told: where they are told of steps of these legs, likewise.
    """

    def __init__(
        self,
        legs: LegReach,
        parameters: PlannerParameters,
        outlook: CompiledOutlook | None = None,
        told: CompiledStep | None = None,
    ) -> None:
        self._legs, self._timing = legs, parameters.step_adaptation.timing
        self._sample_time, self._numbers = parameters.sample_time, parameters.recovery
        self._authority = np.array(parameters.cop_authority)
        self._changes, kernels = np.array(parameters.recovery.time_changes), library()
        self._compiled = None if kernels is None else CompiledAdjustment(kernels, legs, parameters, outlook, told)

    def solve(
        self, com: Array, dcm: Array, window: Window, step: StepProblem, unsure: float = 0.0
    ) -> StepBounds | None:
        """The solution; None where nothing has to be adjusted, or the step has no place to land.

        Args:
            com: now, in the plan frame, shape (2,) [m].
            dcm: now, likewise.
            window: references.
            step: as scheduled.
            unsure: error of the DCM that is no error, since it is not known better [m].
        """
        t, numbers, count = self._sample_time, self._numbers, len(window.stiffness)
        if self._compiled is not None and count == self._compiled.count:
            found = self._compiled.solve(com, dcm, window, step, unsure)
            return None if found is None else StepBounds(*found)
        lift = min(round(step.double / t), count - 3)
        land = min(max(round((step.double + step.single) / t), lift + 1), count - 2)
        # The DCM that keeps bounded what comes, and what a shift of the step does to it.
        reference = window.driving
        box = reference.half_size[lift]
        wider = reference.half_size - box
        wider[lift:] = 0.0
        future = np.concatenate((reference.point, reference.gain[:, :1], wider), axis=1)
        bounded = nominal_dcm(window.stiffness, window.omega, future, t)
        gain = max(float(bounded[land, 2]), _NO_GAIN)
        # Between the feet on which it stood the CoP has more room than on one.
        more = bounded[0, 3:]
        fade = float(decays(window.stiffness[: land + 1], window.omega[: land + 1], t)[-1])
        own = np.minimum(box, self._authority)
        missed = np.where(own < box, fade * numbers.unheld_share * box, fade * numbers.tolerance)
        fine = bool((np.abs(dcm - bounded[0, :2]) <= (1.0 - fade) * own + more + missed + unsure).all())
        if fine and not step.adapted:
            return None
        times, held = self._times(step, fine), numbers.cop_share * own
        means = held, numbers.cop_share * more
        left, landed = _landing(com, dcm, window, step, times, bounded[[0, lift, land], :2], means)
        return self._cheapest(landed, window, step, times, step.nominal + left / gain, (gain, held))

    def _times(self, step: StepProblem, fine: bool) -> tuple[Array, Array]:
        """Pairs of times of double and single support to choose from, the present one last, shape (n,) each [s]."""
        if fine or not self._timing:
            return np.array([step.double]), np.array([step.single])
        numbers = self._numbers
        singles = self._around(step.single, max(numbers.least_single, step.shortest))
        # Put off in every plan, which its clock cannot do so late, a double support would never end.
        most = step.double if step.adapted else math.inf
        doubles = self._around(step.double, numbers.least_double, most) if step.double else np.zeros(1)
        grid = np.zeros((len(doubles), len(singles)))
        return (doubles[:, None] + grid).ravel(), (singles + grid).ravel()

    def _around(self, time: float, least: float, most: float = math.inf) -> Array:
        """Times to choose from [s]: the given one is the last. Changes of a long one begin with the least time."""
        times = min(time, least + self._numbers.longest_cut) + self._changes
        return np.append(times[(times >= min(time, least)) & (times <= most)], time)

    def _cheapest(
        self,
        com: Array,
        window: Window,
        step: StepProblem,
        times: tuple[Array, Array],
        wanted: Array,
        means: tuple[float, Array],
    ) -> StepBounds | None:
        """The cheapest of all times and boxes, with the part of its box in which the step then may land.

        Here `com` is that at the landing, `wanted` is p*, shape (n, 2) each [m], and `means` are g [-] and half size of
        what the CoP has of its box, shape (2,) [m].
        """
        legs, numbers, (double, single), (gain, held) = self._legs.turned(step.place.yaw), self._numbers, times, means
        swung = legs.edges(step.swing, step.nominal, single)
        low, high = -swung[2:].T, swung[:2].T
        # Of each box that the foot may land in, shape (boxes, n).
        boxes = legs.allowed(step.place.foot.side, step.face, step.crosses)
        lower, upper = boxes[:, :1], boxes[:, 1:]
        aside = 0.5 * step.place.foot.side * legs.hip_width * np.array([0.0, 1.0])
        hips = com + aside
        places = legs.within(_between(_between(wanted, low, high), lower, upper), hips)
        places = _between(places, lower, upper)
        growth = np.exp(float(window.omega[0]) * step.cycle)
        # What the CoP holds until the step after it, or in a stand on both feet for ever.
        stand = numbers.stand_share * window.driving.half_size[-1]
        held_next = growth * stand if step.last else (growth - 1.0) * held
        short = wanted - places
        second = np.maximum(gain * growth * np.abs(short) - held_next, 0.0)
        second[..., 1] *= np.where(step.place.foot.side * short[..., 1] > 0.0, numbers.cross_factor, 1.0)
        changed = (double - step.double) ** 2 + (single - step.single) ** 2
        stretch = np.maximum(np.hypot(*(com - aside).T) - legs.radius, 0.0)
        shortfall = legs.shortfall(step.swing, step.place.foot.side, single, places)
        cost = numbers.time_weight * changed / step.cycle**2
        cost = cost + numbers.stretch_weight * stretch**2
        cost = cost + numbers.shift_weight * ((places - step.nominal) ** 2).sum(axis=-1)
        cost = cost + numbers.second_weight * (second**2).sum(axis=-1)
        cost = cost + numbers.swing_weight * ((places - _between(places, low, high)) ** 2).sum(axis=-1)
        cost = cost + numbers.swing_weight * shortfall**2
        cost[(lower > upper).any(axis=(1, 2))] = np.inf
        cheapest = np.where(cost.min(axis=1) < cost[:, -1] - numbers.least_saving, cost.argmin(axis=1), -1)
        way = int(cost[np.arange(len(cost)), cheapest].argmin())
        best = int(cheapest[way])
        if cost[way, best] == np.inf:
            return None
        place, least, most = places[way, best], low[best], high[best]
        # It lands with the DCM well inside the next box, or as near to that as it comes. One that crosses, and does not
        # get that far across, the law weighs against the CoP.
        left = np.maximum(numbers.landing_share * held, held / numbers.cop_share - numbers.landing_spare) / gain
        free = (wanted[best] < boxes[way, 0]) | (wanted[best] > boxes[way, 1]) if way else np.zeros(2, dtype=bool)
        least = np.where(free, least, np.maximum(least, wanted[best] - left))
        most = np.where(free, most, np.minimum(most, wanted[best] + left))
        box = legs.around(place, hips[best], boxes[way], legs.radius)
        box[0], box[1] = np.maximum(box[0], np.minimum(least, place)), np.minimum(box[1], np.maximum(most, place))
        left, more = double if step.double else single, second[way, best].any()
        return StepBounds(float(left[best]), box, bool(more), float(cost[way, best]))


def _landing(
    com: Array,
    dcm: Array,
    window: Window,
    step: StepProblem,
    times: tuple[Array, Array],
    bounded: Array,
    means: tuple[Array, Array],
) -> tuple[Array, Array]:
    """What no CoP holds of the DCM when the step lands, and the CoM then, shape (n, 2) each [m].

    On a foot the DCM goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}, in double support as `moving_cop` says.
    Of the arguments `bounded` is the DCM that the steps as planned keep bounded, now, when the foot leaves the ground,
    and when it lands, shape (3, 2) [m], and `means` are half sizes of what the CoP has of its box, and by how much the
    DCM now may be farther off since it has more in double support, shape (2,) each [m].
    """
    omega, (present, lift_off, landed), (half, more) = float(window.omega[0]), bounded, means
    doubles, singles = times
    spread, grown = np.exp(omega * doubles), np.exp(omega * singles)
    # The constant CoP on the foot, and beside the moving one before it, that are nominal.
    growth = np.exp(omega * step.single)
    centre = (landed - growth * lift_off) / (1.0 - growth)
    lifted, start = np.broadcast_to(dcm, (len(singles), 2)), centre
    if step.double:
        growth, start = np.exp(omega * step.double), window.driving.point[0]
        beside = growth * present - moving_cop(start, centre, omega, np.array([step.double]))[0] - lift_off
        lifted = spread[:, None] * dcm - moving_cop(start, centre, omega, doubles)
        lifted = lifted - (spread[:, None] - 1.0) * (beside / (growth - 1.0))
    astray = grown[:, None] * (lifted - centre) + centre - landed
    most = (grown * spread - 1.0)[:, None] * half + (grown * spread)[:, None] * more
    held = _between(astray, -most, most)
    cop = centre + half * held / np.maximum(most, 1e-9)
    there = pendulum_com(com, dcm, 0.5 * (start + cop), spread) if step.double else com
    return astray - held, pendulum_com(there, lifted, cop, grown)


def _between(places: Array, low: Array, high: Array) -> Array:
    """The places of a box nearest to these, or its upper corner where it is empty: a faster `numpy.clip`."""
    return np.asarray(np.minimum(np.maximum(places, low), high))
