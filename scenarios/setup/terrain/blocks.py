"""Stepping blocks, laid under the footsteps that a scenario asks for."""

from collections.abc import Iterator

from surefoot.models.facts import RobotFacts
from surefoot.planner.ground.blocks import Blocks
from surefoot.planner.ground.terrain import Terrain
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.setup.terrain.ground import Ground, TerrainKind, climb_problems
from surefoot.scenarios.setup.terrain.slope import off_face, steepness

BLOCK_GAP = 0.02
"""Between blocks for the left and the right foot [m]."""

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
