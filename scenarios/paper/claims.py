"""The paper's claims, each with the rule by which the numbers of a run decide whether it holds."""

from collections.abc import Sequence
from functools import partial

from surefoot.scenarios.paper.claim import FOOT_EDGE, Claim, Finding, any_of, balance_text, grade, stable
from surefoot.scenarios.paper.results import Results, Sample
from surefoot.scenarios.paper.studies import (
    HEIGHTS,
    NOISE_ALONE,
    NOISE_STAIRS,
    NOISE_WALK,
    PUSHES,
    SHOVE_DIRECTIONS,
    SHOVE_IMPULSES,
    STAIRS,
    STEP_LAW,
    WALK,
    ZMP_ONLY,
    Study,
)
from surefoot.scenarios.paper.tables import PERCENT, error_norms, feasible, preview_gain, spread_text, survived
from surefoot.scenarios.show.html import number

BETTER = 1.1
"""Ratio from which a ZMP error counts as lower."""

STRONGER = 1.2
"""Ratio from which a survived impulse counts as larger."""

AXES_APART = 1.5
"""Ratio from which an effect in one axis counts as larger than in the other."""


def survival(results: Results, studies: Sequence[Study], full: Sequence[Study], margin: float) -> Finding:
    """Whether the robot stays up and its ZMP inside, as printed, changed and in full physics."""
    by_profile = {
        profile: [results.sample(study, profile, "pendulum") for study in studies]
        for profile in ("paper", "repaired", "default")
    }
    plant = [sample for study in studies if (sample := results.sample(study, "paper", "cart-table")).outcomes]
    body = [results.sample(study, "default", "full") for study in full]
    rows = [*([plant] if plant else []), *by_profile.values()]
    changed = any_of([stable(by_profile[profile], margin) for profile in ("repaired", "default")])
    verdict = grade(stable(by_profile["paper"], margin), changed, stable(body, margin))
    return Finding(". ".join(balance_text(row) for row in rows), balance_text(body), verdict)


def hard_constraint(results: Results) -> Finding:
    """Whether the constrained problem had a solution at every plan."""
    samples = [results.sample(WALK, profile, "pendulum") for profile in ("paper", "repaired")]
    body = [results.sample(WALK, profile, "full") for profile in ("paper", "repaired")]
    printed, changed = (_always_feasible(sample) for sample in samples)
    return Finding(_feasible_text(samples), _feasible_text(body), grade(printed, changed))


def zmp_filter(results: Results) -> Finding:
    """Whether a Kalman filter that sees the ZMP alone gives a state that can be walked with."""
    alone = [results.sample(ZMP_ONLY, profile, "pendulum") for profile in ("repaired", "default")]
    both = [results.sample(NOISE_ALONE, profile, "pendulum") for profile in ("repaired", "default")]
    rows = [f"ZMP alone, {balance_text([sample])}" for sample in alone]
    rows += [f"with the CoM, {balance_text([sample])}" for sample in both]
    body = results.sample(NOISE_WALK, "default", "full")
    verdict = grade(stable(alone), any_of([stable([sample]) for sample in both]), stable([body]))
    return Finding(". ".join(rows), f"with the CoM, {balance_text([body])}", verdict)


def frontal_effect(results: Results) -> Finding:
    """Whether a wrong CoM height moves the ZMP more in the frontal than in the sagittal plane."""
    points = [_height_effect(results, profile, "pendulum") for profile in ("repaired", "default")]
    body = _height_effect(results, "default", "full")
    known = [effect for effect in points if effect is not None]
    if not known:
        return Finding("not measured", "not measured", "not measured")
    frontal = all(y > AXES_APART * x for x, y in known)
    texts = [_effect_text(name, effect) for name, effect in zip(("repaired", "default"), points, strict=True)]
    full = None if body is None else body[1] > AXES_APART * body[0]
    return Finding(". ".join(texts), _effect_text("default", body), grade(frontal, False, full))


