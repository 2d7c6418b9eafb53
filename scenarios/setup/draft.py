"""A scenario on the way to a walk: what follows from its keys, each thing in one place, derived once, when asked."""

import math
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from surefoot.planner.ground.terrain import Box, Site, Terrain, flat
from surefoot.planner.ground.tiles import TILE, Tiles
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.parameters import GroundSearch, PlannerParameters, StepAdaptation
from surefoot.planner.references.com_height import (
    BENT_KNEES,
    BentKneeHeight,
    HeightProfile,
    PaperHeight,
    Rise,
    SmoothHeight,
)
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Array, FeetState, FootstepPlan
from surefoot.scenarios.file.group import recovery_parameters
from surefoot.scenarios.file.schema import GroundError, Scenario
from surefoot.scenarios.setup.commands import told_until
from surefoot.scenarios.setup.gait import (
    FINAL_STAND,
    commanded,
    fitted_to,
    gait_of,
    longest_landing,
    step_region,
)
from surefoot.scenarios.setup.terrain import TerrainKind, kind_of
from surefoot.similarity import REFERENCE_SIZE, Similarity

_STREAM = 2
"""Random numbers of the ground, apart from those of other things with the same seed."""

LONG_FOOT = 0.3
"""Feet are at most as long where the scenario says nothing about it; lengths here are the reference robot's [m]."""

SHORTEST_REACH, LONGEST_REACH = 0.4, 0.8
"""Least and greatest bound on how far ahead of its stance foot a footstep may be planned, whatever the gait [m]."""

FURTHER = 0.1
"""How much further than the gait's own steps it may be [m]."""


