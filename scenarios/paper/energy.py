"""The paper's claims about knees and energy, judged in full physics; a pendulum has no knees."""

import math

from scenarios.paper.claim import Claim, Finding, grade
from scenarios.paper.results import Results, Sample
from scenarios.paper.studies import GAITS, knee_study
from scenarios.paper.text import number

SAVES = 0.05
"""Share from which effort counts as lower."""

SAME_SPEED = 0.02
"""Share by which two speeds may differ and count as the same."""

STRETCHED = math.radians(25.0)
"""Mean knee flexion of a walk with mostly stretched knees: people have about 20 to 25 degrees [rad]."""

_EFFORT = ("cost_of_transport", "knee_torque_rms")
_NO_KNEES = "a pendulum has no knees"


def efficiency(results: Results) -> Finding:
    """Whether stretched knees cost less than bent ones at the same speed."""
    savings = {gait: _savings(results, gait) for gait in GAITS}
    texts = [_savings_text(gait, found) for gait, found in savings.items()]
    known = [found for found in savings.values() if found is not None]
    if len(known) < len(GAITS):
        return Finding(_NO_KNEES, ". ".join(texts), "not measured")
    saved = [all(found[index] >= SAVES for found in known) for index in range(len(_EFFORT))]
    return Finding(_NO_KNEES, ". ".join(texts), grade(all(saved), any(saved)))


def stretched_knees(results: Results) -> Finding:
    """Whether the robot walks with mostly stretched knees."""
    flexions = {gait: results.sample(knee_study(gait, "stretched"), "default", "full") for gait in GAITS}
    found = {gait: sample.median("knee_angle_mean") for gait, sample in flexions.items() if sample.complete}
    if len(found) < len(GAITS):
        return Finding(_NO_KNEES, "not measured", "not measured")
    parts = [f"{gait} gait {number(angle, 180 / math.pi)} degrees" for gait, angle in found.items()]
    known = [angle for angle in found.values() if angle is not None]
    least, most = min(known), max(known)
    return Finding(_NO_KNEES, f"mean knee flexion: {', '.join(parts)}", grade(most <= STRETCHED, least <= STRETCHED))


def _savings(results: Results, gait: str) -> tuple[float, ...] | None:
    """Share of effort that stretched knees save, by measure; None unless both were walked at the same speed."""
    stretched, bent = (results.sample(knee_study(gait, knee), "default", "full") for knee in ("stretched", "bent"))
    if not all(sample.complete and not sample.falls for sample in (stretched, bent)):
        return None
    speeds = [_median(sample, "speed_mean") for sample in (stretched, bent)]
    if not math.isclose(*speeds, rel_tol=SAME_SPEED):
        return None
    return tuple(1.0 - _median(stretched, name) / _median(bent, name) for name in _EFFORT)


def _median(sample: Sample, metric: str) -> float:
    value = sample.median(metric)
    return math.nan if value is None else value


def _savings_text(gait: str, savings: tuple[float, ...] | None) -> str:
    if savings is None:
        return f"{gait} gait: not measured at the same speed"
    transport, torque = (_share_text(share) for share in savings)
    return f"{gait} gait, stretched against bent knees: cost of transport {transport}, knee torque RMS {torque}"


def _share_text(saved: float) -> str:
    return f"{number(abs(saved), 100.0)} % {'lower' if saved >= 0.0 else 'higher'}"


ENERGY_CLAIMS: tuple[Claim, ...] = (
    Claim(
        "claim-stretched", "IV-B, V-B", "The robot walks with mostly stretched knees.",
        "Holds when the knees' mean flexion while walking is at most 25 degrees in both gaits; with a change when in "
        "one of them.", stretched_knees,
    ),
    Claim(
        "claim-efficiency", "IV, VII", "Walking with stretched knees takes less knee torque and less energy.",
        "Holds when cost of transport and RMS of the knee torques are both at least 5 % lower than with bent knees at "
        "the same speed, in both gaits; with a change when one of the two is, in both gaits.", efficiency,
    ),
)  # fmt: skip
