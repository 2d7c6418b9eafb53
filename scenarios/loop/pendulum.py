"""The closed loop of fidelity pendulum: the same planner on a point mass with ideal feet."""

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.geometry import convex_hull, sole_corners
from surefoot.planner.parameters import LegInertia
from surefoot.planner.plan import PlanSample, PlanSampler
from surefoot.planner.plants import CartTable, IdealFeet, Pendulum, PointPush
from surefoot.planner.types import GRAVITY, CentroidalState, Foot, Footstep, PhaseInfo
from surefoot.scenarios.file.schema import PendulumSettings, Scenario
from surefoot.scenarios.judge.walking import LOST_DISTANCE
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.loop.planning import Planning
from surefoot.scenarios.loop.sensing import PlannerSensing
from surefoot.scenarios.loop.skeleton import End, FaultSchedule, OnProgress, RunFault, Watch, refusing, run_ticks
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.foxglove.views import PointView
from surefoot.scenarios.record.walk import PendulumRecorder, TickTiming, WalkRecorder
from surefoot.scenarios.setup.gait import push_time, run_duration
from surefoot.scenarios.setup.ground import start_com_height, terrain_of
from surefoot.scenarios.setup.planner import planner_parameters, square_stance, walking_planner

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


Array = NDArray[np.float64]


