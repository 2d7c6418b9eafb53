"""A scenario resolved: what it means, computed once, in the terms of the layers below; nobody there sees a scenario."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from operator import index
from typing import TYPE_CHECKING

import numpy as np
import yaml

from surefoot.guard import Guard
from surefoot.planner.check import check_walk
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.parameters import LegInertia, PlannerParameters
from surefoot.planner.plan import Planner
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.com_height import HeightProfile
from surefoot.planner.steps.commands import Pose, TimedCommand
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach, StepRegion
from surefoot.planner.types import GRAVITY, Array, FeetState
from surefoot.scenarios.file.group import controller_parameters
from surefoot.scenarios.file.schema import Fault, PendulumSettings, PushSettings, Rates, Scenario, Sensing, Start
from surefoot.scenarios.record.provenance import Agenda
from surefoot.scenarios.setup.checks import notes
from surefoot.scenarios.setup.commands import told, waypoints
from surefoot.scenarios.setup.draft import Draft
from surefoot.scenarios.setup.events import events
from surefoot.scenarios.setup.gait import PushPoint, leg_span, step_region
from surefoot.scenarios.setup.parts import guarded_law, profile_guard
from surefoot.scenarios.setup.robot import describe, facts_of, size_of, stance_widening, true_robot
from surefoot.sim.pushes import Push
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.parameters import WbcParameters

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription

LEG_SHARE = 0.9
"""Share of the span of the legs that steps on command make use of: with all of it both are straight at touchdown, and
at 0.88 m/s a push felled the robot that it took at 0.65 to 0.8 m/s [-]."""

ANKLE_SHARE = 0.85
"""Share of an ankle's torque that bears the robot with the CoP at the edge of its room; the rest is for shocks [-]."""

