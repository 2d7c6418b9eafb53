"""From a scenario's name or file to a checked scenario: every fault of a file is reported at once."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from scenarios import catalogue
from scenarios.errors import Key, Problem, ScenarioError, SetupError, nearest
from scenarios.file.checks import check
from scenarios.file.criteria import Bound
from scenarios.file.override import apply_override
from scenarios.file.robots import RegisteredRobots, Robots
from scenarios.file.schema import Scenario
from scenarios.file.source import MAX_BYTES, parse
from scenarios.file.supported import unavailable
from scenarios.file.translate import problems_of, unknown_metrics, without
from scenarios.rerun import attached_scenario, is_log


def load_scenario(reference: str, overrides: Sequence[str] = (), robots: Robots | None = None) -> Scenario:
    """Load a scenario.

    Args:
        reference: a catalogue name, the path of a YAML file, or that of a log to run again.
        overrides: ``key=value`` with dotted keys and YAML values, applied in order.
        robots: the robots it may name; those of ``models`` by default.

    Returns:
        the scenario, fit to run; its name is the file's when it gives none.

    Raises:
        ScenarioError: it cannot be found, read or run; lists every fault with its place.
    """
    text, name, stem = _text(reference)
    return read_scenario(text, name, stem, overrides, robots or RegisteredRobots())


def locate(reference: str, overrides: Sequence[str], refusal: SetupError) -> ScenarioError:
    """Say where the cause of a refusal stands: at the first key that its sentence names, else at the scenario's begin.

    Args:
        reference: as given to `load_scenario`, as are the overrides.
        overrides: ``key=value``.
        refusal: of a part of the stack.
    """
    text, name, _ = _text(reference)
    source = parse(text, name)
    for override in overrides:
        apply_override(source, override)
    what, _, right = str(refusal).rstrip(".").partition("; ")
    problem = Problem(_named_key(what), what, right or "change the scenario so that it fits")
    return ScenarioError([source.describe(problem)])


def _named_key(sentence: str) -> Key:
    """The first scenario key that a sentence names, such as gait.com_height; () when it names none."""
    for group, name in re.findall(r"\b([a-z_]+)\.([a-z_]+)\b", sentence):
        fields = getattr(Scenario.model_fields.get(group), "annotation", None)
        if name in getattr(fields, "model_fields", {}):
            return (group, name)
    return ()


def read_scenario(text: str, name: str, stem: str, overrides: Sequence[str], robots: Robots) -> Scenario:
    """Check a scenario's text; arguments and errors as of `load_scenario`, with `name` used in messages."""
    source = parse(text, name)
    if source.value is None:
        raise ScenarioError([f"{name}:1:1: the file is empty; give at least 'name: {stem}'"])
    if not isinstance(source.value, dict):
        raise ScenarioError([f"{name}:1:1: a scenario is a group of keys; write 'key: value' lines"])
    for override in overrides:
        apply_override(source, override)
    source.value.setdefault("name", stem)
    scenario, problems = _validated(source.value)
    problems = [*source.problems, *problems]
    wrong = {problem.key for problem in problems}
    semantic = [*check(scenario, robots), *unavailable(scenario)]
    problems += [problem for problem in semantic if not _touched(problem.key, wrong)]
    if problems:
        raise ScenarioError(source.describe(problem) for problem in sorted(problems, key=source.spot))
    if "fell" not in scenario.criteria:
        criteria = {"fell": Bound(equals=False), **scenario.criteria}
        scenario = scenario.model_copy(update={"criteria": criteria})
    return scenario


def _text(reference: str) -> tuple[str, str, str]:
    """Text, name for messages, and stem of a scenario."""
    if reference in catalogue.names():
        return catalogue.text(reference), f"catalogue/{reference}.yaml", reference
    if is_log(reference):
        return *attached_scenario(reference), Path(reference).stem
    path = Path(reference)
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        if len(data) > MAX_BYTES:
            raise ScenarioError([f"{reference}:1:1: larger than {MAX_BYTES} bytes; a scenario is a short YAML file"])
        return data.decode("utf-8-sig"), reference, path.stem
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        column = error.start - data.rfind(b"\n", 0, error.start)
        raise ScenarioError([f"{reference}:{line}:{column}: not UTF-8 text; save the file as UTF-8"]) from None
    except IsADirectoryError:
        raise ScenarioError([f"{reference}: a directory; give a scenario file or a catalogue name"]) from None
    except FileNotFoundError:
        right = nearest(reference, catalogue.names())
        raise ScenarioError([f"{reference}: no such scenario file or catalogue name; {right}"]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ScenarioError([f"{reference}: cannot be read, {reason}; give a readable scenario file"]) from None


def _validated(data: Any) -> tuple[Scenario, list[Problem]]:
    """The scenario that the sound part of the data gives, and the faults of the rest."""
    problems = unknown_metrics(data.get("criteria"))
    data = without(data, problems)
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
    """Whether a finding concerns something that is already known to be at fault."""
    return any(key[: len(other)] == other or other[: len(key)] == key for other in wrong)
