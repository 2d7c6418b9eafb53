"""What a kind of terrain is, and the checks that several kinds share."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from surefoot.errors import at_most
from surefoot.planner.geometry import sole_corners
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.types import Array, FootstepPlan
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.robot import RobotFacts

if TYPE_CHECKING:
    from surefoot.scenarios.setup.draft import Draft

PLATFORM = 1.0
"""Level ground kept before the first and after the last footstep on a platform, for the reference robot [m]."""

FOLDED = 0.5
"""Length of a leg with a deeply bent knee over its length with a straight one [-]."""

MOST_STEPS = 2000
"""Footsteps that are looked at; those after the last stair stand on its platform [-]."""


class TerrainKind:
    """A kind of terrain: how it is built of a scenario's keys, and what makes it impossible.

    To add one is a subclass in a file of its own, and its line in `KINDS`; another package registers an instance under
    an entry point of the group ``surefoot.terrains``.

    Attributes:
        name: value of ``terrain.kind``.
        keys: keys of ``terrain`` that shape it; friction is of all.
    """

    name: str
    keys: tuple[str, ...] = ()

    def completed(self, keys: Scenario) -> Scenario:
        """The scenario with keys that it leaves open and that follow from this ground."""
        return keys

    def build(self, draft: "Draft") -> Terrain:
        """The ground as the planner believes it to be."""
        raise NotImplementedError

    def start_height(self, draft: "Draft") -> float:
        """Height of the ground on which the robot starts [m]."""
        return draft.terrain.height(draft.keys.start.x, draft.keys.start.y)

    def problems(self, draft: "Draft", facts: RobotFacts) -> list[Problem]:
        """List what makes it impossible for a robot and its gait."""
        return []

    def notes(self, draft: "Draft") -> Iterator[str]:
        """Tell what of it the walk does not come to, a sentence each."""
        return iter(())


def way(draft: "Draft") -> float:
    """Way that the steps go at most [m]."""
    keys = draft.keys.gait
    if not draft.commanded:
        return keys.steps * abs(keys.step_length)
    return sum(abs(stride.length) for stride in draft.gait.strides)


def climb_problems(draft: "Draft", facts: RobotFacts, risers: int = 1) -> Iterator[Problem]:
    """List a terrain.riser of which a step goes up so many at once, which the legs cannot.

    The hips are at their height above the lower foot while the other leg folds on the tread above.
    """
    hips, riser = draft.standing_height - facts.com_above_hip, draft.keys.terrain.riser
    highest = (hips - FOLDED * facts.leg_length) / risers
    if riser > highest:
        what = f"terrain.riser {riser} m is out of reach of legs {facts.leg_length:.3f} m long"
        most = max(highest, 0.0)
        yield Problem(("terrain", "riser"), what, f"use at most {at_most(most)} m{meant(riser, 'm', most)}")


def laid(draft: "Draft") -> FootstepPlan:
    """The footsteps on the ground as believed, start feet first."""
    gait = draft.gait
    if not draft.commanded:
        gait = replace(gait, steps=min(gait.steps, MOST_STEPS))
    return plan_footsteps(gait, draft.stance, draft.terrain)


def unreached(plan: FootstepPlan, what: str) -> Iterator[Problem]:
    """Tell a walk that takes steps and leaves off before the ground is anything but level."""
    if plan.steps and np.ptp(plan.position[:, 2]) == 0.0 and (plan.normal[:, 2] == 1.0).all():
        said = f"none of {plan.steps} footsteps comes to the {what}, so that the walk is one on level ground"
        yield Problem(("terrain", "start"), said, "let it begin nearer, take more steps, or use kind flat")


def planned_soles(draft: "Draft", facts: RobotFacts) -> tuple[FootstepPlan, Array]:
    """The footsteps, and the corners of their soles, start feet first, shape (n + 2, 4, 2) [m]."""
    plan = laid(draft)
    half_size = 0.5 * np.array([facts.foot_length, facts.foot_width])
    soles = [plan.footstep(row) for row in range(plan.steps + 2)]
    return plan, np.array([sole_corners(sole, half_size) for sole in soles])
