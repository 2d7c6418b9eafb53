"""What the planner hands over at every tick, and the references that follow from it at any instant."""

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy import bool_
from numpy.typing import NDArray

from surefoot.planner.geometry import quintic, shifted
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.plan_kernel import COLUMNS, POINT, PlanKernel
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.swing.trajectory import TOUCHING, SwingTrajectory
from surefoot.planner.types import (
    Array,
    Balance,
    CentroidalState,
    FeetState,
    Foot,
    Footstep,
    PhaseInfo,
    PhaseKind,
    PlanStatus,
)
from surefoot.values import dataclass, maker, opened


@dataclass(frozen=True, slots=True)
class WalkPlan:
    """A plan from the measured state at `time` over N samples; world frame.

    Attributes:
        time: instant of the measurement [s].
        sample_time: length of a sample [s].
        com: CoM positions at samples 0..N, shape (N + 1, 3) [m].
        com_velocity: shape (N + 1, 3) [m/s].
        com_acceleration: shape (N + 1, 3) [m/s^2].
        jerk: horizontal CoM jerk of each sample, shape (N, 2) [m/s^3].
        zmp: ZMP that this motion has, shape (N + 1, 2) [m].
        zmp_offset: what the swing leg adds to it (see `planner.references.leg_offset`), shape (N + 1, 2) [m].
        zmp_reference: ZMP that the footsteps define, shape (N + 1, 2) [m].
        stiffness: λ of c'' = λ (c - (zmp - zmp_offset)), shape (N + 1,) [1/s^2].
        omega: ω of the DCM, ω' = ω² - λ, shape (N + 1,) [1/s].
        phase: where the plan stands in the gait.
        contacts: planned contacts (left, right) from each sample on, shape (N + 1, 2) [-].
        load_left: planned share of the weight on the left foot, shape (N + 1,) [-]; the right one has the rest.
        support_polygon: hull of the planned soles now, anticlockwise, shape (v, 2) [m].
        inner_polygon: the same of the soles shrunk to the ZMP margin (90 %), shape (v, 2) [m].
        footholds: where the left and the right foot stand now, or stood last.
        footsteps: the next footsteps with number and time, at most three.
        swing: trajectory of the swing foot in single support, otherwise None. It is that of the sole as if it were
            level: a foot that rolls turns about its toe edge.
        roll: pitch of the foot that leaves the ground next or has just left it, None for one that stays level.
        status: how the plan was made.
        balance: what is left to the body, and what of it the plan makes use of.
    """

    time: float
    sample_time: float
    com: Array
    com_velocity: Array
    com_acceleration: Array
    jerk: Array
    zmp: Array
    zmp_offset: Array
    zmp_reference: Array
    stiffness: Array
    omega: Array
    phase: PhaseInfo
    contacts: NDArray[bool_]
    load_left: Array
    support_polygon: Array
    inner_polygon: Array
    footholds: tuple[Footstep, Footstep]
    footsteps: tuple[Footstep, ...]
    swing: SwingTrajectory | None
    roll: FootRoll | None
    status: PlanStatus
    balance: Balance = field(default_factory=Balance)


class Planner(Protocol):
    """What a closed loop asks of a planner; anything with this can take the place of `planner.planner.WalkingPlanner`.

    It is asked once per `parameters.sample_time`, from time 0 on, and each plan has `parameters.horizon` samples;
    nothing else is read of its parameters.
    """

    @property
    def parameters(self) -> PlannerParameters:
        """Gives sample time and horizon of the plans."""

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        """Plan from a measurement.

        Args:
            state: measured CoM.
            feet: measured feet.
        """


_put = object.__setattr__

_OMEGA = 4
"""Place of the pendulum's rate in a point of the kernel, which is read at every tick [-]."""

IN_POINT: Mapping[str, slice | int] = {
    "com": slice(7, 10),
    "com_velocity": slice(16, 19),
    "com_acceleration": slice(25, 28),
    "zmp": slice(36, 38),
    "pendulum_zmp": slice(34, 36),
    "zmp_reference": slice(0, 2),
    "dcm": slice(38, 40),
    "omega": _OMEGA,
    "stiffness": 5,
    "load_left": 6,
    "swing": slice(10, 16),
    "swing_velocity": slice(19, 25),
    "swing_acceleration": slice(28, 34),
}
"""Where the fields of a sample are in a point."""


