"""What a scenario can name, and which package brings it; and the text to start a scenario of one's own from."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

from surefoot.models.registry import ROBOTS, said_of
from surefoot.planner.laws.profiles import PROFILES
from surefoot.plugins import OWN_PACKAGE, Registry
from surefoot.scenarios import catalogue
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.metrics import METRICS
from surefoot.scenarios.judge.metrics import OWN as OWN_METRICS
from surefoot.scenarios.run.sensing import ESTIMATORS
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.show.options import keys
from surefoot.scenarios.study.campaigns.campaign import shipped
from surefoot.wbc.tasks import TASKS

_REGISTRIES: Mapping[str, tuple[Registry[Any], Callable[[str], str]]] = {
    "robot": (ROBOTS, said_of),
    "profile": (PROFILES, lambda name: PROFILES[name].doc),
    "terrain": (KINDS, lambda name: _first_line(type(KINDS[name]))),
    "estimator": (ESTIMATORS, lambda name: _first_line(ESTIMATORS[name])),
    "task": (TASKS, lambda name: ""),
    "metric": (METRICS, lambda name: OWN_METRICS[name].meaning),
}
"""By kind: all there are, and what is said of one of ours; the modules of others are not imported to be listed."""


@dataclass(frozen=True, slots=True)
class Entry:
    """Something that can be run, or that a scenario can name.

    Attributes:
        kind: scenario, control, campaign, robot, profile, terrain, estimator, task or metric.
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
        """Whether it comes with Surefoot."""
        return self.package == OWN_PACKAGE


def entries() -> Iterator[Entry]:
    """Everything, kind after kind: what is Surefoot's first, then what others bring."""
    for name in catalogue.names():
        kind = "control" if name in catalogue.CONTROLS else "scenario"
        yield Entry(kind, name, catalogue.package(name), catalogue.summary(name))
    for name, path in shipped().items():
        yield Entry("campaign", name, OWN_PACKAGE, path.read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# "))
    for kind, (registry, doc) in _REGISTRIES.items():
        for name in registry:
            package = registry.package(name)
            yield Entry(kind, name, package, doc(name) if package == OWN_PACKAGE else "")


def refusals() -> tuple[str, ...]:
    """What of other packages is not listed, and why, one sentence each."""
    clashes = (str(clash) for registry, _ in _REGISTRIES.values() for clash in registry.clashes().values())
    return (*catalogue.refusals(), *clashes)


def lines() -> Iterator[str]:
    """One line per entry; of the metrics, those of other packages alone, since every verdict shows the others."""
    shown = [entry for entry in entries() if not (entry.own and entry.kind == "metric")]
    width = max(len(entry.name) for entry in shown)
    for entry in shown:
        origin = "" if entry.own else f"[{entry.package}]"
        words = " ".join(word for word in (entry.doc, origin) if word)
        yield f"{entry.kind:<10}{entry.name:<{width}} {words}".rstrip()


def to_json() -> dict[str, list[dict[str, str]]]:
    """Everything by kind."""
    found: dict[str, list[dict[str, str]]] = {kind: [] for kind in ("scenario", "control", "campaign", *_REGISTRIES)}
    for entry in entries():
        found[entry.kind].append({"name": entry.name, "package": entry.package, "doc": entry.doc})
    return found


_EDITOR = """\
# Every key has a default; `surefoot schema > surefoot.schema.json` lets an editor complete and check them:
# yaml-language-server: $schema=surefoot.schema.json
"""
_KEY = re.compile(r"( *)(\w+):(?: +[^#|>\s][^#]*)?")
_COLUMN = 40


def starter(name: str) -> str:
    """YAML text of a scenario to start one's own from: each key with its meaning, and what lets an editor check them.

    That of a campaign is given as it is.

    Raises:
        ScenarioError: its file is too large or no UTF-8, or there is none.
    """
    if name not in catalogue.names() and name in (campaigns := shipped()):
        return campaigns[name].read_text(encoding="utf-8")
    text = catalogue.text(name)[0]
    lines = text.splitlines(keepends=True)
    head = next((number for number, line in enumerate(lines) if not line.startswith("#")), len(lines))
    made = "".join((*lines[:head], _EDITOR, *_explained(lines[head:])))
    said = _content(text)
    return made if said is not None and _content(made) == said else text


def _explained(lines: Sequence[str]) -> Iterator[str]:
    """Lines of a scenario, with a comment after each key of whose meaning something is known."""
    meanings = {**dict(keys(Scenario)), **{f"criteria.{name}": metric.meaning for name, metric in OWN_METRICS.items()}}
    path: list[tuple[int, str]] = []
    for line in lines:
        key = _KEY.fullmatch(line.rstrip())
        if key is None:
            yield line
            continue
        path = [*((indent, name) for indent, name in path if indent < len(key[1])), (len(key[1]), key[2])]
        meaning = meanings.get(".".join(name for _, name in path), "")
        yield f"{key[0]:<{_COLUMN}}  # {meaning}\n" if meaning not in ("", key[2]) else line


def _content(text: str) -> Any:
    """What a YAML text says; None where it cannot be read."""
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError:
        return None


def _first_line(thing: object) -> str:
    return (thing.__doc__ or "").strip().split("\n", 1)[0].rstrip(".")
