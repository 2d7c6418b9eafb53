"""The constants of a walk: robot and ground as the planner knows them, and what it works out of them once."""

import math
from dataclasses import dataclass

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.model.world_motion import WorldMotion
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.capture_margin import CaptureMargin
from surefoot.planner.recovery.outlook import Outlook
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.references.com_height import HeightProfile
from surefoot.planner.references.leg_offset import LegOffset, softening
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import Array


@dataclass(frozen=True, eq=False)
class WalkModel:
    """Robot and ground as the planner knows them, which no tick changes.

    Its laws have memory to work in and remember nothing: the same arguments give the same answer.

    Attributes:
        gait: the walk.
        ground: to lay steps on.
        heights: law of the CoM height.
        legs: what they can do; None where it is not known.
        world: CoM motion between the world and the plan frame.
        outlook: what the CoP captures with the steps as planned.
        margin: what steps that are moved capture; None where the legs are not known.
        adjustment: of the next step; None where the legs are not known.
        leg_offset: what the legs' inertia adds to the ZMP; None for a body that is a point mass.
        softening: factor of the pendulum's stiffness by the legs' masses [-].
        parameters: the planner's own numbers.
        terrain: the ground as the planner believes it to be.
        half_size: half of the sole's length and width, shape (2,) [m].
        count: samples of a window of references [-].
        reach: samples that are looked at [-].
        follows: footholds are free, and those to come follow one that is moved; else they were chosen for their faces.
        adapts: footsteps may be moved. It takes legs that are known to move those that were chosen for their faces.
        times: steps may be made sooner or later.
        hardest: acceleration that hips, and knees, can give a foot; infinite for legs that nobody knows [m/s^2].
    """

    gait: GaitParameters
    ground: Ground
    heights: HeightProfile
    legs: LegReach | None
    world: WorldMotion
    outlook: Outlook
    margin: CaptureMargin | None
    adjustment: StepAdjustment | None
    leg_offset: LegOffset | None
    softening: float
    parameters: PlannerParameters
    terrain: Terrain
    half_size: Array
    count: int
    reach: int
    follows: bool
    adapts: bool
    times: bool
    hardest: float

    @classmethod
    def of(cls, gait: GaitParameters, ground: Ground, heights: HeightProfile, legs: LegReach | None) -> "WalkModel":
        """The model of a walk; arguments are attributes."""
        p, half_size, adaptation = ground.parameters, ground.half_size, ground.parameters.step_adaptation
        reach, follows, known = samples_ahead(p), ground.terrain.footholds.follow, legs is not None
        inertia = None if p.leg.chain is None else LegOffset(p.leg, float(half_size[0]), p.sample_time, reach)
        return cls(
            gait=gait,
            ground=ground,
            heights=heights,
            legs=legs,
            world=WorldMotion(p.sample_time, p.horizon),
            outlook=Outlook(p),
            margin=None if legs is None else CaptureMargin(legs, p, half_size),
            adjustment=None if legs is None else StepAdjustment(legs, p),
            leg_offset=inertia,
            softening=softening(p.leg),
            parameters=p,
            terrain=ground.terrain,
            half_size=half_size,
            count=p.horizon + p.preview + 1,
            reach=reach,
            follows=follows,
            adapts=adaptation.places and (follows or known),
            times=follows and known and adaptation.timing,
            hardest=math.inf if legs is None else float(legs.acceleration[0]),
        )


def samples_ahead(parameters: PlannerParameters) -> int:
    """Samples that are looked at: offsets serve for some ticks, at the last of which they are to cover a window [-]."""
    return parameters.horizon + parameters.preview + parameters.recovery.offset_ticks
