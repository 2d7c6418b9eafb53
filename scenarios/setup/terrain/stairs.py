"""Stairs: one foot per tread from where the walk starts, and soles that stand on their treads."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Terrain
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.setup.robot import RobotFacts
from surefoot.scenarios.setup.terrain.kind import PLATFORM, TerrainKind, climb_problems, planned_soles, way

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft

LANDING_TREADS = 3
"""Depth of a landing whose depth is not given, in treads: the gait keeps its rhythm on it."""

MOST_BEHIND = 0.03
"""How far behind mid-tread a foot stands at most: shanks lean forward and must not touch the edge ahead [m]."""

HEEL_ROOM = 0.015
"""Distance of the heel from the riser behind it on the way down [m]."""


class StairsKind(TerrainKind):
    """A staircase, from the middle of the start feet along the start heading."""

    name = "stairs"
    keys = ("riser", "tread", "count", "direction", "start", "landing", "height_noise")

    def build(self, draft: "Draft") -> Terrain:
        """See `TerrainKind`."""
        return stairs_of(draft).build(draft.site)

    def problems(self, draft: "Draft", facts: RobotFacts) -> list[Problem]:
        """List what makes a staircase impossible for a robot and its gait."""
        if draft.keys.gait.velocity:
            what = "gait.velocity on stairs, whose treads its footsteps would not meet"
            return [Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")]
        return list(_geometry(draft)) or list(climb_problems(draft, facts)) or list(_edges(draft, facts))


def stairs_of(draft: "Draft") -> Stairs:
    """The staircase of a scenario in the planner's terms."""
    keys = draft.keys.terrain
    fitted = draft.keys.gait.step_length - 0.5 * keys.tread + _behind(draft)
    return Stairs(
        riser=keys.riser,
        tread=keys.tread,
        count=keys.count,
        direction=Direction(keys.direction),
        start=fitted if keys.start is None else keys.start,
        landing=LANDING_TREADS * keys.tread if keys.landing is None else keys.landing,
        beyond=way(draft) + PLATFORM,
    )


def _behind(draft: "Draft") -> float:
    """How far behind mid-tread the feet stand: half of the room there, if the scenario says how long they are [m].

    Going down the heel also keeps its distance from the riser behind it, or the swing would have to go over that.
    """
    foot, keys = draft.keys.robot_options.foot_length, draft.keys.terrain
    if foot is None:
        return 0.0
    room = 0.5 * (keys.tread - foot)
    behind = min(MOST_BEHIND, max(0.0, 0.5 * room))
    return behind if keys.direction != "down" else min(behind, max(0.0, room - HEEL_ROOM))


def _geometry(draft: "Draft") -> Iterator[Problem]:
    terrain = draft.keys.terrain
    if terrain.riser == 0.0:
        yield Problem(("terrain", "riser"), "terrain.riser 0 makes no stairs", "use more than 0 m, or kind flat")
    elif terrain.height_noise >= terrain.riser:
        what = f"terrain.height_noise {terrain.height_noise} m may swallow risers of {terrain.riser} m"
        yield Problem(("terrain", "height_noise"), what, "use less than terrain.riser")


def _edges(draft: "Draft", facts: RobotFacts) -> Iterator[Problem]:
    plan, corners = planned_soles(draft, facts)
    margins = draft.terrain.edge_margins(plan.position[:, :2], corners)
    beyond = np.flatnonzero(margins < -1e-9)
    if not len(beyond):
        return
    over = -float(margins[beyond[0]])
    if beyond[0] < 2:
        what = f"the feet would start {over:.3f} m over the edge of the first stair"
        yield Problem(("terrain", "start"), what, f"use at least {0.5 * facts.foot_length:.3f} m")
        return
    what = f"footstep {beyond[0] - 1} would stand {over:.3f} m over the edge of its tread"
    right = "give gait.step_length the depth of terrain.tread, and a tread longer than the foot"
    yield Problem(("terrain", "tread"), what, right)
