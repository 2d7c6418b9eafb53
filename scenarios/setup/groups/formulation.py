"""The planner of a walk: its formulation, its height law and its parameters."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from surefoot.models.facts import RobotFacts
from surefoot.parts.guard import Guard
from surefoot.planner.laws.names import PROFILES
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.parameters import GroundSearch, LegInertia, PlannerParameters, StepAdaptation
from surefoot.planner.references.com_height import (
    BENT_KNEES,
    BentKneeHeight,
    HeightProfile,
    Rise,
    SmoothHeight,
)
from surefoot.planner.references.stride_height import StrideHeight
from surefoot.planner.rules import Rule, rule_name
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.errors import Problem, nearest
from surefoot.scenarios.file.group import LAW_NUMBERS, recovery_parameters
from surefoot.scenarios.file.schema import PlannerSettings
from surefoot.scenarios.setup.groups.gait import longest_landing, step_region
from surefoot.scenarios.setup.parts import profile_guard
from surefoot.scenarios.setup.terrain.ground import Ground
from surefoot.similarity import Similarity

LEG_SHARE = 0.9
"""Share of the span of the legs that steps on command use [-]. With all of it both legs are straight at touchdown: at
0.88 m/s the robot fell by a push that it took at 0.65 to 0.8 m/s."""

CATCHING_HIPS = 0.907
"""Greatest height of the hips from which straight legs reach a step that catches the body, over the leg length [-].

The body comes down for such a step, by 6 cm at 0.8 m/s. Legs that are straight between two feet would reach no farther
than the walk's own steps."""

ANKLE_SHARE = 0.85
"""Share of an ankle's torque that bears the robot with the CoP at the edge of its room; the rest is for shocks [-]."""

LEAST_ROOM = 0.15
"""Room of the CoP that a planner needs in any case, of the sole to each side [-]."""

SHORTEST_REACH, LONGEST_REACH = 0.4, 0.8
"""Least and greatest bound on how far ahead of its stance foot a footstep may be planned, whatever the gait, of the
reference robot as all lengths here [m]."""

FURTHER = 0.1
"""Distance beyond the gait's own steps that it may be [m]."""


def lowered(keys: PlannerSettings, size: Similarity) -> float:
    """Height by which a robot of a size carries its CoM lower than the gait says, for knees that are bent [m]."""
    return BENT_KNEES * size.length if keys.knee == "bent" else 0.0


