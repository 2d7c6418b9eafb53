"""The keys of a walk that follow from `gait.speed`; each that is given stays as it is."""

from typing import Any, TypeVar

from pydantic import BaseModel

from surefoot.models.facts import RobotFacts
from surefoot.planner.steps.speed import speed_gait
from surefoot.scenarios.errors import Key
from surefoot.scenarios.file.group import ControllerSettings
from surefoot.scenarios.file.schema import Scenario
from surefoot.similarity import Similarity
from surefoot.wbc.parameters import STRAIGHTENED

G = TypeVar("G", bound=BaseModel)

_OF_STEPS = (
    "step_length",
    "single_support",
    "double_support",
    "com_height",
    "apex_single",
    "apex_double",
    "heel_off",
    "heel_strike",
    "pelvis_yaw",
    "pelvis_list",
    "ramp",
)

_ASKED = ("step_length", "single_support", "double_support", "heel_strike")
"""Keys on which others of these depend."""

FOLLOWING: tuple[Key, ...] = (
    *(("gait", name) for name in _OF_STEPS),
    ("planner", "knee"),
    ("wbc", "knees", "weight"),
)
"""Keys that follow from the speed where they are not given."""


def with_speed(scenario: Scenario, facts: RobotFacts, size: Similarity, given: frozenset[str]) -> Scenario:
    """The scenario with all that follows from the speed of its gait.

    Args:
        scenario: with the defaults of its robot.
        facts: of that robot.
        size: of that robot.
        given: keys of the gait that the user gives.

    Raises:
        ParameterError: the user gives more than fits together.
    """
    gait = scenario.gait
    if gait.speed is None:
        return scenario
    asked = {name: getattr(gait, name) for name in _ASKED if name in given}
    derived = speed_gait(gait.speed, facts.leg_length, facts.com_above_hip, **asked)
    turns, lists = facts.pelvis_free
    numbers = (
        derived.step_length,
        derived.single_support,
        derived.double_support,
        derived.com_height,
        derived.rise,
        0.0,
        derived.heel_off,
        derived.heel_strike,
        derived.pelvis_yaw if turns else 0.0,
        derived.pelvis_list if lists else 0.0,
        derived.ramp,
    )
    update: dict[str, Any] = {"gait": _with(gait, dict(zip(_OF_STEPS, numbers, strict=True)), given)}
    if "knee" not in scenario.planner.model_fields_set:
        update["planner"] = scenario.planner.model_copy(update={"knee": "straight"})
    if scenario.straightens:
        update["wbc"] = _controller(scenario.wbc, size.scaled(STRAIGHTENED).weight)
    return scenario.model_copy(update=update)


def _with(group: G, wanted: dict[str, Any], given: frozenset[str]) -> G:
    """The group with what is wanted and not given."""
    return group.model_copy(update={name: value for name, value in wanted.items() if name not in given})


def _controller(settings: ControllerSettings | None, weight: float) -> ControllerSettings:
    """The group ``wbc`` with that weight of the knees where it has none [s^4]."""
    values: dict[str, Any] = {} if settings is None else settings.model_dump()
    knees = dict(values.get("knees") or {})
    if knees.get("weight") is None:
        knees["weight"] = weight
    return ControllerSettings.model_validate({**values, "knees": knees})
