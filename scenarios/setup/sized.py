"""A scenario for a robot of another size: what a file that was written for one robot says of another, and defaults.

A length, time, speed, force or the like means little by itself: 0.3 m are a stroll for one robot and out of reach of
another. A file says with ``sized_for`` for which robot its numbers are. Named another robot, all of them are multiplied
by their unit's factor (see `surefoot.similarity`) before anything is set over them; what a user sets is meant as it is.
Defaults are those of the reference robot and follow the robot's size in every scenario.
"""

import copy
import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, TypeVar

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from surefoot.errors import ParameterError
from surefoot.models.facts import RobotFacts, stance_widening
from surefoot.parts.plugins import PluginError
from surefoot.planner.parameters import RecoveryParameters
from surefoot.scenarios.errors import Key, Problem, nearest
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.group import groups_in
from surefoot.scenarios.file.schema import Rates, RobotSettings, Scenario, model_of
from surefoot.scenarios.file.source import Overrides, Source, apply_overrides
from surefoot.scenarios.file.units import Unit, is_number, unit_of
from surefoot.scenarios.judge.metric import Metric
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.setup.groups.speed import with_speed
from surefoot.scenarios.setup.robot.robots import POSTURE, Robots, Rule, is_known, nearer_landings, rules
from surefoot.scenarios.setup.terrain import kind_of
from surefoot.scenarios.setup.walk import Walk
from surefoot.similarity import REFERENCE, REFERENCE_SIZE, Similarity, sized_unit
from surefoot.wbc.parameters import WbcParameters

_KEY = "sized_for"
_TORQUE = "torque_ratio_max"
"""The metric whose bounds rise for weaker robots: a walk takes so many times what standing on one foot does."""

_RESERVE = 0.05
"""Least share of its motors' torque that such a bound leaves a weaker robot [-]."""

_APART: tuple[Key, ...] = (("wbc",), ("planner", "recovery"), ("rates",), ("planner", "sample_time"), ("log",))
"""Keys whose units are those of parameters, that follow from the clock, or that bound what is written."""

_SOLES = ("foot_length", "foot_width")
"""Keys of `robot_options` that another robot has its own of."""

G = TypeVar("G", bound=BaseModel)


def sized_walk(scenario: Scenario, robots: Robots) -> Walk:
    """The walk of a scenario, with what follows from its ground, its robot and its speed.

    Raises:
        ParameterError: the scenario gives more than fits together.
        PartError: the ground, of others, fails to say what follows from it.
    """
    gait = kind_of(scenario.terrain.kind).completed(scenario.terrain, scenario.gait)
    scenario = scenario.model_copy(update={"gait": gait})
    facts = None if scenario.robot == REFERENCE else _facts(scenario.robot, RobotSettings(), robots)
    if facts is None or facts.size == REFERENCE_SIZE:
        return Walk(_with_speed(scenario, scenario, robots))
    size, sized = facts.size, with_defaults(scenario, facts.size, robots)
    return Walk(_with_speed(sized, scenario, robots), size, stance_widening(facts, size), facts.foot_length)


def unsaid(scenario: Scenario, group: str, name: str, robots: Robots) -> Any:
    """The value that a key of a group would have if the scenario did not give it, and gave all others of the group.

    Args:
        scenario: as `sized_walk` has it, or as its log has it.
        group: of keys.
        name: of the key.
        robots: that the scenario may name.
    """
    settings = getattr(scenario, group)
    bare = type(settings).model_validate(settings.model_dump(mode="json", exclude={name}))
    return getattr(getattr(sized_walk(scenario.model_copy(update={group: bare}), robots).keys, group), name)


def _with_speed(sized: Scenario, written: Scenario, robots: Robots) -> Scenario:
    """The scenario with what follows from its speed, and is not written in it; as it is without one."""
    facts = None if sized.gait.speed is None else _facts(sized.robot, RobotSettings(), robots)
    if facts is None:
        return sized
    return with_speed(sized, facts, facts.size, frozenset(written.gait.model_fields_set))


