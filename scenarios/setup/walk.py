"""The walk that a scenario means, each part derived once, for the layers below; nobody there sees a scenario."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from operator import index
from typing import TYPE_CHECKING, Any

from surefoot.forces import Push
from surefoot.models.facts import RobotFacts, facts_of, size_of, stance_widening
from surefoot.planner.check import check_walk
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.parameters import LegInertia, PlannerParameters
from surefoot.planner.plan.plan import Planner
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.commands import Command, fitted
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import FeetState, Twist
from surefoot.scenarios.file.control import ControlSettings, SeatSettings
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.group import controller_parameters
from surefoot.scenarios.file.schema import (
    Fault,
    InstrumentSettings,
    LogSettings,
    PendulumSettings,
    PushSettings,
    Rates,
    Scenario,
    Start,
)
from surefoot.scenarios.file.sensing import Sensing
from surefoot.scenarios.setup.groups.formulation import (
    Formulation,
    catching_height,
    cop_room,
    leg_reach,
    lowered,
    region_of,
)
from surefoot.scenarios.setup.groups.gait import (
    FINAL_STAND,
    PushPoint,
    command_of,
    commanded_until,
    gait_of,
    push_force,
    step_region,
    there_at,
    waypoints_of,
)
from surefoot.scenarios.setup.groups.hardware import Hardware
from surefoot.scenarios.setup.keys import FIDELITIES, Fidelity
from surefoot.scenarios.setup.parts import guarded_law
from surefoot.scenarios.setup.robot.robots import describe, true_robot
from surefoot.scenarios.setup.terrain import kind_of
from surefoot.scenarios.setup.terrain.ground import Ground, tiles_of, tilt_of
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.parameters import WbcParameters

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""


@dataclass(frozen=True, eq=False)
class Walk:
    """Everything that a run is made of, and what the checks look at before anyone knows whether it can be run.

    What "is believed" is what planner and controller are given; the simulated world may differ. Each part is derived
    once, when it is first asked for, and raises `ParameterError` where the keys refuse it; of a walk that `resolve`
    gives all have been.

    Attributes:
        keys: the scenario as the user wrote it; nobody below this room sees it.
        size: of its robot, without what it carries.
        wider: by what that has to stand wider than the reference robot, scaled [m].
        foot_length: of its soles where it is known without the scenario, which that of the reference is not [m].
        described: a robot in place of the one that the scenario names.
        given: a profile in place of the planner's profile that it names.
    """

    keys: Scenario
    size: Similarity = REFERENCE_SIZE
    wider: float = 0.0
    foot_length: float | None = None
    described: "RobotDescription | None" = None
    given: Profile | None = None

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.keys.name

    @property
    def fidelity(self) -> str:
        """Full or pendulum."""
        return self.keys.fidelity

    @property
    def seed(self) -> int:
        """Seed of everything random."""
        return self.keys.seed

    @property
    def rates(self) -> Rates:
        """Rates of the clock."""
        return self.keys.rates

    @property
    def start(self) -> Start:
        """Start of the walk, with its noises."""
        return self.keys.start

    @property
    def sensing(self) -> Sensing:
        """The knowledge of the robot for planner and controller."""
        return self.keys.sensing

    @property
    def instruments(self) -> tuple[InstrumentSettings, ...]:
        """Instruments that read into the log."""
        return self.keys.instruments

    @property
    def faults(self) -> tuple[Fault, ...]:
        """Injected."""
        return self.keys.faults

    @property
    def pendulum(self) -> PendulumSettings:
        """The plant of fidelity pendulum."""
        return self.keys.pendulum

    def __reduce__(self) -> tuple[type["Walk"], tuple[Any, ...]]:
        """Survive the way between processes; what is derived is derived anew."""
        return type(self), (self.keys, self.size, self.wider, self.foot_length, self.described, self.given)

    @property
    def text(self) -> str:
        """The scenario as run, in YAML."""
        return scenario_yaml(self.keys)

    @property
    def walker(self) -> Fidelity:
        """The fidelity of the thing that walks."""
        return FIDELITIES[self.keys.walker]

    @property
    def takes_commands(self) -> bool:
        """True if the walk is commanded while it goes on, so that its steps are not known before."""
        return bool(self.keys.gait.waypoints or self.keys.commands)

    @cached_property
    def asked_gait(self) -> GaitParameters:
        """The gait in the planner's terms, its strides as wide as asked for."""
        return gait_of(self.keys.gait)

    @cached_property
    def gait(self) -> GaitParameters:
        """The gait: the strides of a velocity are as wide as feet may land."""
        if not self.keys.gait.velocity:
            return self.asked_gait
        return fitted(self.asked_gait, step_region(self.formulation.parameters, self.sole, self.robot.shank_spacing))

    @cached_property
    def waypoints(self) -> tuple[Twist, ...]:
        """Places in the world to go to one after another, as the first of the commands says."""
        return waypoints_of(self.keys.gait, self.start)

    @cached_property
    def commands(self) -> tuple[Command, ...]:
        """All that the walk hears while it goes on, the waypoints at its start."""
        start = (Command(places=self.waypoints),) if self.waypoints else ()
        return (*start, *map(command_of, self.keys.commands))

    @cached_property
    def gait_duration(self) -> float:
        """Until the end of the last double support, or until the robot stands after all of its commands [s]."""
        end = max(
            [self.asked_gait.duration, *(commanded_until(self.asked_gait, command) for command in self.keys.commands)]
        )
        if not self.waypoints:
            return end
        start = Twist(self.start.x, self.start.y, self.start.yaw)
        return max(end, there_at(self.asked_gait, start, self.waypoints, self.formulation.parameters))

    @cached_property
    def duration(self) -> float:
        """Simulated time: as given, or the gait and a while of standing [s]."""
        return self.gait_duration + FINAL_STAND * self.size.time if self.keys.duration is None else self.keys.duration

    @cached_property
    def pushes(self) -> tuple[Push, ...]:
        """Pushes on bodies, world frame, that begin at a time."""
        return tuple(self._push(push) for push in self.keys.pushes if PushPoint.of(push) is None)

    @cached_property
    def gait_pushes(self) -> tuple[tuple[PushPoint, Push], ...]:
        """Pushes that begin at a point of the gait, whenever it is reached; their time means nothing."""
        pointed = ((PushPoint.of(push), push) for push in self.keys.pushes)
        return tuple((point, self._push(push)) for point, push in pointed if point is not None)

    def _push(self, push: PushSettings) -> Push:
        body = push.body or self.robot.torso_body
        return Push(push.time or 0.0, push.duration, push_force(push, self.true_mass), body)

    @cached_property
    def ground(self) -> Ground:
        """The ground, and where the walk begins on it."""
        keys = self.keys
        return Ground(
            kind=kind_of(keys.terrain.kind),
            keys=keys.terrain,
            steps=keys.gait,
            gait=self.asked_gait,
            start=keys.start,
            seed=keys.seed,
            size=self.size,
            sole=keys.robot_options.foot_length or self.foot_length,
            standing_height=self.standing_height,
            tiles=tiles_of(keys, self.size) if self.walker.has_body else None,
            hidden=keys.errors.ground or (),
            tilt=tilt_of(keys, self.size) if self.walker.has_body else None,
        )

    @property
    def unforeseen(self) -> Mapping[str, tuple[int, ...]]:
        """Numbers of the boxes of the simulated ground that lie elsewhere than believed, by the key that does it."""
        return self.ground.unforeseen if self.walker.has_body else {}

    @property
    def standing_height(self) -> float:
        """CoM height over the soles at which the walk begins and ends [m]."""
        return self.keys.gait.com_height - lowered(self.keys.planner, self.size)

    @cached_property
    def formulation(self) -> Formulation:
        """The scenario's planner."""
        return Formulation(self.keys.planner, self.ground, self.size, self.wider, self.walker.rise, self.given)

    @property
    def start_com_height(self) -> float:
        """CoM height in the world at the start [m]."""
        return self.ground.start_height + self.standing_height

    @cached_property
    def parameters(self) -> PlannerParameters:
        """Parameters of the planner, for legs without inertia.

        Adaptation leaves at least half the planned gap between soles.
        """
        asked = self.formulation.parameters
        near, far = asked.reach_width
        apart = max(near, self.robot.sole_width + 0.5 * asked.recovery.sole_gap)
        return replace(asked, reach_width=(apart, far))

    @property
    def filter(self) -> str:
        """Filter of the planner's state: none, kalman or zmp_only; the Kalman filter by default if there is noise."""
        noisy = self.sensing.zmp_noise > 0.0 or self.sensing.com_noise > 0.0
        return self.keys.planner.filter or ("kalman" if noisy else "none")

    @property
    def region(self) -> StepRegion:
        """Region in which a step that is commanded while it walks may land."""
        return region_of(self.parameters, self.facts, self.gait.com_height)

    @property
    def legs(self) -> LegReach:
        """The reach of the legs that catch the body."""
        height = catching_height(self.keys.planner, self.facts, self.gait.com_height)
        return leg_reach(self.parameters, self.facts, height, self.standing_height)

    def planner(self, feet: FeetState, leg: LegInertia) -> Planner:
        """The planner of this walk, of feet and legs at its start: the profile's own, or the walking one with its law.

        Raises:
            ParameterError: it cannot plan this gait.
            PartError: the profile, of others, fails to make it.
        """
        authority = math.inf, 0.0 if self.robot.roles.feet_lean else math.inf
        room = cop_room(leg, self.facts, self.robot.mass)
        toes = room[0] >= 0.5 * self.robot.sole_length
        parameters = replace(self.parameters, leg=leg, cop_room=room, cop_authority=authority, toes_bear=toes)
        given = (self.gait, feet, *self.sole, self.ground.terrain, parameters, self.formulation.heights)
        profile = guarded_law(self.formulation.profile, self.formulation.guard)
        if profile.planner is not None:
            with self.formulation.guard.making:
                planner = profile.planner(*given, profile)
                index(planner.parameters.horizon)
                return planner
        planner = WalkingPlanner(*given, replace(profile, rules=self.formulation.rules), self.region, self.legs)
        check_walk(planner.schedule, self.formulation.heights)
        return planner

    @cached_property
    def robot(self) -> "RobotDescription":
        """The robot as believed."""
        return self.described or describe(self.keys.robot, self.keys.robot_options)

    @property
    def facts(self) -> RobotFacts:
        """The facts of the robot that bound a walk."""
        return facts_of(self.robot)

    @property
    def sole(self) -> tuple[float, float]:
        """Length and width of the soles [m]."""
        return self.robot.sole_length, self.robot.sole_width

    @cached_property
    def _truth(self) -> "RobotDescription":
        return true_robot(self.keys.errors, self.keys.motors, self.robot, self.seed)

    @property
    def true_robot(self) -> "RobotDescription":
        """The robot as simulated; the same object when nothing about it is believed wrongly."""
        return self._truth if self.walker.has_body else self.robot

    @property
    def true_mass(self) -> float:
        """Mass of the robot as it is [kg]."""
        return float(self._truth.mass)

    @property
    def height_error(self) -> float:
        """Believed minus true CoM height [m]."""
        return self.keys.errors.com_height

    @property
    def true_com_height(self) -> float:
        """Nominal, above the soles [m]."""
        return self.keys.gait.com_height - self.height_error

    @property
    def friction(self) -> float:
        """Coefficient that the controller counts on [-]."""
        keys = self.keys
        if keys.wbc is not None and keys.wbc.friction is not None:
            return keys.wbc.friction
        return max(keys.terrain.friction + keys.errors.friction, LEAST_BELIEVED_FRICTION)

    @cached_property
    def controller(self) -> WbcParameters:
        """Weights and gains of the whole-body controller."""
        return controller_parameters(self.keys.wbc, self.size)

    @property
    def control(self) -> ControlSettings:
        """The commands to the joints."""
        return self.keys.control or ControlSettings()

    @cached_property
    def hardware(self) -> Hardware:
        """The errors of sensors and motors that no part of the controller knows."""
        return Hardware.of(self.sensing, self.keys.motors, self.size)

    @property
    def seat(self) -> SeatSettings | None:
        """The controller in the seat of planner and whole-body controller; None where they have it themselves."""
        return self.keys.controller

    @property
    def log(self) -> LogSettings:
        """The part of the run that its log holds."""
        return self.keys.log or LogSettings()

    @property
    def tasks(self) -> tuple[str, ...]:
        """Names of tasks of other packages in its QP."""
        return self.keys.wbc.tasks if self.keys.wbc is not None else ()


def resolve(scenario: Scenario, robot: "RobotDescription | None" = None, profile: Profile | None = None) -> Walk:
    """Resolve a checked scenario into its walk, with a robot and a profile, if given, in place of those that it names.

    Raises:
        ParameterError: a part refuses its parameters.
    """
    robot = robot or describe(scenario.robot, scenario.robot_options)
    size = size_of(robot, scenario.robot_options.payload_mass)
    own = None if size == REFERENCE_SIZE else float(robot.sole_length)
    walk = Walk(scenario, size, stance_widening(robot, size), own, robot, profile)
    for room in (walk, walk.ground, walk.formulation):
        for name, part in vars(type(room)).items():
            if isinstance(part, cached_property):
                getattr(room, name)
    return walk
