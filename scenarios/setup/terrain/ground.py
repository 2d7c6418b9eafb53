"""The ground of a scenario and the walk that comes to it, what a kind of ground is, and checks that several share."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from surefoot.errors import at_most
from surefoot.models.facts import RobotFacts
from surefoot.planner.geometry.plane import sole_corners, sole_rotation
from surefoot.planner.ground.terrain import Box, Site, Terrain, flat
from surefoot.planner.ground.tiles import TILE, Tiles
from surefoot.planner.ground.tilt import FAR, Tilt
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import Array, FeetState, Footstep
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.schema import GroundError, Scenario, Start, TerrainSettings
from surefoot.scenarios.file.units import meant
from surefoot.similarity import Similarity
from surefoot.streams import Stream, generator

PLATFORM = 1.0
"""Level ground kept before the first and after the last footstep on a platform, for the reference robot [m]."""

MOST_TILES = 1000
"""Tiles of uneven ground, since every look at it goes through all of them [-]."""

FOLDED = 0.5
"""Length of a leg with a deeply bent knee over its length with a straight one [-]."""

MOST_STEPS = 2000
"""Footsteps that are looked at; those after the last stair stand on its platform [-]."""

LONG_FOOT = 0.3
"""Feet are at most as long where the scenario says nothing about it; lengths here are the reference robot's [m]."""


def tiles_of(keys: Scenario, size: Similarity) -> Tiles | None:
    """The tiles on which a robot of a size walks while it believes in level ground; None when it is level."""
    noise = keys.errors.ground_noise
    return Tiles(noise, keys.seed, _level_room(keys, size), TILE * size.length) if noise else None


def tilt_of(keys: Scenario, size: Similarity) -> Tilt | None:
    """The true tilt of ground that a robot of a size believes to be level; None when it is level."""
    pitch, roll = keys.errors.ground_pitch or 0.0, keys.errors.ground_roll or 0.0
    return Tilt(pitch, roll, _level_room(keys, size), FAR * size.length) if pitch or roll else None


def _level_room(keys: Scenario, size: Similarity) -> float:
    """Distance beyond the centres of the feet at the start for which ground stays level, which is known [m]."""
    return 0.5 * max(keys.robot_options.foot_length or 0.0, LONG_FOOT * size.length) + keys.start.position_noise


