"""The profiles by name: parameters, CoM height and law of motion of each."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from surefoot.planner.laws.dcm_feedback import DcmFeedback
from surefoot.planner.laws.footstep_tvmpc import ConstantHeightTvmpc, FootstepTvmpc
from surefoot.planner.laws.law import MotionPlanner
from surefoot.planner.laws.names import PROFILES
from surefoot.planner.laws.tvmpc import paper_law, repaired_law
from surefoot.planner.laws.zmp_preview import ZmpPreview
from surefoot.planner.model.jerk import BLOCK_STARTS
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.plan.plan import Planner
from surefoot.planner.references.com_height import HeightProfile, PaperHeight
from surefoot.planner.rules import RULES, Rule

_BOUNDS = ("jerk_limit", "jerk_rate_limit")


@dataclass(frozen=True, slots=True)
class Profile:
    """A formulation of the planner.

    Attributes:
        name: its name.
        doc: what it is, in one line without a full stop.
        parameters: its parameters, of a class of their own where the law has numbers that no other has.
        law: makes its law of motion, from these parameters and the CoM height over the ground at rest [m].
        moves: whether it optimises moves of the jerk, whose number may be chosen.
        height: vertical CoM motion that belongs to it; None for what the user chooses.
        catches: whether its law moves footsteps as it needs to, so that place and time of a step may be adapted to all
            that the legs can do (see `planner.recovery.step_adjustment`).
        planner: makes a planner that takes the place of `planner.planner.WalkingPlanner`, from the same arguments; None
            for that one.
        rules: what is made of the steps to come, in their order (see `planner.rules`).
        numbers: bounds and weights among its parameters that its law reads: keys of a scenario's group ``planner``.
    """

    name: str
    doc: str
    parameters: PlannerParameters
    law: Callable[[Any, float], MotionPlanner]
    moves: bool
    height: HeightProfile | None = None
    catches: bool = False
    planner: Callable[..., Planner] | None = None
    rules: tuple[Rule, ...] = RULES
    numbers: tuple[str, ...] = _BOUNDS


_PAPER = PlannerParameters(
    horizon=50,
    moves=(0, 1),
    jerk_limit=1.5,
    jerk_rate_limit=0.1,
    jerk_weight=0.0,
    foot_margin=0.9,
    zmp_slack=(1e4, 10.0),
    terminal_margin=1.0,
)
_REPAIRED = replace(_PAPER, moves=BLOCK_STARTS)

_SAID = PROFILES.said

_WEIGHED = (*_BOUNDS, "jerk_weight", "terminal_weight", "step_weight")

DEFAULT = Profile("default", _SAID["default"], PlannerParameters(), FootstepTvmpc, True, catches=True, numbers=_WEIGHED)
PAPER = Profile(
    "paper", _SAID["paper"], _PAPER, paper_law, True, height=PaperHeight(), numbers=(*_BOUNDS, "jerk_weight")
)
REPAIRED = Profile("repaired", _SAID["repaired"], _REPAIRED, repaired_law, True, numbers=(*_BOUNDS, "jerk_weight"))
LTI = Profile("lti", _SAID["lti"], PlannerParameters(), ConstantHeightTvmpc, True, catches=True, numbers=_WEIGHED)
PREVIEW = Profile("preview", _SAID["preview"], PlannerParameters(), ZmpPreview, moves=False)
DCM = Profile("dcm", _SAID["dcm"], PlannerParameters(), DcmFeedback, moves=False)
