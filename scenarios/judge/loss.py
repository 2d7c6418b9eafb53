"""The loss of balance of a robot that fell: before it things acted on the robot, after it all is an effect."""

from dataclasses import dataclass

import numpy as np

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import Array, Mask, RunView
from surefoot.scenarios.judge.walking import fall_time

REGAINED = 1.0
"""Time for which a margin has to stay positive until balance counts as regained, longer than a step [s]."""

HIGH, UPRIGHT = 0.9, 0.35
"""Share of the nominal CoM height above which a body stands [-], and tilt of the torso below which it does [rad]."""

BEFORE = 0.5
"""Time before the loss of balance, or before steps had to catch the body, in which a cause may act [s]."""

LONGEST = 2.0
"""Longest time of steps that try to catch the body: what acted before that was survived [s]."""


@dataclass(frozen=True, slots=True)
class Loss:
    """The loss of balance before a fall.

    Attributes:
        time: when no step as planned, nor moved, held the body any more, or when it was last upright [s].
        since: from when on what acts may be the cause [s].
    """

    time: float
    since: float

    def overlaps(self, begin: float, end: float) -> bool:
        """Return true if something that acts from one time to another [s] acts before the loss and may be its cause."""
        return begin <= self.time and end >= self.since


def loss(run: RunView) -> Loss | None:
    """The loss of balance before the fall of a run; None of one that did not fall."""
    return run.once(_loss)


def _loss(run: RunView) -> Loss | None:
    fall, scale = fall_time(run), run.constants.similarity.time
    if fall is None:
        return None
    planned, movable = _margins(run)
    outside = _since(run, movable < 0.0, fall)
    time = min(fall, _upright_until(run, fall), fall if outside is None else outside)
    caught = _since(run, planned < 0.0, time)
    caught = time if caught is None else max(caught, time - LONGEST * scale)
    return Loss(time, caught - BEFORE * scale)


def _margins(run: RunView) -> Array:
    """Capture margins of all plans: steps as planned, steps moved; shape (2, plans) [m]."""
    try:
        return np.asarray(run.log["/plan"].field("capture_margin").T)
    except (KeyError, LogError):  # of a law that tells none, or of an earlier version
        return np.zeros((2, 0))


def _since(run: RunView, negative: Mask, until: float) -> float | None:
    """From when on plans have been negative up to a time without `REGAINED` between them [s]; None where not."""
    if not negative.any():
        return None
    pause = REGAINED * run.constants.similarity.time
    times = run.log["/plan"].time[negative]
    times = times[times <= until]
    if not len(times) or until - times[-1] > pause:
        return None
    gaps = np.flatnonzero(np.diff(times) > pause)
    return float(times[gaps[-1] + 1] if len(gaps) else times[0])


def _upright_until(run: RunView, fall: float) -> float:
    """Last time before a fall at which the body stood as one that walks [s]."""
    if run.constants.fidelity == "pendulum":
        return fall
    lower = np.minimum(run.sole(0)[:, 2], run.sole(1)[:, 2])
    height = run.field("/truth", "com")[:, 2] - lower
    stands = (height > HIGH * run.constants.com_height) & (run.field("/truth", "torso_tilt") < UPRIGHT)
    found = np.flatnonzero(stands & (run.time <= fall))
    return float(run.time[found[-1]]) if len(found) else fall
