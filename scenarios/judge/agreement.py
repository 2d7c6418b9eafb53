"""Whether a log says one thing: how its run ended by its last record, and what its channels show."""

import math
from collections.abc import Iterator

import numpy as np

from surefoot.scenarios.judge.digest import CONTROL_TOPICS, RunView
from surefoot.scenarios.judge.walking import fall_time
from surefoot.scenarios.record.provenance import END_RECORD


def contradictions(run: RunView) -> tuple[str, ...]:
    """Say where the record of a run's end, the clock and the data of a whole log do not go together."""
    if not run.has("/truth"):
        return ("the log shows no motion: /truth has no messages",)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return (*_clock(run), *_numbers(run), *_end(run))


def _clock(run: RunView) -> Iterator[str]:
    """Every tick has its message on every channel of the control rate, one period after the other."""
    stamps, period = run.log["/truth"].time_ns, 1e9 / run.constants.control_rate
    uneven = np.flatnonzero(np.abs(np.diff(stamps) - period) > 1.0)
    if len(uneven):
        yield f"the ticks of the log are not {1e-6 * period:g} ms apart at {1e-9 * stamps[uneven[0]]:.3f} s"
    for topic in CONTROL_TOPICS:
        if topic in run.log and not np.array_equal(run.log[topic].time_ns, stamps):
            yield f"{topic} has not the ticks of /truth"


def _numbers(run: RunView) -> Iterator[str]:
    """A state that is no number is no fall, and no walk either."""
    for name in ("com", "com_velocity"):
        if not np.isfinite(run.field("/truth", name)).all():
            yield f"/truth {name} has values that are not numbers"


def _end(run: RunView) -> Iterator[str]:
    """The record of the end tells the fall that the data show, at its time, or the time at which they end."""
    record, tick = run.log.metadata[END_RECORD], 1.0 / run.constants.control_rate
    try:
        said = float(record["time"])
    except (KeyError, ValueError):
        said = math.nan
    fall = fall_time(run)
    if record["kind"] == "completed":
        if fall is not None:
            yield f"the log says that the run was completed, and its data show a fall at {fall:.3f} s"
        end = run.log["/truth"].time[-1] + tick
        if not abs(end - said) < 1.5 * tick:
            yield f"the log says that the run was completed at {said:.3f} s, and its data end at {end:.3f} s"
    elif fall is None:
        yield f"the log says that the robot fell at {said:.3f} s, and its data show no fall"
    elif not abs(fall - said) < 1.5 * tick:
        yield f"the log says that the robot fell at {said:.3f} s, and its data show a fall at {fall:.3f} s"
