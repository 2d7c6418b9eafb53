"""Metrics of an estimator that senses: by what it is wrong, and whether it knows that.

Where a robot is in the world and where it looks no sensor tells. So errors are those from the stance foot, turned to
the true heading, as the log has them.
"""

import math

import numpy as np

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge.balance import rms
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.metric import DEG, MM, OF_THE_TIME, SHARE, metric

SETTLED = 0.5
"""Time after which an estimate is judged: it starts with what the encoders alone measure [s]."""

DEG_PER_MINUTE = (60.0 * math.degrees(1.0), "deg/min")
"""Unit in which a slow turn is shown."""

_TOPIC = "/estimation"
_PARTS = ("com", "com_velocity", "tilt", "sole_height")


@metric(unit="m", shown=MM, size=3, reads={_TOPIC: ("com_error",)}, body=True, least=0.0)
def com_estimation_error_rms(run: RunView) -> list[float] | None:
    """Estimated minus true CoM, each from the stance foot, RMS, x, y and z [m]."""
    return rms(_settled(run, "com_error"))


@metric(unit="m/s", size=3, reads={_TOPIC: ("com_velocity_error",)}, body=True, least=0.0)
def velocity_estimation_error_rms(run: RunView) -> list[float] | None:
    """Estimated minus true CoM velocity, RMS, x, y and z [m/s]."""
    return rms(_settled(run, "com_velocity_error"))


@metric(unit="rad", shown=DEG, reads={_TOPIC: ("tilt_error",)}, body=True, least=0.0)
def tilt_estimation_error_rms(run: RunView) -> float | None:
    """Angle by which the estimated base is tilted against the true one, RMS [rad]."""
    found = rms(np.linalg.norm(_settled(run, "tilt_error"), axis=1)[:, None])
    return found[0] if found else None


@metric(shown=(1e2, "% of the way"), reads={_TOPIC: ("place_error",), "/truth": ("com",)}, body=True, least=0.0)
def estimation_drift(run: RunView) -> float | None:
    """Error of the stance foot's estimated place in the end, over the way of the CoM [-]."""
    com = run.field("/truth", "com")[:, :2]
    way = float(np.linalg.norm(np.diff(com, axis=0), axis=1).sum())
    # Of a robot that stands or steps on the spot a share of its way says nothing.
    if way < LEAST_WAY * run.constants.similarity.length:
        return None
    return float(np.linalg.norm(run.field(_TOPIC, "place_error")[-1, :2])) / way


LEAST_WAY = 0.5
"""Shortest way of the CoM of which a drift is a share [m]."""


@metric(unit="rad", shown=DEG, reads={_TOPIC: ("yaw_error",)}, body=True, least=0.0)
def estimation_yaw(run: RunView) -> float | None:
    """Error of the base's estimated heading in the end [rad]."""
    return abs(float(run.field(_TOPIC, "yaw_error")[-1]))


@metric(
    unit="rad/s", shown=DEG_PER_MINUTE, reads={_TOPIC: ("yaw_error",)}, body=True, least=0.0, tolerance=(2e-5, SHARE)
)
def estimation_yaw_rate(run: RunView) -> float | None:
    """Drift of the base's estimated heading, mean over the run after the estimate has settled [rad/s]."""
    off, time = _settled(run, "yaw_error"), run.time[run.time >= SETTLED * run.constants.similarity.time]
    if len(time) < 2 or not time[-1] > time[0]:
        return None
    return abs(float(np.unwrap(off)[-1] - off[0])) / float(time[-1] - time[0])


_NEES_READS = {_TOPIC: tuple(f"{name}_{kind}" for name in _PARTS for kind in ("error", "deviation"))}


@metric(parts=_PARTS, reads=_NEES_READS, body=True, least=0.0)
def estimation_nees(run: RunView) -> dict[str, float] | None:
    """Mean square of errors over deviations, each number alone: 1 of an estimator that knows how wrong it is [-]."""
    found = {}
    for name in _PARTS:
        values = squares(run, name)
        sound = np.isfinite(values)
        if not sound.any():
            return None
        found[name] = float(np.mean(values[sound]))
    return found


def squares(run: RunView, name: str) -> Array:
    """Mean square of a part's errors over their deviations at each tick once settled, NaN where either is not known."""
    error, deviation = _settled(run, f"{name}_error"), _settled(run, f"{name}_deviation")
    sound = np.isfinite(error).all(axis=1) & (deviation > 0.0).all(axis=1)
    found = np.full(len(error), np.nan)
    found[sound] = np.mean((error[sound] / deviation[sound]) ** 2, axis=1)
    return found


@metric(shown=OF_THE_TIME, reads={_TOPIC: ("contact",), "/contact": ("normal_force",)}, body=True, least=0.0, most=1.0)
def contact_estimation_error(run: RunView) -> float:
    """Share of ticks with a foot that is said to stand and carries nothing, or that carries and is not said to [-]."""
    force, said = run.field("/contact", "normal_force"), run.field(_TOPIC, "contact") != 0
    weight = run.constants.mass * GRAVITY
    wrong = (said & (force <= 0.0)) | (~said & (force > CARRYING * weight))
    return float(np.mean(wrong.any(axis=1)))


CARRYING = 0.05
"""Share of the weight that a foot carries without doubt [-]."""


PUSH_LASTS = 0.5
"""Time after a push in which a force that is still counted with may be of it [s]."""

_PUSHED = {"/measurement": ("external_force",)}


@metric(unit="N", reads={"/estimate": ("external_force",), **_PUSHED}, body=True, least=0.0, tolerance=(1.0, SHARE))
def ghost_force_max(run: RunView) -> float:
    """Largest external force that the controller counts with where nothing pushes [N]."""
    return _ghost(run, "external_force")


@metric(unit="N m", reads={"/estimate": ("external_moment",), **_PUSHED}, body=True, least=0.0, tolerance=(1.0, SHARE))
def ghost_moment_max(run: RunView) -> float:
    """Largest external moment about the CoM that the controller counts with where nothing pushes [N m]."""
    return _ghost(run, "external_moment")


def _ghost(run: RunView, name: str) -> float:
    ticks = round(PUSH_LASTS * run.constants.similarity.time * run.constants.control_rate)
    pushed = np.flatnonzero(np.nan_to_num(run.field("/measurement", "external_force")).any(axis=1))
    quiet = np.ones(run.ticks, dtype=bool)
    for tick in pushed:
        quiet[tick : tick + ticks] = False
    return float(np.max(np.linalg.norm(run.field("/estimate", name)[quiet], axis=1), initial=0.0))


def _settled(run: RunView, name: str) -> Array:
    values = run.field(_TOPIC, name)
    return values[run.time >= SETTLED * run.constants.similarity.time]