def preview(results: Results) -> Finding:
    """Whether previewing the changing dynamics lowers the ZMP error."""
    studies = (WALK, *STAIRS)
    gains = {study: _gain(results, study, "pendulum") for study in studies}
    body = {study: _gain(results, study, "full") for study in (WALK, *STAIRS[:2])}
    if None in gains.values():
        return Finding(_gains_text(gains), _gains_text(body), "not measured")
    better = {study: _is_better(results, study) for study in studies}
    on_stairs = all(better[study] for study in STAIRS)
    return Finding(_gains_text(gains), _gains_text(body), grade(on_stairs and better[WALK], on_stairs))


def adaptation(results: Results) -> Finding:
    """Whether moving the next footstep lets the robot survive stronger pushes; by the printed law, whether it walks."""
    law = results.sample(STEP_LAW, "paper", "pendulum")
    largest = {kind: _largest_mean(results, kind) for kind in ("none", "location")}
    fixed, moved = largest["none"], largest["location"]
    if fixed is None or moved is None:
        return Finding("not measured", "not run", "not measured")
    text = (
        f"The printed law, without a push: {balance_text([law])}. "
        f"Largest impulse survived, mean of four directions: {number(fixed)} N s with fixed footsteps, "
        f"{number(moved)} N s with footsteps in the QP, {number(moved / fixed)} times as much"
    )
    stronger = moved >= STRONGER * fixed
    return Finding(text, "not run", grade(stable([law]), stronger))


def online(results: Results) -> Finding:
    """Whether a plan is made within a sample time."""
    sample_time = 0.02
    points = [results.sample(WALK, profile, "pendulum") for profile in ("paper", "repaired", "default")]
    body = results.sample(WALK, "default", "full")
    in_time = [sample.greatest("planner_time", "median") for sample in (points[0], body)]
    if None in in_time:
        return Finding("not measured", "not measured", "not measured")
    fast = all(time is not None and time < sample_time for time in in_time)
    return Finding("; ".join(_plan_time_text(s) for s in points), _plan_time_text(body), grade(fast, False))


def _always_feasible(sample: Sample) -> bool | None:
    share = feasible(sample)
    return None if share is None or not sample.complete else share.least >= 1.0


def _feasible_text(samples: Sequence[Sample]) -> str:
    rows = []
    for sample in samples:
        share = feasible(sample)
        known = "not measured" if share is None else f"{spread_text(share, PERCENT)} % of plans feasible"
        rows.append(f"{sample.profile}: {known}")
    return "; ".join(rows)


def _height_effect(results: Results, profile: str, world: str) -> tuple[float, float] | None:
    """Most that a height error adds to the ZMP error's RMS, in x and in y [m]."""
    base = results.sample(WALK, profile, "full" if world == "full" else "pendulum")
    errors = [results.sample(study, profile, base.world) for study in HEIGHTS]
    if not base.complete or not all(sample.complete and not sample.falls for sample in (base, *errors)):
        return None
    x, y = (max(max(sample.values("zmp_error_rms", axis)) for sample in errors)
            - (base.median("zmp_error_rms", axis) or 0.0) for axis in (0, 1))  # fmt: skip
    return x, y


def _effect_text(name: str, effect: tuple[float, float] | None) -> str:
    if effect is None:
        return f"{name}: not measured"
    x, y = (number(value, 1e3) for value in effect)
    return f"{name}: a wrong height adds up to {x} mm to the RMS in x (sagittal), {y} mm in y (frontal)"


def _gain(results: Results, study: Study, world: str) -> float | None:
    where = "full" if world == "full" else "pendulum"
    samples = [results.sample(study, profile, where) for profile in ("lti", "default")]  # type: ignore[arg-type]
    return preview_gain(*samples) if all(sample.complete for sample in samples) else None


def _is_better(results: Results, study: Study) -> bool:
    """Whether preview lowers the ZMP error on the pendulum by more than the spread over seeds."""
    without, previewed = (error_norms(results.sample(study, profile, "pendulum")) for profile in ("lti", "default"))
    gain = _gain(results, study, "pendulum")
    return gain is not None and gain >= BETTER and min(without) > max(previewed)


def _gains_text(gains: dict[Study, float | None]) -> str:
    parts = [f"{study.title} {number(gain, digits=2)}" for study, gain in gains.items()]
    return f"RMS without over with preview (lti over default): {', '.join(parts)}"


