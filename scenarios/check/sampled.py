"""Runs of several seeds of a scenario, and how they compare with the sample of a baseline."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from surefoot.maths.chance import SuccessRate, wilson
from surefoot.scenarios.check.findings import ALARMS, Finding, decided
from surefoot.scenarios.check.sample import SeedSample

FIRST = 6
"""Runs of the first look; each look after it has twice as many."""


@dataclass(frozen=True, slots=True)
class Sampled:
    """Runs of several seeds, and how they compare with the sample of a baseline.

    Attributes:
        sample: of the runs.
        asked: runs that were asked for; fewer were made where the answer was there before.
        findings: against the baseline's sample, the pass rate first; none where it has no sample.
        before: the baseline's sample, None where it has none.
        reasons: why runs missed their criteria, by seed.
        beyond: thresholds that were not within their range, by seed and name, with the side.
        took: sum of the runs' times on the wall's clock [s].
    """

    sample: SeedSample
    asked: int
    findings: tuple[Finding, ...] = ()
    before: SeedSample | None = None
    reasons: Mapping[int, str] = field(default_factory=dict)
    beyond: Mapping[tuple[int, str], str] = field(default_factory=dict)
    took: float = 0.0

    @property
    def rate(self) -> SuccessRate:
        """Share of the runs that met their criteria, with its interval."""
        return wilson(self.sample.passed.count(True), len(self.sample.seeds))

    @property
    def rate_before(self) -> SuccessRate | None:
        """The same of the baseline."""
        return None if self.before is None else wilson(self.before.passed.count(True), len(self.before.seeds))

    @property
    def random(self) -> bool:
        """True if the seed matters to what was run."""
        return self.sample.is_random

    @property
    def decided(self) -> bool:
        """True if more runs are not needed; one that is held against nothing is never."""
        return bool(self.findings) and decided(self.findings)

    @property
    def alarms(self) -> tuple[Finding, ...]:
        """Findings that something is worse, or has moved."""
        return tuple(one for one in self.findings if one.verdict in ALARMS)


def size_of(look: int, most: int) -> int:
    """Number of runs at a look, from 1 on: 6, 12, 24 and so on, and at most so many."""
    return min(FIRST << (look - 1), most)
