"""A plant, which moves a robot and measures it: Surefoot's simulated world, another simulator, or a machine."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Protocol, cast

import numpy as np

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.parts.guard import Guard, Guarded, MisfitError, taken_for
from surefoot.readings import Readings
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.setup.parts import fit
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Array, Measurement, is_rotation


class Plant(Protocol):
    """A plant as a closed loop sees it; its joints are in the order of the robot's description.

    The loop calls `reset`, and then in turn `measure` and `act`, once each in a control tick. What a plant raises ends
    the run with a fault that names it. Two methods more are asked only of plants that have them: ``push``, which takes
    a `surefoot.forces.Push` before it begins, and ``read``, which gives `surefoot.Readings` of a `Measurement`
    and the number of the control tick, to estimators that sense. The impulse of a push is judged by the external forces
    that are measured.
    """

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """Stand at the start of a walk.

        Args:
            q: configuration in Pinocchio's convention, shape (7 + nj,) [m, -, rad].
            v: velocity in Pinocchio's convention, shape (6 + nj,) [m/s, rad/s]; None for rest.
            torque: of the joints, that hold it, shape (nj,) [N·m].
        """
        ...

    def measure(self) -> Measurement:
        """Measure the state now; `q` and `v` count as the truth, by which a run is judged."""
        ...

    def act(self, command: JointCommand, period: float) -> None:
        """Do what is commanded for so long [s]."""
        ...


class Sensors(Protocol):
    """The sensors that turn a measurement into readings."""

    def read(self, measurement: Measurement, tick: int) -> Readings:
        """Read what has arrived at a control tick."""
        ...


PlantMaker = Callable[..., Plant]


def made(maker: PlantMaker, walk: Walk, options: Mapping[str, Any], guard: Guard, senses: bool) -> Plant:
    """A plant of others, behind its guard.

    Args:
        maker: of the plant.
        walk: what is run.
        options: given to it by name.
        guard: of its package.
        senses: whether its sensors are to be read.

    Raises:
        ParameterError: it can do less than the scenario asks.
    """
    with guard.making:
        plant = maker(walk, **options)
        able = {verb: callable(getattr(plant, verb, None)) for verb in (*_VERBS, "push", "read")}
    for verb in _VERBS:
        if not able[verb]:
            raise ParameterError(("plant", "name"), f"a plant without a method {verb}", "give it one")
    if not able["push"] and (walk.pushes or walk.gait_pushes):
        what = "pushes of a plant without a method push"
        raise ParameterError(("pushes",), what, "leave them out, or push it yourself")
    if senses and not able["read"]:
        what = "an estimator that senses, of a plant without a method read"
        raise ParameterError(("sensing", "source"), what, "let sensing.source be truth, or give the plant one")
    return cast("Plant", Guarded(plant, guard, {"measure": _measured(len(walk.robot.joint_names))}))


_VERBS = ("reset", "measure", "act")


def push_plant(plant: Plant, push: Push) -> None:
    """Push a plant.

    Raises:
        ParameterError: it cannot be pushed.
    """
    try:
        given = plant.push  # type: ignore[attr-defined]
    except AttributeError:
        raise ParameterError(("push",), "a push of a plant without a method push", "push it yourself") from None
    given(push)


def _measured(joints: int) -> Callable[..., Measurement]:
    """A check of measurements of a plant of so many joints."""

    def take(answer: Measurement, *_: Any) -> Measurement:
        taken_for(Measurement)(answer)
        fit(answer.q, (7 + joints,), "q")
        fit(answer.v, (6 + joints,), "v")
        if not is_rotation(answer.q[3:7]):
            raise MisfitError("gave q whose quaternion is no rotation")
        if not math.isfinite(answer.time):
            raise MisfitError(f"gave time {answer.time}, which should be one")
        for name in ("joint_position", "joint_velocity", "joint_torque"):
            fit(getattr(answer, name), (joints,), name, finite=False)
        fit(answer.wrench, (2, 6), "wrench", finite=False)
        fit(answer.external_force, (3,), "external_force", finite=False)
        return answer

    return take


MOST_SKIPPED = 10.0
"""Time that a plant may be ahead of its controller, since states have got lost [s]."""


def measured_tick(tick: int, due: int, rate: int) -> int:
    """Number of the control tick that a plant says it has measured.

    Args:
        tick: that it says.
        due: the one after that which it measured before.
        rate: of control ticks [Hz].

    Raises:
        RunFault: it is not that which is due, nor a later one within reach.
    """
    if not due <= tick <= due + MOST_SKIPPED * rate:
        raise RunFault(f"the plant has measured at control tick {tick}, where {due} is due")
    return tick


def completed(measurement: Measurement, wrench: Array, torque: Array) -> Measurement:
    """A measurement with what is not measured as it is inferred: wrenches of the soles and torques of the joints."""
    if math.isnan(measurement.wrench.item(2)):
        measurement = replace(measurement, wrench=wrench)
    if math.isnan(measurement.joint_torque.item(0)):
        measurement = replace(measurement, joint_torque=torque)
    if math.isnan(measurement.accelerometer.item(0)):
        measurement = replace(measurement, accelerometer=np.zeros(3))
    return measurement
