"""The assembly of a controller from a walk, and from parts of Surefoot or of others."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from operator import index
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from surefoot.errors import ParameterError
from surefoot.models.facts import knee_turn
from surefoot.models.pinocchio import limb_shapes
from surefoot.models.types import RobotDescription
from surefoot.parts.guard import Guard, MisfitError, shown
from surefoot.scenarios.file.control import ControlSettings
from surefoot.scenarios.file.schema import Rates, Scenario
from surefoot.scenarios.run.driven import driven_joints
from surefoot.scenarios.run.sensed import Senses
from surefoot.scenarios.run.sensing import ESTIMATORS, Estimator, SensorEstimator
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.parts import TASK, guarded
from surefoot.scenarios.setup.robot.body import Body
from surefoot.scenarios.setup.sized import clock
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.wbc.contact.cone import Sole
from surefoot.wbc.controller import WholeBodyController
from surefoot.wbc.tasks import TASKS, Task, TaskFactory
from surefoot.wbc.tasks.knees import Knees
from surefoot.wbc.types import Array

if TYPE_CHECKING:
    from surefoot.scenarios.run.plant import PlantMaker


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of the loop that a user may replace.

    Attributes:
        controller: makes the whole-body controller; takes the arguments of `WholeBodyController` by name.
        estimator: makes the state estimator of a walk; None for the one that the scenario names.
        tasks: make tasks of the whole-body QP, which go after the default ones and those that the scenario names.
        plant: makes what moves the robot, a `surefoot.Plant`, of a walk; None for the one that the scenario names. A
            `Controller` has none.
    """

    controller: Callable[..., WholeBodyController] = WholeBodyController
    estimator: Callable[[Walk], Estimator | SensorEstimator] | None = None
    tasks: tuple[TaskFactory, ...] = ()
    plant: "PlantMaker | None" = None

    @classmethod
    def of(cls, **chosen: Any) -> "Parts":
        """Parts of which None stands for surefoot's own."""
        return cls(**{name: part for name, part in chosen.items() if part is not None})

    def given(self) -> dict[str, object]:
        """Parts that are not surefoot's own, by name."""
        own = Parts()
        return {
            e.name: getattr(self, e.name) for e in fields(self) if getattr(self, e.name) is not getattr(own, e.name)
        }


def resolved_walk(
    robot: str | RobotDescription, gait: Scenario | Walk | str, control: Mapping[str, Any] | None
) -> Walk:
    """The walk of a robot."""
    if isinstance(gait, Walk):
        return gait
    scenario = load(gait) if isinstance(gait, str) else gait
    if isinstance(robot, str) and robot != scenario.robot:
        if not isinstance(gait, str):
            what = f"a scenario of {scenario.robot} for {robot}"
            right = "give the scenario of this robot, or the name of one to be scaled to it"
            raise ParameterError(("robot",), what, right)
        scenario = load(gait, {"robot": robot, "sized_for": scenario.sized_for or scenario.robot})
    if control is not None:
        try:
            keys = ControlSettings.model_validate(dict(control))
        except ValidationError as error:
            fault = error.errors(include_url=False)[0]
            key = ("control", *fault["loc"])
            raise ParameterError(key, f"{'.'.join(map(str, key))} {fault['input']!r}", fault["msg"]) from None
        scenario = scenario.model_copy(update={"control": keys})
    return resolve(scenario, None if isinstance(robot, str) else robot)


def senses_of(walk: Walk, parts: Parts) -> Senses:
    """The estimator that a program hands over, else that which the scenario names."""
    source = walk.sensing.source
    make = parts.estimator or ESTIMATORS[source]
    guard = ESTIMATORS.guard(source) if parts.estimator is None else Guard.of_program("estimator", make)
    with guard.making:
        return Senses(make(walk, **(walk.sensing.options or {})), guard)


def _tasks(walk: Walk, body: Body, parts: Parts) -> Iterator[Task]:
    """The tasks that the scenario names, then those that a program hands over."""
    named = ((TASKS[name], TASKS.guard(name)) for name in walk.tasks)
    for make, guard in (*named, *((make, Guard.of_program("task", make)) for make in parts.tasks)):
        with guard.making:
            task = guarded(make(body.model, body.frames), guard, TASK)
            if not isinstance(task.name, str):
                raise MisfitError(f"has the name {shown(task.name)}, which is no text")
            index(task.size)
            np.asarray(task.weight, dtype=np.float64)
        yield task


def knees_of(robot: RobotDescription) -> Knees:
    """The knees of a robot."""
    left, right = robot.joint_indices(robot.roles.knees)
    straight = robot.straight_joint_positions
    one, other = (bend / knee_turn(robot, foot) for foot, bend in enumerate(robot.roles.knee_bend))
    return Knees((left, right), (float(straight[left]), float(straight[right])), (one, other))


def whole_body_of(walk: Walk, body: Body, posture: Array, parts: Parts) -> WholeBodyController:
    """The whole-body controller of a walk.

    Args:
        walk: what is walked.
        body: of its robot.
        posture: configuration in which it begins, shape (nq,).
        parts: in place of surefoot's own.
    """
    robot = walk.robot
    rate, parameters = walk.control.output_rate or walk.rates.control, walk.controller
    usual = clock(Rates(), walk.size.time).control
    if rate != usual:
        # A foot feels for a time, not for a number of ticks.
        ticks = max(1, round(parameters.schedule.felt_ticks * rate / usual))
        parameters = replace(parameters, schedule=replace(parameters.schedule, felt_ticks=ticks))
    driven = driven_joints(walk.control, robot)
    shoulders = robot.joint_indices(robot.roles.arm_swing or ())
    return parts.controller(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, walk.friction),
        limits=body.limits,
        posture=posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / rate,
        parameters=parameters,
        limbs=limb_shapes(robot),
        arm_joints=(shoulders[0], shoulders[1]) if shoulders else None,
        arm_back=robot.roles.arm_back,
        tasks=tuple(_tasks(walk, body, parts)),
        knees=knees_of(robot),
        **({} if driven is None else {"driven": driven}),
    )