class Plant(Protocol):
    """A point mass that follows plans.

    Attributes:
        position: horizontal position, shape (2,) [m].
        velocity: shape (2,) [m/s].
        zmp: ZMP of the last tick, shape (2,) [m].
    """

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

    def __init__(self, mass: float, position: Array, height_error: float, feedback: float) -> None:
        super().__init__(mass, position, np.zeros(2))
        self._height_error, self._feedback = height_error, feedback

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`), held at what it says of the middle of the tick."""
        start, middle = sampler.sample(now), sampler.sample(now + 0.5 * period)
        error = self.position + self.velocity / start.omega - start.dcm
        command = middle.pendulum_zmp + self._feedback * error
        self.advance(period, command, support, true_stiffness(middle, self._height_error), force)


class CartTablePlant(CartTable):
    """The cart-table, which needs neither low level nor support.

    Args:
        mass: true mass [kg].
        position: where it rests at the start, shape (2,) [m].
        height_error: believed minus true CoM height [m].
    """

    def __init__(self, mass: float, position: Array, height_error: float) -> None:
        super().__init__(mass, position)
        self._height_error = height_error

    def drive(self, sampler: PlanSampler, now: float, period: float, support: Array, force: Array) -> None:
        """Follow the plan (see `Plant`); between two ticks the planned jerk is constant."""
        start, end = sampler.sample(now), sampler.sample(now + period)
        jerk = (end.com_acceleration[:2] - start.com_acceleration[:2]) / period
        self.advance(period, jerk, true_stiffness(end, self._height_error), force)


def plant(settings: PendulumSettings, mass: float, position: Array, height_error: float) -> Plant:
    """The plant that a scenario asks for; arguments as of the plants."""
    if settings.plant == "cart_table":
        return CartTablePlant(mass, position, height_error)
    return PendulumPlant(mass, position, height_error, settings.feedback)


def true_stiffness(sample: PlanSample, height_error: float) -> float:
    """λ = (g + z'') / (z - p_z) of the true CoM height, which is the believed one less its error [1/s^2]."""
    pressing = GRAVITY + float(sample.com_acceleration[2])
    return pressing / (pressing / sample.stiffness - height_error)


def simulate(scenario: Scenario, robot: "RobotDescription", writer: LogWriter, on_progress: OnProgress) -> End:
    """Run a scenario on the pendulum; arguments and errors as of the loop in full physics."""
    with refusing():
        loop = PendulumLoop(scenario, robot, writer)
    return run_ticks(loop, scenario.rates.control, run_duration(scenario), on_progress)


class PendulumLoop:
    """Plant, planner and recorders of one run; the feet do what the plan says.

    The plant's true height is the planned one less the scenario's error of the CoM height.

    Raises:
        ValueError: the planner refuses the gait.
    """

    def __init__(self, scenario: Scenario, robot: "RobotDescription", writer: LogWriter) -> None:
        rates, feet = scenario.rates, square_stance(scenario)
        self._rate, self._height_error = rates.control, scenario.errors.com_height
        mass = robot.mass / scenario.errors.mass_scale
        self._half_size = 0.5 * np.array([robot.sole_length, robot.sole_width])
        parameters = planner_parameters(scenario, LegInertia())
        planner = walking_planner(scenario, robot, terrain_of(scenario), feet, parameters)
        sizes = Sizes(nj=0, nq=0, nv=0, horizon=planner.parameters.horizon)
        self._recorder = PendulumRecorder(writer, sizes, mass)
        self._walk_recorder = WalkRecorder(writer, sizes)
        self._view = PointView(writer, (robot.sole_length, robot.sole_width), rates.control)
        self._faults = FaultSchedule(scenario.faults, rates.control)
        sensing = PlannerSensing(scenario, feet)
        self._planning = Planning(planner, sensing, self._walk_recorder, self._faults, rates)
        self._pushes = tuple(
            PointPush(push_time(scenario.gait, push), push.duration, np.array(push.force[:2]))
            for push in scenario.pushes
        )
        self._feet = IdealFeet(feet)
        self._plant = plant(scenario.pendulum, mass, start_position(scenario), self._height_error)
        self._can_fall = scenario.pendulum.plant == "pendulum"
        self._height, self._climb = start_com_height(scenario), 0.0
        self._contacts, self._support = (False, False), np.zeros((0, 2))

    @property
    def phase(self) -> PhaseInfo:
        """Where the gait stands."""
        return self._planning.phase

    def tick(self, tick: int) -> bool:
        """One control tick; returns whether no foot could catch the mass any more.

        Raises:
            RunFault: the measured state is not finite.
        """
        watch = Watch.start()
        begin = watch.last
        now, now_ns, period = tick / self._rate, tick * 1_000_000_000 // self._rate, 1.0 / self._rate
        state = self._sense(now, tick)
        planning = self._planning
        state_time = watch.lap()
        planner_time = 0.0
        if planning.due(tick):
            planning.update(tick, now_ns, self._believed(state), self._plant.zmp, self._feet.state)
            planner_time = watch.lap()
        sample = planning.sampler.sample(now)
        force = mean_force(self._pushes, now, period)
        support = self._support_of(sample.contacts)
        self._recorder.state(now_ns, state, self._feet.state, force)
        self._recorder.contact(now_ns, self._plant.zmp, sample, self._feet.state)
        self._walk_recorder.reference(now_ns, planning.plan, sample)
        lost = self._lost(state, sample.omega)
        plan, zmp = planning.plan, self._plant.zmp
        self._view.events(now_ns, sample.contacts, force, plan, lost)
        self._view.picture(tick, now_ns, state.com, state.com_velocity, zmp, plan, sample)
        log_time = watch.lap()
        self._advance(now, period, support, force)
        parts = (state_time, 0.0, 0.0, planner_time, watch.lap(), log_time)
        self._walk_recorder.timing(now_ns, TickTiming(*parts, watch.last - begin))
        return lost

    def _sense(self, now: float, tick: int) -> CentroidalState:
        position = np.append(self._plant.position, self._height - self._height_error)
        velocity = np.append(self._plant.velocity, self._climb)
        if self._faults.active("state_nan", tick) or not math.isfinite(float(position.sum() + velocity.sum())):
            raise RunFault(f"the measured state is not finite at {now:.3f} s")
        return CentroidalState(now, position, velocity)

    def _believed(self, state: CentroidalState) -> CentroidalState:
        return CentroidalState(state.time, np.append(state.com[:2], self._height), state.com_velocity)

    def _advance(self, now: float, period: float, support: Array, force: Array) -> None:
        """Drive the plant through the tick, then move feet and height to its end."""
        sampler = self._planning.sampler
        self._plant.drive(sampler, now, period, support, force)
        end = sampler.sample(now + period)
        self._height, self._climb = float(end.com[2]), float(end.com_velocity[2])
        self._feet.follow(sampler, now + period)

    def _support_of(self, contacts: tuple[bool, bool]) -> Array:
        """Hull of the soles in contact, shape (v, 2); they rest, so it changes with the contacts only."""
        if contacts != self._contacts:
            feet = self._feet.state
            soles = [Footstep(foot, feet.position[foot], float(feet.yaw[foot])) for foot in Foot if contacts[foot]]
            self._support = convex_hull(np.concatenate([sole_corners(sole, self._half_size) for sole in soles]))
            self._contacts = contacts
        return self._support

    def _lost(self, state: CentroidalState, omega: float) -> bool:
        dcm = state.com[:2] + state.com_velocity[:2] / omega
        return self._can_fall and bool(np.hypot(*(dcm - self._plant.zmp)) > LOST_DISTANCE)


def start_position(scenario: Scenario) -> Array:
    """Where the mass rests at the start: over the middle of the feet, with the start noise, shape (2,) [m]."""
    start = scenario.start
    noise = np.random.default_rng(scenario.seed).uniform(-start.position_noise, start.position_noise, 2)
    return np.array([start.x, start.y]) + noise


def mean_force(pushes: tuple[PointPush, ...], time: float, period: float) -> Array:
    """Mean of the pushes from an instant on for a period, so that their impulses are exact, shape (2,) [N]."""
    total = np.zeros(2)
    for push in pushes:
        overlap = min(time + period, push.time + push.duration) - max(time, push.time)
        if overlap > 0.0:
            total += overlap / period * push.force
    return total
