"""What a kind of terrain is, and the checks that several kinds share."""

from collections.abc import Iterator

import numpy as np

from surefoot.errors import at_most
from surefoot.models.facts import RobotFacts
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import FootstepPlan
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Gait, TerrainSettings
from surefoot.scenarios.file.units import meant
from surefoot.scenarios.setup.terrain.ground import Ground

PLATFORM = 1.0
"""Level ground kept before the first and after the last footstep on a platform, for the reference robot [m]."""

FOLDED = 0.5
"""Length of a leg with a deeply bent knee over its length with a straight one [-]."""


class TerrainKind:
    """A kind of terrain: how it is built of a scenario's keys, and what makes it impossible.

    To add one is a subclass in a file of its own, and its line in `KINDS`; another package registers an instance under
    an entry point of the group ``surefoot.terrains``.

    Attributes:
        name: value of ``terrain.kind``.
        keys: keys of ``terrain`` that shape it; friction is of all.
        settings: model of the group ``terrain``, with the keys that only this kind has, which need no mention above.
    """

    name: str
    keys: tuple[str, ...] = ()
    settings: type[TerrainSettings] = TerrainSettings

    def completed(self, keys: TerrainSettings, gait: Gait) -> Gait:
        """The keys of a gait with those that it leaves open and that follow from this ground."""
        return gait

    def build(self, ground: Ground) -> Terrain:
        """The ground as the planner believes it to be."""
        raise NotImplementedError

    def start_height(self, ground: Ground) -> float:
        """Height of the ground on which the robot starts [m]."""
        return ground.terrain.height(ground.start.x, ground.start.y)

    def problems(self, ground: Ground, facts: RobotFacts) -> list[Problem]:
        """List what makes it impossible for a robot and its gait."""
        return []

    def notes(self, ground: Ground) -> Iterator[str]:
        """Tell what of it the walk does not come to, a sentence each."""
        return iter(())


def climb_problems(ground: Ground, facts: RobotFacts, risers: int = 1) -> Iterator[Problem]:
    """List a terrain.riser of which a step goes up so many at once, which the legs cannot.

    The hips are at their height above the lower foot while the other leg folds on the tread above.
    """
    hips, riser = ground.standing_height - facts.com_above_hip, ground.keys.riser
    highest = (hips - FOLDED * facts.leg_length) / risers
    if riser > highest:
        what = f"terrain.riser {riser} m is out of reach of legs {facts.leg_length:.3f} m long"
        most = max(highest, 0.0)
        yield Problem(("terrain", "riser"), what, f"use at most {at_most(most)} m{meant(riser, 'm', most)}")


def unreached(plan: FootstepPlan, what: str) -> Iterator[Problem]:
    """Tell a walk that takes steps and leaves off before the ground is anything but level."""
    if plan.steps and np.ptp(plan.position[:, 2]) == 0.0 and (plan.normal[:, 2] == 1.0).all():
        said = f"none of {plan.steps} footsteps comes to the {what}, so that the walk is one on level ground"
        yield Problem(("terrain", "start"), said, "let it begin nearer, take more steps, or use kind flat")
