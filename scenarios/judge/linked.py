"""Metrics of a controller beside its plant: a line on which messages are late or lost, and the shadow of a log."""

import numpy as np

from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metric import metric


@metric(unit="s", shown=(1e3, "ms"), parts=("median", "p99"), reads={"/link": ("command_age",)}, least=0.0)
def command_age(run: RunView) -> dict[str, float] | None:
    """Age of the state that the command in force answers, over a line: median and 99th percentile [s]."""
    age = run.log["/link"].field("command_age")
    age = age[np.isfinite(age)]
    return None if not len(age) else {"median": float(np.median(age)), "p99": float(np.percentile(age, 99.0))}


@metric(reads={"/link": ("commands_missed",)}, least=0.0)
def commands_missed(run: RunView) -> int | None:
    """Control ticks to which no new command had come, where messages may be late."""
    missed = run.log["/link"].field("commands_missed")
    return int(missed[-1]) if len(missed) else None


@metric(reads={"/link": ("states_missed",)}, least=0.0)
def states_missed(run: RunView) -> int | None:
    """Control ticks whose states never came to the controller, where messages may be late."""
    missed = run.log["/link"].field("states_missed")
    return int(missed.sum()) if len(missed) else None


@metric(reads={"/link": ("commands_limited",)}, least=0.0)
def commands_limited(run: RunView) -> int | None:
    """Control ticks at which a plant in another process did less than it was commanded."""
    limited = run.log["/link"].field("commands_limited")
    return int(limited[-1]) if len(limited) else None


@metric(
    unit="N m", parts=("rms", "max"), reads={"/shadow": ("command",), "/torque": ("command",)}, least=0.0,
)  # fmt: skip
def shadow_difference(run: RunView) -> dict[str, float] | None:
    """Commanded torques minus those of the log in whose shadow it walked: RMS and largest [N m]."""
    then, now = run.log["/shadow"].field("command"), run.log["/torque"].field("command")
    count = min(len(then), len(now))
    if not count:
        return None
    difference = now[:count] - then[:count]
    return {"rms": float(np.sqrt(np.mean(difference**2))), "max": float(np.abs(difference).max())}
