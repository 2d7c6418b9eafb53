"""The closed loop of fidelity pendulum: the same planner on a point mass with ideal feet."""

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.maths.polygon import convex_hull
from surefoot.planner.geometry.plane import sole_corners
from surefoot.planner.model.dcm import dcm
from surefoot.planner.parameters import LegInertia
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import PlanSample
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.plants import CartTable, IdealFeet, Pendulum
from surefoot.planner.types import GRAVITY, CentroidalState, FeetState, Foot, Footstep
from surefoot.scenarios.file.schema import PendulumSettings
from surefoot.scenarios.judge.body import lost
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.foxglove.views import PointView
from surefoot.scenarios.record.walk import PendulumRecorder, WalkRecorder
from surefoot.scenarios.run.planning import FaultSchedule, Measured, Planned, Planning, RunFault
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.run.tick import Look, Spent
from surefoot.scenarios.setup.walk import Walk

Array = NDArray[np.float64]


class Plant(Protocol):
    """A point mass that follows plans.

    Attributes:
        can_fall: whether its DCM may get out of reach of any foot.
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last tick, shape (2,) [m].
    """

    can_fall: bool
    position: Array
    velocity: Array
    zmp: Array

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan for a control tick.

        Args:
            sampler: of the plan.
            now: begin of the tick [s].
            period: its length [s].
            support: real support polygon, anticlockwise, shape (v, 2) [m].
            force: mean push during the tick, shape (2,) [N].
        """


class PendulumPlant(Pendulum):
    """The true pendulum under a low level that commands p = p_ref + k (ξ - ξ_ref), clipped to the real support.

    The low level knows the true state and believes the plan's height, as the whole-body controller does.

    Args:
        mass: true mass [kg].
        position: where it rests at the start, shape (2,) [m].
        height_error: believed minus true CoM height [m].
        feedback: k [-].
    """

    can_fall = True

    def __init__(self, mass: float, position: Array, height_error: float, feedback: float) -> None:
        super().__init__(mass, position, np.zeros(2))
        self._height_error, self._feedback = height_error, feedback

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`), held at what it says of the middle of the tick."""
        start, middle = sampler.sample(now), sampler.sample(now + 0.5 * period)
        error = dcm(self.position, self.velocity, start.omega) - start.dcm
        command = middle.pendulum_zmp + self._feedback * error
        self.advance(period, command, support, true_stiffness(middle, self._height_error), force)


