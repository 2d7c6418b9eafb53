"""The report on a regression: for a person, as JSON, and as the comment of its scenario."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from shlex import quote
from typing import Any

from surefoot.studies.incident.causes import Cause, settings
from surefoot.studies.incident.harm import SAME_WAY, Harm
from surefoot.studies.incident.regression import Regression, Trial

WIDTH = 100
"""Characters of a cause that a comment shows."""


def starts(found: Regression) -> Iterator[str]:
    """The beginnings that were tried, a line each."""
    for begin, trial in found.starts:
        where = "run from its beginning" if begin == 0.0 else f"begun in the state of the log at {begin:.3f} s"
        yield f"{where}: {outcome(trial)}"


def outcome(trial: Trial) -> str:
    """The outcome of a trial, with its likeness where it came to the incident."""
    alike = f"; {trial.likeness.text}" if trial.same and trial.likeness is not None else ""
    return f"{trial.text}{alike}"


def comment(found: Regression, path: Path) -> tuple[str, ...]:
    """The comment of the scenario in a file."""
    begins = "at the beginning of the run" if found.begin == 0.0 else f"in the state of the log at {found.begin:.3f} s"
    lines = [
        f"{_capital(found.incident.harm.text)}, as in {found.incident.log.path.name}; it begins {begins}.",
        *(f"Note on the log: {note}." for note in found.incident.notes),
        _heading(found),
    ]
    for cause in found.needed:
        lines += [
            f"- {_short(found.in_file(cause).text)}{_then(found, cause, '; ')}",
            f"  {_without(found, cause, path)}",
        ]
    return (*lines, *_left_out(found))


def _heading(found: Regression) -> str:
    """The heading of the list of causes."""
    if not found.needed:
        return "It takes nothing but the walk itself: the cause is in the robot, the gait or the code."
    if found.without(found.needed[0]) is None:
        return "All that acted then, also what need not:"
    return "It takes each of these, and without any single one it is another run:"


def _then(found: Regression, cause: Cause, mark: str) -> str:
    """The outcome of the run without a cause, after a mark; empty where that was not tried."""
    trial = found.without(cause)
    return "" if trial is None else f"{mark}without it {trial.text}"


def _left_out(found: Regression) -> Iterator[str]:
    needless = [_short(cause.text, 40) for cause in found.causes if cause not in found.needed]
    if needless:
        yield f"Not needed, and taken out: {'; '.join(needless)}."


def _short(text: str, most: int = WIDTH) -> str:
    return text if len(text) <= most else f"{text[: most - 4]} ..."


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _without(found: Regression, cause: Cause, path: Path) -> str:
    given = " ".join(f"--set {quote(one)}" for one in settings(found.values, found.in_file(cause)))
    return f"surefoot check {quote(str(path))} {given}"


def lines(found: Regression, path: Path, last: Trial | None) -> Iterator[str]:
    """All for a person.

    Args:
        found: the regression.
        path: of its scenario.
        last: the run of that file; None where it was not written.
    """
    harm = found.incident.harm
    yield f"{found.incident.log.path}: {harm.text}"
    yield from (f"note: {note}" for note in found.incident.notes)
    yield from starts(found)
    if last is None:
        yield "the incident does not come back, and no scenario is written"
        return
    yield f"{len(found.needed)} of {len(found.causes)} causes are needed, by {len(found.trials)} runs; {rule(harm)}"
    for cause in found.causes:
        if cause in found.needed:
            setting = ", a setting of the controller" if cause.is_setting else ""
            yield f"  needed      {_short(cause.text)}{setting}{_then(found, cause, ': ')}"
        else:
            yield f"  not needed  {_short(cause.text)}"
    yield f"{path}: {outcome(last)}"
    yield from _too_late(found)
    yield f"red until it is mended: surefoot check {quote(str(path))}"
    for cause in found.needed:
        trial = found.without(cause)
        if trial is not None and trial.harm is None and not trial.refused:
            yield f"green without a cause: {_without(found, cause, path)} --update"


def _too_late(found: Regression) -> Iterator[str]:
    lost = found.incident.lost
    if lost is not None and found.begin >= lost:
        yield f"note: balance was lost at {lost:.3f} s, before it begins, so that nothing can mend it; begin earlier"


def rule(harm: Harm) -> str:
    """The rule by which another run counts as the same incident, in words."""
    if harm.fault:
        return f"the same is a fault within {harm.within:.2g} s"
    if not harm.fell:
        return "the same is to miss the same criterion"
    return f"the same is a fall within {harm.within:.2g} s and {SAME_WAY:g} degrees"


def to_json(found: Regression, path: Path, last: Trial | None) -> dict[str, Any]:
    """All as one JSON object."""
    return {
        "log": str(found.incident.log.path),
        "scenario": None if last is None else str(path),
        "incident": _harm(found.incident.harm),
        "notes": list(found.incident.notes),
        "begin": found.begin,
        "starts": [{"begin": begin, **_trial(trial)} for begin, trial in found.starts],
        "causes": [
            {
                "cause": cause.text,
                "needed": cause in found.needed,
                "setting": cause.is_setting,
                "without": list(settings(found.values, found.in_file(cause))) if cause in found.needed else None,
                "then": _trial(then) if (then := found.without(cause)) is not None and cause in found.needed else None,
            }
            for cause in found.causes
        ],
        "trials": [_trial(trial) for trial in found.trials],
        "again": None if last is None else _trial(last),
        "same_within": {"time": found.incident.harm.within, "angle_deg": SAME_WAY},
    }


def _harm(harm: Harm | None) -> Mapping[str, Any] | None:
    if harm is None:
        return None
    way = None if harm.way is None else harm.way.tolist()
    return {"fell": harm.fell, "time": harm.time, "way": way, "missed": list(harm.missed), "fault": harm.fault or None}


def _trial(trial: Trial) -> dict[str, Any]:
    alike = trial.likeness
    close = None
    if alike is not None:
        close = {"to_the_bit": alike.parts is None, "com_distance": alike.distance, "later": alike.later}
    return {
        "causes": [cause.text for cause in trial.causes],
        "incident": _harm(trial.harm),
        "same": trial.same,
        "likeness": close,
        "refused": trial.refused or None,
    }
