"""Stairs: one foot per tread from where the walk starts, and soles that stand on their treads."""

import math
from collections.abc import Iterator

import numpy as np

from surefoot.errors import at_least
from surefoot.models.facts import RobotFacts
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Terrain
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.schema import TerrainSettings
from surefoot.scenarios.setup.terrain.ground import PLATFORM, Ground, TerrainKind, climb_problems, unreached

LANDING_TREADS = 3
"""Depth of a landing whose depth is not given, in treads: the gait keeps its rhythm on it."""

MOST_BEHIND = 0.03
"""Greatest distance of a foot behind mid-tread: shanks lean forward and must not touch the edge ahead [m]."""

HEEL_ROOM = 0.015
"""Distance of the heel from the riser behind it on the way down [m]."""


class StairsKind(TerrainKind):
    """A staircase, from the middle of the start feet along the start heading."""

    name = "stairs"
    keys = ("riser", "tread", "count", "direction", "start", "landing", "height_noise")

    def completed(self, keys: TerrainSettings, gait: Gait) -> Gait:
        """A step is as long as a tread is deep, unless the scenario gives its length."""
        given = "step_length" in gait.model_fields_set
        return gait if given else gait.model_copy(update={"step_length": keys.tread})

    def build(self, ground: Ground) -> Terrain:
        """See `TerrainKind`."""
        return stairs_of(ground).build(ground.site)

    def problems(self, ground: Ground, facts: RobotFacts) -> list[Problem]:
        """List what makes a staircase impossible for a robot and its gait."""
        if ground.steps.velocity:
            what = "gait.velocity on stairs, whose treads its footsteps would not meet"
            return [Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")]
        return list(_geometry(ground)) or list(climb_problems(ground, facts)) or list(_edges(ground, facts))

    def notes(self, ground: Ground) -> Iterator[str]:
        """See `TerrainKind`."""
        stairs, taken = ground.keys, sum(_risers(ground))
        there = stairs.count * (2 if stairs.direction == "up_down" else 1)
        if taken < there:
            yield f"the footsteps take {taken} of the {there} risers of the stairs"
        if stairs.landing is not None and stairs.direction != "up_down":
            yield f"terrain.landing has no effect on stairs whose terrain.direction is {stairs.direction}"


def _risers(ground: Ground) -> list[int]:
    """Number of risers that each footstep takes, up or down, in order."""
    heights = ground.places[:, 2]
    return [int(number) for number in np.round(np.abs(np.diff(heights)) / ground.keys.riser)]


def stairs_of(ground: Ground) -> Stairs:
    """The staircase of a scenario in the planner's terms."""
    keys = ground.keys
    fitted = ground.steps.step_length - 0.5 * keys.tread + _behind(ground)
    return Stairs(
        riser=keys.riser,
        tread=keys.tread,
        count=keys.count,
        direction=Direction(keys.direction),
        start=fitted if keys.start is None else keys.start,
        landing=LANDING_TREADS * keys.tread if keys.landing is None else keys.landing,
        beyond=ground.way + PLATFORM * ground.size.length,
    )


def _behind(ground: Ground) -> float:
    """Distance of feet of known length behind mid-tread: half of the room, going down away from risers [m]."""
    foot, keys, length = ground.sole, ground.keys, ground.size.length
    if foot is None:
        return 0.0
    room = 0.5 * (keys.tread - foot)
    behind = min(MOST_BEHIND * length, max(0.0, 0.5 * room))
    return behind if keys.direction != "down" else min(behind, max(0.0, room - HEEL_ROOM * length))


def _geometry(ground: Ground) -> Iterator[Problem]:
    terrain = ground.keys
    if terrain.riser == 0.0:
        yield Problem(("terrain", "riser"), "terrain.riser 0 makes no stairs", "use more than 0 m, or kind flat")
    elif terrain.height_noise >= terrain.riser:
        what = f"terrain.height_noise {terrain.height_noise} m may swallow risers of {terrain.riser} m"
        yield Problem(("terrain", "height_noise"), what, "use less than terrain.riser")


def _edges(ground: Ground, facts: RobotFacts) -> Iterator[Problem]:
    margins = ground.edge_margins(facts)
    beyond = np.flatnonzero(margins < -1e-9)
    if len(beyond):
        yield _over_edge(ground, facts, int(beyond[0]), -float(margins[beyond[0]]))
    else:
        yield from _leaps(ground)
        yield from unreached(ground, "stairs")


def _over_edge(ground: Ground, facts: RobotFacts, row: int, over: float) -> Problem:
    terrain, gait = ground.keys, ground.steps
    fit = f"give gait.step_length the depth of terrain.tread, {terrain.tread:g} m"
    if row < 2:
        what, least = f"the feet would start {over:.3f} m over the edge of the first stair", 0.5 * facts.foot_length
        if terrain.start is None:
            return Problem(("gait", "step_length"), what, f"{fit}, or terrain.start at least {at_least(least)} m")
        return Problem(("terrain", "start"), what, f"use at least {at_least(least)} m")
    what = f"footstep {row - 1} would stand {over:.3f} m over the edge of its tread"
    if _beyond_climb(ground, row) and terrain.landing is not None:
        steps = max(1, math.floor(terrain.landing / terrain.tread))
        sizes = " or ".join(f"{number * terrain.tread:g} m" for number in (steps, steps + 1))
        return Problem(("terrain", "landing"), f"{what}, with terrain.landing {terrain.landing:g} m", f"use {sizes}")
    if gait.turn and not ground.commanded:
        return Problem(("gait", "turn"), f"{what}, as the walk turns", "use 0 on stairs")
    return Problem(("terrain", "tread"), what, f"{fit}, and a tread longer than the foot")


def _beyond_climb(ground: Ground, row: int) -> bool:
    """Return true if a row of the footsteps lies beyond the last riser of the way up, or steps over it."""
    if ground.keys.direction != "up_down":
        return False
    stairs, yaw = stairs_of(ground), ground.start.yaw
    way = (ground.footsteps[row].position[:2] - ground.origin) @ (math.cos(yaw), math.sin(yaw))
    return bool(way > stairs.start + (stairs.count - 1) * stairs.tread)


def _leaps(ground: Ground) -> Iterator[Problem]:
    """Report the first step that takes more than one riser."""
    riser, risers = ground.keys.riser, _risers(ground)
    rows = [row for row, number in enumerate(risers) if number > 1]
    if rows:
        what = f"footstep {rows[0]} would take {risers[rows[0]]:g} risers of {riser:g} m at once"
        right = f"give gait.step_length the depth of terrain.tread, {ground.keys.tread:g} m"
        yield Problem(("gait", "footsteps" if ground.commanded else "step_length"), what, right)


STAIRS = StairsKind()
