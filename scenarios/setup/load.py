"""From a scenario's name, file or log to a checked scenario: every fault of a file is reported at once."""

import copy
import json
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from pydantic import ValidationError

from surefoot.errors import ParameterError, PartError
from surefoot.models.names import is_file
from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import Key, LogError, Problem, ScenarioError, SetupError, hinted_once
from surefoot.scenarios.file.criteria import Bound, standing_walk
from surefoot.scenarios.file.names import unusable
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.source import Overrides, Source, apply_overrides, decoded, parse, value_at
from surefoot.scenarios.file.translate import problems_of, without
from surefoot.scenarios.judge.metrics import unknown_metrics
from surefoot.scenarios.judge.verdict import applies
from surefoot.scenarios.log import read
from surefoot.scenarios.log.encoding import MAGIC
from surefoot.scenarios.record import provenance
from surefoot.scenarios.setup.checks.checks import check
from surefoot.scenarios.setup.checks.criteria import criteria_problems
from surefoot.scenarios.setup.groups.speed import FOLLOWING
from surefoot.scenarios.setup.keys import scenario_problem
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.sized import say_for, sized_walk

LOG_ENDING = ".mcap"
MOST_PROBLEMS = 20
"""Problems of a scenario that are shown at once."""


class Written(NamedTuple):
    """A scenario as it is written: its text, what to call it in messages, and its name where it gives none."""

    text: str
    place: str
    stem: str


def is_log(reference: str) -> bool:
    """Return true if a reference to a scenario is the path of a log, by its ending or by how the file begins."""
    if reference.endswith(LOG_ENDING):
        return True
    try:
        with Path(reference).open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):
        return False


_UNSAID = re.compile(r"(?m)^  (?:encoder_noise|gyro_noise|accelerometer_noise|wrench_noise|latency): 0\.0\n")
"""Lines of the group `sensing` in logs of versions without presets, of which none had any other value."""


def attached_scenario(path: str, own_parts: bool = False) -> tuple[str, str]:
    """Text of the scenario that a log carries, and what to call it in messages.

    Args:
        path: of the log.
        own_parts: whether Surefoot's own parts may stand for those that a program has brought.

    Raises:
        ScenarioError: the log cannot be read, or carries none.
    """
    try:
        log = read(path)
        text = decoded(BytesIO(log.attachments[provenance.SCENARIO_FILE]), f"{path}/{provenance.SCENARIO_FILE}")
        text = _as_run(text if "\n  preset:" in text else _UNSAID.sub("", text), log.metadata)
        text = _seated_as_run(text, log.metadata)
    except LogError as error:
        raise ScenarioError([str(error)]) from None
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError):
        what = f"{path}: carries no readable {provenance.SCENARIO_FILE}, so it cannot be run again"
        raise ScenarioError([f"{what}; give a log that `surefoot run` has written"]) from None
    if provenance.PARTS_RECORD in log.metadata and not own_parts:
        parts = ", ".join(f"{name} {part}" for name, part in log.metadata[provenance.PARTS_RECORD].items())
        what = f"{path}: was made by a program with parts of its own ({parts}), which no log can carry"
        raise ScenarioError([f"{what}; run that program again"])
    return text, f"{path}/{provenance.SCENARIO_FILE}"


def _as_run(text: str, metadata: Mapping[str, Mapping[str, str]]) -> str:
    """The text of a scenario with the pushes and commands that were given while it ran, as long as it ran then.

    What was given by hand was promised to nobody; nor was what the scenario holds, in a run that was ended by hand.
    """
    given = {
        keys: [
            {**json.loads(record[kind.strip()]), "live": True}
            for name, record in metadata.items()
            if name.startswith(kind)
        ]
        for keys, kind in (("pushes", provenance.PUSH_RECORD), ("commands", provenance.COMMAND_RECORD))
    }
    end = metadata.get(provenance.END_RECORD, {})
    if not any(given.values()) and end.get("reason") != provenance.STOPPED:
        return text
    keys = parse(text, provenance.SCENARIO_FILE).value
    keys |= {name: [*keys.get(name, []), *values] for name, values in given.items() if values}
    if end:
        keys["duration"] = float(end["time"]) + (provenance.AFTER_FALL if end["kind"] == "fall" else 0.0)
        for name in ("pushes", "commands", "faults"):
            # What was to come later has not acted.
            keys[name] = [entry for entry in keys.get(name, []) if (entry.get("time") or 0.0) < keys["duration"]]
        if end.get("reason") == provenance.STOPPED or end["kind"] == "fall":
            for name in ("pushes", "commands"):
                keys[name] = [{**entry, "live": True} for entry in keys[name]]
            keys["faults"] = [_until(keys["duration"], entry) for entry in keys["faults"]]
    return yaml.safe_dump(keys, sort_keys=False)