@dataclass(frozen=True, eq=False)
class Ground:
    """A scenario's ground, and the walk that comes to it.

    Attributes:
        kind: of the ground.
        keys: of the ground, by the model of its kind.
        steps: keys of the gait.
        gait: the same in the planner's terms, its strides as wide as asked for.
        start: where the walk starts.
        seed: of everything random.
        size: of the robot.
        sole: length of its soles where they are known, which those of the reference robot are not [m].
        standing_height: CoM over the soles at which the walk begins [m].
        tiles: what lies in truth where level ground is believed in; None when it is level.
        hidden: boxes that are there and that nobody believes in.
        tilt: of the true ground where level ground is believed in; None when it is level.
    """

    kind: "TerrainKind"
    keys: TerrainSettings
    steps: Gait
    gait: GaitParameters
    start: Start
    seed: int
    size: Similarity
    sole: float | None
    standing_height: float
    tiles: Tiles | None
    hidden: tuple[GroundError, ...]
    tilt: Tilt | None = None

    @property
    def commanded(self) -> bool:
        """True if the gait is given by a velocity or by footsteps."""
        return bool(self.steps.velocity or self.steps.footsteps)

    @property
    def way(self) -> float:
        """Way that the steps go at most [m]."""
        if not self.commanded:
            return self.steps.steps * abs(self.steps.step_length)
        return sum(abs(stride.x) for stride in self.gait.strides)

    @cached_property
    def origin(self) -> Array:
        """Middle of the start feet, x and y, shape (2,) [m]."""
        return np.array([self.start.x, self.start.y])

    @property
    def site(self) -> Site:
        """The place where ground is built, and the walk for which it is."""
        return Site(
            self.origin,
            self.start.yaw,
            self.keys.friction,
            lambda: self.level_footsteps,
            generator(self.seed, Stream.GROUND),
        )

    @cached_property
    def level_footsteps(self) -> tuple[Footstep, ...]:
        """The footsteps on level ground."""
        return plan_footsteps(self.gait, self._stance(0.0), flat())

    @cached_property
    def terrain(self) -> Terrain:
        """The ground as the planner believes it to be."""
        return self.kind.build(self)

    @cached_property
    def start_height(self) -> float:
        """Height of the ground on which the robot starts [m]."""
        return self.kind.start_height(self)

    @cached_property
    def stance(self) -> FeetState:
        """Feet at the start: side by side at the start position and heading, on the ground there."""
        return self._stance(self.start_height)

    def _stance(self, height: float) -> FeetState:
        yaw = self.start.yaw
        left = 0.5 * self.steps.step_width * np.array([-math.sin(yaw), math.cos(yaw), 0.0])
        origin = np.append(self.origin, height)
        return FeetState(np.array([origin + left, origin - left]), np.full(2, yaw), (True, True))

    @cached_property
    def footsteps(self) -> tuple[Footstep, ...]:
        """The first footsteps on the ground as believed, start feet first."""
        gait = self.gait if self.commanded else replace(self.gait, steps=min(self.gait.steps, MOST_STEPS))
        return plan_footsteps(gait, self.stance, self.terrain)

    @property
    def places(self) -> Array:
        """Sole centres of these footsteps, shape (n + 2, 3) [m]."""
        return np.array([step.position for step in self.footsteps])

    def soles(self, facts: RobotFacts) -> Array:
        """Corners of the soles of a robot on these footsteps, shape (n + 2, 4, 2) [m]."""
        half_size = 0.5 * np.array([facts.foot_length, facts.foot_width])
        return np.array([sole_corners(step, half_size) for step in self.footsteps])

    def edge_margins(self, facts: RobotFacts) -> Array:
        """Least distance of each of these soles from the edge of its face, negative beyond, shape (n + 2,) [m]."""
        return self.terrain.edge_margins(self.places[:, :2], self.soles(facts))

    @property
    def height_noise(self) -> float:
        """Half range by which boxes are truly higher or lower than believed [m]; 0 of a kind that the key is not of."""
        return self.keys.height_noise if "height_noise" in self.kind.keys else 0.0

    @cached_property
    def true_terrain(self) -> Terrain:
        """The ground as it is: higher or lower than believed, by the seed, and with what the planner knows not of.

        Where the robot starts is known.
        """
        terrain, noise = self.terrain, self.height_noise
        other = self.tiles or self.tilt
        if other is not None:
            terrain = other.build(self.site)
        elif noise != 0.0:
            errors = generator(self.seed, Stream.HEIGHTS).uniform(-noise, noise, len(terrain.boxes))
            boxes = (
                box if box.top(self.origin[None])[1][0] >= 0.0 else _raised(box, error)
                for box, error in zip(terrain.boxes, errors, strict=True)
            )
            terrain = replace(terrain, boxes=tuple(boxes))
        hidden = tuple(self._box(error) for error in self.hidden)
        return replace(terrain, boxes=(*terrain.boxes, *hidden)) if hidden else terrain

    @cached_property
    def unforeseen(self) -> dict[str, tuple[int, ...]]:
        """Numbers of the boxes of the true ground that lie elsewhere than believed, by the key that has put them there.

        Where the robot starts is known.
        """
        true = self.true_terrain.boxes
        first = len(true) - len(self.hidden)
        found: dict[str, tuple[int, ...]]
        found = {f"errors.ground.{index}": (first + index,) for index in range(len(self.hidden))}
        if self.tiles is not None:
            other = (number for number, box in enumerate(true[:first]) if _top(box) != self.start_height)
            return {"errors.ground_noise": tuple(other), **found}
        if self.tilt is not None:
            given = {"errors.ground_pitch": self.tilt.pitch, "errors.ground_roll": self.tilt.roll}
            return {name: (1, 2) for name, angle in given.items() if angle}
        if not self.height_noise:
            return found
        pairs = enumerate(zip(true[:first], self.terrain.boxes, strict=True))
        return {"terrain.height_noise": tuple(number for number, (box, known) in pairs if box is not known), **found}

    def _box(self, error: GroundError) -> Box:
        """A box that nobody believes in, laid along the start heading."""
        rotation = sole_rotation(self.start.yaw, 0.0, 0.0)
        base = self.start_height
        center = rotation @ (error.x, error.y, 0.0) + (*self.origin, base + 0.5 * error.height)
        return Box(center, 0.5 * np.array([error.length, error.width, error.height]), rotation, error.friction)


def _top(box: Box) -> float:
    """Height of a level box [m]."""
    return float(box.center[2] + box.half_size[2])


def _raised(box: Box, height: float) -> Box:
    up = np.array([0.0, 0.0, 0.5 * height])
    return replace(box, center=box.center + up, half_size=box.half_size + up)


_SIZES = ("riser", "angle", "height_noise")
"""Common keys of sizes that make the ground uneven."""