@dataclass(frozen=True, slots=True)
class PlanSample:
    """References at one instant; world frame, arrays are fresh at every call.

    Attributes:
        time: instant [s].
        com: CoM position, shape (3,) [m].
        com_velocity: shape (3,) [m/s].
        com_acceleration: shape (3,) [m/s^2].
        zmp: ZMP of this motion, shape (2,) [m].
        pendulum_zmp: the ZMP less what the swing leg adds: c - c''/λ, which drives the CoM, shape (2,) [m].
        zmp_reference: ZMP that the footsteps define, shape (2,) [m].
        dcm: ξ = c + c'/ω, shape (2,) [m].
        omega: ω [1/s].
        stiffness: λ [1/s^2].
        contacts: planned contacts (left, right).
        load_left: planned share of the weight on the left foot [-].
        swing_foot: the swinging foot, or None; the swing arrays are zero without one.
        swing: swing sole x, y, z [m], yaw, pitch, roll [rad], shape (6,).
        swing_velocity: shape (6,) [m/s, rad/s].
        swing_acceleration: shape (6,) [m/s^2, rad/s^2].
        point: the numbers above as a sampler gives them, shape (POINT,) [SI]; None of a sample that none has made.
    """

    time: float
    com: Array
    com_velocity: Array
    com_acceleration: Array
    zmp: Array
    pendulum_zmp: Array
    zmp_reference: Array
    dcm: Array
    omega: float
    stiffness: float
    contacts: tuple[bool, bool]
    load_left: float
    swing_foot: Foot | None
    swing: Array
    swing_velocity: Array
    swing_acceleration: Array
    point: Array | None = field(init=False, default=None, repr=False, compare=False)

    @classmethod
    def of_point(cls, time: float, point: Array, contacts: tuple[bool, bool], swing_foot: Foot | None) -> "PlanSample":
        """A sample out of the numbers of the kernel, shape (POINT,) [SI], which become fields when first read."""
        sample = _OpenSample()
        sample.time, sample.contacts, sample.swing_foot, sample.point = time, contacts, swing_foot, point
        sample.omega = point.item(_OMEGA)  # which is read at every tick
        sample.__class__ = cls
        return sample  # type: ignore[no-any-return]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """A field that has not been read before."""
            if name not in IN_POINT:
                raise AttributeError(f"{type(self).__name__} has no attribute '{name}'")
            place = IN_POINT[name]
            value = self.point[place] if isinstance(place, slice) else self.point.item(place)
            _put(self, name, value)
            return value

    def until(self, middle: "PlanSample") -> "PlanSample":
        """What is to be done over a time that begins with this sample: its state, and all else of the middle."""
        if middle.swing_foot is not self.swing_foot:
            return middle
        return _a_sample(
            middle.time, self.com, self.com_velocity, middle.com_acceleration, middle.zmp, middle.pendulum_zmp,
            middle.zmp_reference, middle.dcm, middle.omega, middle.stiffness, middle.contacts, middle.load_left,
            middle.swing_foot, self.swing, self.swing_velocity, middle.swing_acceleration,
        )  # fmt: skip


_OpenSample, _a_sample = opened(PlanSample), maker(PlanSample)