class CartTablePlant(CartTable):
    """The cart-table, which needs neither low level nor support.

    Args:
        mass: true mass [kg].
        position: where it rests at the start, shape (2,) [m].
        height_error: believed minus true CoM height [m].
    """

    can_fall = False

    def __init__(self, mass: float, position: Array, height_error: float) -> None:
        super().__init__(mass, position)
        self._height_error = height_error

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`); between two ticks the planned jerk is constant."""
        start, end = sampler.sample(now), sampler.sample(now + period)
        jerk = (end.com_acceleration[:2] - start.com_acceleration[:2]) / period
        self.advance(period, jerk, true_stiffness(end, self._height_error), force)


def plant(settings: PendulumSettings, mass: float, position: Array, height_error: float) -> Plant:
    """The plant that a scenario asks for."""
    if settings.plant == "cart_table":
        return CartTablePlant(mass, position, height_error)
    return PendulumPlant(mass, position, height_error, settings.feedback)


def true_stiffness(sample: PlanSample, height_error: float) -> float:
    """λ = (g + z'') / (z - p_z) of the true CoM height, which is the believed one less its error [1/s^2]."""
    pressing = GRAVITY + float(sample.com_acceleration[2])
    return pressing / (pressing / sample.stiffness - height_error)


def pendulum_loop(walk: Walk, writer: LogWriter) -> ClosedLoop:
    """Put the parts of one run on the pendulum together; the feet do what the plan says.

    Args:
        walk: what to run.
        writer: gets every boundary crossing.

    Raises:
        ValueError: the planner refuses the gait.
    """
    planner = walk.planner(walk.ground.stance, LegInertia())
    sizes = Sizes(nj=0, nq=0, nv=0, horizon=planner.parameters.horizon)
    point_recorder, recorder = PendulumRecorder(writer, sizes, walk.true_mass), WalkRecorder(writer, sizes)
    view = PointView(writer, walk.sole, walk.rates.control)
    planning = Planning.of(walk, planner)
    planning.recorder = recorder
    return ClosedLoop.of(walk, PointMass(walk, planning, point_recorder, view), recorder)


class PointMass(Planned):
    """A point mass on ideal feet; a `Walker`.

    The plant's true height is the planned one less the error of the CoM height.

    Args:
        walk: what is run.
        planning: its planner.
        recorder: of its channels.
        view: of what MCAP viewers show.

    Attributes:
        planning: its planner.
        state: true state of this tick.
        zmp: true ZMP, shape (2,) [m].
        feet: the ideal feet.
    """

    controller = None

    def __init__(self, walk: Walk, planning: Planning, recorder: PendulumRecorder, view: PointView) -> None:
        self.planning = planning
        self._recorder, self._view = recorder, view
        self._period, self._height_error = 1.0 / walk.rates.control, walk.height_error
        self._half_size = 0.5 * np.array(walk.sole)
        self._faults = FaultSchedule(walk.faults, walk.rates.control)
        self._pushes = list(walk.pushes)
        self._feet = IdealFeet(walk.ground.stance)
        self._plant = plant(walk.pendulum, walk.true_mass, start_position(walk), self._height_error)
        self._height, self._climb, self._length = walk.start_com_height, 0.0, walk.size.length
        self._contacts, self._support = (False, False), np.zeros((0, 2))
        self._sample: PlanSample
        self._force = np.zeros(2)
        self._now = 0.0
        self.state: CentroidalState

    @property
    def zmp(self) -> Array:
        """True ZMP of the last tick, shape (2,) [m]."""
        return self._plant.zmp

    @property
    def feet(self) -> FeetState:
        """The feet."""
        return self._feet.state

    def sense(self, tick: int, now: float) -> int:
        """See `Walker`."""
        position = np.append(self._plant.position, self._height - self._height_error)
        velocity = np.append(self._plant.velocity, self._climb)
        if self._faults.active("state_nan", tick) or not math.isfinite(float(position.sum() + velocity.sum())):
            raise RunFault(f"the measured state is not finite at {now:.3f} s")
        self.state, self._now = CentroidalState(now, position, velocity), now
        return tick

    def measured(self) -> Measured:
        """The state that the planner may measure."""
        state = self.state
        believed = CentroidalState(state.time, np.append(state.com[:2], self._height), state.com_velocity)
        return believed, self._plant.zmp, self._feet.state

    def control(self, tick: int, now: float) -> tuple[PlanSample, Spent]:
        """See `Walker`."""
        spent = self.planning.follow(now, self.measured) if now >= self.planning.due else 0.0
        sample, until = self.planning.sampler.tick(now, now + 0.5 * self._period)
        self._force = mean_force(self._pushes, self._now, self._period)
        self._support = self._support_of(until.contacts)
        return sample, Spent(plan=spent)

    def record(self, now_ns: int, sample: PlanSample) -> None:
        """See `Walker`."""
        self._recorder.state(now_ns, self.state, self._feet.state, self._force)
        self._recorder.contact(now_ns, self._plant.zmp, sample, self._feet.state)

    def fallen(self, sample: PlanSample) -> bool:
        """Return true if no foot could catch the mass any more."""
        true_dcm = dcm(self.state.com[:2], self.state.com_velocity[:2], sample.omega)
        return self._plant.can_fall and bool(lost(true_dcm, self._plant.zmp, self._length))

    def draw(self, tick: int, now_ns: int, plan: WalkPlan, sample: PlanSample, fallen: bool) -> None:
        """See `Walker`."""
        self._view.events(now_ns, sample.contacts, self._force, plan, fallen)
        state = self.state
        self._view.picture(tick, now_ns, state.com, state.com_velocity, self._plant.zmp, plan, sample)

    def advance(self, now: float) -> None:
        """Drive the plant through the tick, then move feet and height to its end."""
        period, sampler = self._period, self.planning.sampler
        self._plant.drive(sampler, now, period, self._support, self._force)
        end = sampler.sample(now + period)
        self._height, self._climb = float(end.com[2]), float(end.com_velocity[2])
        self._feet.follow(sampler, now + period)

    def look(self) -> Look:
        """See `Walker`."""
        return Look(self.state.com, self.state.com_velocity, self._plant.zmp)

    def push(self, push: Push) -> None:
        """See `Walker`."""
        if push.force[2] != 0.0:
            raise ParameterError(
                ("force",), "a vertical push on a pendulum, whose height is prescribed", "use [x, y, 0]"
            )
        self._pushes.append(push)
        self._force = mean_force(self._pushes, self._now, self._period)  # it may begin in this tick

    def _support_of(self, contacts: tuple[bool, bool]) -> Array:
        """Hull of the soles in contact, shape (v, 2); they rest, so it changes with the contacts only."""
        if contacts != self._contacts:
            feet = self._feet.state
            soles = [Footstep(foot, feet.position[foot], float(feet.yaw[foot])) for foot in Foot if contacts[foot]]
            self._support = convex_hull(np.concatenate([sole_corners(sole, self._half_size) for sole in soles]))
            self._contacts = contacts
        return self._support


def start_position(walk: Walk) -> Array:
    """Start of the mass: at rest over the middle of the feet, with the start noise, shape (2,) [m]."""
    start = walk.start
    noise = np.random.default_rng(walk.seed).uniform(-start.position_noise, start.position_noise, 2)
    return np.array([start.x, start.y]) + noise


def mean_force(pushes: Sequence[Push], time: float, period: float) -> Array:
    """Horizontal mean of the pushes from an instant on for a period, impulses exact, shape (2,) [N]."""
    total = np.zeros(2)
    for push in pushes:
        overlap = min(time + period, push.time + push.duration) - max(time, push.time)
        if overlap > 0.0:
            total += overlap / period * push.force[:2]
    return total