class TerrainKind:
    """A kind of terrain: how it is built of a scenario's keys, and what makes it impossible.

    To add one is a subclass with an instance in a file of its own, and a line in
    `surefoot.scenarios.file.registries.TERRAIN_KINDS` that leads to the instance; another package has an entry point
    of the group ``surefoot.terrains`` that leads to it.

    Attributes:
        name: value of ``terrain.kind``.
        keys: keys of ``terrain`` that shape it; friction is of all. Others have no effect, which a note says. With
            ``height_noise`` among them, each box of the true ground is higher or lower than `build` has it, but for
            those under the start.
        settings: model of the group ``terrain``, with the keys that only this kind has, which need no mention above.
    """

    name: str
    keys: tuple[str, ...] = ()
    settings: type[TerrainSettings] = TerrainSettings

    @property
    def uneven(self) -> tuple[str, ...]:
        """Keys of sizes without which it is level: by default the common ones among `keys`.

        A kind with sizes of its own names them. One so small that nothing follows from it is refused. The calmer walk
        that a refusal proposes has less of them.
        """
        return tuple(name for name in _SIZES if name in self.keys)

    def completed(self, keys: TerrainSettings, gait: Gait) -> Gait:
        """The keys of a gait with those that it leaves open and that follow from this ground."""
        return gait

    def build(self, ground: Ground) -> Terrain:
        """The ground as the planner believes it to be: boxes on a plane, which need not lie as high as the start.

        Gaps between raised boxes have a floor at ``Terrain.plane``: a negative one lies below the world's zero, so that
        boxes may have their tops there. `start_height` follows from both.
        """
        raise NotImplementedError

    def start_height(self, ground: Ground) -> float:
        """Height of the ground on which the robot starts [m]."""
        return ground.terrain.height(ground.start.x, ground.start.y)

    def problems(self, ground: Ground, facts: RobotFacts) -> list[Problem]:
        """List what makes it impossible for a robot and its gait."""
        return []

    def notes(self, ground: Ground) -> Iterator[str]:
        """Note what of it the walk does not come to, a sentence each."""
        return iter(())


def climb_problems(ground: Ground, facts: RobotFacts, risers: int = 1, name: str = "riser") -> Iterator[Problem]:
    """List a riser of which a step goes up so many at once, which the legs cannot.

    The hips are at their height above the lower foot while the other leg folds on the tread above.

    Args:
        ground: of the walk.
        facts: of the robot.
        risers: that a step goes up.
        name: key of the height of a riser.
    """
    hips, riser = ground.standing_height - facts.com_above_hip, getattr(ground.keys, name)
    highest = (hips - FOLDED * facts.leg_length) / risers
    if riser > highest:
        what = f"terrain.{name} {riser} m is out of reach of legs {facts.leg_length:.3f} m long"
        most = max(highest, 0.0)
        yield Problem(("terrain", name), what, f"use at most {at_most(most)} m{meant(riser, 'm', most)}")


def unreached(ground: Ground, what: str, name: str = "start") -> Iterator[Problem]:
    """Note a walk that takes steps and leaves off before the ground is anything but level.

    Args:
        ground: of the walk.
        what: what no footstep comes to.
        name: key of where it begins.
    """
    count = len(ground.footsteps) - 2
    if count and np.ptp(ground.places[:, 2]) == 0.0 and all(step.normal[2] == 1.0 for step in ground.footsteps):
        said = f"none of {count} footsteps comes to the {what}, so that the walk is one on level ground"
        yield Problem(("terrain", name), said, "let it begin nearer, take more steps, or use kind flat")


def uneven_problems(ground: Ground) -> Iterator[Problem]:
    """List errors.ground_noise where ground is not level, or under too many steps, and ground that is tilted beside."""
    yield from _tilt_problems(ground)
    key, kind, steps = ("errors", "ground_noise"), ground.keys.kind, ground.gait.steps
    if ground.tiles is None:
        return
    if kind != "flat":
        right = (
            "use terrain.height_noise" if "height_noise" in ground.kind.keys and kind != "slope" else "use kind flat"
        )
        yield Problem(key, f"errors.ground_noise on terrain.kind {kind}", right)
    elif steps > MOST_TILES or len(ground.tiles.cells(ground.site)) > MOST_TILES:
        what = f"errors.ground_noise under {steps} steps needs more than {MOST_TILES} tiles"
        yield Problem(key, what, "take fewer steps, or leave it out")


def _tilt_problems(ground: Ground) -> Iterator[Problem]:
    if ground.tilt is None:
        return
    name = "ground_pitch" if ground.tilt.pitch else "ground_roll"
    if ground.keys.kind != "flat":
        yield Problem(("errors", name), f"errors.{name} on terrain.kind {ground.keys.kind}", "use kind flat")
    for other, there in (("ground_noise", ground.tiles is not None), ("ground", bool(ground.hidden))):
        if there:
            yield Problem(("errors", name), f"errors.{name} beside errors.{other}", "give one of them")