def _facts(name: Any, options: RobotSettings, robots: Robots) -> RobotFacts | None:
    with suppress(ParameterError, PluginError, LookupError):
        return robots.facts(name, options) if is_known(name, robots) else None
    return None


def say_for(source: Source, overrides: Overrides, robots: Robots) -> tuple[str, str] | None:
    """Translate a file that is sized for another robot than it is run with, in place, and take its `sized_for` out.

    Args:
        source: the file, before anything is set over it.
        overrides: what will be; the robot may be among it.
        robots: that may be named.

    Returns:
        The robot that it was for and the one that it is for, if it was translated.

    Raises:
        ScenarioError: an override leads nowhere.
    """
    named = Source(source.name, copy.deepcopy(source.value))
    apply_overrides(named, overrides)
    origin, robot = named.value.get(_KEY), named.value.get("robot", REFERENCE)
    if origin is None:
        return None
    if not is_known(origin, robots):
        right = nearest(str(origin), robots.names())
        source.problems.append(Problem((_KEY,), f"unknown robot '{origin}' in {_KEY}", right))
    source.value.pop(_KEY, None)
    if origin == robot:
        return None
    soles = _soles(source.value)
    before, after = _facts(origin, soles, robots), _facts(robot, RobotSettings(), robots)
    if before is None and is_known(origin, robots) and _facts(origin, RobotSettings(), robots) is None:
        what = f"{_KEY} '{origin}' is a robot that cannot be read"
        source.problems.append(Problem((_KEY,), what, "mend its file, or name another robot"))
    if before is None or after is None:
        return None
    effort = _effort(source.value, (str(origin), soles), (str(robot), RobotSettings()), robots)
    gait = source.value.get("gait")
    posture = rules(nearer_landings(gait if isinstance(gait, dict) else {}, bool(source.value.get("commands"))))
    _Translation(source, str(origin), before, after, effort, posture).run()
    return str(origin), str(robot)


def _effort(
    values: dict[str, Any], before: tuple[str, RobotSettings], after: tuple[str, RobotSettings], robots: Robots
) -> float:
    """Ratio of the shares of motor torque that standing on one foot takes, of one robot over another.

    1 where no criterion asks for it, and where one of them cannot stand so.
    """
    criteria = values.get("criteria")
    if not isinstance(criteria, dict) or _TORQUE not in criteria:
        return 1.0
    ratio = robots.one_foot_share(*after) / robots.one_foot_share(*before)
    return ratio if math.isfinite(ratio) and ratio > 0.0 else 1.0


def _soles(values: Any) -> RobotSettings:
    """The soles that a file gives its robot; those of the robot where it says nothing sound."""
    given = values.get("robot_options")
    try:
        return RobotSettings.model_validate({name: given[name] for name in _SOLES if name in given} if given else {})
    except (ValueError, TypeError):
        return RobotSettings()


