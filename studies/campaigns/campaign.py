"""A campaign that can be run: its specification with the scenarios that it names, and what of it cannot be."""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from surefoot.scenarios.errors import Key, Problem, ScenarioError, nearest
from surefoot.scenarios.file.search import MOST_RUNS, Bisect
from surefoot.scenarios.file.source import Source, decoded, parse, plain_scalar, setting
from surefoot.scenarios.file.translate import problems_of
from surefoot.scenarios.many.points import Base
from surefoot.scenarios.setup.load import for_robot, key_problems, written
from surefoot.scenarios.setup.robot.robots import Robots, is_known
from surefoot.studies.campaigns.beside import Beside
from surefoot.studies.campaigns.shipped import ENDING, shipped
from surefoot.studies.campaigns.spec import Spec

SCENARIO, SEARCH = "scenario", "bisect."
"""Keys that are no scenario's and may vary as any other: which scenario, and the range of the search."""


class Setting(NamedTuple):
    """A value of an axis: what stands in the table, and what it sets."""

    label: Any
    keys: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Campaign:
    """A specification that can be run.

    Attributes:
        spec: as written, with what was set from outside.
        place: what to call its file in messages.
        axes: of the grid, by name.
        literal: keys of ``set`` that were set from outside, and mean what they say for every robot.
        bases: the scenarios that it names, by name.
    """

    spec: Spec
    place: str
    axes: Mapping[str, tuple[Setting, ...]]
    literal: frozenset[str]
    bases: Mapping[str, Base]

    @property
    def cells(self) -> int:
        """Number of runs, or of thresholds that are sought."""
        combinations = math.prod(len(axis) for axis in self.axes.values())
        return combinations * (1 if self.spec.bisect else self.spec.seeds)

    def bisect(self, keys: Mapping[str, Any]) -> Bisect | None:
        """The search of a combination, whose range may be its own.

        Raises:
            ValidationError: it cannot be.
        """
        own = {key.removeprefix(SEARCH): value for key, value in keys.items() if key.startswith(SEARCH)}
        bisect = self.spec.bisect
        return bisect if bisect is None or not own else Bisect.model_validate({**bisect.model_dump(), **own})

    def combinations(self, robots: Robots | None = None) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Labels and settings of every combination of the grid, the last axis fastest; robots are looked at once."""
        robots = robots or Robots()
        for chosen in itertools.product(*self.axes.values()):
            labels = {name: one.label for name, one in zip(self.axes, chosen, strict=True)}
            keys = dict(self.spec.set)
            for one in chosen:
                keys |= one.keys
            yield labels, self._sized(keys, robots)

    def base(self, keys: Mapping[str, Any]) -> str:
        """Name of the scenario that settings are of."""
        return str(keys.get(SCENARIO, self.spec.scenario))

    def _sized(self, keys: dict[str, Any], robots: Robots) -> dict[str, Any]:
        """Settings as they are for the robot that they name; lists and what is drawn or searched mean what they say."""
        origin, base = self.spec.sized_for, self.bases.get(self.base(keys))
        if base is None or origin in (None, keys.get("robot")):
            return keys
        listed = (name for name, axis in self.spec.grid.items() if isinstance(axis, list))
        said = {"robot", SCENARIO, *self.literal, *listed}
        own = {key: value for key, value in keys.items() if key not in said and not key.startswith(SEARCH)}
        sized = for_robot(base.written, own, origin, keys.get("robot"), robots)
        return {key: sized.get(key, value) for key, value in keys.items() if key not in own or key in sized}


def read_campaign(
    reference: str, overrides: Sequence[str] = (), seeds: int | None = None, beside: Beside | None = None
) -> Campaign:
    """Read and check a specification.

    Args:
        reference: name of a shipped campaign, or a file.
        overrides: ``key=value``: values of scenario keys in every run, over those that the specification sets or
            varies; of an axis with named settings, the name of the one to keep; of any axis a list of those to keep.
        seeds: over those of the specification.
        beside: two walkers that are laid beside each other; None for the one that the specification has.

    Raises:
        ScenarioError: it cannot be read or run; lists every fault with its place.
    """
    text, place = _text(reference)
    source = parse(text, place)
    spec = _validated(source, Path(place).name.removesuffix(ENDING))
    fixed = frozenset(setting(override)[0] for override in overrides)
    spec = _overridden(spec, overrides)
    if seeds is not None:
        spec = spec.model_copy(update={"seeds": seeds})
    if beside is not None:
        spec = beside.laid(spec, place)
    campaign = Campaign(spec, place, {name: _settings(name, axis) for name, axis in spec.grid.items()}, fixed, {})
    campaign = replace(campaign, bases=_bases(campaign, source))
    problems = list(_twice(campaign)) or list(_faults(campaign))
    if problems:
        raise ScenarioError(dict.fromkeys(source.describe(problem) for problem in problems))
    if campaign.cells * (spec.seeds if spec.bisect else 1) > MOST_RUNS:
        raise ScenarioError([f"{place}: {campaign.cells} cells, of {spec.seeds} seeds; give at most {MOST_RUNS} runs"])
    return campaign


def _text(reference: str) -> tuple[str, str]:
    """Text of a specification, and what to call it in messages."""
    own = shipped()
    path = Path(reference)
    if not path.is_file() and reference in own:
        return own[reference].read_text(encoding="utf-8"), f"campaigns/{reference}{ENDING}"
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise ValueError("a pipe or a device is no regular file")
        with path.open("rb") as file:
            return decoded(file, reference), reference
    except FileNotFoundError:
        raise ScenarioError([f"{reference}: no such specification or campaign; {nearest(reference, own)}"]) from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise ScenarioError([f"{reference}: cannot be read, {why}; give a specification of a campaign"]) from None


def _validated(source: Source, stem: str) -> Spec:
    if not isinstance(source.value, dict):
        raise ScenarioError([f"{source.name}:1:1: a campaign is a group of keys; give at least 'scenario: walk'"])
    source.value.setdefault("name", stem)
    try:
        spec = Spec.model_validate(source.value)
        problems = source.problems
    except ValidationError as error:
        problems = [*source.problems, *problems_of(error, source.value, Spec)]
    if problems:
        raise ScenarioError(source.describe(problem) for problem in sorted(problems, key=source.spot))
    return spec


def _overridden(spec: Spec, overrides: Sequence[str]) -> Spec:
    """The specification with keys fixed from outside, wherever it has them."""
    fixed, grid = dict(spec.set), dict(spec.grid)
    for override in overrides:
        name, value = setting(override)
        text, axis = override.partition("=")[2], grid.get(name)
        if isinstance(axis, dict):
            kept = [str(one) for one in value] if isinstance(value, list) else [text]
            unknown = next((one for one in kept if one not in axis), None)
            if unknown is not None or not kept:
                right = nearest(unknown or text, axis)
                raise ScenarioError([f"--set {name}={text}: the grid has no such setting; {right}"])
            grid[name] = {one: axis[one] for one in axis if one in kept}
        elif axis is not None:
            several = isinstance(value, list) and value and all(one in axis for one in value)
            grid[name] = [one for one in axis if one in value] if several else [value]
        else:
            fixed[name] = value
    taken = {name: value for name, value in fixed.items() if name not in spec.set or value != spec.set[name]}
    update = {
        "set": fixed,
        "grid": grid,
        "sample": {name: draw for name, draw in spec.sample.items() if name not in taken},
        "first": {name: values for name, values in spec.first.items() if name not in taken},
        "records": [one for one in spec.records if all(label in grid[name] for name, label in one.at.items())],
    }
    return spec.model_copy(update=update)


def _settings(name: str, axis: list[Any] | dict[str, dict[str, Any]]) -> tuple[Setting, ...]:
    if isinstance(axis, list):
        return tuple(Setting(value, {name: value}) for value in axis)
    return tuple(Setting(plain_scalar(label), keys) for label, keys in axis.items())


def _bases(campaign: Campaign, source: Source) -> dict[str, Base]:
    """The scenarios that are named."""
    found: dict[str, Base] = {}
    for _, keys in campaign.combinations():
        name = campaign.base(keys)
        if not name:
            problem = Problem((), "names no scenario", "give 'scenario: walk', or vary it in the grid")
            raise ScenarioError([source.describe(problem)])
        if name not in found:
            beside = Path(campaign.place).parent / name
            reference = str(beside) if beside.is_file() else name
            found[name] = Base(reference, written(reference))
    return found


def _twice(campaign: Campaign) -> Iterator[Problem]:
    """Report keys that are varied in two ways, one of which would be lost."""
    spec, seen = campaign.spec, dict.fromkeys(("seed",), "seeds")
    varied = [("sample", tuple(spec.sample)), ("first", tuple(spec.first))]
    varied += [("grid", tuple({key for setting in axis for key in setting.keys})) for axis in campaign.axes.values()]
    varied += [("bisect", (spec.bisect.key,))] if spec.bisect else []
    for group, keys in varied:
        for key in keys:
            if key in seen:
                yield Problem((group, key), f"{key} is varied by {seen[key]} too", "vary a key once")
            seen[key] = group


def _faults(campaign: Campaign) -> Iterator[Problem]:
    """List what is wrong with keys or values alone; what several together cannot be is found by the run itself."""
    robots, origin = Robots(), campaign.spec.sized_for
    if origin is not None and not is_known(origin, robots):
        yield Problem(("sized_for",), f"unknown robot '{origin}' in sized_for", nearest(origin, robots.names()))
        return
    base = next(campaign.combinations(robots))[1]
    plain = base | _ends(campaign.spec, 0)
    yield from _of_point(
        campaign, robots, plain, {key: ("set", key) for key in campaign.spec.set} | _searched(campaign.spec)
    )
    for name, axis in campaign.axes.items():
        named = isinstance(campaign.spec.grid[name], dict)
        for index, one in enumerate(axis):
            at: Key = ("grid", name, str(one.label)) if named else ("grid", name, index)
            places = {key: (*at, key) if named else at for key in one.keys}
            alone = replace(campaign, axes={**campaign.axes, name: (one,)})
            yield from _of_point(
                campaign, robots, next(alone.combinations(robots))[1] | _ends(campaign.spec, 0), places
            )
    yield from _of_point(campaign, robots, base | _ends(campaign.spec, -1), _searched(campaign.spec))
    for key, values in campaign.spec.first.items():
        for index, value in enumerate(values[1:], start=1):
            yield from _of_point(campaign, robots, plain | {key: value}, {key: ("first", key, index)})
    for key, draw in campaign.spec.sample.items():
        for index, value in enumerate((draw.choice or ())[1:], start=1):
            yield from _of_point(campaign, robots, plain | {key: value}, {key: ("sample", key, "choice", index)})


def _ends(spec: Spec, which: int) -> dict[str, Any]:
    """Values at one end of every range that is drawn from or searched, lower (0) or upper (-1); else the first."""
    ends: dict[str, Any] = {key: values[0] for key, values in spec.first.items()}
    for key, draw in spec.sample.items():
        ends[key] = draw.uniform[which] if draw.uniform else (draw.choice or draw.normal or [])[0]
    if spec.bisect is not None:
        ends[spec.bisect.key] = (spec.bisect.low, spec.bisect.high)[which]
    return ends


def _searched(spec: Spec) -> dict[str, Key]:
    """Places of the keys that are drawn or searched."""
    places: dict[str, Key] = {key: ("sample", key) for key in spec.sample}
    places |= {key: ("first", key) for key in spec.first}
    if spec.bisect is not None:
        places[spec.bisect.key] = ("bisect", "key")
    return places


def _of_point(
    campaign: Campaign, robots: Robots, keys: Mapping[str, Any], places: Mapping[str, Key]
) -> Iterator[Problem]:
    """Faults of a run's keys that stand at one of these places."""
    try:
        campaign.bisect(keys)
    except ValidationError as error:
        for problem in problems_of(error, keys, Bisect):
            what = problem.what.removeprefix("the file: ")
            yield from (replace(problem, key=at, what=what) for key, at in places.items() if key.startswith(SEARCH))
    keys = {key: value for key, value in keys.items() if not key.startswith(SEARCH)}
    base = campaign.bases[campaign.base(keys)]
    keys.pop(SCENARIO, None)
    try:
        problems = key_problems(base.written, keys, robots)
    except ScenarioError as error:
        for message in error.problems:
            name, _, rest = message.removeprefix("--set ").partition(": ")
            what, _, right = rest.partition("; ")
            if name in places:
                yield Problem(places[name], f"{name}: {what}", right)
        return
    for problem in problems:
        at = next((place for key, place in places.items() if _concerns(key, problem.key)), None)
        if at is not None:
            yield replace(problem, key=at, at_key=False)


def _concerns(setting: str, key: Key) -> bool:
    """Return true if a problem's key is what a setting sets, or a part of it, or the other way round."""
    path = tuple(setting.split("."))
    found = tuple(map(str, key))
    return path[: len(found)] == found or found[: len(path)] == path
