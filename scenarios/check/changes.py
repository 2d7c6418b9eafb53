"""Changes in a history: the checks at which a run was no more as the one before.

A run repeats to the bit, so its metrics have no noise: a change is any difference by more than the tolerances of
`surefoot check`. Each run is held against the first one since the last change, as a check would hold it against a
baseline that is written anew at every change. So slow drifts are found when they leave the tolerance. Runs of several
seeds are held against each other by the laws of chance of `findings`; the same seeds of the same program are the same.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from surefoot.scenarios.check.baseline import Baseline, Move
from surefoot.scenarios.check.findings import Asked, Finding, findings
from surefoot.scenarios.check.lines import Line
from surefoot.scenarios.check.signs import Parting
from surefoot.scenarios.judge.verdict import value_text
from surefoot.scenarios.record.provenance import PACKAGES

RunOf = Callable[[Line], Baseline | None]
"""From a line to what was measured; None where there was no run, or nothing is left of it."""

_NAMED = (*PACKAGES, "python")
"""Versions that are named where they differ."""


@dataclass(frozen=True, slots=True)
class Change:
    """A check at which a scenario was no more as before.

    Attributes:
        before: line of the check before.
        now: line of the check.
        partings: in order.
        moves: metrics that moved.
        reasons: what else is not as it was: settings, the world, or that it could not run; a sentence each.
        versions: that are not as they were, a sentence each.
    """

    before: Line
    now: Line
    partings: tuple[Parting, ...] = ()
    moves: tuple[Move, ...] = ()
    reasons: tuple[str, ...] = ()
    versions: tuple[str, ...] = ()

    @property
    def is_one(self) -> bool:
        """True if anything is not as it was."""
        return bool(self.partings or self.moves or self.reasons)


def series(lines: Iterable[Line]) -> dict[tuple[str, str], list[Line]]:
    """Lines by scenario and kind of machine, each in order."""
    found: dict[tuple[str, str], list[Line]] = {}
    for line in lines:
        found.setdefault((line.scenario, line.machine), []).append(line)
    return {key: sorted(found[key], key=lambda line: line.order) for key in sorted(found)}


def changes(lines: Sequence[Line], run_of: RunOf) -> Iterator[Change]:
    """The changes in lines of one scenario, in order."""
    reference: Baseline | None = None
    digest, before = "", None
    for line in lines:
        run = run_of(line) if line.run else None
        lost = bool(line.run) and run is None
        alike = bool(line.run) and line.run == digest and before is not None and bool(before.run)
        if before is not None and not lost and not alike:
            change = _change(before, reference, line, run)
            if change.is_one:
                reference, digest = run, line.run
                yield change
        if reference is None:
            reference, digest = run, line.run
        before = line


def _change(before: Line, reference: Baseline | None, line: Line, run: Baseline | None) -> Change:
    """The differences of a run from the one that it is held against."""
    versions = tuple(
        f"{name} {line.versions[name]}, {before.versions[name]} before"
        for name in _NAMED
        if name in line.versions and name in before.versions and line.versions[name] != before.versions[name]
    )
    if run is None or not before.run:
        reasons = () if bool(run) == bool(before.run) else line.reasons or ("it runs again",)
        return Change(before, line, reasons=reasons, versions=versions)
    if reference is None:
        return Change(before, line)
    sentences = (*reference.others(line.scenario, run.settings), *reference.other_world(run))
    reasons = tuple(sentence.replace(" in the baseline", " before") for sentence in sentences)
    partings = tuple(reference.trace.partings(run.trace))
    if reference.sample is None or run.sample is None:
        return Change(before, line, partings, tuple(reference.moves(run.metrics, line.criteria)), reasons, versions)
    found = findings(reference.sample, run.sample, Asked(line.criteria, line.margins))
    moved = tuple(one for one in found if one.verdict not in ("same", "not decided"))
    reasons += tuple(_seeds_text(one) for one in moved)
    return Change(before, line, partings if moved else (), (), reasons, versions)


def _seeds_text(one: Finding) -> str:
    """A finding in a sentence."""
    was, now = (value_text(one.name.partition("[")[0], value) for value in (one.before, one.now))
    return f"{one.name} over seeds: {was} -> {now}, {one.verdict}"