@dataclass(frozen=True, eq=False)
class Formulation:
    """A scenario's planner, for legs without inertia and before the robot's soles are known.

    Attributes:
        keys: of the planner.
        ground: the ground, and the gait that comes to it.
        size: of the robot.
        wider: by what the robot has to stand wider than the reference robot, scaled [m].
        usual_rise: support phase in which the CoM climbs unless the scenario says it.
        given: a profile in place of the one that the scenario names.
    """

    keys: PlannerSettings
    ground: Ground
    size: Similarity
    wider: float
    usual_rise: Rise
    given: Profile | None

    @cached_property
    def profile(self) -> Profile:
        """The formulation of the planner."""
        return self.given or PROFILES[self.keys.profile]

    @property
    def guard(self) -> Guard:
        """Stands around the calls of what the profile brings."""
        return profile_guard(self.profile, given=self.given is not None)

    @property
    def heights(self) -> HeightProfile:
        """The law of the CoM height: the profile's own, if it has one and knees are to be stretched."""
        lower, own = lowered(self.keys, self.size), self.profile.height
        if own is not None and not lower:
            return own
        rise = Rise(self.keys.rise) if self.keys.rise else self.usual_rise
        if self.keys.knee == "straight":
            return StrideHeight(rise)
        return BentKneeHeight(rise, lower) if lower else SmoothHeight(rise)

    @cached_property
    def usual(self) -> PlannerParameters:
        """Parameters of a planner for this robot, whatever the scenario says but for its reach."""
        return self._widened(_usual(self.size)[0])

    def _widened(self, parameters: PlannerParameters) -> PlannerParameters:
        # Legs that stand wider step as much wider.
        usual, scaled = _usual(self.size)
        scaled = scaled if parameters == usual else self.size.scaled(parameters)
        near, far = scaled.reach_width
        return replace(scaled, reach_width=(near, far + self.wider), reach_length=self._reach)

    @property
    def _reach(self) -> float:
        """Farthest footstep that the planner may place ahead of the stance foot: a little beyond the gait's own [m]."""
        ground, steps, length = self.ground, self.ground.steps, self.size.length
        if not ground.commanded and steps.steps == 0 and not steps.waypoints:
            return LONGEST_REACH * length
        own = longest_landing(ground.gait) if ground.commanded else abs(steps.step_length)
        return min(max(own + FURTHER * length, SHORTEST_REACH * length), LONGEST_REACH * length)

    @property
    def _search(self) -> GroundSearch:
        """The search of a swing foot that has not felt the ground, on its way down.

        Where the ground has steps its heights are believed less: a foot that finds no tread by the end of single
        support hurries after one that lies lower, since waiting for it costs balance.
        """
        usual, follow = self.usual, self.ground.terrain.footholds.follow
        return usual.search if follow else replace(usual.search, hurry_after=usual.touchdown_lead)

    @cached_property
    def parameters(self) -> PlannerParameters:
        """The profile's parameters at this size with what the scenario changes of them."""
        keys = self.keys
        chosen: dict[str, Any] = {
            "horizon": keys.horizon,
            "moves": None if keys.control_horizon is None else tuple(range(keys.control_horizon)),
            # A profile that is given may have numbers that the group of the named one has not got.
            **{name: getattr(keys, name, None) for name in self.profile.numbers},
        }
        usual = self._widened(self.profile.parameters)
        return replace(
            usual,
            recovery=recovery_parameters(keys.recovery, usual.recovery),
            sample_time=keys.sample_time,
            search=self._search,
            step_adaptation=StepAdaptation(keys.step_adaptation),
            **{name: value for name, value in chosen.items() if value is not None},
        )

    @property
    def rules(self) -> tuple[Rule, ...]:
        """The profile's rules of recovery but for those that the scenario leaves out."""
        return tuple(rule for rule in self.profile.rules if rule_name(rule) not in self.keys.without)

    def problems(self) -> Iterator[Problem]:
        """List what the scenario asks of the profile that it has not got: moves of the jerk, numbers or rules."""
        yield from self._missing_rules()
        yield from self._unread_numbers()
        yield from self._missing_moves()

    def _missing_rules(self) -> Iterator[Problem]:
        profile = self.profile
        own = () if profile.planner is not None else tuple(map(rule_name, profile.rules))
        for name in self.keys.without:
            if name not in own:
                what = f"planner.without {name[:100]!r}, which is no rule of profile {profile.name!r}"
                right = nearest(name, own) if own else "leave it out: there is none"
                yield Problem(("planner", "without"), what, right)

    def _unread_numbers(self) -> Iterator[Problem]:
        """List the numbers of a law of motion that the profile's law does not read."""
        for name in LAW_NUMBERS:
            if getattr(self.keys, name) is not None and name not in self.profile.numbers:
                what = f"planner.{name} with profile {self.profile.name!r}, whose law does not read it"
                yield Problem(("planner", name), what, "leave it null")

    def _missing_moves(self) -> Iterator[Problem]:
        """List moves of the jerk that the profile has not got, or that begin after the horizon."""
        profile, keys = self.profile, self.keys
        if not profile.moves:
            if keys.control_horizon is not None:
                what = f"planner.control_horizon with profile {profile.name!r}, which optimises no moves of the jerk"
                yield Problem(("planner", "control_horizon"), what, "leave it null")
            return
        horizon = keys.horizon or profile.parameters.horizon
        if keys.control_horizon is not None:
            if keys.control_horizon > horizon:
                what = f"planner.control_horizon {keys.control_horizon} exceeds the horizon of {horizon} samples"
                yield Problem(("planner", "control_horizon"), what, f"use at most {horizon}")
        elif horizon <= profile.parameters.moves[-1]:
            what = f"planner.horizon {horizon} is shorter than the planner's blocks of moves"
            yield Problem(("planner", "horizon"), what, f"use at least {profile.parameters.moves[-1] + 1}")


def _usual(size: Similarity) -> tuple[PlannerParameters, PlannerParameters]:
    """Parameters of the reference robot, and the same for a size."""
    usual = PlannerParameters()
    return usual, size.scaled(usual)


def region_of(parameters: PlannerParameters, facts: RobotFacts, com_height: float) -> StepRegion:
    """Region in which a step that is commanded while it walks may land: within reach of planner and legs."""
    span, sole = LEG_SHARE * facts.leg_span(com_height), (facts.foot_length, facts.foot_width)
    return step_region(parameters, sole, facts.shank_spacing, span, facts.hip_width)


def catching_height(keys: PlannerSettings, facts: RobotFacts, com_height: float) -> float:
    """CoM height from which legs reach a step that catches the body, with its CoM at a height in the gait [m]."""
    if keys.knee != "straight":
        return com_height
    return min(com_height, CATCHING_HIPS * facts.leg_length + facts.com_above_hip)


def leg_reach(parameters: PlannerParameters, facts: RobotFacts, com_height: float, standing_height: float) -> LegReach:
    """The reach of legs that catch a body with its CoM at a height for that, and at one in standing [m]."""
    recovery = parameters.recovery
    return LegReach(
        radius=0.5 * LEG_SHARE * facts.leg_span(com_height),
        hip_width=facts.hip_width,
        near=parameters.reach_width[0],
        across=recovery.across,
        clear=facts.foot_length + recovery.clear,
        acceleration=facts.swing_acceleration,
        sole=(facts.foot_length, facts.foot_width),
        height=standing_height - facts.com_above_hip,
        length=facts.leg_length,
    )


def cop_room(leg: LegInertia, facts: RobotFacts, mass: float) -> tuple[float, float]:
    """Distances from a sole's centre at which ankles bear a mass [kg], ahead and behind, and to both sides [m]."""
    if leg.chain is None:
        return math.inf, math.inf
    levers = [ANKLE_SHARE * torque / (GRAVITY * mass) for torque in facts.ankle_torque]
    sole = facts.foot_length, facts.foot_width
    ahead, side = (
        max(lever - abs(off), LEAST_ROOM * size)
        for lever, off, size in zip(levers, leg.chain.ankle, sole, strict=False)
    )
    return ahead, side
