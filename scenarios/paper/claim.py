"""What a claim is, how it is graded, and the measures that the grades rest on."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from surefoot.scenarios.paper.results import Results, Sample
from surefoot.scenarios.paper.tables import MM, WORLD_NAMES, fell_text
from surefoot.scenarios.show.html import number

Verdict = Literal["holds", "holds with a change", "does not hold", "not measured"]

FOOT_EDGE = 0.00375
"""From the 90 % box of a 0.075 m sole to its edge [m]."""

_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class Finding:
    """What was found about a claim.

    Attributes:
        pendulum: what the point-mass worlds show, in a sentence.
        full: what full physics shows, in a sentence.
        verdict: by the claim's rule.
    """

    pendulum: str
    full: str
    verdict: Verdict


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
    judge: Callable[[Results], Finding]


def grade(printed: bool | None, changed: bool | None, full: bool | None = None) -> Verdict:
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
