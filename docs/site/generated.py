"""Pages of the site that follow from the code: keys, metrics, channels, commands, errors, and the interface in Python.

`pages` gives their Markdown by path; `build.py` puts them into the site. None of them is a file of the repository: the
tables on docs/scenarios.md and docs/log.md are the same facts for who reads them there.
"""

import importlib
import importlib.util
import inspect
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import typer
from pydantic.fields import FieldInfo

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.units import unit_of
from surefoot.scenarios.judge.metric import Metric
from surefoot.scenarios.judge.metrics import OWN

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent

FACES = ("surefoot", "surefoot.planner", "surefoot.wbc", "surefoot.sim", "surefoot.models")
"""Packages whose public names have a page."""


@lru_cache(maxsize=1)
def reference() -> Any:
    """The module docs/reference.py, which makes the tables."""
    spec = importlib.util.spec_from_file_location("reference", DOCS / "reference.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pages() -> dict[str, str]:
    """Markdown of every generated page by its path in the site."""
    made = {
        "reference/keys.md": keys_page(),
        "reference/metrics.md": metrics_page(),
        "reference/channels.md": channels_page(),
        "reference/commands.md": commands_page(),
        "reference/errors.md": errors_page(),
        "examples.md": examples_page(),
    }
    made |= {f"reference/{face.rpartition('.')[2]}.md": interface_page(face) for face in FACES}
    return made


def heading(level: int, name: str, suffix: str = "") -> str:
    """A heading, whose anchor on the page is the name with dashes."""
    return f"{'#' * level} `{name}`{suffix}"


def keys_page() -> str:
    """Every key of a scenario with a heading of its own."""
    lines = ["# Keys of a scenario", "", "Every key with its default, its unit and what it takes. A key of a list has"]
    lines += ["`[]` behind the list's name. [Scenarios](../scenarios.md) says how they go together.", ""]
    group = None
    for name, field in sorted(reference().every_key(Scenario), key=lambda one: "." in one[0]):
        first = re.split(r"\[|\.", name)[0] if "." in name else "One value each"
        if first != group:
            lines += [f"## {first}" if first[0].isupper() else heading(2, first), ""]
        group = first
        lines += [heading(3, name), "", *_key(field), ""]
    return "\n".join(lines)


def _key(field: FieldInfo) -> list[str]:
    unit = unit_of(field.annotation, field.metadata)
    facts = [f"Default {reference().default_of(field)}".replace("Default required", "Required")]
    facts += [f"in {unit}"] if unit and unit != "-" else []
    facts += _range(field)
    meaning = field.description or ""
    return [f"{meaning[:1].upper()}{meaning[1:]}.", "", f"{', '.join(facts)}."]


_SIGNS = {"gt": ">", "ge": "at least", "lt": "<", "le": "at most", "min_length": "length at least"}


def _range(field: FieldInfo) -> list[str]:
    """Range of a value."""
    annotation = field.annotation
    choices = [a for part in (annotation, *get_args(annotation)) if get_origin(part) is Literal for a in get_args(part)]
    if choices:
        return [f"one of {', '.join(f'`{choice}`' for choice in dict.fromkeys(choices))}"]
    bounds = (getattr(one, "metadata", [one]) for part in (field, *get_args(annotation)) for one in _metadata(part))
    found = [
        f"{sign} {getattr(one, name):g}"
        for several in bounds
        for one in several
        for name, sign in _SIGNS.items()
        if isinstance(getattr(one, name, None), int | float)
    ]
    return list(dict.fromkeys(found))


def _metadata(part: Any) -> list[Any]:
    return list(getattr(part, "metadata", None) or getattr(part, "__metadata__", ()))


def metrics_page() -> str:
    """Every metric with a heading of its own."""
    lines = ["# Metrics", "", "What a run is measured by, in SI units; each is a pure function of the log. A criterion"]
    lines += ["bounds one of them. [Scenarios](../scenarios.md#metrics) has them as one table.", ""]
    for name, metric in sorted(OWN.items()):
        lines += [heading(2, name), "", *_metric(metric), ""]
    return "\n".join(lines)


def _metric(metric: Metric[Any]) -> list[str]:
    facts = [f"Shown in {metric.shown}"] if metric.shown.strip("-") else ["Without a unit"]
    facts += [] if metric.body else ["also of a pendulum"]
    facts += [f"tolerance of `surefoot check`: {reference().tolerance(metric)}"]
    meaning = metric.meaning
    return [f"{meaning[:1].upper()}{meaning[1:]}.", "", f"{', '.join(facts)}."]


def channels_page() -> str:
    """Every channel of a log."""
    text = re.sub(
        r"(?m)^### `(\S+)` \((\w+)\)$", lambda m: heading(2, m[1], f" ({m[2]})"), reference().channels_table()
    )
    head = "# Channels of a log\n\nWhat a run writes, in SI units. nj is the number of joints, nq is nj + 7, nv is"
    return f"{head} nj + 6; N is the horizon. [The log](../log.md) says at which rates.\n\n{text}\n"


def commands_page() -> str:
    """Every command with what it takes."""
    root = typer.main.get_command(app)
    lines = ["# Commands", "", "Every command with its arguments and options, as `-h` tells them.", ""]
    lines += ["[How a command ends](../log.md#how-a-command-ends) has the exit codes.", ""]
    return "\n".join([*lines, *_commands("surefoot", root)])


def _commands(path: str, group: Any) -> Iterator[str]:
    for name, command in sorted(group.commands.items()):
        if hasattr(command, "commands"):
            yield from _commands(f"{path} {name}", command)
            continue
        yield from (heading(2, f"{path} {name}"), "", inspect.cleandoc(command.help or ""), "")
        if command.params:
            yield from ("| | takes | default | meaning |", "|---|---|---|---|", *map(_option, command.params), "")


def _option(parameter: Any) -> str:
    names = [parameter.name.upper()] if parameter.param_type_name == "argument" else parameter.opts
    default = "" if parameter.default in (None, False, ()) or callable(parameter.default) else f"`{parameter.default}`"
    kind = "" if getattr(parameter, "is_flag", False) else parameter.metavar or _taken(parameter)
    meaning = (getattr(parameter, "help", "") or "").replace("|", "/")
    needed = "required" if parameter.required else default
    return f"| {', '.join(f'`{name}`' for name in names)} | {kind} | {needed} | {meaning} |"


def _taken(parameter: Any) -> str:
    """The type of a value in one word; a list's is that of its elements."""
    annotation = parameter.type_descriptor.annotation
    inner = get_args(annotation) or (annotation,)
    return {"str": "text", "Path": "path", "int": "number", "float": "number"}.get(inner[0].__name__, inner[0].__name__)


ERRORS = (
    *("surefoot.ScenarioError", "surefoot.SetupError", "surefoot.LogError", "surefoot.ParameterError"),
    *("surefoot.PluginError", "surefoot.PartError", "surefoot.models.RobotError", "surefoot.models.UnknownRobotError"),
    *("surefoot.sim.WorldError", "surefoot.sim.SimulationDiverged"),
)
"""Errors that the interface raises on purpose."""


def errors_page() -> str:
    """Errors that a user can mend, and exit codes."""
    lines = [
        "# Errors",
        "",
        "Each message says what is wrong, where, and what would be right. A command prints it on one line",
    ]
    lines += ["and ends with the [exit code](../log.md#how-a-command-ends) 2. In Python these are raised.", ""]
    return "\n".join([*lines, *(_documented(name) for name in ERRORS)])


def interface_page(face: str) -> str:
    """The public names of a package."""
    module = importlib.import_module(face)
    names = sorted(name for name in module.__all__ if f"{face}.{name}" not in ERRORS and not name.startswith("__"))
    head = f"# {face}\n\n```{{eval-rst}}\n.. automodule:: {face}\n   :no-members:\n```\n"
    return "\n".join([head, *(_entry(face, name) for name in names)])


def _entry(face: str, name: str) -> str:
    """A public name: what it is, or where that stands when a layer has it too."""
    thing = getattr(importlib.import_module(face), name)
    others = (layer for layer in FACES if layer != face and layer.startswith(f"{face}."))
    owner = next((layer for layer in others if getattr(importlib.import_module(layer), name, None) is thing), None)
    if owner is None:
        return _documented(f"{face}.{name}")
    return f"## {name}\n\nIt is [{owner}.{name}]({owner.rpartition('.')[2]}.md#{name.lower()}).\n"


def _documented(name: str) -> str:
    """A name with what its docstring says."""
    face, _, last = name.rpartition(".")
    thing = getattr(importlib.import_module(face), last)
    kind = "autoexception" if inspect.isclass(thing) and issubclass(thing, Exception) else "autoclass"
    if not inspect.isclass(thing):
        kind = "autofunction" if inspect.isfunction(thing) else "autodata"
    more = "   :no-value:\n" if kind == "autodata" else ""
    return f"## {last}\n\n```{{eval-rst}}\n.. {kind}:: {name}\n{more}```\n"


def examples_page() -> str:
    """The short programs of examples/, each as it stands."""
    lines = ["# Examples", "", "Short programs that the tests run. Copy one and change it."]
    for path in sorted((ROOT / "examples").glob("*.py")):
        text = path.read_text(encoding="utf-8")
        lines += ["", heading(2, path.name), "", "```python", text.rstrip(), "```"]
    return "\n".join([*lines, ""])
