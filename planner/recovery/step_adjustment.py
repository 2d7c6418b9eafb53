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
- times: T_d = T̄_d or that and a member of time_changes, and T_s in the same way, each with each. The rest of a support
  is not shortened below least_double or least_single, nor below the time in which body and foot come to the footstep's
  height. Changes of a longer support count from its least time plus the longest cut. T_d ≤ T̄_d where the step is
  adapted.

Solver: for given times p* follows in closed form, since the CoP does what it can; p is p* brought into the limits, the
boxes and the legs' reach in turn. So times and boxes are enumerated, and the cheapest is taken.
docs/recovery.md has every formula.
"""

import math

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.planner.model import pendulum
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.outlook import Outlook
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.recovery.step_problem import StepBounds, StepProblem
from surefoot.planner.references.window import Window
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import Array

NO_GAIN = 1e-9
"""Gain of a step below which it counts as this: one that lands where the window ends does nothing to its DCM [-]."""

NOW, LIFT_OFF, LANDED = range(3)
"""Rows of `Outlook.bounded`."""


class StepAdjustment:
    """The program of the module's head, for one robot.

    Args:
        legs: what they can do.
        parameters: of the planner.
    """

    def __init__(self, legs: LegReach, parameters: PlannerParameters) -> None:
        numbers = parameters.recovery
        self._reach, self._outlook = StepReach(legs), Outlook(parameters)
        self._timing, self._sample_time = parameters.step_adaptation.timing, parameters.sample_time
        self._authority = np.array(parameters.cop_authority, dtype=np.float64)
        self._changes, self._longest_cut = np.array(numbers.time_changes), numbers.longest_cut
        self._shift_weight, self._second_weight = numbers.shift_weight, numbers.second_weight
        self._time_weight, self._stretch_weight = numbers.time_weight, numbers.stretch_weight
        self._swing_weight, self._cross_factor = numbers.swing_weight, numbers.cross_factor
        self._least_saving, self._cop_share = numbers.least_saving, numbers.cop_share
        self._landing_share, self._landing_spare = numbers.landing_share, numbers.landing_spare
        self._tolerance, self._unheld_share = numbers.tolerance, numbers.unheld_share
        self._stand_share = numbers.stand_share
        self._least_double, self._least_single = numbers.least_double, numbers.least_single
        self._doubles, self._singles = np.zeros(len(self._changes) + 1), np.zeros(len(self._changes) + 1)
        self._held, self._more = np.zeros(2), np.zeros(2)
        self._wanted, self._low, self._high = np.zeros(2), np.zeros(2), np.zeros(2)
        self._hips, self._place, self._second = np.zeros(2), np.zeros(2), np.zeros(2)

    def solve(
        self, com: Array, dcm: Array, window: Window, step: StepProblem, uncertainty: float = 0.0
    ) -> StepBounds | None:
        """The solution; None where nothing has to be adjusted, or the step has no place to land.

        Args:
            com: now, in the plan frame, shape (2,) [m].
            dcm: now in the plan frame, shape (2,) [m].
            window: references.
            step: as scheduled.
            uncertainty: error of the DCM that is no error, since it is not known better [m].
        """
        self._com, self._dcm, self._omega = com, dcm, window.omega[0]
        self._reach.see(step)
        self._outlook.see(window)
        self._grow()
        fine = self._is_held(uncertainty)
        if fine and not self._reach.adapted:
            return None
        time, cost, box = self._cheapest(fine)
        if cost == algebra.INFINITY:
            return None
        more = self._second[0] != 0.0 or self._second[1] != 0.0
        return StepBounds(float(time), self._landing_box(box), bool(more), float(cost))

    def _grow(self) -> None:
        """Set e^{ωT} of the times as planned, and of the step after them."""
        step = self._reach
        self._double_growth, self._single_growth = (
            math.exp(self._omega * step.double),
            math.exp(self._omega * step.single),
        )
        self._cycle_growth = math.exp(self._omega * step.cycle)

    def _is_held(self, uncertainty: float) -> bool:
        """Look at the DCM that keeps bounded what comes; whether the CoP alone holds the body to it.

        Sets what the CoP has of its box (`_held`), and by how much the DCM now may be farther off since it has more in
        double support, between the feet (`_more`).
        """
        ahead, step = self._outlook, self._reach
        lift = min(int(linear.nearest(step.double / self._sample_time)), ahead.count - 3)
        lands = int(linear.nearest((step.double + step.single) / self._sample_time))
        lands = min(max(lands, lift + 1), ahead.count - 2)
        ahead.look(lift, lands)
        self._gain = max(ahead.bounded[LANDED, 2], NO_GAIN)
        fade, held = ahead.decay[lands], True
        for axis in range(2):
            box = ahead.half_size[lift, axis]
            own = min(box, self._authority[axis])
            missed = fade * (self._unheld_share * box if own < box else self._tolerance)
            self._more[axis] = ahead.bounded[NOW, 3 + axis]
            self._held[axis] = self._cop_share * own
            off = abs(self._dcm[axis] - ahead.bounded[NOW, axis])
            held = held and off <= (1.0 - fade) * own + self._more[axis] + missed + uncertainty
        return held

    def _cheapest(self, fine: bool) -> tuple[float, float, int]:
        """Settle on the cheapest of all times and boxes: time left of the present phase [s], cost [-] and its box."""
        step = self._reach
        doubles, singles = self._time_choices(fine)
        best_double = step.double
        best_single = step.single
        least = algebra.INFINITY
        best = 0
        for box in range(step.boxes):
            cost, double, single = algebra.INFINITY, step.double, step.single
            planned = cost
            for d in range(doubles):
                for s in range(singles):
                    # The last ones are those planned.
                    planned = self._cost(box, self._doubles[d], self._singles[s])
                    if planned < cost:
                        cost, double, single = planned, self._doubles[d], self._singles[s]
            if not cost < planned - self._least_saving:
                cost, double, single = planned, step.double, step.single
            if cost < least:
                least = cost
                best = box
                best_double = double
                best_single = single
        if least < algebra.INFINITY:
            least = self._cost(best, best_double, best_single)
        return best_double if step.double != 0.0 else best_single, least, best

    def _time_choices(self, fine: bool) -> tuple[int, int]:
        """Set the times of double and single support to choose from, the present one last; how many there are."""
        step = self._reach
        if fine or not self._timing:
            self._doubles[0], self._singles[0] = step.double, step.single
            return 1, 1
        least = max(self._least_single, step.shortest)
        singles = self._around(self._singles, step.single, least, algebra.INFINITY)
        if step.double == 0.0:
            self._doubles[0] = 0.0
            return 1, singles
        # Put off in every plan, which its clock cannot do so late, a double support would never end.
        most = step.double if step.adapted else algebra.INFINITY
        return self._around(self._doubles, step.double, self._least_double, most), singles

    def _around(self, times: Array, time: float, least: float, most: float) -> int:
        """Set times to choose from, the given one last; how many. Changes of a long one begin with the least time."""
        count, shortest = 0, min(time, least)
        begin = min(time, least + self._longest_cut)
        for k in range(len(self._changes)):
            changed = begin + self._changes[k]
            if shortest <= changed <= most:
                times[count] = changed
                count += 1
        times[count] = time
        return count + 1

    def _cost(self, box: int, double: float, single: float) -> float:
        """Bring the step at given times into a box; the cost, infinite where the box is empty [-].

        Sets p* (`_wanted`), where the foot can be swung to (`_low`, `_high`), the hip at the landing (`_hips`), p
        (`_place`) and σ (`_second`), shape (2,) each [m].
        """
        step, ahead = self._reach, self._outlook
        spread, grown = math.exp(self._omega * double), math.exp(self._omega * single)
        x, y = self._land(0, double, spread, grown), self._land(1, double, spread, grown)
        aside = 0.5 * step.side * step.hip_width
        self._hips[0], self._hips[1] = x, y + aside
        for axis in range(2):
            self._low[axis], self._high[axis] = -step.swung(axis, -1.0, single), step.swung(axis, 1.0, single)
        way_x, way_y = self._way(0, box), self._way(1, box)
        share = min(1.0, step.radius / max(math.hypot(way_x, way_y), 1e-9))
        growth, cost = self._cycle_growth, 0.0
        for axis in range(2):
            way = way_y if axis else way_x
            place = algebra.between(self._hips[axis] + share * way, step.low[box, axis], step.high[box, axis])
            short = self._wanted[axis] - place
            # What the CoP holds until the step after it, or in a stand on both feet for ever.
            stand = growth * self._stand_share * ahead.half_size[ahead.count - 1, axis]
            second = max(
                self._gain * growth * abs(short) - (stand if step.last else (growth - 1.0) * self._held[axis]), 0.0
            )
            if axis == 1 and step.side * short > 0.0:
                second *= self._cross_factor
            unswung = place - algebra.between(place, self._low[axis], self._high[axis])
            cost += self._shift_weight * algebra.square(place - step.place[axis])
            cost += self._second_weight * algebra.square(second)
            cost += self._swing_weight * algebra.square(unswung)
            self._place[axis], self._second[axis] = place, second
        changed = algebra.square(double - step.double) + algebra.square(single - step.single)
        stretch = max(math.hypot(x, y - aside) - step.radius, 0.0)
        shortfall = step.shortfall(single, self._place[0], self._place[1])
        cost += self._time_weight * changed / algebra.square(step.cycle) + self._stretch_weight * algebra.square(
            stretch
        )
        cost += self._swing_weight * algebra.square(shortfall)
        return algebra.INFINITY if step.is_empty(box) else cost

    def _way(self, axis: int, box: int) -> float:
        """Way from the hip to p* as far as the foot can be swung there and the box lets it [m]."""
        step = self._reach
        swung = algebra.between(self._wanted[axis], self._low[axis], self._high[axis])
        return float(algebra.between(swung, step.low[box, axis], step.high[box, axis]) - self._hips[axis])

    def _land(self, axis: int, double: float, spread: float, grown: float) -> float:
        """Set p* on an axis, which leaves nothing that no CoP holds of the DCM at the landing; the CoM then [m].

        On a foot the DCM goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}, in double support as
        `planner.model.pendulum.moving_cop` says. Here `spread` and `grown` are e^{ωT} of the times.
        """
        step = self._reach
        omega = self._omega
        dcm = self._dcm[axis]
        com = self._com[axis]
        present, lift_off, landed = (
            self._outlook.bounded[NOW, axis],
            self._outlook.bounded[LIFT_OFF, axis],
            self._outlook.bounded[LANDED, axis],
        )
        # The constant CoP on the foot, and beside the moving one before it, that are nominal.
        centre = (landed - self._single_growth * lift_off) / (1.0 - self._single_growth)
        lifted, start = dcm, centre
        if step.double != 0.0:
            start, nominal = self._outlook.point[0, axis], self._double_growth
            beside = nominal * present - pendulum.moving_cop(start, centre, omega, step.double) - lift_off
            lifted = spread * dcm - pendulum.moving_cop(start, centre, omega, double)
            lifted -= (spread - 1.0) * (beside / (nominal - 1.0))
        astray = grown * (lifted - centre) + centre - landed
        half, more = self._held[axis], self._cop_share * self._more[axis]
        most = (grown * spread - 1.0) * half + grown * spread * more
        held = algebra.between(astray, -most, most)
        cop = centre + half * held / max(most, 1e-9)
        there = pendulum.com_after(com, dcm, 0.5 * (start + cop), spread) if step.double != 0.0 else com
        self._wanted[axis] = step.place[axis] + (astray - held) / self._gain
        return pendulum.com_after(there, lifted, cop, grown)

    def _landing_box(self, box: int) -> Array:
        """The part of a box in which the step then may land: lower and upper corner, shape (2, 2) [m].

        It lands with the DCM well inside the next box, or as near to that as it comes. One that crosses, and does not
        get that far across, the law weighs against the CoP.
        """
        step, found = self._reach, np.zeros((2, 2))
        for axis in range(2):
            place, held, wanted = self._place[axis], self._held[axis], self._wanted[axis]
            lowest, highest = step.low[box, axis], step.high[box, axis]
            other = self._place[1 - axis] - self._hips[1 - axis]
            most = math.sqrt(max(algebra.square(step.radius) - algebra.square(other), 0.0))
            low, high = self._low[axis], self._high[axis]
            if box == 0 or lowest <= wanted <= highest:
                unheld = max(self._landing_share * held, held / self._cop_share - self._landing_spare)
                low, high = max(low, wanted - unheld / self._gain), min(high, wanted + unheld / self._gain)
            least = min(max(lowest, self._hips[axis] - most), place)
            greatest = max(min(highest, self._hips[axis] + most), place)
            found[0, axis] = max(least, min(low, place))
            found[1, axis] = min(greatest, max(high, place))
        return found
