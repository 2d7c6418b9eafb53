"""The paper's claims, each with the rule by which the numbers of the runs decide whether it holds."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from surefoot.scenarios.study.paper import rules
from surefoot.scenarios.study.paper.results import Results
from surefoot.scenarios.study.paper.rules import AXES_APART, BETTER, FOOT_EDGE, STRONGER, Assessment
from surefoot.scenarios.study.paper.studies import HEIGHTS, NOISE_STAIRS, NOISE_WALK, PUSHES, STAIRS, WALK


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of the paper.

    Attributes:
        name: its anchor.
        section: of the paper.
        text: what the paper says.
        rule: how the verdict follows from the numbers, in words.
        judge: the same as a function.
    """

    name: str
    section: str
    text: str
    rule: str
    judge: Callable[[Results], Assessment]


_SURVIVES = (
    "Holds when no run of `paper` on the pendulum and none of `default` in full physics falls or has its ZMP outside "
    "{edge}; with a change when that is so for `repaired` or `default` on the pendulum instead of `paper`. "
    "Runs in full physics that are not available are left out."
)
_BOX = _SURVIVES.format(edge="the support of feet shrunk to 90 %")
_SOLES = _SURVIVES.format(edge="the planned support")

CLAIMS: tuple[Claim, ...] = (
    Claim(
        "claim-walk", "V-B",
        "The planner generates stable walking and keeps the actual ZMP inside the support polygon.",
        _BOX, partial(rules.survival, studies=(WALK,), full=(WALK,), margin=0.0),
    ),
    Claim(
        "claim-hard", "III-B", "The ZMP constraint is hard: the solution must always satisfy it.",
        "Holds when every plan of `paper` on the pendulum had a solution within all hard limits; with a change when "
        "every plan of `repaired` had.", rules.hard_constraint,
    ),
    Claim(
        "claim-stairs", "V-C", "The method generates stable stair climbing, with stairs of 0.1 m.",
        _BOX, partial(rules.survival, studies=(STAIRS[0],), full=(STAIRS[0],), margin=0.0),
    ),
    Claim(
        "claim-preview", "I, VI", "Previewing the changes of the dynamics improves the performance of the planner.",
        f"Holds when the RMS of the ZMP error on the pendulum without preview (`lti`) is at least {BETTER:g} times "
        "that with it (`default`) and their ranges over seeds do not overlap, on flat ground and on every stair; with "
        "a change when on the stairs only.", rules.preview,
    ),
    Claim(
        "claim-noise", "V-D", "The planner is robust against measurement noise of ±0.02 m, walking and on stairs.",
        _SOLES, partial(rules.survival, studies=(NOISE_WALK, NOISE_STAIRS), full=(NOISE_WALK,), margin=FOOT_EDGE),
    ),
    Claim(
        "claim-filter", "II-B, V-D", "A Kalman filter on the measured ZMP gives the state that the planner needs.",
        "Holds when no run with the ZMP alone falls on the pendulum, where the planner alone closes the loop, or has "
        "its ZMP outside the planned support; with a change when that is so for `repaired` or `default` with the "
        "filter that also sees the CoM, and in full physics.", rules.zmp_filter,
    ),
    Claim(
        "claim-height", "V-E", "With a CoM height wrong by ±0.1 and ±0.2 m walking is stable and the ZMP stays inside.",
        _SOLES, partial(rules.survival, studies=HEIGHTS, full=HEIGHTS, margin=FOOT_EDGE),
    ),
    Claim(
        "claim-frontal", "V-E", "Unlike in the sagittal plane, the height error matters in the frontal plane.",
        f"Holds when the most that the four errors add to the RMS of the ZMP error is {AXES_APART:g} times as much "
        "in y as in x, for `repaired` and `default` on the pendulum and `default` in full physics.",
        rules.frontal_effect,
    ),
    Claim(
        "claim-push", "V-F", "The planner is robust against pushes of ±50 and ±75 N for 10 ms, with noise.",
        _SOLES, partial(rules.survival, studies=PUSHES, full=PUSHES, margin=FOOT_EDGE),
    ),
    Claim(
        "claim-adaptation", "I, VI", "Moving the landing location by the DCM helps against severe disturbances.",
        "Holds when `paper` with its step law walks on the pendulum; with a change (footsteps in the QP of `default`) "
        f"when the largest impulse survived, mean of four directions, grows at least {STRONGER:g} times.",
        rules.adaptation,
    ),
    Claim(
        "claim-online", "III", "The planner works online.",
        "Holds when the median plan of `paper` on the pendulum and of `default` in full physics takes less than the "
        "sample time of 20 ms, on the machine that made the logs, with all its cores busy.", rules.online,
    ),
    Claim(
        "claim-stretched", "IV-B, V-B", "The robot walks with mostly stretched knees.",
        "Holds when the knees' mean flexion while walking is at most 25 degrees in both gaits; with a change when in "
        "one of them.", rules.stretched_knees,
    ),
    Claim(
        "claim-torque", "IV", "Always bending the knees takes high torques in them; stretched knees take less.",
        "Holds when the RMS of the knee torques is at least 5 % lower with stretched than with bent knees at the same "
        "speed, in both gaits; with a change when in one of them.",
        partial(rules.saving, metric="knee_torque_rms", name="knee torque RMS"),
    ),
    Claim(
        "claim-energy", "IV, VII", "Walking with mostly stretched knees is more energy efficient.",
        "Holds when the cost of transport is at least 5 % lower with stretched than with bent knees at the same speed, "
        "in both gaits; with a change when in one of them.",
        partial(rules.saving, metric="cost_of_transport", name="cost of transport"),
    ),
)  # fmt: skip
"""Those of knees and energy, which stand last, are judged in full physics: a pendulum has no knees."""
