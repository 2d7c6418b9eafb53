"""A slope; what it shares with blocks: faces that are tilted, and soles that lie on them as a whole."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from surefoot.errors import at_least, at_most
from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import Array, FootstepPlan
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.robot import RobotFacts
from surefoot.scenarios.setup.terrain.kind import PLATFORM, TerrainKind, planned_soles, unreached, way

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft

STEEPEST = 0.35
"""Inclination beyond which no ground is made; the ankle has to turn as far [rad]."""

_FLUSH = 1e-3
"""How far a neighbouring face may rise above the plane of a sole [m]."""


class SlopeKind(TerrainKind):
    """A slope along the start heading; by default its edge is half a step ahead of the start."""

    name = "slope"
    keys = ("angle", "start", "height_noise")

    def build(self, draft: "Draft") -> Terrain:
        """See `TerrainKind`."""
        keys = draft.keys.terrain
        start = 0.5 * draft.keys.gait.step_length if keys.start is None else keys.start
        platform = PLATFORM * draft.size.length
        return Slope(keys.angle, start, way(draft) + platform, platform).build(draft.site)

    def problems(self, draft: "Draft", facts: RobotFacts) -> list[Problem]:
        """List what makes a slope impossible for a robot and its gait."""
        return list(steepness(draft)) or list(_extent(draft)) or list(_edge(draft, facts))


def steepness(draft: "Draft") -> Iterator[Problem]:
    """List a terrain.angle that makes no such ground, or one that friction does not hold."""
    terrain = draft.keys.terrain
    tilt, key = abs(terrain.angle), ("terrain", "angle")
    if terrain.kind == "slope" and tilt == 0.0:
        yield Problem(key, "terrain.angle 0 makes no slope", "use more or less than 0 rad, or kind flat")
    elif terrain.kind == "blocks" and terrain.angle < 0.0:
        yield Problem(key, f"terrain.angle {terrain.angle} rad is no half range", "use at least 0 rad")
    elif tilt > STEEPEST:
        right = f"use at most {STEEPEST} rad{meant(terrain.angle, 'rad', STEEPEST)}"
        yield Problem(key, f"terrain.angle {terrain.angle} rad is too steep", right)
    elif math.tan(tilt) >= terrain.friction:
        what = f"terrain.angle {terrain.angle} rad is steeper than terrain.friction {terrain.friction} holds"
        yield Problem(key, what, f"use less than {at_most(math.atan(terrain.friction))} rad, or more friction")


def first_sole_off_its_face(draft: "Draft", facts: RobotFacts) -> tuple[FootstepPlan, int | None]:
    """The footsteps, and the row of the first that would not have its whole sole on one face."""
    plan, corners = planned_soles(draft, facts)
    margins = draft.terrain.edge_margins(plan.position[:, :2], corners)
    beyond = np.flatnonzero((margins < -1e-9) | (_buried(draft.terrain, plan, corners) > _FLUSH))
    return plan, int(beyond[0]) if len(beyond) else None


def tilted_start(plan: FootstepPlan, facts: RobotFacts) -> Problem | None:
    """A walk that would start on a tilted face."""
    if not np.any(plan.normal[:2, 2] < 1.0):
        return None
    right = f"use at least {at_least(0.5 * facts.foot_length)} m, so that both feet stand level"
    return Problem(("terrain", "start"), "the walk would start on the slope", right)


def stander(row: int) -> str:
    """Who stands at a row of a footstep plan."""
    return f"footstep {row - 1}" if row > 1 else "a start foot"


def _extent(draft: "Draft") -> Iterator[Problem]:
    if draft.keys.terrain.height_noise > 0.0:
        what = "terrain.height_noise on a slope, which has one face only"
        yield Problem(("terrain", "height_noise"), what, "use 0, or kind stairs or blocks")


def _edge(draft: "Draft", facts: RobotFacts) -> Iterator[Problem]:
    plan, row = first_sole_off_its_face(draft, facts)
    tilted = tilted_start(plan, facts)
    if tilted is not None:
        yield tilted
    elif row is not None:
        what = f"{stander(row)} would stand across the edge of the slope"
        yield Problem(("terrain", "start"), what, "put the edge between two footsteps")
    else:
        yield from unreached(plan, "slope")


def _buried(terrain: Terrain, plan: FootstepPlan, corners: Array) -> Array:
    """How far the ground is above each sole's plane at the worst of its corners, shape (n + 2,) [m]."""
    heights = terrain.heights(corners.reshape(-1, 2)).reshape(corners.shape[:2])
    tilt = plan.normal[:, :2] / plan.normal[:, 2:]
    offsets = np.einsum("nkj,nj->nk", corners - plan.position[:, None, :2], tilt)
    return np.asarray(np.max(heights - plan.position[:, 2:] + offsets, axis=1))