def _seated_as_run(text: str, metadata: Mapping[str, Mapping[str, str]]) -> str:
    """The text of a scenario whose controller must be the one that it had then, where the log tells its digest."""
    digest = metadata.get(provenance.SEAT_RECORD, {}).get("digest")
    if digest is None:
        return text
    keys = parse(text, provenance.SCENARIO_FILE).value
    keys["controller"]["digest"] = json.loads(digest)
    return yaml.safe_dump(keys, sort_keys=False)


def _until(end: float, fault: dict[str, Any]) -> dict[str, Any]:
    """A fault that lasts to the end of the run, if it would last longer [s]."""
    lasts = fault.get("duration")
    if lasts is None or fault["time"] + lasts <= end:
        return fault
    return {name: value for name, value in fault.items() if name != "duration"}


def written(reference: str) -> Written:
    """The text of a scenario, by its name, the path of a YAML file or that of a log.

    Raises:
        ScenarioError: it cannot be found or read.
    """
    if reference in catalogue.OURS:
        return Written(*catalogue.text(reference), reference)
    path = Path(reference)
    try:
        if not path.is_file() and reference in catalogue.names():
            return Written(*catalogue.text(reference), reference)
        if path.exists() and not path.is_file() and not path.is_dir():
            raise ScenarioError([f"{reference}: a pipe or a device; give a regular file, or a catalogue name"])
        if is_log(reference):
            return Written(*attached_scenario(reference), path.stem)
        with path.open("rb") as file:
            return Written(decoded(file, reference), reference, path.stem)
    except IsADirectoryError:
        raise ScenarioError([f"{reference}: a directory; give a scenario file or a catalogue name"]) from None
    except FileNotFoundError:
        raise catalogue.unknown(reference, "no such scenario file or catalogue name") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ScenarioError([f"{reference}: cannot be read, {reason}; give a readable scenario file"]) from None


def load(reference: str | Path, overrides: Overrides = (), robots: Robots | None = None) -> Scenario:
    """Load a scenario.

        load("walk", {"gait.steps": 12, "terrain.friction": 0.5})

    Args:
        reference: a catalogue name, the path of a YAML file, or that of a log to run again.
        overrides: values by dotted key, or ``key=value`` with YAML values as on the command line, applied in order.
        robots: the robots it may name; those of ``models`` by default.

    Returns:
        the scenario, fit to run; its name is the file's when it gives none.

    Raises:
        ScenarioError: it cannot be found, read or run; lists every fault with its place.
    """
    return read_scenario(*written(str(reference)), overrides, robots)


def locate(reference: str, overrides: Overrides, refusal: SetupError) -> ScenarioError:
    """Locate the cause of a refusal: at the key that it names, else at the begin; arguments of `load`."""
    source = _source(written(reference), overrides, Robots())
    return ScenarioError([source.describe(refusal.problem, together=True)])


def read_scenario(
    text: str, place: str, stem: str, overrides: Overrides = (), robots: Robots | None = None
) -> Scenario:
    """Check a scenario as it is `Written`; ScenarioError lists every fault with its place."""
    robots = robots or Robots()
    source = _source(Written(text, place, stem), overrides, robots)
    scenario, problems = _validated(source.value)
    problems = [*source.problems, *problems]
    wrong = {problem.key for problem in problems}
    scenario, unfit = _checked(scenario, robots)
    semantic = [*criteria_problems(scenario.criteria, scenario.walker), *unfit]
    semantic = [problem for problem in semantic if not _touched(problem.key, wrong)]
    if problems or semantic:
        raise ScenarioError(_described(source, problems, semantic))
    if "fell" not in scenario.criteria:
        criteria = {"fell": Bound(equals=False), **scenario.criteria}
        scenario = scenario.model_copy(update={"criteria": criteria})
    return scenario


def key_problems(written: Written, overrides: Overrides, robots: Robots) -> list[Problem]:
    """List what is wrong with single keys of a scenario, whatever the others say.

    Args:
        written: the scenario.
        overrides: over its keys.
        robots: that it may name, each of which they look at once for all scenarios that they are given with.

    Raises:
        ScenarioError: it is no scenario, or an override leads nowhere.
    """
    return _validated(_source(written, overrides, robots).value)[1]


