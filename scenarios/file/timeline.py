"""When the phases of a gait begin: standing, then for each footstep a double and a single support, then standing.

Times are nominal; step adaptation may shift the true ones.
"""

from scenarios.file.commands import gait_of
from scenarios.file.schema import Gait, PushSettings, Scenario

FINAL_STAND = 2.5
"""Standing after the last double support that ends a run whose duration is not given [s]."""


def step_count(gait: Gait) -> int:
    """Number of footsteps."""
    return gait_of(gait).steps


def phase_start(gait: Gait, step: int, phase: str) -> float:
    """Begin [s] of a support phase of a footstep; step 1 is the first, its double support comes first.

    The double support before the first step of a bout shifts the weight from rest and lasts twice as long as the
    others.
    """
    single = _lift_off(gait, step)
    return single if phase == "single" else single - phase_duration(gait, step, phase)


def phase_duration(gait: Gait, step: int, phase: str) -> float:
    """Duration [s] of a support phase of a footstep."""
    if phase == "single":
        return gait.single_support
    return gait.double_support * (2 if step in _first_steps(gait) else 1)


def push_time(gait: Gait, push: PushSettings) -> float:
    """Begin [s] of a push, given directly or by step, phase and fraction."""
    if push.time is not None:
        return push.time
    if push.step is None or push.phase is None:
        raise ValueError("a push needs a time, or a step and a phase")
    return phase_start(gait, push.step, push.phase) + (push.fraction or 0.0) * phase_duration(
        gait, push.step, push.phase
    )


def gait_duration(gait: Gait) -> float:
    """Time from the start to the end of the last double support [s]."""
    steps = step_count(gait)
    return gait.initial_stand if steps == 0 else _lift_off(gait, steps + 1)


def run_duration(scenario: Scenario) -> float:
    """Simulated time [s]: as given, or the gait and a while of standing."""
    return gait_duration(scenario.gait) + FINAL_STAND if scenario.duration is None else scenario.duration


def _lift_off(gait: Gait, step: int) -> float:
    """Time at which a foot lifts off; of a step after the last one when it would if the walk went on [s]."""
    begin, before, walk = 0.0, 0, gait_of(gait).walk
    for number, bout in enumerate(walk, start=1):
        first = begin + bout.stand + 2 * gait.double_support
        if step <= before + len(bout.strides) or number == len(walk):
            return first + (step - before - 1) * (gait.single_support + gait.double_support)
        begin = first + len(bout.strides) * (gait.single_support + gait.double_support)
        before += len(bout.strides)
    raise ValueError(f"step {step} is none of a gait that stands")


def _first_steps(gait: Gait) -> list[int]:
    """Numbers of the steps that begin a bout."""
    counts = [len(bout.strides) for bout in gait_of(gait).walk]
    return [1 + sum(counts[:i]) for i in range(len(counts))]
