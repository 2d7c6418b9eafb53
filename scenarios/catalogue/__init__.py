"""The scenarios found by name: those that come with Surefoot, and those of other packages.

Another distribution names a package in which its YAML files lie:

    [project.entry-points."surefoot.scenarios"]
    my-package = "my_package.scenarios"
"""

from collections.abc import Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from types import ModuleType
from typing import NamedTuple

from surefoot.parts.plugins import OWN_PACKAGE, PluginError, Registry
from surefoot.scenarios.errors import ScenarioError, nearest
from surefoot.scenarios.file.source import decoded

_ENDING = ".yaml"


class _Other(NamedTuple):
    """A scenario of another package: what to call it in messages, its file, and the name of the package."""

    place: str
    file: Traversable
    package: str


def _inside(folder: Traversable) -> dict[str, Traversable]:
    """The YAML files of a folder by name, sorted."""
    entries = {entry.name: entry for entry in folder.iterdir() if entry.name.endswith(_ENDING)}
    return {name.removesuffix(_ENDING): entries[name] for name in sorted(entries)}


OWN: Mapping[str, Traversable] = _inside(files(__name__))
"""Ours that a robot is to do well."""

CONTROLS: Mapping[str, Traversable] = _inside(files(__name__) / "controls")
"""Scenarios of ours in which the reference robot comes to known harm, or walks with known errors of sensors and motors.
A kinder world, or a judge that sees less, does not meet their criteria."""

OURS: Mapping[str, Traversable] = {**OWN, **CONTROLS}
"""All of ours; their names always mean them."""

SCENARIOS = Registry("surefoot.scenarios", ModuleType, {})
"""The packages in which the files of others lie, by the name of their entry point."""


def names() -> tuple[str, ...]:
    """Names of all scenarios: ours, then those of other packages sorted."""
    return (*OURS, *sorted(_others()[0]))


def refusals() -> tuple[str, ...]:
    """Reasons why scenarios of other packages are not found, one sentence each."""
    return _others()[1]


def package(name: str) -> str:
    """Package that brings a scenario that there is."""
    return OWN_PACKAGE if name in OURS else _others()[0][name].package


def text(name: str) -> tuple[str, str]:
    """YAML text of a scenario, and what to call it in messages.

    Raises:
        ScenarioError: its file is too large or no UTF-8, or there is none.
    """
    if name in OURS:
        place, file = f"catalogue/{'controls/' if name in CONTROLS else ''}{name}{_ENDING}", OURS[name]
    elif name in (others := _others()[0]):
        place, file, _ = others[name]
    else:
        raise unknown(name, "no such catalogue name")
    with file.open("rb") as opened:
        return decoded(opened, place), place


def summary(name: str) -> str:
    """First comment line of a scenario: what it is, or what is wrong with its file."""
    try:
        return text(name)[0].split("\n", 1)[0].lstrip("# ")
    except ScenarioError as error:
        return str(error)


def unknown(name: str, what: str) -> ScenarioError:
    """The error for a name that no scenario has, with the packages whose scenarios could not be looked at."""
    return ScenarioError([f"{name}: {what}; {nearest(name, names())}", *refusals()])


def _others() -> tuple[dict[str, _Other], tuple[str, ...]]:
    """The scenarios of other packages by name, and what is not among them and why."""
    found: dict[str, _Other] = {}
    refused: list[str] = []
    for entry in SCENARIOS:
        try:
            module = SCENARIOS[entry]
        except PluginError as error:
            refused.append(f"scenarios {error}")
            continue
        if not hasattr(module, "__path__"):
            refused.append(f"scenarios '{entry}': {module.__name__} is no package; name one in which YAML files lie")
            continue
        for name, file in _inside(files(module.__name__)).items():
            place = f"{module.__name__}:{file.name}"
            if name in OURS:
                refused.append(f"{place}: '{name}' is a scenario of surefoot's own; give the file another name")
            elif name in found:
                refused.append(f"{place}: '{name}' is {found[name].place} already; give one of them another name")
            else:
                found[name] = _Other(place, file, SCENARIOS.package(entry))
    return found, tuple(refused)
