"""Runs of several seeds in words: the pass rate, what is worse or better and by how much, and what is not decided."""

from collections.abc import Iterator, Sequence

from surefoot.maths.chance import SuccessRate
from surefoot.scenarios.check.findings import MOST_NEEDED, RATE, Finding
from surefoot.scenarios.check.sample import MARGIN
from surefoot.scenarios.check.sampled import Sampled
from surefoot.scenarios.judge.verdict import shown_unit, value_text

_SHOWN = 8
"""Findings of a kind, and seeds that missed their criteria, that are named; the others are counted."""


def seed_lines(sampled: Sampled) -> list[str]:
    """Lines on the runs of several seeds, worst first."""
    return [
        _rate_line(sampled),
        *_missed_lines(sampled),
        *_named(sampled, "worse"),
        *_named(sampled, "moved"),
        *_undecided_lines(sampled),
        *_named(sampled, "better"),
        *_beyond_lines(sampled),
        *_rest_line(sampled),
    ]


def finding_text(one: Finding) -> str:
    """A finding: from where to where, by how much with its interval, and what would have been allowed."""
    before, now, low, high, margin = (
        _text(one, value) for value in (one.before, one.now, one.difference.low, one.difference.high, one.margin)
    )
    by = _text(one, one.difference.value)
    pairs = f"{one.pairs} pairs" if one.pairs else "no seeds in common"
    unit = f" {_unit(one)}".rstrip()
    return f"{one.name}: {before} -> {now}{unit}, by {by} ({low} to {high}), {margin} is allowed, {pairs}"


def _rate_line(sampled: Sampled) -> str:
    passed, count = sampled.sample.passed.count(True), len(sampled.sample.seeds)
    text = f"{passed} of {count} seeds met their criteria: {_share(sampled.rate)}"
    if sampled.rate_before is not None and sampled.before is not None:
        then = sampled.before.passed.count(True)
        text += f"; {then} of {len(sampled.before.seeds)} in the baseline: {_share(sampled.rate_before)}"
    if not sampled.random:
        text += "; nothing in them is random, one run says all"
    elif count < sampled.asked:
        text += f"; decided before all {sampled.asked}"
    return text


def _share(rate: SuccessRate) -> str:
    return f"{100 * rate.rate:.3g} % (95 % interval {rate.between} %)"


def _missed_lines(sampled: Sampled) -> Iterator[str]:
    for seed, reason in list(sampled.reasons.items())[:_SHOWN]:
        had = sampled.before is not None and seed in set(sampled.before.seeds) - set(sampled.before.missed)
        yield f"seed {seed} missed its criteria{', not so in the baseline' if had else ''}: {reason}"
    if len(sampled.reasons) > _SHOWN:
        yield f"and {len(sampled.reasons) - _SHOWN} seeds more"


def _named(sampled: Sampled, verdict: str) -> Iterator[str]:
    """The findings of a verdict, those that a criterion asks for first."""
    found = [one for one in sampled.findings if one.verdict == verdict]
    found.sort(key=lambda one: not one.deciding)
    yield from (f"{verdict}: {finding_text(one)}" for one in found[:_SHOWN])
    yield from _more(found, verdict)


def _undecided_lines(sampled: Sampled) -> Iterator[str]:
    """Findings that decide and are not decided, with how many runs more they would be."""
    found = [one for one in sampled.findings if one.verdict == "not decided" and one.deciding]
    found = [] if sampled.alarms else found
    yield from (f"not decided: {finding_text(one)}; needs {needed(one)}" for one in found[:_SHOWN])
    yield from _more(found, "not decided")


def needed(one: Finding) -> str:
    """About how many runs more would decide a finding."""
    if one.needs > MOST_NEEDED:
        return f"more than {MOST_NEEDED} runs more"
    return f"about {one.needs} runs more" if one.pairs else f"about {one.needs} runs more, and as many in the baseline"


def _more(found: Sequence[Finding], verdict: str) -> Iterator[str]:
    if len(found) > _SHOWN:
        yield f"and {len(found) - _SHOWN} {verdict} more"


def _beyond_lines(sampled: Sampled) -> Iterator[str]:
    counts: dict[tuple[str, str], int] = {}
    for (_, name), side in sampled.beyond.items():
        counts[name, side] = counts.get((name, side), 0) + 1
    for (name, side), count in counts.items():
        yield f"{MARGIN}{name} is {side} its range with {count} seeds, and counts as the end of it; widen the range"


def _rest_line(sampled: Sampled) -> Iterator[str]:
    """Counts of what is the same and of what is not decided and does not decide."""
    same = sum(one.verdict == "same" for one in sampled.findings)
    open_ = sum(one.verdict == "not decided" and not one.deciding for one in sampled.findings)
    if sampled.findings:
        yield f"{same} of {len(sampled.findings)} are the same within what is allowed" + (
            f"; {open_} others are not decided" if open_ else ""
        )


def _text(one: Finding, value: float) -> str:
    if one.name == RATE:
        return f"{100 * value:.3g}"
    return f"{value:.3g}" if one.name.startswith(MARGIN) else value_text(_metric(one), float(value))


def _unit(one: Finding) -> str:
    return "%" if one.name == RATE else "" if one.name.startswith(MARGIN) else shown_unit(_metric(one))


def _metric(one: Finding) -> str:
    return one.name.partition("[")[0]