def _largest_mean(results: Results, kind: str) -> float | None:
    """Largest impulse survived, mean over directions; one below the least tried counts as a step of the ladder less."""
    step = SHOVE_IMPULSES[1] - SHOVE_IMPULSES[0]
    found = [survived(results, kind, direction) for direction in SHOVE_DIRECTIONS]
    largest = [max(impulses, default=SHOVE_IMPULSES[0] - step) for impulses in found if impulses is not None]
    return sum(largest) / len(largest) if len(largest) == len(found) else None


def _plan_time_text(sample: Sample) -> str:
    median, p99 = (sample.greatest("planner_time", key) for key in ("median", "p99"))
    if median is None:
        return f"{sample.profile}: not measured"
    return f"{sample.profile}: median {number(median, 1e3, 2)} ms, 99th percentile {number(p99, 1e3, 2)} ms"


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
        _BOX, partial(survival, studies=(WALK,), full=(WALK,), margin=0.0),
    ),
    Claim(
        "claim-hard", "III-B", "The ZMP constraint is hard: the solution must always satisfy it.",
        "Holds when every plan of `paper` on the pendulum had a solution within all hard limits; with a change when "
        "every plan of `repaired` had.", hard_constraint,
    ),
    Claim(
        "claim-stairs", "V-C", "The method generates stable stair climbing, with stairs of 0.1 m.",
        _BOX, partial(survival, studies=(STAIRS[0],), full=(STAIRS[0],), margin=0.0),
    ),
    Claim(
        "claim-preview", "I, VI", "Previewing the changes of the dynamics improves the performance of the planner.",
        f"Holds when the RMS of the ZMP error on the pendulum without preview (`lti`) is at least {BETTER:g} times "
        "that with it (`default`) and their ranges over seeds do not overlap, on flat ground and on every stair; with "
        "a change when on the stairs only.", preview,
    ),
    Claim(
        "claim-noise", "V-D", "The planner is robust against measurement noise of ±0.02 m, walking and on stairs.",
        _SOLES, partial(survival, studies=(NOISE_WALK, NOISE_STAIRS), full=(NOISE_WALK,), margin=FOOT_EDGE),
    ),
    Claim(
        "claim-filter", "II-B, V-D", "A Kalman filter on the measured ZMP gives the state that the planner needs.",
        "Holds when no run with the ZMP alone falls on the pendulum, where the planner alone closes the loop, or has "
        "its ZMP outside the planned support; with a change when that is so for `repaired` or `default` with the "
        "filter that also sees the CoM, and in full physics.", zmp_filter,
    ),
    Claim(
        "claim-height", "V-E", "With a CoM height wrong by ±0.1 and ±0.2 m walking is stable and the ZMP stays inside.",
        _SOLES, partial(survival, studies=HEIGHTS, full=HEIGHTS, margin=FOOT_EDGE),
    ),
    Claim(
        "claim-frontal", "V-E", "Unlike in the sagittal plane, the height error matters in the frontal plane.",
        f"Holds when the most that the four errors add to the RMS of the ZMP error is {AXES_APART:g} times as much "
        "in y as in x, for `repaired` and `default` on the pendulum and `default` in full physics.", frontal_effect,
    ),
    Claim(
        "claim-push", "V-F", "The planner is robust against pushes of ±50 and ±75 N for 10 ms, with noise.",
        _SOLES, partial(survival, studies=PUSHES, full=PUSHES, margin=FOOT_EDGE),
    ),
    Claim(
        "claim-adaptation", "I, VI", "Moving the landing location by the DCM helps against severe disturbances.",
        "Holds when `paper` with its step law walks on the pendulum; with a change (footsteps in the QP of `default`) "
        f"when the largest impulse survived, mean of four directions, grows at least {STRONGER:g} times.", adaptation,
    ),
    Claim(
        "claim-online", "III", "The planner works online.",
        "Holds when the median plan of `paper` on the pendulum and of `default` in full physics takes less than the "
        "sample time of 20 ms, on the machine that made the logs, with all its cores busy.", online,
    ),
)  # fmt: skip
