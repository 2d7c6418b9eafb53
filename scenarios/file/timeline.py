"""When the phases of a gait begin: standing, then for each footstep a double and a single support, then standing.

Times are nominal; step adaptation may shift the true ones.
"""

from scenarios.file.schema import Gait, PushSettings, Scenario

FINAL_STAND = 2.5
"""Standing after the last double support that ends a run whose duration is not given [s]."""


def phase_start(gait: Gait, step: int, phase: str) -> float:
    """Begin [s] of a support phase of a footstep; step 1 is the first, its double support comes first.

    The double support before the first step shifts the weight from rest and lasts twice as long as the others.
    """
    first = gait.initial_stand + 2 * gait.double_support
    single = first + (step - 1) * (gait.single_support + gait.double_support)
    return single if phase == "single" else single - phase_duration(gait, step, phase)


def phase_duration(gait: Gait, step: int, phase: str) -> float:
    """Duration [s] of a support phase of a footstep."""
    if phase == "single":
        return gait.single_support
    return gait.double_support * (2 if step == 1 else 1)


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
    return gait.initial_stand if gait.steps == 0 else phase_start(gait, gait.steps + 1, "single")


def run_duration(scenario: Scenario) -> float:
    """Simulated time [s]: as given, or the gait and a while of standing."""
    return gait_duration(scenario.gait) + FINAL_STAND if scenario.duration is None else scenario.duration
