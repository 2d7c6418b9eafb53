"""Parts of others in the loop: each behind its guard, with what it gives held against what its protocol says."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from surefoot.parts.guard import Guard, Guarded, MisfitError, taken_for
from surefoot.planner.laws.law import Motion, MotionPlanner, MotionProblem
from surefoot.planner.laws.names import PROFILES
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.types import Array
from surefoot.wbc.estimation.estimate import Estimate

if TYPE_CHECKING:
    from surefoot.readings import Readings
    from surefoot.sim.measurement import Measurement
    from surefoot.wbc.types import RobotState

Shape = tuple[int, ...]


def profile_guard(profile: Profile, given: bool) -> Guard:
    """A guard for the calls of what a profile brings, which a program may have given in place of a name."""
    if PROFILES.owns(profile) or not given:
        return PROFILES.guard(profile.name)
    return Guard(f"profile '{profile.name}' of this program")


def guarded_law(profile: Profile, guard: Guard) -> Profile:
    """A profile whose law of motion stays behind its guard."""
    if not guard.who:
        return profile

    def law(*given: Any) -> MotionPlanner:
        with guard.making:
            return cast("MotionPlanner", Guarded(profile.law(*given), guard, {"plan": _motion}))

    return replace(profile, law=law)


def guarded(part: Any, guard: Guard, take: dict[str, Callable[..., Any]]) -> Any:
    """A part behind its guard; itself where it is Surefoot's own."""
    return Guarded(part, guard, take) if guard.who else part


def _motion(answer: Motion, problem: MotionProblem) -> Motion:
    """The motion of a law, checked."""
    fit(answer.jerk, problem.fallback.shape, "jerk")
    fit(answer.shifts, (2, 2), "shifts")
    for name in ("zmp_slack", "terminal_slack"):
        fit(getattr(answer, name), (2,), name, finite=False)
    return answer


_SAMPLED: dict[str, Shape] = {
    **dict.fromkeys(("com", "com_velocity", "com_acceleration"), (3,)),
    **dict.fromkeys(("zmp", "zmp_offset", "zmp_reference"), (2,)),
    **dict.fromkeys(("stiffness", "omega", "load_left"), ()),
}
"""Fields of a plan that have a value at each end of a sample, and the shape of one."""


def plan(answer: WalkPlan, *_: Any) -> WalkPlan:
    """The plan of a planner, checked; see `surefoot.parts.guard.Guard.function`."""
    taken_for(WalkPlan)(answer)
    horizon = len(answer.jerk)
    fit(answer.jerk, (horizon, 2), "jerk")
    for name, shape in _SAMPLED.items():
        fit(getattr(answer, name), (horizon + 1, *shape), name)
    return answer


def _state(answer: "RobotState | Estimate", measurement: "Measurement") -> "RobotState | Estimate":
    """The state of an estimator, or its estimate, checked."""
    state = answer.state if isinstance(answer, Estimate) else answer
    fit(state.q, measurement.q.shape, "q")
    fit(state.v, measurement.v.shape, "v")
    return _complete(answer) if isinstance(answer, Estimate) else answer


def _estimate(answer: Estimate, readings: "Readings") -> Estimate:
    """The estimate of an estimator that senses, checked."""
    taken_for(Estimate)(answer)
    joints = len(readings.joint_position.values)
    fit(answer.state.q, (7 + joints,), "q", finite=False)
    fit(answer.state.v, (6 + joints,), "v", finite=False)
    if answer.wrench is None and readings.wrench is None:
        raise MisfitError("gave no wrench, and the feet have no force sensors")
    return _complete(answer)


def _complete(answer: Estimate) -> Estimate:
    """An estimate, checked but for its state."""
    if answer.wrench is not None:
        fit(answer.wrench, (2, 6), "wrench")
    if not 0.0 <= answer.wrench_age < math.inf:
        raise MisfitError(f"gave a wrench_age of {answer.wrench_age}, which should be a time")
    if answer.contact is not None:
        fit(answer.contact, (2,), "contact")
    if answer.deviation is not None:
        for name, shape in _DEVIATED.items():
            fit(getattr(answer.deviation, name), shape, f"deviation.{name}", finite=False)
    return answer


_DEVIATED: dict[str, Shape] = {
    **dict.fromkeys(("com", "com_velocity"), (3,)),
    **dict.fromkeys(("tilt", "sole_height"), (2,)),
    **dict.fromkeys(("step_height", "force", "moment"), ()),
}
"""Fields of a deviation, and the shape of each."""


def _wanted(answer: Iterable[float], terms: Any, reference: Any, scale: Array, rows: Array) -> Any:
    """The target of a task, which it has also written into its rows, checked."""
    wanted = [float(one) for one in answer]
    if len(wanted) != len(scale) or not math.isfinite(sum(wanted)):
        fit(wanted, scale.shape[:1], "acceleration")
    fit(rows, rows.shape, "rows")
    return wanted


ESTIMATE: dict[str, Callable[..., Any]] = {"estimate": _state, "sense": _estimate}
TASK = {"write": _wanted}
"""Checks of the answers of an estimator and of a task, by their methods."""


def fit(value: Any, shape: Shape, name: str, finite: bool = True) -> None:
    """Hold an array against what it should be.

    Raises:
        MisfitError: it has another shape, or a value that is no number.
    """
    array = np.asarray(value, dtype=np.float64)
    if array.shape != shape:
        raise MisfitError(f"gave {name} of shape {array.shape}, which should be {shape}")
    # A number that is not finite makes the sum of squares so, which is found ten times as fast.
    if finite and not math.isfinite(np.vdot(array, array)) and not np.isfinite(array).all():
        raise MisfitError(f"gave {name} with values that are not finite")