class Draft:
    """What a scenario means, before anyone knows whether it can be run.

    The checks look at it, and `surefoot.scenarios.setup.walk.resolve` freezes it. A property raises `ParameterError`
    where the planner refuses the keys.

    Attributes:
        keys: the scenario as the user wrote it; nobody below this room sees it.
        size: of its robot.
        wider: by what that has to stand wider than the reference robot, scaled [m].
        sole: length of its soles where they are known without the scenario, which those of the reference are not [m].
    """

    def __init__(
        self, keys: Scenario, size: Similarity = REFERENCE_SIZE, wider: float = 0.0, sole: float | None = None
    ) -> None:
        self.keys, self.size, self.wider, self.sole = keys, size, wider, keys.robot_options.foot_length or sole

    @cached_property
    def commanded(self) -> bool:
        """Whether the gait is given by a velocity or by footsteps."""
        return commanded(self.keys.gait)

    @property
    def told(self) -> bool:
        """Whether the walk hears while it goes on where to go, so that its steps are not known before."""
        return bool(self.keys.gait.waypoints or self.keys.commands)

    @cached_property
    def gait(self) -> GaitParameters:
        """The gait in the planner's terms, its strides as wide as asked for."""
        return gait_of(self.keys.gait)

    @cached_property
    def gait_duration(self) -> float:
        """Time from the start to the end of the last double support, or of all that the walk is told [s]."""
        return max(self.gait.duration, told_until(self))

    @cached_property
    def duration(self) -> float:
        """Simulated time: as given, or the gait and a while of standing [s]."""
        return self.gait_duration + FINAL_STAND * self.size.time if self.keys.duration is None else self.keys.duration

    @cached_property
    def origin(self) -> Array:
        """Middle of the start feet, x and y, shape (2,) [m]."""
        return np.array([self.keys.start.x, self.keys.start.y])

    @cached_property
    def kind(self) -> TerrainKind:
        """The kind of ground."""
        return kind_of(self.keys.terrain.kind)

    @cached_property
    def terrain(self) -> Terrain:
        """The ground as the planner believes it to be."""
        return self.kind.build(self)

    @property
    def site(self) -> Site:
        """Where ground is built, and for which walk."""
        rng = np.random.default_rng(np.random.SeedSequence(self.keys.seed, spawn_key=(_STREAM,)))
        start = self.keys.start
        return Site(self.origin, start.yaw, self.keys.terrain.friction, lambda: self.level_footsteps, rng)

    @cached_property
    def true_terrain(self) -> Terrain:
        """The ground as it is: higher or lower than believed, by the seed, and with what the planner knows not of.

        Where the robot starts is known.
        """
        terrain, noise = self.terrain, self.keys.terrain.height_noise
        if self.tiles is not None:
            terrain = self.tiles.build(self.site)
        elif noise != 0.0:
            errors = np.random.default_rng(self.keys.seed).uniform(-noise, noise, len(terrain.boxes))
            boxes = (
                box if box.top(self.origin[None])[1][0] >= 0.0 else _raised(box, error)
                for box, error in zip(terrain.boxes, errors, strict=True)
            )
            terrain = replace(terrain, boxes=tuple(boxes))
        hidden = tuple(self._hidden(error) for error in self.keys.errors.ground or ())
        return replace(terrain, boxes=(*terrain.boxes, *hidden)) if hidden else terrain

    @cached_property
    def unforeseen(self) -> dict[str, tuple[int, ...]]:
        """Numbers of the boxes of the true ground that lie elsewhere than believed, by the key that has put them there.

        Where the robot starts is known.
        """
        true, hidden = self.true_terrain.boxes, len(self.keys.errors.ground or ())
        first = len(true) - hidden
        noisy = "errors.ground_noise" if self.tiles is not None else "terrain.height_noise"
        believed = (None,) * first if self.tiles is not None else self.terrain.boxes
        other = tuple(
            number
            for number, (box, known) in enumerate(zip(true[:first], believed, strict=True))
            if box is not known and (known is not None or self._top(box) != self.start_height)
        )
        found = {noisy: other} if self.tiles is not None or self.keys.terrain.height_noise else {}
        return found | {f"errors.ground.{index}": (first + index,) for index in range(hidden)}

    def _top(self, box: Box) -> float:
        """Height of a level box [m]."""
        return float(box.center[2] + box.half_size[2])

    @cached_property
    def tiles(self) -> Tiles | None:
        """What lies in truth where level ground is believed in; None when it is level."""
        keys = self.keys
        noise = keys.errors.ground_noise if keys.fidelity == "full" else None
        length = self.size.length
        room = 0.5 * max(keys.robot_options.foot_length or 0.0, LONG_FOOT * length) + keys.start.position_noise
        return Tiles(noise, keys.seed, room, TILE * length) if noise else None

    def _hidden(self, error: GroundError) -> Box:
        """A box that is there and that nobody believes in, laid along the start heading."""
        c, s = math.cos(self.keys.start.yaw), math.sin(self.keys.start.yaw)
        rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        base = self.start_height
        center = rotation @ (error.x, error.y, 0.0) + (*self.origin, base + 0.5 * error.height)
        return Box(center, 0.5 * np.array([error.length, error.width, error.height]), rotation)

    @cached_property
    def start_height(self) -> float:
        """Height of the ground on which the robot starts [m]."""
        return self.kind.start_height(self)

    @cached_property
    def search(self) -> GroundSearch:
        """How a swing foot that has not felt the ground goes on downwards.

        Where the ground has steps its heights are believed less: a foot that finds no tread by the end of single
        support hurries after one that lies lower, since waiting for it costs balance.
        """
        usual = self.usual
        free = self.terrain.footholds.follow
        return usual.search if free else replace(usual.search, hurry_after=usual.touchdown_lead)

    @cached_property
    def stance(self) -> FeetState:
        """Where the feet stand at the start: side by side at the start position and heading, on the ground there."""
        return self._stance(self.start_height)

    @cached_property
    def level_footsteps(self) -> FootstepPlan:
        """The footsteps on level ground."""
        return plan_footsteps(self.gait, self._stance(0.0), flat())

    def _stance(self, height: float) -> FeetState:
        yaw, width = self.keys.start.yaw, self.keys.gait.step_width
        left = 0.5 * width * np.array([-math.sin(yaw), math.cos(yaw), 0.0])
        origin = np.append(self.origin, height)
        return FeetState(np.array([origin + left, origin - left]), np.full(2, yaw), (True, True))

    @cached_property
    def profile(self) -> Profile:
        """The formulation of the planner."""
        return PROFILES[self.keys.planner.profile]

    @cached_property
    def heights(self) -> HeightProfile:
        """The height law: where the CoM climbs follows from the fidelity unless the scenario says it.

        The paper's profile has the paper's own law, in double support and with its jumps. A pendulum can do what the
        paper does, and climbs in double support; legs cannot, and climb in single support.
        """
        planner = self.keys.planner
        if planner.profile == "paper" and planner.knee == "stretched":
            return PaperHeight()
        rise = Rise(planner.rise or ("double" if self.keys.fidelity == "pendulum" else "single"))
        lower = BENT_KNEES * self.size.length
        return BentKneeHeight(rise, lower) if planner.knee == "bent" else SmoothHeight(rise)

    @cached_property
    def standing_height(self) -> float:
        """CoM height over the soles at which the walk begins and ends [m]."""
        bent = self.keys.planner.knee == "bent"
        return self.keys.gait.com_height - (BENT_KNEES * self.size.length if bent else 0.0)

    @cached_property
    def reach(self) -> float:
        """How far ahead of its stance foot the planner may place a footstep: a little beyond the gait's own [m]."""
        gait, length = self.keys.gait, self.size.length
        if not self.commanded and gait.steps == 0 and not gait.waypoints:
            return LONGEST_REACH * length
        own = longest_landing(self.gait) if self.commanded else abs(gait.step_length)
        return min(max(own + FURTHER * length, SHORTEST_REACH * length), LONGEST_REACH * length)

    @cached_property
    def usual(self) -> PlannerParameters:
        """Parameters of a planner for this robot, whatever the scenario says."""
        return self._widened(PlannerParameters())

    def _widened(self, parameters: PlannerParameters) -> PlannerParameters:
        # Who stands wider steps as much wider.
        scaled = self.size.scaled(parameters)
        near, far = scaled.reach_width
        return replace(scaled, reach_width=(near, far + self.wider))

    @cached_property
    def parameters(self) -> PlannerParameters:
        """The profile's parameters at this size with what the scenario changes of them, for legs without inertia."""
        keys = self.keys.planner
        chosen: dict[str, Any] = {
            "horizon": keys.horizon,
            "moves": None if keys.control_horizon is None else tuple(range(keys.control_horizon)),
            "jerk_limit": keys.jerk_limit,
            "jerk_rate_limit": keys.jerk_rate_limit,
            "search": self.search,
        }
        usual = self._widened(self.profile.parameters)
        return replace(
            usual,
            recovery=recovery_parameters(keys.recovery, usual.recovery),
            sample_time=keys.sample_time,
            reach_length=self.reach,
            step_adaptation=StepAdaptation(keys.step_adaptation),
            **{name: value for name, value in chosen.items() if value is not None},
        )

    def region(self, sole: tuple[float, float], shank_spacing: float) -> StepRegion:
        """Where steps may land, for soles of this length and width, and shanks that keep this distance [m]."""
        return step_region(self.parameters, sole, shank_spacing)

    def fitted_gait(self, region: StepRegion) -> GaitParameters:
        """The gait that is walked where feet may land in this region."""
        return fitted_to(region, self.gait, self.keys.gait)


def _raised(box: Box, height: float) -> Box:
    up = np.array([0.0, 0.0, 0.5 * height])
    return replace(box, center=box.center + up, half_size=box.half_size + up)
