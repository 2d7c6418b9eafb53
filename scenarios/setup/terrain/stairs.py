"""Stairs: one foot per tread from where the walk starts, and soles that stand on their treads."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from surefoot.errors import at_least
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import FootstepPlan
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.robot import RobotFacts
from surefoot.scenarios.setup.terrain.kind import (
    PLATFORM,
    TerrainKind,
    climb_problems,
    laid,
    planned_soles,
    unreached,
    way,
)

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

    def completed(self, keys: Scenario) -> Scenario:
        """A step is as long as a tread is deep, unless the scenario gives its length."""
        if "step_length" in keys.gait.model_fields_set:
            return keys
        return keys.model_copy(update={"gait": keys.gait.model_copy(update={"step_length": keys.terrain.tread})})

    def build(self, draft: "Draft") -> Terrain:
        """See `TerrainKind`."""
        return stairs_of(draft).build(draft.site)

    def problems(self, draft: "Draft", facts: RobotFacts) -> list[Problem]:
        """List what makes a staircase impossible for a robot and its gait."""
        if draft.keys.gait.velocity:
            what = "gait.velocity on stairs, whose treads its footsteps would not meet"
            return [Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")]
        return list(_geometry(draft)) or list(climb_problems(draft, facts)) or list(_edges(draft, facts))

    def notes(self, draft: "Draft") -> Iterator[str]:
        """See `TerrainKind`."""
        stairs, taken = draft.keys.terrain, sum(_risers(draft, laid(draft)))
        there = stairs.count * (2 if stairs.direction == "up_down" else 1)
        if taken < there:
            yield f"the footsteps take {taken} of the {there} risers of the stairs"
        if stairs.landing is not None and stairs.direction != "up_down":
            yield f"terrain.landing has no effect on stairs whose terrain.direction is {stairs.direction}"


def _risers(draft: "Draft", plan: FootstepPlan) -> list[int]:
    """How many risers each footstep takes, up or down, in order."""
    return [int(number) for number in np.round(np.abs(np.diff(plan.position[:, 2])) / draft.keys.terrain.riser)]


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
        beyond=way(draft) + PLATFORM * draft.size.length,
    )


def _behind(draft: "Draft") -> float:
    """How far behind mid-tread the feet stand: half of the room there, if the scenario says how long they are [m].

    Going down the heel also keeps its distance from the riser behind it, or the swing would have to go over that.
    """
    foot, keys, length = draft.sole, draft.keys.terrain, draft.size.length
    if foot is None:
        return 0.0
    room = 0.5 * (keys.tread - foot)
    behind = min(MOST_BEHIND * length, max(0.0, 0.5 * room))
    return behind if keys.direction != "down" else min(behind, max(0.0, room - HEEL_ROOM * length))


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
    if len(beyond):
        yield _over_edge(draft, facts, plan, int(beyond[0]), -float(margins[beyond[0]]))
    else:
        yield from _leaps(draft, plan)
        yield from unreached(plan, "stairs")


def _over_edge(draft: "Draft", facts: RobotFacts, plan: FootstepPlan, row: int, over: float) -> Problem:
    terrain, gait = draft.keys.terrain, draft.keys.gait
    fit = f"give gait.step_length the depth of terrain.tread, {terrain.tread:g} m"
    if row < 2:
        what, least = f"the feet would start {over:.3f} m over the edge of the first stair", 0.5 * facts.foot_length
        if terrain.start is None:
            return Problem(("gait", "step_length"), what, f"{fit}, or terrain.start at least {at_least(least)} m")
        return Problem(("terrain", "start"), what, f"use at least {at_least(least)} m")
    what = f"footstep {row - 1} would stand {over:.3f} m over the edge of its tread"
    if _beyond_climb(draft, plan, row) and terrain.landing is not None:
        steps = max(1, math.floor(terrain.landing / terrain.tread))
        sizes = " or ".join(f"{number * terrain.tread:g} m" for number in (steps, steps + 1))
        return Problem(("terrain", "landing"), f"{what}, with terrain.landing {terrain.landing:g} m", f"use {sizes}")
    if gait.turn and not draft.commanded:
        return Problem(("gait", "turn"), f"{what}, as the walk turns", "use 0 on stairs")
    return Problem(("terrain", "tread"), what, f"{fit}, and a tread longer than the foot")


def _beyond_climb(draft: "Draft", plan: FootstepPlan, row: int) -> bool:
    """Whether a row of the footsteps lies beyond the last riser of the way up, or is the one that steps over it."""
    if draft.keys.terrain.direction != "up_down":
        return False
    stairs, yaw = stairs_of(draft), draft.keys.start.yaw
    way = (plan.position[row, :2] - draft.origin) @ (math.cos(yaw), math.sin(yaw))
    return bool(way > stairs.start + (stairs.count - 1) * stairs.tread)


def _leaps(draft: "Draft", plan: FootstepPlan) -> Iterator[Problem]:
    """Tell the first step that takes more than one riser."""
    riser, risers = draft.keys.terrain.riser, _risers(draft, plan)
    rows = [row for row, number in enumerate(risers) if number > 1]
    if rows:
        what = f"footstep {rows[0]} would take {risers[rows[0]]:g} risers of {riser:g} m at once"
        right = f"give gait.step_length the depth of terrain.tread, {draft.keys.terrain.tread:g} m"
        yield Problem(("gait", "footsteps" if draft.commanded else "step_length"), what, right)
