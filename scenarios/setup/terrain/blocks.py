"""Stepping blocks, laid under the footsteps that a scenario asks for."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from surefoot.planner.ground.blocks import Blocks
from surefoot.planner.ground.terrain import Terrain
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.setup.robot import RobotFacts
from surefoot.scenarios.setup.terrain.kind import TerrainKind, climb_problems
from surefoot.scenarios.setup.terrain.slope import first_sole_off_its_face, stander, steepness, tilted_start

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft

BLOCK_GAP = 0.02
"""Between blocks for the left and the right foot [m]."""

MOST_BLOCKS = 200
"""Blocks of a field, since every look at the ground goes through all of them [-]."""


class BlocksKind(TerrainKind):
    """A field of blocks; left and right ones stand side by side with a gap between them."""

    name = "blocks"
    keys = ("riser", "angle", "tread", "height_noise")

    def build(self, draft: "Draft") -> Terrain:
        """See `TerrainKind`."""
        return blocks_of(draft).build(draft.site)

    def start_height(self, draft: "Draft") -> float:
        """See `TerrainKind`."""
        return blocks_of(draft).middle

    def problems(self, draft: "Draft", facts: RobotFacts) -> list[Problem]:
        """List what makes a field of blocks impossible for a robot and its gait."""
        return list(steepness(draft)) or list(_extent(draft, facts)) or list(_edges(draft, facts))


def blocks_of(draft: "Draft") -> Blocks:
    """The blocks of a scenario in the planner's terms."""
    keys = draft.keys.terrain
    return Blocks(keys.riser, keys.angle, keys.tread, draft.keys.gait.step_width - BLOCK_GAP * draft.size.length)


def _extent(draft: "Draft", facts: RobotFacts) -> Iterator[Problem]:
    gait = draft.keys.gait
    if gait.velocity:
        what = "gait.velocity on blocks, which are laid under given footsteps"
        yield Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")
    elif max(gait.steps, len(gait.footsteps)) > MOST_BLOCKS:
        yield Problem(("gait", "steps"), "a field of so many blocks", f"take at most {MOST_BLOCKS} steps")
    elif gait.step_width <= (gap := BLOCK_GAP * draft.size.length):
        what = f"gait.step_width {gait.step_width} m leaves no width for blocks"
        yield Problem(("gait", "step_width"), what, f"use more than {gap:g} m")
    else:
        yield from climb_problems(draft, facts, risers=2)


def _edges(draft: "Draft", facts: RobotFacts) -> Iterator[Problem]:
    plan, row = first_sole_off_its_face(draft, facts)
    tilted = tilted_start(plan, facts)
    if tilted is not None:
        yield tilted
    elif row is not None:
        what = f"{stander(row)} would not have the whole sole on its block"
        right = f"use more than the foot's {facts.foot_length:g} m and less than the way between two steps of a foot"
        yield Problem(("terrain", "tread"), what, f"{right}, or a wider gait.step_width")
