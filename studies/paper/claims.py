"""The paper's claims, each with the rule by which the numbers of the runs decide whether it holds."""

import math
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib.resources import files
from typing import Literal, NamedTuple

import yaml

from surefoot.scenarios.show.kit.html import number
from surefoot.studies.paper import studies
from surefoot.studies.paper.results import MM, PERCENT, Results, Sample, balance_text, spread_text
from surefoot.studies.paper.studies import PaperWorld, Study, knee_study

Grade = Literal["holds", "holds with a change", "does not hold", "not measured"]

FOOT_EDGE = 0.00375
"""From the 90 % box of a 0.075 m sole to its edge [m]."""

BETTER = 1.1
"""Ratio from which a ZMP error counts as lower."""

STRONGER = 1.2
"""Ratio from which a survived impulse counts as larger."""

AXES_APART = 1.5
"""Ratio from which an effect in one axis counts as larger than in the other."""

SAVES = 0.05
"""Share from which effort counts as lower."""

SAME_SPEED = 0.02
"""Share by which two speeds may differ and count as the same."""

STRETCHED = math.radians(25.0)
"""Mean knee flexion of a walk with mostly stretched knees: people have about 20 to 25 degrees [rad]."""

SAMPLE_TIME, _ROUNDING = 0.02, 1e-6
"""Within which a plan is to be made [s], and what does not count of a distance [m]."""


class Assessment(NamedTuple):
    """The evidence of point-mass worlds and full physics on a claim, in a sentence each, with the verdict."""

    pendulum: str
    full: str
    verdict: Grade


class Claim(NamedTuple):
    """A claim of the paper: its anchor, section and words, and the rule of its verdict in words and as a function."""

    name: str
    section: str
    text: str
    rule: str
    judge: Callable[[Results], Assessment]


_NO_KNEES = "a pendulum has no knees"
_NOT_MEASURED = Assessment("not measured", "not measured", "not measured")
_POINT_AND_BODY: tuple[PaperWorld, PaperWorld] = ("pendulum", "full")


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
    """True if no run fell and the ZMP stayed inside the planned support, in all runs.

    Args:
        samples: of which every run counts.
        margin: beyond the support of feet shrunk to 90 % that is allowed [m]; by default up to the soles' edges.

    Returns:
        None when a run is missing.
    """
    every = list(samples)
    if not every or not all(sample.complete for sample in every):
        return None
    most = margin + _ROUNDING
    excursions = (sample.greatest("zmp_excursion_max") for sample in every if not sample.falls)
    return sum(excursion is not None and excursion <= most for excursion in excursions) == len(every)


def any_of(verdicts: Sequence[bool | None]) -> bool | None:
    """True if one of some holds; None when that is not known."""
    if any(verdicts):
        return True
    return None if None in verdicts else False


def survival(results: Results, points: Sequence[Study], full: Sequence[Study], margin: float) -> Assessment:
    """Assess whether the robot stays up and its ZMP inside, as printed, changed and in full physics."""
    printed, *changed = ([results.sample(study, profile) for study in points] for profile in studies.CLAIMANTS)
    plant = [sample for study in points if (sample := results.sample(study, "paper", "cart-table")).outcomes]
    body = [results.sample(study, "default", "full") for study in full]
    rows = [row for row in (plant, printed, *changed) if row]
    verdict = grade(stable(printed, margin), any_of([stable(row, margin) for row in changed]), stable(body, margin))
    return Assessment(". ".join(map(balance_text, rows)), balance_text(body), verdict)


def hard_constraint(results: Results) -> Assessment:
    """Assess whether the constrained problem has a solution at every plan."""
    samples, body = (results.of(studies.WALK, "paper", "repaired", world=world) for world in _POINT_AND_BODY)
    printed, changed = (
        None if share is None or not sample.complete else share.least >= 1.0
        for sample in samples
        for share in (sample.feasible,)
    )
    return Assessment(_feasible_text(samples), _feasible_text(body), grade(printed, changed))


def _feasible_text(samples: Iterable[Sample]) -> str:
    shares = {sample.profile: sample.feasible for sample in samples}
    texts = {name: f"{spread_text(share, PERCENT)} % of plans feasible" for name, share in shares.items() if share}
    return "; ".join(f"{name}: {texts.get(name, 'not measured')}" for name in shares)


def zmp_filter(results: Results) -> Assessment:
    """Assess whether a Kalman filter that sees the ZMP alone gives a state that can be walked with."""
    alone, both = (results.of(study, "repaired", "default") for study in (studies.ZMP_ONLY, studies.NOISE_ALONE))
    rows = [f"ZMP alone, {balance_text([sample])}" for sample in alone]
    rows += [f"with the CoM, {balance_text([sample])}" for sample in both]
    body = results.sample(studies.NOISE_WALK, "default", "full")
    verdict = grade(stable(alone), any_of([stable([sample]) for sample in both]), stable([body]))
    return Assessment(". ".join(rows), f"with the CoM, {balance_text([body])}", verdict)