@dataclass(frozen=True, slots=True)
class _Translation:
    """From a robot, with the soles that its file gives it, to another; the rules are of keys beyond what size says."""

    source: Source
    origin: str
    before: RobotFacts
    after: RobotFacts
    effort: float
    rules: dict[Key, Rule]

    def run(self) -> None:
        """Translate every number that has a unit; what is of a wrong type stays for the schema to tell."""
        values = self.source.value
        options = values.get("robot_options")
        for name in _SOLES if isinstance(options, dict) else ():
            options.pop(name, None)
        gait, terrain = values.setdefault("gait", {}), values.get("terrain")
        for name in POSTURE if isinstance(gait, dict) else ():
            gait.setdefault(name, Gait.model_fields[name].default)
        given = [
            group.get(name) for group, name in ((gait, "step_length"), (terrain, "tread")) if isinstance(group, dict)
        ]
        self._group(Scenario, values, ())
        if isinstance(terrain, dict) and len(given) == 2 and given[0] == given[1] is not None:
            gait["step_length"] = terrain["tread"]  # steps from tread to tread stay such
        self._parameters(WbcParameters(), values.get("wbc"), ("wbc",))
        planner = values.get("planner")
        recovery = planner.get("recovery") if isinstance(planner, dict) else None
        self._parameters(RecoveryParameters(), recovery, ("planner", "recovery"))
        for name, bound in values["criteria"].items() if isinstance(values.get("criteria"), dict) else ():
            self._criterion(values["criteria"], name, bound)
        self._rates(values)

    def _rates(self, values: dict[str, Any]) -> None:
        """The clock; the sample time follows from it."""
        given, planner = values.get("rates"), values.get("planner")
        if isinstance(planner, dict):
            planner.pop("sample_time", None)
        if isinstance(given, dict):
            with suppress(ValueError, TypeError):
                values["rates"] = clock(Rates(**given), self.after.size.time / self.before.size.time).model_dump()

    def _group(self, model: type[BaseModel], values: Any, key: Key) -> None:
        for name, unit, inner in _entries(model):
            at = (*key, name)
            if at in _APART or not isinstance(values, dict):
                continue
            value = values.get(name)
            if inner is not None:
                members = enumerate(value) if isinstance(value, list) else [(None, value)]
                for index, member in members:
                    self._group(model_of(inner, member), member, at if index is None else (*at, index))
            elif unit:
                self._put(values, name, at, self._number(value, unit, at))

    def _parameters(self, parameters: Any, values: Any, key: Key) -> None:
        for entry in fields(parameters) if isinstance(values, dict) else ():
            value, at, own = values.get(entry.name), (*key, entry.name), getattr(parameters, entry.name)
            if is_dataclass(own):
                self._parameters(own, value, at)
            elif (unit := sized_unit(entry)) is not None and entry.name in values:
                units = unit.split(", ")
                factors = [_against(self.after.size, self.before.size, unit) for unit in units]
                self._put(values, entry.name, at, _times(value, factors[0] if len(factors) == 1 else factors))

    def _criterion(self, criteria: dict[str, Any], name: str, bound: Any) -> None:
        metric, key = known(str(name).partition(".")[0]), ("criteria", name)
        if metric is None:
            return
        if isinstance(bound, dict):
            for side, limit in bound.items():
                self._put(bound, side, (*key, side), self._limit(metric, limit))
        else:
            self._put(criteria, name, key, self._limit(metric, bound))

    def _limit(self, metric: Metric[Any], limit: Any) -> Any:
        """Side of a bound on a metric for the other robot, or of one for each of its elements."""
        if isinstance(limit, list):
            return [self._limit(metric, part) for part in limit]
        if metric.name != _TORQUE:
            return _times(limit, _against(self.after.size, self.before.size, metric.unit))
        scaled = _times(limit, self.effort)
        return max(limit, min(scaled, 1.0 - _RESERVE)) if is_number(limit) else limit

    def _number(self, value: Any, unit: str, key: Key) -> Any:
        """The value for the other robot."""
        with suppress(PydanticCustomError):
            value = Unit(unit).number(value)
        rule = self.rules.get(key) if is_number(value) else None
        if rule is not None:
            return rule(value, self.before, self.after)
        return _times(value, _against(self.after.size, self.before.size, unit))

    def _put(self, values: dict[str, Any], name: str, key: Key, value: Any) -> None:
        """Write a value, and remember how it stands in the file."""
        if value != values.get(name):
            self.source.written[key] = f"{values[name]} in the file, for {self.origin}"
            values[name] = value


