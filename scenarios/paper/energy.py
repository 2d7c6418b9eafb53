"""The paper's claims about knees and energy, judged in full physics; a pendulum has no knees."""

import math
from functools import partial

from surefoot.scenarios.paper.claim import Claim, Finding, grade
from surefoot.scenarios.paper.results import Results
from surefoot.scenarios.paper.studies import GAITS, knee_study
from surefoot.scenarios.show.html import number

SAVES = 0.05
"""Share from which effort counts as lower."""

SAME_SPEED = 0.02
"""Share by which two speeds may differ and count as the same."""

STRETCHED = math.radians(25.0)
"""Mean knee flexion of a walk with mostly stretched knees: people have about 20 to 25 degrees [rad]."""

_NO_KNEES = "a pendulum has no knees"


def saving(results: Results, metric: str, name: str) -> Finding:
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
        return Finding(_NO_KNEES, text, "not measured")
    lower = [saved >= SAVES for saved in known]
    return Finding(_NO_KNEES, text, grade(all(lower), any(lower)))


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


ENERGY_CLAIMS: tuple[Claim, ...] = (
    Claim(
        "claim-stretched", "IV-B, V-B", "The robot walks with mostly stretched knees.",
        "Holds when the knees' mean flexion while walking is at most 25 degrees in both gaits; with a change when in "
        "one of them.", stretched_knees,
    ),
    Claim(
        "claim-torque", "IV", "Always bending the knees takes high torques in them; stretched knees take less.",
        "Holds when the RMS of the knee torques is at least 5 % lower with stretched than with bent knees at the same "
        "speed, in both gaits; with a change when in one of them.",
        partial(saving, metric="knee_torque_rms", name="knee torque RMS"),
    ),
    Claim(
        "claim-energy", "IV, VII", "Walking with mostly stretched knees is more energy efficient.",
        "Holds when the cost of transport is at least 5 % lower with stretched than with bent knees at the same speed, "
        "in both gaits; with a change when in one of them.",
        partial(saving, metric="cost_of_transport", name="cost of transport"),
    ),
)  # fmt: skip