def frontal_effect(results: Results) -> Assessment:
    """Assess whether a wrong CoM height moves the ZMP more in the frontal than in the sagittal plane."""
    points = {profile: _height_effect(results, profile, "pendulum") for profile in ("repaired", "default")}
    body = _height_effect(results, "default", "full")
    known = [effect for effect in points.values() if effect is not None]
    if not known:
        return _NOT_MEASURED
    frontal = all(y > AXES_APART * x for x, y in known)
    full = None if body is None else body[1] > AXES_APART * body[0]
    texts = (_effect_text(name, effect) for name, effect in points.items())
    return Assessment(". ".join(texts), _effect_text("default", body), grade(frontal, False, full))


def _height_effect(results: Results, profile: str, world: PaperWorld) -> tuple[float, float] | None:
    """Most that a height error adds to the ZMP error's RMS, in x and in y [m]."""
    base, *errors = (results.sample(study, profile, world) for study in (studies.WALK, *studies.HEIGHTS))
    if not base.complete or not all(sample.complete and not sample.falls for sample in (base, *errors)):
        return None
    x, y = (
        max(max(sample.values("zmp_error_rms", axis)) for sample in errors)
        - (base.median("zmp_error_rms", axis) or 0.0)
        for axis in (0, 1)
    )
    return x, y


def _effect_text(name: str, effect: tuple[float, float] | None) -> str:
    if effect is None:
        return f"{name}: not measured"
    x, y = (number(value, MM) for value in effect)
    return f"{name}: a wrong height adds up to {x} mm to the RMS in x (sagittal), {y} mm in y (frontal)"


def preview(results: Results) -> Assessment:
    """Assess whether previewing the changing dynamics lowers the ZMP error."""
    points = {study: _gain(results, study, "pendulum") for study in (studies.WALK, *studies.STAIRS)}
    body = {study: _gain(results, study, "full") for study in (studies.WALK, *studies.STAIRS[:2])}
    verdict: Grade = "not measured"
    if all(points.values()):
        better = {study: gain is not None and gain[0] >= BETTER and gain[1] for study, gain in points.items()}
        on_stairs = all(better[study] for study in studies.STAIRS)
        verdict = grade(on_stairs and better[studies.WALK], on_stairs)
    return Assessment(_gains_text(points), _gains_text(body), verdict)


def _gain(results: Results, study: Study, world: PaperWorld) -> tuple[float, bool] | None:
    """Factor by which preview lowers the ZMP error, and true if the ranges over seeds lie apart."""
    samples = results.of(study, "lti", "default", world=world)
    without, previewed = (sample.error_norms for sample in samples)
    if not without or not previewed or not all(sample.complete for sample in samples):
        return None
    return statistics.median(without) / statistics.median(previewed), min(without) > max(previewed)


def _gains_text(gains: Mapping[Study, tuple[float, bool] | None]) -> str:
    parts = [f"{study.title} {number(gain and gain[0], digits=2)}" for study, gain in gains.items()]
    return f"RMS without over with preview (lti over default): {', '.join(parts)}"


def adaptation(results: Results) -> Assessment:
    """Assess whether moving the next footstep lets the robot survive stronger pushes; and by the printed law, walk."""
    law = results.sample(studies.STEP_LAW, "paper")
    fixed, moved = (_largest_mean(results, kind) for kind in ("none", "location"))
    if fixed is None or moved is None:
        return Assessment("not measured", "not run", "not measured")
    text = (
        f"The printed law, without a push: {balance_text([law])}. "
        f"Largest impulse survived, mean of four directions: {number(fixed)} N s with fixed footsteps, "
        f"{number(moved)} N s with footsteps in the QP, {number(moved / fixed)} times as much"
    )
    return Assessment(text, "not run", grade(stable([law]), moved >= STRONGER * fixed))


def _largest_mean(results: Results, kind: str) -> float | None:
    """Largest impulse survived, mean over directions; one below the least tried counts as a step of the ladder less."""
    step = studies.SHOVE_IMPULSES[1] - studies.SHOVE_IMPULSES[0]
    found = [results.survived(kind, direction) for direction in studies.SHOVE_DIRECTIONS]
    largest = [max(impulses, default=studies.SHOVE_IMPULSES[0] - step) for impulses in found if impulses is not None]
    return sum(largest) / len(largest) if len(largest) == len(found) else None


def online(results: Results) -> Assessment:
    """Assess whether a plan is made within a sample time."""
    points, body = results.of(studies.WALK, *studies.CLAIMANTS), results.sample(studies.WALK, "default", "full")
    medians = [sample.greatest("planner_time", "median") for sample in (points[0], body)]
    known = [median for median in medians if median is not None]
    if len(known) < len(medians):
        return _NOT_MEASURED
    verdict = grade(all(median < SAMPLE_TIME for median in known), False)
    return Assessment("; ".join(map(_plan_time_text, points)), _plan_time_text(body), verdict)


