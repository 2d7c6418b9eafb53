"""Tilted faces, on which soles lie as a whole: a slope, and stepping blocks under the footsteps that are asked for."""

import math
from collections.abc import Iterator

import numpy as np

from surefoot.errors import at_least, at_most
from surefoot.models.facts import RobotFacts
from surefoot.planner.ground.blocks import Blocks
from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import Array
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.terrain.ground import PLATFORM, Ground, TerrainKind, climb_problems, unreached

STEEPEST = 0.35
"""Inclination beyond which no ground is made; the ankle has to turn as far [rad]."""

_FLUSH = 1e-3
"""Height of a neighbouring face above the plane of a sole that does not count [m]."""


class SlopeKind(TerrainKind):
    """A slope along the start heading; by default its edge is half a step ahead of the start."""

    name = "slope"
    keys = ("angle", "start", "height_noise")

    def build(self, ground: Ground) -> Terrain:
        """See `TerrainKind`."""
        keys = ground.keys
        start = 0.5 * ground.steps.step_length if keys.start is None else keys.start
        platform = PLATFORM * ground.size.length
        return Slope(keys.angle, start, ground.way + platform, platform).build(ground.site)

    def problems(self, ground: Ground, facts: RobotFacts) -> list[Problem]:
        """List what makes a slope impossible for a robot and its gait."""
        if ground.keys.angle == 0.0:
            what, right = "terrain.angle 0 makes no slope", "use more or less than 0 rad, or kind flat"
            return [Problem(("terrain", "angle"), what, right)]
        if steep := list(steepness(ground)):
            return steep
        if ground.keys.height_noise > 0.0:
            what = "terrain.height_noise on a slope, which has one face only"
            return [Problem(("terrain", "height_noise"), what, "use 0, or kind stairs or blocks")]
        crossed = "would stand across the edge of the slope", "put the edge between two footsteps"
        return list(off_face(ground, facts, "start", *crossed)) or list(unreached(ground, "slope"))


def steepness(ground: Ground) -> Iterator[Problem]:
    """List a terrain.angle that makes no ground, or one that friction does not hold."""
    terrain = ground.keys
    tilt, key = abs(terrain.angle), ("terrain", "angle")
    if tilt > STEEPEST:
        right = f"use at most {STEEPEST} rad{meant(terrain.angle, 'rad', STEEPEST)}"
        yield Problem(key, f"terrain.angle {terrain.angle} rad is too steep", right)
    elif math.tan(tilt) >= terrain.friction:
        what = f"terrain.angle {terrain.angle} rad is steeper than terrain.friction {terrain.friction} holds"
        yield Problem(key, what, f"use less than {at_most(math.atan(terrain.friction))} rad, or more friction")


def off_face(ground: Ground, facts: RobotFacts, name: str, what: str, right: str) -> Iterator[Problem]:
    """Report a walk that would start on a tilted face, or else its first sole that would not be whole on one face.

    Args:
        ground: tilted in part.
        facts: of the robot.
        name: key of the terrain that is at fault for such a sole.
        what: becomes of the foot.
        right: what would be right.
    """
    if any(foot.normal[2] < 1.0 for foot in ground.footsteps[:2]):
        least = f"use at least {at_least(0.5 * facts.foot_length)} m, so that both feet stand level"
        yield Problem(("terrain", "start"), "the walk would start on the slope", least)
        return
    buried = _buried(ground, ground.soles(facts))
    beyond = np.flatnonzero((ground.edge_margins(facts) < -1e-9) | (buried > _FLUSH))
    if len(beyond):
        who = f"footstep {beyond[0] - 1}" if beyond[0] > 1 else "a start foot"
        yield Problem(("terrain", name), f"{who} {what}", right)


def _buried(ground: Ground, corners: Array) -> Array:
    """Height of the ground above each sole's plane at the worst of its corners, shape (n + 2,) [m]."""
    heights = ground.terrain.heights(corners.reshape(-1, 2)).reshape(corners.shape[:2])
    places, normals = ground.places, np.array([step.normal for step in ground.footsteps])
    tilt = normals[:, :2] / normals[:, 2:]
    offsets = np.einsum("nkj,nj->nk", corners - places[:, None, :2], tilt)
    return np.asarray(np.max(heights - places[:, 2:] + offsets, axis=1))


BLOCK_GAP = 0.02
"""Distance between blocks for the left and the right foot [m]."""

MOST_BLOCKS = 200
"""Blocks of a field, since every look at the ground goes through all of them [-]."""


class BlocksKind(TerrainKind):
    """A field of blocks; left and right ones stand side by side with a gap between them."""

    name = "blocks"
    keys = ("riser", "angle", "tread", "height_noise")

    def build(self, ground: Ground) -> Terrain:
        """See `TerrainKind`."""
        return blocks_of(ground).build(ground.site)

    def start_height(self, ground: Ground) -> float:
        """See `TerrainKind`."""
        return blocks_of(ground).middle

    def problems(self, ground: Ground, facts: RobotFacts) -> list[Problem]:
        """List what makes a field of blocks impossible for a robot and its gait."""
        if ground.keys.angle < 0.0:
            what = f"terrain.angle {ground.keys.angle} rad is no half range"
            return [Problem(("terrain", "angle"), what, "use at least 0 rad")]
        longest = "less than the way between two steps of a foot, or a wider gait.step_width"
        right = f"use more than the foot's {facts.foot_length:g} m and {longest}"
        parted = off_face(ground, facts, "tread", "would not have the whole sole on its block", right)
        return list(steepness(ground)) or list(_extent(ground, facts)) or list(parted)


def blocks_of(ground: Ground) -> Blocks:
    """The blocks of a scenario in the planner's terms."""
    keys = ground.keys
    return Blocks(keys.riser, keys.angle, keys.tread, ground.steps.step_width - BLOCK_GAP * ground.size.length)


def _extent(ground: Ground, facts: RobotFacts) -> Iterator[Problem]:
    gait = ground.steps
    if gait.velocity:
        what = "gait.velocity on blocks, which are laid under given footsteps"
        yield Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")
    elif max(gait.steps, len(gait.footsteps)) > MOST_BLOCKS:
        yield Problem(("gait", "steps"), "a field of so many blocks", f"take at most {MOST_BLOCKS} steps")
    elif gait.step_width <= (gap := BLOCK_GAP * ground.size.length):
        what = f"gait.step_width {gait.step_width} m leaves no width for blocks"
        yield Problem(("gait", "step_width"), what, f"use more than {gap:g} m")
    else:
        yield from climb_problems(ground, facts, risers=2)


SLOPE, BLOCKS = SlopeKind(), BlocksKind()
