"""How a claim of the paper is judged: the rules, and the measures that they rest on."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from surefoot.scenarios.show.kit.html import number
from surefoot.scenarios.study.paper.results import Results, Sample
from surefoot.scenarios.study.paper.studies import (
    GAITS,
    HEIGHTS,
    NOISE_ALONE,
    NOISE_WALK,
    SHOVE_DIRECTIONS,
    SHOVE_IMPULSES,
    STAIRS,
    STEP_LAW,
    WALK,
    ZMP_ONLY,
    PaperWorld,
    Study,
    knee_study,
)
from surefoot.scenarios.study.paper.tables import (
    MM,
    PERCENT,
    WORLD_NAMES,
    error_norms,
    feasible,
    fell_text,
    preview_gain,
    spread_text,
    survived,
)

Grade = Literal["holds", "holds with a change", "does not hold", "not measured"]

FOOT_EDGE = 0.00375
"""From the 90 % box of a 0.075 m sole to its edge [m]."""

_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class Assessment:
    """What was found about a claim.

    Attributes:
        pendulum: what the point-mass worlds show, in a sentence.
        full: what full physics shows, in a sentence.
        verdict: by the claim's rule.
    """

    pendulum: str
    full: str
    verdict: Grade


def grade(printed: bool | None, changed: bool | None, full: bool | None = None) -> Grade:
    """Grade a claim.

    Args:
        printed: whether it holds as the paper printed the planner; None when that was not measured.
        changed: whether it holds with the planner changed.
        full: whether it holds in full physics too; None when that is not asked or was not measured.
    """
    if printed is None or (changed is None and not printed):
        return "not measured"
    if full is False:
        return "does not hold"
    if printed:
        return "holds"
    return "holds with a change" if changed else "does not hold"


def stable(samples: Iterable[Sample], margin: float = FOOT_EDGE) -> bool | None:
    """Whether no run fell and the ZMP stayed inside the planned support, in all runs.

    Args:
        samples: of which every run counts.
        margin: beyond the support of feet shrunk to 90 % that is allowed [m]; by default up to the soles' edges.

    Returns:
        None when a run is missing.
    """
    every = list(samples)
    if not every or not all(sample.complete for sample in every):
        return None
    return all(_stayed(sample, margin) for sample in every)


def any_of(verdicts: Sequence[bool | None]) -> bool | None:
    """Whether one of some holds; None when that is not known."""
    if any(verdicts):
        return True
    return None if None in verdicts else False


def balance_text(samples: Sequence[Sample]) -> str:
    """Falls and excursions of some samples of one profile and world, in a phrase."""
    name = f"{samples[0].profile}, {WORLD_NAMES[samples[0].world]}"
    missing = [outcome for sample in samples for outcome in sample.failures]
    runs = [outcome for sample in samples for outcome in sample.runs]
    if missing or not runs:
        return f"{name}: could not run" if missing else f"{name}: not run"
    falls = sum(sample.falls for sample in samples)
    fell = fell_text(samples[0]) if len(samples) == 1 else f"{falls} of {len(runs)}"
    found = [value for sample in samples for value in sample.values("zmp_excursion_max")]
    return f"{name}: fell in {fell}; {excursion_text(max(found, default=None))}"


def excursion_text(excursion: float | None) -> str:
    """How far the ZMP came out of the 90 % box, in a phrase."""
    if excursion is None:
        return "no ZMP"
    if excursion <= 0.0:
        return f"ZMP at least {number(-excursion, MM)} mm inside the 90 % box"
    return f"ZMP up to {number(excursion, MM)} mm beyond the 90 % box"


def _stayed(sample: Sample, margin: float) -> bool:
    excursion = sample.greatest("zmp_excursion_max")
    return not sample.falls and excursion is not None and excursion <= margin + _ROUNDING


BETTER = 1.1
"""Ratio from which a ZMP error counts as lower."""

STRONGER = 1.2
"""Ratio from which a survived impulse counts as larger."""

AXES_APART = 1.5
"""Ratio from which an effect in one axis counts as larger than in the other."""


def survival(results: Results, studies: Sequence[Study], full: Sequence[Study], margin: float) -> Assessment:
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
    return Assessment(". ".join(balance_text(row) for row in rows), balance_text(body), verdict)


def hard_constraint(results: Results) -> Assessment:
    """Whether the constrained problem had a solution at every plan."""
    samples = [results.sample(WALK, profile, "pendulum") for profile in ("paper", "repaired")]
    body = [results.sample(WALK, profile, "full") for profile in ("paper", "repaired")]
    printed, changed = (_always_feasible(sample) for sample in samples)
    return Assessment(_feasible_text(samples), _feasible_text(body), grade(printed, changed))


def zmp_filter(results: Results) -> Assessment:
    """Whether a Kalman filter that sees the ZMP alone gives a state that can be walked with."""
    alone = [results.sample(ZMP_ONLY, profile, "pendulum") for profile in ("repaired", "default")]
    both = [results.sample(NOISE_ALONE, profile, "pendulum") for profile in ("repaired", "default")]
    rows = [f"ZMP alone, {balance_text([sample])}" for sample in alone]
    rows += [f"with the CoM, {balance_text([sample])}" for sample in both]
    body = results.sample(NOISE_WALK, "default", "full")
    verdict = grade(stable(alone), any_of([stable([sample]) for sample in both]), stable([body]))
    return Assessment(". ".join(rows), f"with the CoM, {balance_text([body])}", verdict)


def frontal_effect(results: Results) -> Assessment:
    """Whether a wrong CoM height moves the ZMP more in the frontal than in the sagittal plane."""
    points = [_height_effect(results, profile, "pendulum") for profile in ("repaired", "default")]
    body = _height_effect(results, "default", "full")
    known = [effect for effect in points if effect is not None]
    if not known:
        return Assessment("not measured", "not measured", "not measured")
    frontal = all(y > AXES_APART * x for x, y in known)
    texts = [_effect_text(name, effect) for name, effect in zip(("repaired", "default"), points, strict=True)]
    full = None if body is None else body[1] > AXES_APART * body[0]
    return Assessment(". ".join(texts), _effect_text("default", body), grade(frontal, False, full))


def preview(results: Results) -> Assessment:
    """Whether previewing the changing dynamics lowers the ZMP error."""
    studies = (WALK, *STAIRS)
    gains = {study: _gain(results, study, "pendulum") for study in studies}
    body = {study: _gain(results, study, "full") for study in (WALK, *STAIRS[:2])}
    if None in gains.values():
        return Assessment(_gains_text(gains), _gains_text(body), "not measured")
    better = {study: _is_better(results, study) for study in studies}
    on_stairs = all(better[study] for study in STAIRS)
    return Assessment(_gains_text(gains), _gains_text(body), grade(on_stairs and better[WALK], on_stairs))


def adaptation(results: Results) -> Assessment:
    """Whether moving the next footstep lets the robot survive stronger pushes; by the printed law, whether it walks."""
    law = results.sample(STEP_LAW, "paper", "pendulum")
    largest = {kind: _largest_mean(results, kind) for kind in ("none", "location")}
    fixed, moved = largest["none"], largest["location"]
    if fixed is None or moved is None:
        return Assessment("not measured", "not run", "not measured")
    text = (
        f"The printed law, without a push: {balance_text([law])}. "
        f"Largest impulse survived, mean of four directions: {number(fixed)} N s with fixed footsteps, "
        f"{number(moved)} N s with footsteps in the QP, {number(moved / fixed)} times as much"
    )
    stronger = moved >= STRONGER * fixed
    return Assessment(text, "not run", grade(stable([law]), stronger))


def online(results: Results) -> Assessment:
    """Whether a plan is made within a sample time."""
    sample_time = 0.02
    points = [results.sample(WALK, profile, "pendulum") for profile in ("paper", "repaired", "default")]
    body = results.sample(WALK, "default", "full")
    in_time = [sample.greatest("planner_time", "median") for sample in (points[0], body)]
    if None in in_time:
        return Assessment("not measured", "not measured", "not measured")
    fast = all(time is not None and time < sample_time for time in in_time)
    return Assessment("; ".join(_plan_time_text(s) for s in points), _plan_time_text(body), grade(fast, False))


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


def _height_effect(results: Results, profile: str, world: PaperWorld) -> tuple[float, float] | None:
    """Most that a height error adds to the ZMP error's RMS, in x and in y [m]."""
    base = results.sample(WALK, profile, world)
    errors = [results.sample(study, profile, world) for study in HEIGHTS]
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