def for_robot(
    written: Written, values: Mapping[str, Any], origin: str, robot: str | None, robots: Robots
) -> dict[str, Any]:
    """Values by key, for an origin, as they are for a robot or the scenario's own; without those that it has itself.

    Raises:
        ScenarioError: the scenario cannot be read, or a key leads nowhere.
    """
    source = parse(written.text, written.place)
    if not isinstance(source.value, dict):
        return dict(values)
    source.value["sized_for"] = origin
    apply_overrides(source, values)
    _size(source, {} if robot is None else {"robot": robot}, robots)
    sized = {}
    for name in values:
        with suppress(LookupError):
            sized[name] = value_at(source.value, name)
    return sized


def _source(written: Written, overrides: Overrides, robots: Robots) -> Source:
    """The values of a scenario's text, as they are for its robot, with what is set over them; or a ScenarioError."""
    name = written.place
    source = parse(written.text, name)
    if source.value is None:
        raise ScenarioError([f"{name}:1:1: the file is empty; give at least 'name: {written.stem}'"])
    if not isinstance(source.value, dict):
        raise ScenarioError([f"{name}:1:1: a scenario is a group of keys; write 'key: value' lines"])
    _place_files(source, Path(written.place).parent)
    _size(source, overrides, robots)
    own, written_for_it = source.value.get("criteria"), _seat(source.value) is not None
    asked = list(own) if isinstance(own, dict) else []
    _follow_speed(source, overrides, robots)
    apply_overrides(source, overrides)
    _place_files(source, Path.cwd())
    if _seat(source.value) is not None:
        _ask_of_seat(source.value, [] if written_for_it else asked, overrides)
    source.value.pop("sized_for", None)
    source.value.setdefault("name", written.stem)
    return source


def _size(source: Source, overrides: Overrides, robots: Robots) -> None:
    """Translate a file for the robot that it is run with, whose knees are to be bent as the other one's."""
    given = _names(overrides)
    if "sized_for" not in source.value and "sized_for" not in given:
        return
    before = copy.deepcopy(source.value)
    names = say_for(source, overrides, robots)
    if names is None:
        return
    of, walk = (_sound({**one, "robot": name}, robots) for one, name in zip((before, source.value), names, strict=True))
    if of is None or walk is None:
        return
    from surefoot.scenarios.setup.stances.stances import bent_once

    with suppress(ParameterError):
        source.value["gait"]["com_height"] = bent_once(of, walk, robots)
        source.written["gait", "com_height"] = f"{of.gait.com_height:g} in the file, for {names[0]}"


def _follow_speed(source: Source, overrides: Overrides, robots: Robots) -> None:
    """Let what follows from a speed in the text follow from the one that is set over it.

    A log has all numbers of its scenario. Those that are not as the speed has them were given, and stay.
    """
    gait = source.value.get("gait")
    if "gait.speed" not in _names(overrides) or not isinstance(gait, dict) or gait.get("speed") is None:
        return
    bare = copy.deepcopy(source.value)
    for key in FOLLOWING:
        _drop(bare, key)
    derived = _sound(bare, robots)
    values = {} if derived is None else derived.model_dump(mode="json")
    for key in FOLLOWING:
        name = ".".join(map(str, key))
        with suppress(LookupError, TypeError):
            if value_at(source.value, name) == value_at(values, name):
                _drop(source.value, key)


def _names(overrides: Overrides) -> list[str]:
    """The dotted keys of overrides."""
    given = overrides if isinstance(overrides, Mapping) else [one.partition("=")[0].strip() for one in overrides]
    return [str(name) for name in given]


def _drop(values: Any, key: Key) -> None:
    """Take a key out of nested groups, if it is there."""
    *groups, last = key
    for name in groups:
        values = values.get(name) if isinstance(values, dict) else None
    if isinstance(values, dict):
        values.pop(last, None)


def _sound(values: dict[str, Any], robots: Robots) -> Scenario | None:
    """The scenario of values; None where anything is wrong with them, which others tell."""
    given = {name: value for name, value in values.items() if name != "sized_for"}
    scenario, problems = _validated(given)
    if problems:
        return None
    scenario, unfit = _checked(scenario, robots)
    return None if unfit else scenario


