"""The planner layer: gait, footsteps, references and the laws of motion that plan CoM, ZMP and footsteps at every tick.

`WalkingPlanner` makes a `WalkPlan` of a `CentroidalState` and a `FeetState`, and `PlanSampler` evaluates it in between:

    planner = WalkingPlanner(GaitParameters(steps=4), feet, foot_length=0.22, foot_width=0.11)
    plan = planner.update(CentroidalState(0.0, com, com_velocity), feet)
    sample = PlanSampler(plan).sample(0.01)

What varies is an object. A `MotionPlanner` is a law of motion, and a `Profile` of `PROFILES` makes one. Anything that
is a `Planner` can stand in a closed loop. The names below are imported when they are first asked for, since a part of
the layer is wanted more often than its solvers.
"""

from typing import TYPE_CHECKING

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.planner.ground.terrain import Box, Terrain, flat
    from surefoot.planner.laws.law import BuiltQps, Motion, MotionPlanner, MotionProblem, QpLaw
    from surefoot.planner.laws.names import PROFILES
    from surefoot.planner.laws.profiles import Profile
    from surefoot.planner.laws.qp import Qp, QpSolution, solve
    from surefoot.planner.look import View
    from surefoot.planner.parameters import LegInertia, PlannerParameters, StepAdaptation
    from surefoot.planner.plan.plan import Planner, WalkPlan
    from surefoot.planner.plan.sample import PlanSample
    from surefoot.planner.plan.sampling import PlanSampler
    from surefoot.planner.planner import WalkingPlanner
    from surefoot.planner.plants import IdealFeet, Pendulum
    from surefoot.planner.rules import RULES, Rule
    from surefoot.planner.steps.commands import Command, velocity_bouts, walk_of
    from surefoot.planner.steps.gait import Bout, GaitParameters
    from surefoot.planner.types import CentroidalState, FeetState, Foot, Footstep, PhaseKind, Twist

__all__ = [
    "PROFILES",
    "RULES",
    "Bout",
    "Box",
    "BuiltQps",
    "CentroidalState",
    "Command",
    "FeetState",
    "Foot",
    "Footstep",
    "GaitParameters",
    "IdealFeet",
    "LegInertia",
    "Motion",
    "MotionPlanner",
    "MotionProblem",
    "Pendulum",
    "PhaseKind",
    "PlanSample",
    "PlanSampler",
    "Planner",
    "PlannerParameters",
    "Profile",
    "Qp",
    "QpLaw",
    "QpSolution",
    "Rule",
    "StepAdaptation",
    "Terrain",
    "Twist",
    "View",
    "WalkPlan",
    "WalkingPlanner",
    "flat",
    "solve",
    "velocity_bouts",
    "walk_of",
]

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            "ground.terrain": ("Box", "Terrain", "flat"),
            "laws.law": ("BuiltQps", "Motion", "MotionPlanner", "MotionProblem", "QpLaw"),
            "laws.names": ("PROFILES",),
            "laws.profiles": ("Profile",),
            "laws.qp": ("Qp", "QpSolution", "solve"),
            "look": ("View",),
            "parameters": ("LegInertia", "PlannerParameters", "StepAdaptation"),
            "plan.plan": ("Planner", "WalkPlan"),
            "plan.sample": ("PlanSample",),
            "rules": ("RULES", "Rule"),
            "plan.sampling": ("PlanSampler",),
            "planner": ("WalkingPlanner",),
            "plants": ("IdealFeet", "Pendulum"),
            "types": ("CentroidalState", "FeetState", "Foot", "Footstep", "PhaseKind", "Twist"),
            "steps.commands": ("Command", "velocity_bouts", "walk_of"),
            "steps.gait": ("Bout", "GaitParameters"),
        },
    )
