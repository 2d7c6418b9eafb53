"""Where and when the next step lands after a push: what no CoP can hold is caught by place and time together.

On a foot the DCM goes away from the CoP p as ξ(t) = p + (ξ - p) e^{ωt}. While the CoP moves evenly from p0 to p1 in a
double support of length T it comes to ξ(T) = e^{ωT} ξ - p0 (e^{ωT} - 1) - (p1 - p0) ((e^{ωT} - 1) / (ωT) - 1). So where
it is when the next foot lands follows from the times left alone; a foot that lands d beside its nominal place moves the
DCM that its future ZMP keeps bounded by g d. For each of some times left the CoP takes what it can, the step what legs
reach and the foot can be swung to until then, and the step after it what is left. The cheapest is walked.

It is the law of Khadiv et al. (IEEE Transactions on Robotics 2020) with the CoP as one more means, with double support,
and with the limits of the legs as they are, over a list of times in place of a QP. Without need, where the CoP alone
can bring the DCM back until the foot lands, nothing is adapted.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from surefoot.planner.model.dcm import decays, moving_cop, nominal_dcm, pendulum_com
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.window import Window
from surefoot.planner.references.zmp_reference import Support, ZmpReference
from surefoot.planner.types import Array, FeetState, PhaseKind
from surefoot.planner.walk.hurry import Haste, SwingState
from surefoot.planner.walk.reach import Legs
from surefoot.planner.walk.stepper import Stepper


@dataclass(frozen=True, slots=True)
class Situation:
    """A tick before a step lands, in the plan frame: its origin is the stance foot of that step.

    Attributes:
        com: CoM now, shape (2,) [m].
        dcm: DCM now, shape (2,) [m].
        stiffness: λ over the window, shape (n,) [1/s^2].
        omega: ω over the window, shape (n,) [1/s].
        reference: ZMP that drives the pendulum, over the window.
        nominal: where the step lands nominally, shape (2,) [m].
        side: +1 where it is a left one, -1 where it is a right one.
        swing: position and velocity of its foot, shape (2, 2) [m, m/s].
        double: time until that leaves the ground as planned, zero when it has [s].
        single: time that it swings, or swings on, as planned [s].
        cycle: duration of the step after it [s].
        shortest: time left of its swing in which the body can be lifted or lowered with it [s].
        room: by which the step may land elsewhere, least and greatest way, shape (2, 2) [m].
        adapted: whether the step is being adapted already.
        last: whether the robot stands after it.
        crosses: whether it may land beyond its stance foot, as far as legs may at all.
        turn: heading in which it lands against that of its stance foot [rad].
    """

    com: Array
    dcm: Array
    stiffness: Array
    omega: Array
    reference: ZmpReference
    nominal: Array
    side: float
    swing: Array
    double: float
    single: float
    cycle: float
    shortest: float
    room: Array
    adapted: bool
    last: bool
    crosses: bool
    turn: float = 0.0

    @property
    def foot(self) -> SwingState:
        """The foot that lands."""
        return SwingState(self.swing, self.nominal, self.side, self.turn)

    @classmethod
    def of(
        cls, time: float, stepper: Stepper, local: Array, feet: FeetState, support: Support, window: Window
    ) -> "Situation | None":
        """That of a tick; None where no step is to come.

        Args:
            time: now [s].
            stepper: clock and footholds.
            local: CoM position, velocity and acceleration per axis of the plan frame, shape (2, 3).
            feet: the measured feet.
            support: what carries the robot now, with the plan frame.
            window: references.
        """
        phase, rotation, moving = stepper.info, support.rotation, np.zeros(2)
        swings = phase.kind is PhaseKind.SINGLE
        if not phase.leads_to:
            return None
        step = stepper.queue.steps[phase.leads_to]
        foot, swing = step.place.foot, stepper.queue.lift_off(phase.leads_to)
        yet = min(1.0, (swing.end - stepper.clock.now) / swing.samples)
        if stepper.swing is not None:
            moving = stepper.swing.evaluate(time)[1, :2] @ rotation
        return cls(
            com=local[:, 0],
            dcm=local[:, 0] + local[:, 1] / window.omega[0],
            stiffness=window.stiffness,
            omega=window.omega,
            reference=window.driving,
            nominal=(stepper.footsteps.position[stepper.row + 1, :2] - support.origin) @ rotation,
            side=foot.side,
            swing=np.stack(((feet.position[foot, :2] - support.origin) @ rotation, moving)),
            double=0.0 if swings else phase.left,
            single=phase.left if swings else swing.samples * stepper.sample_time,
            cycle=stepper.queue.gait.period,
            shortest=yet * stepper.quickest,
            room=stepper.room(0),
            adapted=stepper.adapted,
            last=stepper.stops,
            crosses=stepper.may_cross,
            turn=stepper.turn(0),
        )


class Catch(NamedTuple):
    """What is made of a step.

    Attributes:
        left: time until the present phase is to end [s].
        low: lower corner of the box in which it may land, shape (2,) [m].
        high: upper corner, shape (2,) [m].
        more: whether the step after it has something to catch, too.
    """

    left: float
    low: Array
    high: Array
    more: bool


_AUTHORITY = 0.8
"""Share of the ZMP box that a step which is adapted leaves to the CoP [-]."""

_LANDED, _SPARE = 0.5, 0.03
"""DCM error that a step which is adapted may land with: this share of what the CoP has of its box [-], or all of the
box but this, if that is more [m]."""

_MARGIN = 0.02
"""DCM error at landing that the CoP cannot hold from which on a step is adapted [m]."""

_UNHELD = 0.5
"""The same where the CoP cannot be moved at will, of the ZMP box, so that each step makes good what the last one left
over [-]."""

_HELD = 0.85
"""Share of the ZMP box of a stand that holds the body without a step [-]."""

ASTRIDE, CALM = 0.03, 0.005
"""Distance of a foot from where it was to stand beside the other one from which on it is brought there, and the DCM
error up to which the robot is calm enough for that [m]."""

ASIDE = 0.02
"""DCM error sideways from which on the foot on that side stays [m]."""

_LEAST_GAIN = 0.05
"""Gain of a step, which no horizon that ends with it shall make zero [-]."""

_CHANGES = np.array(
    [*np.arange(-0.6, -0.2, 0.1), *np.arange(-0.24, 0.0, 0.04), -0.02, 0.02, *np.arange(0.04, 0.21, 0.04)]
)
"""By which a phase may become longer at once [s]."""

SHORTEST = {"double": 0.06, "single": 0.16}
"""Times left that phases are not made shorter than [s]."""

_PLACE, _TIME, _STRETCH, _SECOND = 0.02, 0.38, 1.0, 1.0
"""Cost of a squared shift, change of time, way of the hip beyond the reach of the stance leg, and shift of the step
after it [1/m^2, 1/s^2, 1/m^2, 1/m^2]."""

_UNREACHED = 10.0
"""Cost of a squared way to the place that the foot cannot be swung in the time left [1/m^2]."""

_OUTWARD = 3.0
"""Factor of that shift where the body goes on outward over the foot that has landed: the other one has to cross [-]."""

_WORTH = 0.001
"""Cost that other times must save [-]."""


class Recovery:
    """Chooses when the next step lands, and the box of where.

    Args:
        legs: what they can do.
        parameters: of the planner.
        timing: whether times may change.

    Attributes:
        legs: what they can do.
        timing: whether times may change.
        haste: how far a foot can be swung in time.
    """

    def __init__(self, legs: Legs, parameters: PlannerParameters, timing: bool) -> None:
        self.legs, self.timing = legs, timing
        self._sample_time = parameters.sample_time
        self.haste = Haste(legs, parameters.touchdown_lead, parameters.sample_time)
        self._size, self._authority = parameters.size, np.array(parameters.cop_authority)
        self._weights = self._size.times((_PLACE, _STRETCH, _SECOND, _UNREACHED), "1/m^2")

    def topples(self, dcm: Array, window: Window) -> tuple[Array, bool]:
        """DCM error of a robot that stands, or will without another step, and whether no CoP can hold it.

        Args:
            dcm: now, in the plan frame, shape (2,) [m].
            window: references.

        Returns:
            The error, shape (2,) [m], and whether it falls.
        """
        nominal = nominal_dcm(window.stiffness, window.omega, window.driving.point, self._sample_time)
        error = dcm - nominal[0]
        return error, bool((np.abs(error) > _HELD * window.driving.half_size[-1]).any())

    def catch(self, now: Situation) -> Catch | None:
        """What is made of the next step; None where nothing has to be."""
        t, count = self._sample_time, len(now.stiffness)
        lift = min(round(now.double / t), count - 3)
        land = min(max(round((now.double + now.single) / t), lift + 1), count - 2)
        # The DCM that keeps bounded what comes, and what a shift of the step does to it.
        point = now.reference.point
        box = now.reference.half_size[lift]
        wider = now.reference.half_size - box
        wider[lift:] = 0.0
        future = np.concatenate((point, now.reference.gain[:, :1], wider), axis=1)
        bounded = nominal_dcm(now.stiffness, now.omega, future, t)
        nominal, landed, gain = bounded[:, :2], bounded[land, :2], max(float(bounded[land, 2]), _LEAST_GAIN)
        # Between the feet on which it stood the CoP has more room than on one.
        more = bounded[0, 3:]
        fade = float(decays(now.stiffness[: land + 1], now.omega[: land + 1], t)[-1])
        own = np.minimum(box, self._authority)
        missed = np.where(own < box, fade * _UNHELD * box, fade * _MARGIN * self._size.length)
        held = (1.0 - fade) * own + more + missed
        fine = bool((np.abs(now.dcm - nominal[0]) <= held).all())
        if fine and not now.adapted:
            return None
        times, half = self._times(now, fine), _AUTHORITY * own
        left, com = _landing(now, times, nominal[[0, lift]], landed, (half, _AUTHORITY * more))
        return self._cheapest(now, times, now.nominal + left / gain, com, (gain, half))

    def _cheapest(
        self, now: Situation, times: tuple[Array, Array], wanted: Array, com: Array, means: tuple[float, Array]
    ) -> Catch | None:
        """The cheapest of some times, with the box of where the step then lands; None where it has no place to.

        Args:
            now: the situation.
            times: of double and single support, the present ones last, shape (n,) each [s].
            wanted: where the step would have to land to leave nothing, shape (n, 2) [m].
            com: CoM when it lands, shape (n, 2) [m].
            means: gain of a shift [-], and half sizes of what the CoP has of its box, shape (2,) [m].
        """
        (doubles, singles), (gain, half) = times, means
        hip = 0.5 * now.side * self.legs.hip_width * np.array([0.0, 1.0])
        stretch = np.hypot(*(com - hip).T) - self.legs.radius
        cost = _TIME * ((doubles - now.double) ** 2 + (singles - now.single) ** 2) / now.cycle**2
        shift, stretched, second_shift, unreached = self._weights
        cost = cost + stretched * np.maximum(stretch, 0.0) ** 2
        swung = self.haste.edges(now.foot, singles)
        low, high = -swung[2:].T, swung[:2].T
        growth = np.exp(float(now.omega[0]) * now.cycle)
        # What the CoP holds until the step after it, or in a stand on both feet for ever.
        held_next = growth * _HELD * now.reference.half_size[-1] if now.last else (growth - 1.0) * half
        # Of each box that the foot may land in, shape (boxes, n).
        room, boxes = now.nominal + now.room, self.boxes(now)
        lower, upper = np.maximum(boxes[:, :1], room[0]), np.minimum(boxes[:, 1:], room[1])
        places = self.legs.within(_between(_between(wanted, low, high), lower, upper), com + hip)
        places = _between(places, lower, upper)
        short = wanted - places
        second = np.maximum(gain * growth * np.abs(short) - held_next, 0.0)
        second[..., 1] *= np.where(now.side * short[..., 1] > 0.0, _OUTWARD, 1.0)
        total = cost + shift * ((places - now.nominal) ** 2).sum(axis=-1) + second_shift * (second**2).sum(axis=-1)
        total = total + unreached * ((places - _between(places, low, high)) ** 2).sum(axis=-1)
        total = total + unreached * self.haste.lacking_around(now.foot, singles, places) ** 2
        total[(lower > upper).any(axis=(1, 2))] = np.inf
        least_cost, rows = total.min(axis=1), np.arange(len(total))
        cheapest = np.where(least_cost < total[:, -1] - _WORTH, total.argmin(axis=1), -1)
        way = int(total[rows, cheapest].argmin())
        best = int(cheapest[way])
        if total[way, best] == np.inf:
            return None
        place, more, crosses = places[way, best], bool(second[way, best].any()), way > 0
        lower, upper = self.legs.around(place, com[best] + hip, (lower[way, 0], upper[way, 0]), self.legs.radius)
        least, most = low[best], high[best]
        if not crosses:
            # Beside its stance foot it lands with the DCM well inside the next box, or as near to that as it comes.
            held = np.maximum(_LANDED * half, half / _AUTHORITY - _SPARE * self._size.length) / gain
            least, most = np.maximum(least, wanted[best] - held), np.minimum(most, wanted[best] + held)
        lower, upper = np.maximum(lower, np.minimum(least, place)), np.minimum(upper, np.maximum(most, place))
        return Catch(float(doubles[best] if now.double else singles[best]), lower, upper, more)

    def boxes(self, now: Situation) -> Array:
        """Lower and upper corners of where the step may land, as far as its stance foot is concerned.

        Args:
            now: the situation.

        Returns:
            Shape (boxes, 2, 2) [m].
        """
        return np.array(self.legs.turned(now.turn).boxes(now.side, now.crosses))

    def _times(self, now: Situation, fine: bool) -> tuple[Array, Array]:
        """Pairs of times of double and single support to choose from, the present one last, shape (n,) each [s]."""
        if fine or not self.timing:
            return np.array([now.double]), np.array([now.single])
        time = self._size.time
        singles = _around(now.single, max(SHORTEST["single"] * time, now.shortest), time)
        doubles = _around(now.double, SHORTEST["double"] * time, time) if now.double else np.zeros(1)
        grid = np.zeros((len(doubles), len(singles)))
        return (doubles[:, None] + grid).ravel(), (singles + grid).ravel()


def _landing(
    now: Situation, times: tuple[Array, Array], nominal: Array, landed: Array, means: tuple[Array, Array]
) -> tuple[Array, Array]:
    """What no CoP holds of the DCM when the step lands, and the CoM then, shape (n, 2) each [m].

    Args:
        now: the situation.
        times: of double and single support, shape (n,) each [s].
        nominal: DCM now and when the foot leaves the ground that the steps as planned keep bounded, shape (2, 2) [m].
        landed: the same when it lands, shape (2,) [m].
        means: half sizes of what the CoP has of its box, and by how much the DCM now may be farther off since it has
            more in double support, shape (2,) each [m].
    """
    omega, (present, lift_off), (half, more) = float(now.omega[0]), nominal, means
    doubles, singles = times
    spread, grown = np.exp(omega * doubles), np.exp(omega * singles)
    # The constant CoP on the foot, and beside the moving one before it, that are nominal.
    growth = np.exp(omega * now.single)
    centre = (landed - growth * lift_off) / (1.0 - growth)
    lifted, start = np.broadcast_to(now.dcm, (len(singles), 2)), centre
    if now.double:
        growth, start = np.exp(omega * now.double), now.reference.point[0]
        beside = growth * present - moving_cop(start, centre, omega, np.array([now.double]))[0] - lift_off
        lifted = spread[:, None] * now.dcm - moving_cop(start, centre, omega, doubles)
        lifted = lifted - (spread[:, None] - 1.0) * (beside / (growth - 1.0))
    astray = grown[:, None] * (lifted - centre) + centre - landed
    most = (grown * spread - 1.0)[:, None] * half + (grown * spread)[:, None] * more
    held = _between(astray, -most, most)
    cop = centre + half * held / np.maximum(most, 1e-9)
    com = pendulum_com(now.com, now.dcm, 0.5 * (start + cop), spread) if now.double else now.com
    return astray - held, pendulum_com(com, lifted, cop, grown)


def _between(places: Array, low: Array, high: Array) -> Array:
    """The places of a box nearest to these, or its upper corner where it is empty: a faster `numpy.clip`."""
    return np.asarray(np.minimum(np.maximum(places, low), high))


def _around(time: float, least: float, scale: float) -> Array:
    """Times about one, which is the last, by changes of this scale [s, s, -]."""
    times = time + scale * _CHANGES
    return np.append(times[times >= min(time, least)], time)