def _checked(scenario: Scenario, robots: Robots) -> tuple[Scenario, list[Problem]]:
    """The scenario with what follows from its ground, and what of it does not fit together."""
    try:
        walk = sized_walk(scenario, robots)
        return walk.keys, check(walk, robots)
    except PartError as fault:  # of the ground: what is wrong with a robot is among the checks
        return scenario, [Problem(("terrain", "kind"), fault.what, fault.right)]
    except ParameterError as refusal:  # of the ground, too
        return scenario, [scenario_problem(refusal)]


def _described(source: Source, alone: list[Problem], together: list[Problem]) -> list[str]:
    """The first problems with their places, in the order of the file, and how many more there are.

    Args:
        source: of the scenario.
        alone: of single values.
        together: of values that do not fit together.
    """
    found = sorted(((*alone, *together)), key=source.spot)
    first = found[:MOST_PROBLEMS]
    shortened = zip(first, hinted_once(first), strict=True)
    lines = [source.describe(short, problem in together) for problem, short in shortened]
    rest = len(found) - len(lines)
    return [*lines, f"{source.name}: {rest} problems more; mend these first"] if rest else lines


def _place_files(source: Source, folder: Path) -> None:
    """Name files by their full paths, so that the scenario means the same wherever it is read again."""
    robot, seat = source.value.get("robot"), _seat(source.value)
    if isinstance(robot, str) and is_file(robot):
        source.value["robot"] = os.path.normpath(folder.absolute() / robot)
    if seat is not None and isinstance(seat.get("policy"), str):
        seat["policy"] = os.path.normpath(folder.absolute() / seat["policy"])
    if isinstance(log := _log_option(source.value).get("log"), str):
        _log_option(source.value)["log"] = os.path.normpath(folder.absolute() / log)


def _log_option(values: dict[str, Any]) -> dict[str, Any]:
    """The options of a plant that goes on from a log, as they are written; empty of another one."""
    plant = values.get("plant")
    options = plant.get("options") if isinstance(plant, dict) and plant.get("name") == "log" else None
    return options if isinstance(options, dict) else {}


def _seat(values: Any) -> dict[str, Any] | None:
    """The group of what has the seat of planner and whole-body controller, as it is written; None without one."""
    seat = values.get("controller") if isinstance(values, dict) else None
    return seat if isinstance(seat, dict) else None


def _ask_of_seat(values: dict[str, Any], written: list[Any], overrides: Overrides) -> None:
    """Leave out the criteria of a planner that a scenario asks which was written for one, and keep their names.

    Those that the overrides themselves ask stay, to be refused. Of the criteria of a file that gives none, those of a
    planner are not meant.

    Args:
        values: of the scenario.
        written: criteria of a file that has named no controller itself.
        overrides: over its keys.
    """
    if "criteria" not in values:
        usual = standing_walk().items()
        values["criteria"] = {
            name: bound.model_dump(exclude_none=True) for name, bound in usual if applies(name, bound, "seat")
        }
    asked = values["criteria"]
    if not isinstance(asked, dict):
        return
    given = [one if isinstance(overrides, Mapping) else one.partition("=")[0].strip() for one in overrides]
    left = [
        name
        for name in written
        if _needs_planner(asked.get(name), name) and not any(f"{one}.".startswith(f"criteria.{name}.") for one in given)
    ]
    values["criteria"] = {name: bound for name, bound in asked.items() if name not in left}
    if left:
        values["controller"]["left_out"] = left


def _needs_planner(bound: Any, name: Any) -> bool:
    """Return true if a criterion as it is written needs a planner; a faulty one does not."""
    with suppress(ValidationError):
        return not applies(str(name), Bound.model_validate(bound), "seat")
    return False


def _validated(data: Any) -> tuple[Scenario, list[Problem]]:
    """The scenario that the sound part of the data gives, and the faults of the rest."""
    problems = [*unknown_metrics(data.get("criteria")), *unusable(data)]
    data = without(data, [problem for problem in problems if problem.key != ("robot",)])
    while True:
        try:
            return Scenario.model_validate(data), problems
        except ValidationError as error:
            found = problems_of(error, data)
            problems += found
            smaller = without(data, found)
            if smaller == data:
                return Scenario(), problems
            data = smaller


def _touched(key: Key, wrong: set[Key]) -> bool:
    """Return true if a finding concerns something that is already known to be at fault."""
    return any(key[: len(other)] == other or other[: len(key)] == key for other in wrong)