def _gain(results: Results, study: Study, world: PaperWorld) -> float | None:
    samples = [results.sample(study, profile, world) for profile in ("lti", "default")]
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


SAVES = 0.05
"""Share from which effort counts as lower."""

SAME_SPEED = 0.02
"""Share by which two speeds may differ and count as the same."""

STRETCHED = math.radians(25.0)
"""Mean knee flexion of a walk with mostly stretched knees: people have about 20 to 25 degrees [rad]."""

_NO_KNEES = "a pendulum has no knees"


def saving(results: Results, metric: str, name: str) -> Assessment:
    """Whether stretched knees take less effort than bent ones at the same speed.

    Args:
        results: of the knee studies.
        metric: that measures the effort.
        name: of it.
    """
    found = {gait: _saving(results, gait, metric) for gait in GAITS}
    parts = [f"{gait} gait {_share_text(saved)}" for gait, saved in found.items()]
    text = f"{name}, stretched against bent knees: {', '.join(parts)}"
    known = [saved for saved in found.values() if saved is not None]
    if len(known) < len(GAITS):
        return Assessment(_NO_KNEES, text, "not measured")
    lower = [saved >= SAVES for saved in known]
    return Assessment(_NO_KNEES, text, grade(all(lower), any(lower)))


def stretched_knees(results: Results) -> Assessment:
    """Whether the robot walks with mostly stretched knees."""
    flexions = {gait: results.sample(knee_study(gait, "stretched"), "default", "full") for gait in GAITS}
    found = {gait: sample.median("knee_angle_mean") for gait, sample in flexions.items() if sample.complete}
    if len(found) < len(GAITS):
        return Assessment(_NO_KNEES, "not measured", "not measured")
    parts = [f"{gait} gait {number(angle, 180 / math.pi)} degrees" for gait, angle in found.items()]
    known = [angle for angle in found.values() if angle is not None]
    least, most = min(known), max(known)
    return Assessment(_NO_KNEES, f"mean knee flexion: {', '.join(parts)}", grade(most <= STRETCHED, least <= STRETCHED))


def _saving(results: Results, gait: str, metric: str) -> float | None:
    """Share of effort that stretched knees save; None unless both were walked, at the same speed."""
    samples = [results.sample(knee_study(gait, knee), "default", "full") for knee in ("stretched", "bent")]
    if not all(sample.complete and not sample.falls for sample in samples):
        return None
    speeds, efforts = ([sample.median(name) for sample in samples] for name in ("speed_mean", metric))
    if None in (*speeds, *efforts) or not math.isclose(speeds[0] or 0.0, speeds[1] or 0.0, rel_tol=SAME_SPEED):
        return None
    return 1.0 - (efforts[0] or 0.0) / (efforts[1] or math.inf)


def _share_text(saved: float | None) -> str:
    if saved is None:
        return "not measured at the same speed"
    return f"{number(abs(saved), 100.0)} % {'lower' if saved >= 0.0 else 'higher'}"
