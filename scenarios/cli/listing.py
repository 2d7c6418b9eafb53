"""The things that a scenario can name, and the package of each; nothing of them is imported to be listed."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from surefoot.models.names import ROBOTS
from surefoot.parts.plugins import OWN_PACKAGE, Declared, Registry
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios import catalogue
from surefoot.scenarios.cli import texts
from surefoot.scenarios.cli.files import brought, first_line
from surefoot.scenarios.file.registries import CONTROLLERS, INSTRUMENTS, PLANT_NAMES, SOURCES, TERRAIN_KINDS
from surefoot.scenarios.judge.names import METRICS
from surefoot.wbc.tasks.registry import TASKS

_REGISTRIES: Mapping[str, Registry[Any]] = {
    "robot": ROBOTS,
    "profile": PROFILES,
    "terrain": TERRAIN_KINDS,
    "estimator": SOURCES,
    "controller": CONTROLLERS,
    "plant": PLANT_NAMES,
    "instrument": INSTRUMENTS,
    "task": TASKS,
    "metric": METRICS,
}
"""Registries by kind: all there are."""


@dataclass(frozen=True, slots=True)
class Entry:
    """Something that can be run, or that a scenario can name.

    Attributes:
        kind: scenario, control, robot, profile, terrain, estimator, controller, plant, instrument, task, metric, or one
            of files as campaign.
        name: its name.
        package: what brings it.
        doc: what it is, in one line; empty where nothing says so.
    """

    kind: str
    name: str
    package: str
    doc: str

    @property
    def own(self) -> bool:
        """True if it comes with Surefoot."""
        return self.package == OWN_PACKAGE


def entries(metrics: bool = True) -> Iterator[Entry]:
    """Everything, kind after kind: what is Surefoot's first, then what others bring.

    Args:
        metrics: whether those of this package are among it.
    """
    for name in catalogue.names():
        kind = "control" if name in catalogue.CONTROLS else "scenario"
        yield Entry(kind, name, catalogue.package(name), catalogue.summary(name))
    for kind, (files, package) in brought()[0].items():
        yield from (Entry(kind, name, package, first_line(path)) for name, path in files.items())
    for kind, registry in _REGISTRIES.items():
        if isinstance(registry, Declared) and (metrics or registry is not METRICS):
            yield from (Entry(kind, name, OWN_PACKAGE, doc) for name, doc in _said(registry).items())
        yield from (Entry(kind, name, registry.package(name), "") for name in registry.others())


def _said(registry: Declared[Any]) -> Mapping[str, str]:
    """Texts on each of a registry's own; those of metrics, whose modules take long to import, are read from a file."""
    return texts.entries("metrics") if registry is METRICS else registry.said


def refusals() -> tuple[str, ...]:
    """Reasons why things of other packages are not listed, one sentence each."""
    clashes = (str(clash) for registry in _REGISTRIES.values() for clash in registry.clashes().values())
    return (*catalogue.refusals(), *brought()[1], *clashes)


def lines() -> Iterator[str]:
    """One line per entry; of the metrics, those of other packages alone, since every verdict shows the others."""
    shown = list(entries(metrics=False))
    width = max(len(entry.name) for entry in shown)
    for entry in shown:
        origin = "" if entry.own else f"[{entry.package}]"
        words = " ".join(word for word in (entry.doc, origin) if word)
        yield f"{entry.kind:<11}{entry.name:<{width}} {words}".rstrip()


def to_json() -> dict[str, list[dict[str, str]]]:
    """Everything by kind."""
    found: dict[str, list[dict[str, str]]] = {kind: [] for kind in ("scenario", "control", *brought()[0], *_REGISTRIES)}
    for entry in entries():
        found[entry.kind].append({"name": entry.name, "package": entry.package, "doc": entry.doc})
    return found