LEAST_ROOM = 0.15
"""Room of the CoP that a planner needs in any case, of the sole to each side [-]."""

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """Everything that a run is made of.

    What "is believed" is what planner and controller are told; the simulated world may differ.

    Attributes:
        name: of the scenario.
        text: the scenario as run, in YAML.
        fidelity: full or pendulum.
        seed: of everything random.
        duration: simulated time [s].
        gait_duration: until the end of the last double support [s].
        rates: of the clock.
        robot: as believed.
        true_robot: as simulated; the same object when nothing about it is believed wrongly.
        true_mass: [kg].
        true_com_height: nominal, above the soles [m].
        height_error: believed minus true CoM height [m].
        friction: as believed [-].
        gait: what is walked.
        heights: law of the CoM height.
        standing_height: CoM over the soles at begin and end [m].
        terrain: the ground as believed.
        true_terrain: the ground as simulated.
        terrain_kind: name of its kind.
        unforeseen: numbers of the boxes of the simulated ground that lie elsewhere than believed, by the key that has
            put them there.
        start: where the walk starts, with its noises.
        start_height: of the ground there [m].
        stance: the feet there, side by side.
        profile: formulation of the planner.
        guard: stands around the calls of what the profile brings.
        parameters: of the planner, for legs without inertia.
        controller: weights and gains of the whole-body controller.
        tasks: of other packages in its QP, by name.
        sensing: noises of what is measured.
        filter: filter of the planner's state: none, kalman or zmp_only.
        waypoints: places in the world to go to one after another, as the first of the commands says.
        commands: that the walk hears while it goes on.
        pushes: on bodies, world frame, that begin at a time.
        gait_pushes: those that begin at a point of the gait, whenever it is reached.
        faults: injected.
        pendulum: the plant of fidelity pendulum.
        agenda: what is to happen, as its log tells it.
    """

    name: str
    text: str
    fidelity: str
    seed: int
    duration: float
    gait_duration: float
    rates: Rates
    robot: "RobotDescription"
    true_robot: "RobotDescription"
    true_mass: float
    true_com_height: float
    height_error: float
    friction: float
    gait: GaitParameters
    heights: HeightProfile
    standing_height: float
    terrain: Terrain
    true_terrain: Terrain
    terrain_kind: str
    unforeseen: Mapping[str, tuple[int, ...]]
    start: Start
    start_height: float
    stance: FeetState
    profile: Profile
    guard: Guard
    parameters: PlannerParameters
    controller: WbcParameters
    tasks: tuple[str, ...]
    sensing: Sensing
    filter: str
    waypoints: tuple[Pose, ...]
    commands: tuple[TimedCommand, ...]
    pushes: tuple[Push, ...]
    gait_pushes: tuple[tuple[PushPoint, Push], ...]
    faults: tuple[Fault, ...]
    pendulum: PendulumSettings
    agenda: Agenda

    @property
    def size(self) -> Similarity:
        """Of the robot, without what it carries."""
        return self.parameters.size

    @property
    def start_com_height(self) -> float:
        """CoM height in the world at the start [m]."""
        return self.start_height + self.standing_height

    @property
    def sole(self) -> tuple[float, float]:
        """Length and width of the soles [m]."""
        return self.robot.sole_length, self.robot.sole_width

    @property
    def region(self) -> StepRegion:
        """Where a step that is commanded while it walks may land: within reach of planner and, with some left, legs."""
        facts = facts_of(self.robot)
        span = LEG_SHARE * leg_span(self.gait.com_height, facts)
        return step_region(self.parameters, self.sole, facts.shank_spacing, span, facts.hip_width)

    @property
    def legs(self) -> LegReach:
        """What the legs can do to catch the body."""
        facts, apart = facts_of(self.robot), self.parameters.reach_width[0]
        radius = 0.5 * LEG_SHARE * leg_span(self.gait.com_height, facts)
        recovery = self.parameters.recovery
        return LegReach(
            radius=radius,
            hip_width=facts.hip_width,
            near=apart,
            across=recovery.across,
            clear=self.robot.sole_length + recovery.clear,
            acceleration=facts.swing_acceleration,
            sole=self.sole,
            height=self.standing_height - facts.com_above_hip,
            length=facts.leg_length,
        )

    def _cop_room(self, leg: LegInertia) -> tuple[float, float]:
        """How far from a sole's centre the ankle's torques bear the robot, ahead and behind, and to both sides [m]."""
        if leg.chain is None:
            return math.inf, math.inf
        levers = [ANKLE_SHARE * torque / (GRAVITY * self.robot.mass) for torque in facts_of(self.robot).ankle_torque]
        ahead, side = (
            max(lever - abs(off), LEAST_ROOM * sole)
            for lever, off, sole in zip(levers, leg.chain.ankle, self.sole, strict=False)
        )
        return ahead, side

    def planner(self, feet: FeetState, leg: LegInertia) -> Planner:
        """The planner of this walk: the profile's own, or the walking planner with the profile's law.

        Args:
            feet: where the feet stand at the start.
            leg: inertia of the legs.

        Raises:
            ParameterError: it cannot plan this gait.
            PartError: the profile, of others, fails to make it.
        """
        authority = math.inf, 0.0 if self.robot.roles.feet_lean else math.inf
        parameters = replace(self.parameters, leg=leg, cop_room=self._cop_room(leg), cop_authority=authority)
        given = (self.gait, feet, *self.sole, self.terrain, parameters, self.heights)
        profile = guarded_law(self.profile, self.guard)
        if profile.planner is not None:
            with self.guard.making:
                planner = profile.planner(*given, profile)
                index(planner.parameters.horizon)
                return planner
        check_walk(*given)
        return WalkingPlanner(*given, profile, self.region, self.legs)