def _plan_time_text(sample: Sample) -> str:
    median, p99 = (sample.greatest("planner_time", key) for key in ("median", "p99"))
    if median is None:
        return f"{sample.profile}: not measured"
    return f"{sample.profile}: median {number(median, 1e3, 2)} ms, 99th percentile {number(p99, 1e3, 2)} ms"


def saving(results: Results, metric: str, name: str) -> Assessment:
    """Assess whether stretched knees take less effort, by a metric and its name, than bent ones at the same speed."""
    found = {gait: _saving(results, gait, metric) for gait in studies.GAITS}
    parts = [f"{gait} gait {_share_text(saved)}" for gait, saved in found.items()]
    text = f"{name}, stretched against bent knees: {', '.join(parts)}"
    lower = [saved >= SAVES for saved in found.values() if saved is not None]
    verdict = grade(all(lower), any(lower)) if len(lower) == len(studies.GAITS) else "not measured"
    return Assessment(_NO_KNEES, text, verdict)


def _saving(results: Results, gait: str, metric: str) -> float | None:
    """Share of effort that stretched knees save; None unless both were walked, at the same speed."""
    samples = [results.sample(knee_study(gait, knee), "default", "full") for knee in studies.KNEES]
    if not all(sample.complete and not sample.falls for sample in samples):
        return None
    speeds, efforts = ([sample.median(name) for sample in samples] for name in ("speed_mean", metric))
    if None in (*speeds, *efforts) or not math.isclose(speeds[0] or 0.0, speeds[1] or 0.0, rel_tol=SAME_SPEED):
        return None
    return 1.0 - (efforts[0] or 0.0) / (efforts[1] or math.inf)


def _share_text(saved: float | None) -> str:
    if saved is None:
        return "not measured at the same speed"
    return f"{number(abs(saved), PERCENT)} % {'lower' if saved >= 0.0 else 'higher'}"


def stretched_knees(results: Results) -> Assessment:
    """Assess whether the robot walks with mostly stretched knees."""
    samples = {gait: results.sample(knee_study(gait, "stretched"), "default", "full") for gait in studies.GAITS}
    angles = {gait: sample.median("knee_angle_mean") for gait, sample in samples.items() if sample.complete}
    found = {gait: angle for gait, angle in angles.items() if angle is not None}
    if len(found) < len(studies.GAITS):
        return Assessment(_NO_KNEES, "not measured", "not measured")
    parts = [f"{gait} gait {number(angle, 180 / math.pi)} degrees" for gait, angle in found.items()]
    stretched = [angle <= STRETCHED for angle in found.values()]
    verdict = grade(all(stretched), any(stretched))
    return Assessment(_NO_KNEES, f"mean knee flexion: {', '.join(parts)}", verdict)


JUDGES: Mapping[str, Callable[[Results], Assessment]] = {
    "walk": partial(survival, points=(studies.WALK,), full=(studies.WALK,), margin=0.0),
    "hard": hard_constraint,
    "stairs": partial(survival, points=studies.STAIRS[:1], full=studies.STAIRS[:1], margin=0.0),
    "preview": preview,
    "noise": partial(
        survival, points=(studies.NOISE_WALK, studies.NOISE_STAIRS), full=(studies.NOISE_WALK,), margin=FOOT_EDGE
    ),
    "filter": zmp_filter,
    "height": partial(survival, points=studies.HEIGHTS, full=studies.HEIGHTS, margin=FOOT_EDGE),
    "frontal": frontal_effect,
    "push": partial(survival, points=studies.PUSHES, full=studies.PUSHES, margin=FOOT_EDGE),
    "adaptation": adaptation,
    "online": online,
    "stretched": stretched_knees,
    "torque": partial(saving, metric="knee_torque_rms", name="knee torque RMS"),
    "energy": partial(saving, metric="cost_of_transport", name="cost of transport"),
}
"""Claims, of which those of knees and energy, which stand last, are judged in full physics: a pendulum has no knees."""


def claims() -> tuple[Claim, ...]:
    """All claims in the order of the page; their words are those of `claims.yaml`."""
    numbers = {"better": BETTER, "axes_apart": AXES_APART, "stronger": STRONGER, "saves": PERCENT * SAVES}
    numbers["stretched"] = math.degrees(STRETCHED)
    written = yaml.safe_load((files(__package__) / "claims.yaml").read_text(encoding="utf-8"))
    return tuple(
        Claim(f"claim-{name}", said["section"], said["text"], said["rule"].format(**numbers), JUDGES[name])
        for name, said in written.items()
    )