def clock(rates: Rates, time: float) -> Rates:
    """Rates where times are longer by a factor: the planner's the nearest whole one, the others in step with it."""
    planner = max(1, round(rates.planner / time))
    control = planner * max(1, rates.control // rates.planner)
    return Rates(planner=planner, control=control, physics=control * max(1, rates.physics // rates.control))


def with_defaults(scenario: Scenario, size: Similarity, robots: Robots) -> Scenario:
    """The scenario with the defaults that follow from the size of its robot; what was given stays as it is."""
    if size == REFERENCE_SIZE:
        return scenario
    followed = _followed(scenario, size)
    gait, changed = scenario.gait, {}
    before = after = None
    if not gait.model_fields_set.issuperset(POSTURE):
        before, after = (_facts(name, RobotSettings(), robots) for name in (REFERENCE, scenario.robot))
    if before is not None and after is not None:
        posture = rules(nearer_landings(gait.model_dump(exclude_unset=True), bool(scenario.commands)))
        for name in POSTURE:
            if name not in gait.model_fields_set:
                changed[name] = posture["gait", name](getattr(gait, name), before, after)
    rates, sample_time = _clock(scenario, size)
    update: dict[str, Any] = {
        "gait": followed.gait.model_copy(update=changed),
        "rates": rates,
        "planner": followed.planner.model_copy(update={"sample_time": sample_time}),
    }
    if "criteria" not in scenario.model_fields_set:
        update["criteria"] = {name: _bound(name, bound, size) for name, bound in scenario.criteria.items()}
    return followed.model_copy(update=update)


def _clock(scenario: Scenario, size: Similarity) -> tuple[Rates, float]:
    """Rates, and sample time [s], of which those that are not given follow the robot and the ones that are."""
    usual, given = clock(Rates(), size.time), scenario.rates.model_fields_set
    planner = scenario.rates.planner if "planner" in given else usual.planner
    control = scenario.rates.control if "control" in given else planner * (usual.control // usual.planner)
    physics = scenario.rates.physics if "physics" in given else control * (usual.physics // usual.control)
    own = "sample_time" in scenario.planner.model_fields_set
    return Rates(planner=planner, control=control, physics=physics), (
        scenario.planner.sample_time if own else 1.0 / planner
    )


def _followed(group: G, size: Similarity) -> G:
    update: dict[str, Any] = {}
    for name, unit, inner in _entries(type(group)):
        value = getattr(group, name)
        if inner is not None:
            if isinstance(value, BaseModel):
                update[name] = _followed(value, size)
            elif value:
                update[name] = tuple(_followed(member, size) for member in value)
        elif unit and name not in group.model_fields_set:
            update[name] = default_of(type(group), name, size)
    return group.model_copy(update=update)


def default_of(model: type[BaseModel], name: str, size: Similarity) -> Any:
    """Default of a key for a robot of a size, but for what follows from more than that."""
    field = model.model_fields[name]
    unit = unit_of(field.annotation, field.metadata)
    return field.default if unit in ("", "Hz") else _times(field.default, _against(size, REFERENCE_SIZE, unit))


def _bound(name: str, bound: Bound, size: Similarity) -> Bound:
    metric = known(name)
    factor = 1.0 if metric is None else _against(size, REFERENCE_SIZE, metric.unit)
    return Bound(**{side: _times(limit, factor) for side, limit in bound if limit is not None})


def _against(after: Similarity, before: Similarity, unit: str) -> float:
    """Factor of a unit from one size to another; 1 for bytes, and for what a package has made up."""
    try:
        return after.factor(unit) / before.factor(unit)
    except ValueError:
        return 1.0


def _entries(model: type[BaseModel]) -> Iterator[tuple[str, str, type[BaseModel] | None]]:
    """Keys of a group with their units and, where they hold groups, the type of these."""
    for name, field in model.model_fields.items():
        inner = None if name == "criteria" else next(groups_in(field.annotation), None)
        yield name, unit_of(field.annotation, field.metadata), inner


def _times(value: Any, factor: float | list[float]) -> Any:
    """A number, or a list or tuple of numbers, times a factor or one for each; all else as it is."""
    if isinstance(value, list | tuple):
        factors = factor if isinstance(factor, list) else [factor] * len(value)
        return type(value)(_times(part, one) for part, one in zip(value, factors, strict=False))
    if isinstance(factor, list):
        return value
    plain = is_number(value) and math.isfinite(value)
    return value * factor if plain and factor != 1.0 else value