def resolve(scenario: Scenario, robot: "RobotDescription | None" = None, profile: Profile | None = None) -> Walk:
    """Say what a checked scenario means.

    Args:
        scenario: fit to run.
        robot: in place of the one that it names.
        profile: in place of the planner's profile that it names.

    Raises:
        ParameterError: a part refuses its parameters.
    """
    keys = scenario
    robot = robot or describe(keys.robot, keys.robot_options)
    size = size_of(robot, keys.robot_options)
    own = None if size == REFERENCE_SIZE else float(robot.sole_length)
    draft = Draft(keys, size, stance_widening(robot, size), own)
    if profile is not None:
        draft.profile = profile
    near, far = draft.parameters.reach_width
    sole = (robot.sole_length, robot.sole_width)
    region = draft.region(sole, robot.shank_spacing)
    apart = max(near, robot.sole_width + 0.5 * region.gap)
    true = true_robot(keys.errors, robot, keys.seed)
    timed, pointed = _pushes(draft, robot, float(true.mass))
    return Walk(
        name=keys.name,
        text=scenario_yaml(keys),
        fidelity=keys.fidelity,
        seed=keys.seed,
        duration=draft.duration,
        gait_duration=draft.gait_duration,
        rates=keys.rates,
        robot=robot,
        true_robot=true if keys.fidelity == "full" else robot,
        true_mass=float(true.mass),
        true_com_height=keys.gait.com_height - keys.errors.com_height,
        height_error=keys.errors.com_height,
        friction=_friction(keys),
        gait=draft.fitted_gait(region),
        heights=draft.heights,
        standing_height=draft.standing_height,
        terrain=draft.terrain,
        true_terrain=draft.true_terrain,
        terrain_kind=keys.terrain.kind,
        unforeseen=draft.unforeseen if keys.fidelity == "full" else {},
        start=keys.start,
        start_height=draft.start_height,
        stance=draft.stance,
        profile=draft.profile,
        guard=profile_guard(draft.profile, given=profile is not None),
        # Adaptation leaves at least half the planned gap between soles.
        parameters=replace(draft.parameters, reach_width=(apart, far)),
        controller=controller_parameters(keys.wbc, draft.size),
        tasks=keys.wbc.tasks if keys.wbc is not None else (),
        sensing=keys.sensing,
        filter=_filter(draft),
        waypoints=waypoints(draft),
        commands=told(draft),
        pushes=timed,
        gait_pushes=pointed,
        faults=keys.faults,
        pendulum=keys.pendulum,
        agenda=_agenda(draft, [push.body for push in (*timed, *(push for _, push in pointed))]),
    )


def _agenda(draft: Draft, bodies: Iterable[str]) -> Agenda:
    """What is to happen, on a robot whose pushes act on these bodies."""
    said, driven = notes(draft), notes(draft, driven=True)
    return Agenda(
        events=events(draft),
        bodies=tuple(dict.fromkeys(bodies)),
        notes=said,
        standing=tuple(note for note in said if note not in driven),
    )


def _friction(keys: Scenario) -> float:
    """The friction coefficient that the controller counts on [-]."""
    if keys.wbc is not None and keys.wbc.friction is not None:
        return keys.wbc.friction
    return max(keys.terrain.friction + keys.errors.friction, LEAST_BELIEVED_FRICTION)


def _filter(draft: Draft) -> str:
    """The filter of the planner's state; when the scenario names none, the Kalman filter if there is noise."""
    sensing = draft.keys.sensing
    noisy = sensing.zmp_noise > 0.0 or sensing.com_noise > 0.0
    return draft.keys.planner.filter or ("kalman" if noisy else "none")


def _pushes(
    draft: Draft, robot: "RobotDescription", mass: float
) -> tuple[tuple[Push, ...], tuple[tuple[PushPoint, Push], ...]]:
    """The pushes at times and at points of the gait, on a robot of this true mass [kg]; without a body, on the torso.

    Of the latter the time means nothing.
    """
    timed, pointed = [], []
    for settings in draft.keys.pushes:
        point, body = PushPoint.of(settings), settings.body or robot.torso_body
        push = Push(settings.time or 0.0, settings.duration, _force(settings, mass), body)
        if point is None:
            timed.append(push)
        else:
            pointed.append((point, push))
    return tuple(timed), tuple(pointed)


def _force(push: PushSettings, mass: float) -> Array:
    """Force of a push, given directly or by its impulse per mass, shape (3,) [N]."""
    if push.impulse is None:
        return np.array(push.force or np.zeros(3))
    size, direction = mass * push.impulse / push.duration, push.direction or 0.0
    return size * np.array([math.cos(direction), math.sin(direction), 0.0])


def scenario_yaml(scenario: Scenario) -> str:
    """The scenario as run: every key with its value, but for those left null."""
    return yaml.safe_dump(scenario.model_dump(mode="json", exclude_none=True), sort_keys=False)