class PlanSampler:
    """Evaluates a plan between its samples.

    The horizontal CoM is the exact cubic of the sample's jerk, its height the quintic through both samples' z, z', z'';
    ω, λ, ZMP reference, ZMP offset and load are linear. Each interval's polynomials are prepared when it is entered,
    and anew where the swing touches down within it: its descent would go on to accelerate a foot that is to rest. Where
    a single support ends within an interval its foot is from then on planned to bear load. After the end of the horizon
    the last sample is held.

    Args:
        plan: the plan.
        kernel: evaluates it; None for plain Python. It serves one sampler at a time.

    Attributes:
        plan: the plan.
        contacts: planned ones of the interval that was sampled last.
        swing_foot: that swings in it, or None.
        lands: from when on the foot bears load whose single support ends within the first interval [s].
    """

    def __init__(self, plan: WalkPlan, kernel: PlanKernel | None = None) -> None:
        self.plan, self._kernel = plan, kernel
        self._last = len(plan.jerk) - 1
        self._entered = (-1, False)
        self._touchdown = np.inf if plan.swing is None else plan.swing.touchdown_time - TOUCHING
        single = plan.phase.kind is PhaseKind.SINGLE
        self.lands = plan.time + plan.phase.left - TOUCHING if single else np.inf
        self._start = plan.time
        self._table: Array
        self.contacts = (True, True)
        self.swing_foot: Foot | None = None
        if kernel is not None:
            kernel.take(plan.time, plan.sample_time, self._last, self._touchdown)
            self._enter(0, plan.time >= self._touchdown)  # where it is asked first

    def sample(self, time: float) -> PlanSample:
        """References at an instant.

        Args:
            time: instant, not before the plan [s].
        """
        self._go_to(self._place(time))
        if self._kernel is not None:
            points = self._kernel.sample(time, time)
            assert points is not None
            return PlanSample.of_point(time, points[0], self.contacts_at(time), self.swing_foot)
        t = min(max(time - self._start, 0.0), self.plan.sample_time)
        t2 = t * t
        t3 = t2 * t
        point = np.empty(POINT)
        table = np.array((1.0, t, t2, t3, t3 * t, t3 * t2)).dot(self._table, out=point[:COLUMNS]).tolist()
        _, _, x_offset, y_offset, omega, stiffness, load, x, y = table[:9]
        # Plain floats: at this size they are faster than arrays.
        p_x, p_y = x - table[25] / stiffness, y - table[26] / stiffness
        point[COLUMNS:] = p_x, p_y, p_x + x_offset, p_y + y_offset, x + table[16] / omega, y + table[17] / omega
        sample = _OpenSample()
        sample.time, sample.contacts, sample.swing_foot = time, self.contacts_at(time), self.swing_foot
        sample.omega, sample.stiffness, sample.load_left = omega, stiffness, load
        sample.com, sample.com_velocity, sample.com_acceleration = point[7:10], point[16:19], point[25:28]
        sample.swing, sample.swing_velocity, sample.swing_acceleration = point[10:16], point[19:25], point[28:34]
        sample.point, sample.zmp_reference, sample.pendulum_zmp = point, point[:2], point[34:36]
        sample.zmp, sample.dcm, sample.__class__ = point[36:38], point[38:], PlanSample
        return sample  # type: ignore[no-any-return]

    def tick(self, time: float, middle: float) -> tuple[PlanSample, PlanSample]:
        """The references at an instant, and what is to be done from there on over a time with that middle [s]."""
        if self._kernel is None or not self.goes_to(time, middle):
            sample = self.sample(time)
            return sample, sample.until(self.sample(middle))
        points = self._kernel.sample(time, middle)
        assert points is not None
        now, late = self.contacts_at(time), self.contacts_at(middle)
        foot = self.swing_foot
        return PlanSample.of_point(time, points[0], now, foot), PlanSample.of_point(middle, points[1], late, foot)

    def goes_to(self, time: float, middle: float) -> bool:
        """Go to the interval of an instant, if another one is in the same, with the swing foot landed or not [s]."""
        place = self._place(time)
        if self._place(middle) != place:
            return False
        self._go_to(place)
        return True

    def _place(self, time: float) -> tuple[int, bool]:
        """The interval of an instant, and whether the swing foot has landed by then."""
        interval = int((time - self.plan.time) / self.plan.sample_time + 1e-6)
        return min(max(interval, 0), self._last), time >= self._touchdown

    def _go_to(self, place: tuple[int, bool]) -> None:
        if place != self._entered:
            self._enter(*place)

    def contacts_at(self, time: float) -> tuple[bool, bool]:
        """Planned contacts at an instant of the interval that was sampled last [s]."""
        return self.contacts if time < self.lands or self._entered[0] else (True, True)

    def _enter(self, i: int, landed: bool) -> None:
        """Prepare an interval: contacts, the foot that swings, and all functions of time."""
        plan = self.plan
        self._entered, self._start = (i, landed), plan.time + i * plan.sample_time
        left, right = plan.contacts[i].tolist()
        self.contacts, self.swing_foot, swing = (left, right), None, None
        if plan.swing is not None and not plan.contacts[i, plan.swing.foot]:
            self.swing_foot = plan.swing.foot
            since = max(self._start, plan.swing.touchdown_time) if landed else self._start
            swing = plan.swing.coefficients(since)
            if self._kernel is None or since != self._start:
                swing = shifted(swing, self._start - since)
        if self._kernel is None:
            self._table = self._tabulated(i, swing)
        else:
            quantities = (
                plan.com, plan.com_velocity, plan.com_acceleration,
                plan.zmp_reference, plan.zmp_offset, plan.omega, plan.stiffness, plan.load_left,
            )  # fmt: skip
            foot = -1 if self.swing_foot is None else int(self.swing_foot)
            self._kernel.enter(i, landed, self._start, quantities, plan.jerk[i], foot, swing)

    def _tabulated(self, i: int, swing: Array | None) -> Array:
        """An interval: 7 linear functions, 9 polynomials and their two derivatives as columns."""
        plan, t = self.plan, self.plan.sample_time
        table = np.zeros((6, COLUMNS))
        linear, motion, rates, bends = table[:, :7], table[:, 7:16], table[:, 16:25], table[:, 25:]
        for row, k in enumerate((i, i + 1)):
            linear[row, :2], linear[row, 2:4] = plan.zmp_reference[k], plan.zmp_offset[k]
            linear[row, 4:] = plan.omega[k], plan.stiffness[k], plan.load_left[k]
        linear[1] = (linear[1] - linear[0]) / t
        motion[0, :2], motion[1, :2] = plan.com[i, :2], plan.com_velocity[i, :2]
        motion[2, :2], motion[3, :2] = 0.5 * plan.com_acceleration[i, :2], plan.jerk[i] / 6.0
        heights = np.stack(
            (plan.com[i : i + 2, 2], plan.com_velocity[i : i + 2, 2], plan.com_acceleration[i : i + 2, 2])
        )
        motion[:, 2] = quintic(heights[:, :1], heights[:, 1:], t)[:, 0]
        if swing is not None:
            motion[:, 3:] = swing
        rates[:5] = _DERIVATIVE * motion[1:]
        bends[:4] = _DERIVATIVE[:4] * rates[1:5]
        return table


_DERIVATIVE = np.arange(1.0, 6.0)[:, None]
