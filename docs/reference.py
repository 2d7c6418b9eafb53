"""Write the tables and numbers of the documentation that follow from the code.

    python docs/reference.py

Each table stands between two comment lines, `<!-- table: name -->` and `<!-- end -->`; each number within a line of any
page between `<!-- value: name -->` and `<!-- end -->`.
"""

import csv
import inspect
import json
import math
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, get_args, get_origin

import yaml
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from surefoot.models.robot_file.schema import RobotFile
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.rules import RULES, Rule, rule_name
from surefoot.scenarios import catalogue
from surefoot.scenarios.check.signs import SIGNS
from surefoot.scenarios.file.gait import CommandSettings, FootstepSettings, PlaceSettings, VelocitySettings
from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.file.schema import (
    Fault,
    GroundError,
    InstrumentFault,
    InstrumentSettings,
    PushSettings,
    Scenario,
    own_keys,
)
from surefoot.scenarios.file.sensing import SENSOR_KEYS, Sensing
from surefoot.scenarios.file.units import unit_of
from surefoot.scenarios.judge.metric import LITTLE, SHARE, Metric
from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.log.spec import ChannelSpec
from surefoot.scenarios.log.writer import CHUNK_PERIOD_NS
from surefoot.scenarios.policy.contract import Contract, Recurrent, Term
from surefoot.scenarios.policy.terms import OWN as TERMS
from surefoot.scenarios.policy.terms import meaning
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.run.instruments import channel
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.sensor_errors import PRESETS, SensorErrors
from surefoot.studies.tour.page import markdown

sys.path.insert(0, str(Path(__file__).parent))
import asked
import elements
import handed
import result_tables
import standing
from page_table import table

FOLDER = Path(__file__).parent

CHANNELS = (
    *(
        channels.measurement,
        channels.readings,
        channels.truth,
        channels.point_truth,
        channels.estimate,
        channels.contact,
        channels.felt_contact,
        channels.gait,
    ),
    *(
        channels.planner_state,
        channels.reference,
        channels.plan,
        channels.footsteps,
        channels.footstep,
        channels.wbc,
        channels.torque,
    ),
    channels.command,
    channels.coupling,
    channels.link,
    channels.shadow,
    channels.timing,
    channels.process,
)
SIZES = Sizes(nj=1009, nq=1013, nv=1019, horizon=1031, nf=1021)
_SYMBOLS = {1009: "nj", 1013: "nq", 1019: "nv", 1021: "nf", 1031: "N", 1032: "N+1"}
_LISTS: dict[str, type[BaseModel]] = {
    "pushes": PushSettings,
    "faults": Fault,
    "gait.velocity": VelocitySettings,
    "gait.footsteps": FootstepSettings,
    "gait.waypoints": PlaceSettings,
    "commands": CommandSettings,
    "instruments": InstrumentSettings,
    "instruments[].faults": InstrumentFault,
    "errors.ground": GroundError,
    "observations": Term,
    "recurrent": Recurrent,
}


def keys_table() -> str:
    """Every key of a scenario with its default and meaning."""
    return table(("key", "default", "meaning"), _key_rows("", Scenario))


def robot_keys_table() -> str:
    """Every key of a robot file with its meaning."""
    return table(("key", "default", "meaning"), _key_rows("", RobotFile))


def channels_table() -> str:
    """Every channel with its fields, shapes, units and frames."""
    walk = Walk(Scenario())
    instruments = (channel(INSTRUMENTS[name], walk, name) for name in INSTRUMENTS.said)
    return "\n\n".join(_channel(spec) for spec in (*(make(SIZES) for make in CHANNELS), *instruments))


def metrics_table() -> str:
    """Every metric with its meaning."""
    rows = (
        [f"`{name}`", metric.shown, "" if metric.body else "yes", tolerance(metric), metric.meaning]
        for name, metric in OWN.items()
    )
    return table(("metric", "shown in", "pendulum", "tolerance", "meaning"), rows)


def tolerance(metric: Metric[Any]) -> str:
    """Tolerance of a metric in `surefoot check`, in the unit in which it is shown and of its value."""
    if not metric.repeatable:
        return "not compared"
    counts = metric.tolerance is None and metric.kind in ("bool", "int")
    little, share = (0.0, 0.0) if counts else metric.tolerance or (LITTLE.get(metric.unit, 0.0), SHARE)
    unit = "%" if metric.shown.startswith("%") else metric.shown
    parts = [f"{little * metric.scale:.3g} {unit}".strip() if little else ""]
    parts.append(f"{100.0 * share:g} % of it" if share else "")
    return " + ".join(part for part in parts if part) or "none"


def signs_table() -> str:
    """Table of what `surefoot check` compares stage by stage, and by how much it may differ."""
    rows = []
    for sign in SIGNS:
        what = sign.words.format(stage="", label="the stage", foot="swing").replace(" of the stage", "").strip()
        little, share = sign.tolerance
        allowed = f"{sign.scale * little:.3g} {sign.unit}".strip() + (f" + {100 * share:g} %" if share else "")
        above = " above the greatest of all stages" if sign.peak else ""
        rows.append([what, ", ".join(f"`{name}`" for name in sign.columns), f"{allowed}{above}"])
    return table(("from lift-off to lift-off", "columns", "may differ by"), rows)


def profiles_table() -> str:
    """The formulations of the planner, with their numbers."""
    heads = ("profile", "what it is", "N_p", "moves", "jerk [m/s³]", "its change per sample [m/s³]")
    return table(heads, map(_profile, PROFILES.values()))


def _profile(profile: Profile) -> list[str]:
    numbers = profile.parameters
    moves = str(len(numbers.moves)) if profile.moves else ""
    change = "any" if math.isinf(numbers.jerk_rate_limit) else f"{numbers.jerk_rate_limit:g}"
    return [f"`{profile.name}`", profile.doc, str(numbers.horizon), moves, f"{numbers.jerk_limit:g}", change]


def rules_table() -> str:
    """The planner's rules of recovery, in their order."""
    return table(("rule", "what it does"), ([f"`{rule_name(rule)}`", first_line(rule)] for rule in RULES))


RULES_CAMPAIGN = FOLDER / "campaigns" / "rules.yaml"


def with_rules(text: str, rules: Sequence[Rule] = RULES) -> str:
    """The campaign that leaves out one rule at a time, with a line for each of them."""
    lines = [f"    rule {rule_name(rule)}: {{planner.without: [{rule_name(rule)}]}}\n" for rule in rules]
    return re.sub(r"(?m)(^    rule \w+: .*\n)+", "".join(lines), text)


def first_line(thing: object) -> str:
    """First line of a docstring."""
    return (inspect.getdoc(thing) or "").splitlines()[0]


def sensors_table() -> str:
    """Every term of the sensors, in each preset."""
    rows = []
    for name in SENSOR_KEYS:
        field = Sensing.model_fields[name]
        said = [_of_preset(name, errors) for errors in PRESETS.values()]
        if any(said):
            rows.append([f"`{name}`", unit_of(field.annotation, field.metadata) or "-", *said])
    return table(["key", "unit", *(f"`{name}`" for name in PRESETS)], rows)


def _of_preset(name: str, errors: SensorErrors) -> str:
    """Value of a preset for a key, as it is read; empty where the key is no term of it."""
    group, _, term = name.partition("_")
    delivery = {"encoder": errors.joints, "imu": errors.imu, "wrench": errors.feet}.get(group)
    if name == "wrench":
        return "feet" if errors.wrench_sensors else "none"
    value = getattr(errors, name, getattr(delivery, term, None))
    if value is None or isinstance(value, bool):
        return "" if value is None else str(value).lower()
    return "none" if value == math.inf else f"{value:.3g}"


def sensed_table() -> str:
    """Table of what `benchmarks.sensed` measured: errors of the estimator, and their squares over its own variances."""
    with (FOLDER / "sensors.csv").open() as file:
        found = list(csv.DictReader(file))
    rows = ([f"`{row['preset']}`", row["quantity"], f"{row['error_rms']} {row['unit']}", row["nees"]] for row in found)
    return table(("preset", "quantity", f"error, RMS of a number over {found[0]['seeds']} seeds", "NEES"), rows)


def field_table() -> str:
    """Table of what others have reached, with its sources."""
    quoted = yaml.safe_load((FOLDER / "field.yaml").read_text(encoding="utf-8"))
    columns = ("what", "value", "who", "evidence", "source")
    return table(columns, ([str(row[column]) for column in columns] for row in quoted))


def engines_table() -> str:
    """The walks in two simulators, as `examples/other_simulator/compare.py` has written them down."""
    with (FOLDER / "other-simulator.csv").open(encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    shown = [OWN[name] for name in names[4:]]
    heads = [*names[:4], *(f"`{name}` [{metric.shown}]" for name, metric in zip(names[4:], shown, strict=True))]
    lines = [[*row[:4], *(f"{float(v) * m.scale:.3g}" for v, m in zip(row[4:], shown, strict=True))] for row in rows]
    return table(heads, lines)


def benchmark_tables() -> str:
    """Tables of the tour of a public benchmark, from the result that is kept beside the page."""
    return markdown(json.loads((FOLDER / "benchmark-g1.json").read_text(encoding="utf-8")))


def policy_keys_table() -> str:
    """Every key of a policy's contract with its default and meaning."""
    return table(("key", "default", "meaning"), _key_rows("", Contract))


def policy_terms_table() -> str:
    """Every observation term with its meaning."""
    return table(("term", "what it tells, how many numbers [unit]"), ([f"`{name}`", meaning(name)] for name in TERMS))


CATALOGUE = (
    ("meets every criterion", "met"),
    ("goes to the end, misses a criterion", "missed"),
    ("falls", "fell"),
    ("refused before it runs", "refused"),
)
"""Outcomes of a scenario: in words, and as docs/catalogue.yaml has it."""


def walked() -> Any:
    """Results of the robots that come along on the catalogue, as `docs/catalogue.py` has measured them."""
    return yaml.safe_load((FOLDER / "catalogue.yaml").read_text(encoding="utf-8"))


def catalogue_table() -> str:
    """Table of how many scenarios each robot walks, and the names of those that it does not."""
    heads = ["robot", *(words for words, _ in CATALOGUE), "not met"]
    return table(heads, (_walked_row(name, found) for name, found in walked().items()))


def _walked_row(name: str, found: Any) -> list[str]:
    lacks = ", ".join(f"`{one}`" for kind in ("missed", "fell", "refused") for one in found[kind])
    return [f"`{name}`", *(str(len(found[kind])) for _, kind in CATALOGUE), lacks]


TABLES: dict[str, tuple[str, Callable[[], str]]] = {
    "catalogue": ("robots.md", catalogue_table),
    "keys": ("scenarios.md", keys_table),
    "profiles": ("profiles.md", profiles_table),
    "signs": ("checking.md", signs_table),
    "metrics": ("scenarios.md", metrics_table),
    "channels": ("log.md", channels_table),
    "robot-keys": ("robot-files.md", robot_keys_table),
    "mjcf-elements": ("robot-files.md", elements.mjcf_table),
    "urdf-elements": ("robot-files.md", elements.urdf_table),
    "recovery-rules": ("recovery.md", rules_table),
    "sensors": ("sensors.md", sensors_table),
    "sensed": ("sensors.md", sensed_table),
    "policy-keys": ("policies.md", policy_keys_table),
    "policy-terms": ("policies.md", policy_terms_table),
    "standing": ("standing.md", standing.table),
    "field": ("standing.md", field_table),
    "engines": ("other-simulator.md", engines_table),
    "benchmark-g1": ("benchmark-g1.md", benchmark_tables),
    "handed": ("extending.md", handed.tables),
    **result_tables.TABLES,
    **asked.TABLES,
}


_LIMITS = json.loads((FOLDER.parent / "benchmarks" / "limits.json").read_text(encoding="utf-8"))
_COMMANDS = {"help": "--help", "list": "list", "show": "show walk", "schema": "schema", "run": "run diagonal-walk"}


VALUES: dict[str, str] = {
    "chunk": f"{CHUNK_PERIOD_NS / 1e6:g} ms",
    "scenarios": str(len(catalogue.OWN)),
    "models": result_tables.models_held(),
    "knees": f"{standing.measured('walk-level', 'knee_angle_mean'):.0f}",
    "calls": str(_LIMITS["diagonal-walk"]["calls of a tick without a plan"]),
    "calls_plan": str(_LIMITS["diagonal-walk"]["calls of a tick with a plan"]),
    **{
        f"modules_{word}": str(_LIMITS["surefoot's modules that a command imports"][command])
        for word, command in _COMMANDS.items()
    },
}


def pages() -> list[Path]:
    """Every page that may have such a number."""
    return [FOLDER.parent / "README.md", *sorted(FOLDER.glob("*.md"))]


def with_values(text: str) -> str:
    """The text of a page with its numbers written anew."""
    place = r"(<!-- value: (\w+) -->).*?(<!-- end -->)"
    return re.sub(place, lambda found: f"{found[1]}{VALUES[found[2]]}{found[3]}", text)


def updated(text: str, name: str, table: str) -> str:
    """The text of a page with one of its tables written anew."""
    begin, end = f"<!-- table: {name} -->\n", "<!-- end -->"
    return re.sub(f"(?s){re.escape(begin)}.*?{re.escape(end)}", lambda _: f"{begin}{table}\n{end}", text)


def main() -> None:
    """Update all tables and numbers."""
    for name, (page, make) in TABLES.items():
        path = FOLDER / page
        path.write_text(updated(path.read_text(encoding="utf-8"), name, make()), encoding="utf-8")
    for path in pages():
        path.write_text(with_values(path.read_text(encoding="utf-8")), encoding="utf-8")
    RULES_CAMPAIGN.write_text(with_rules(RULES_CAMPAIGN.read_text(encoding="utf-8")), encoding="utf-8")


def _key_rows(prefix: str, group: type[BaseModel]) -> list[list[str]]:
    """Rows of a group's keys."""
    return [_key_row(name, field) for name, field in every_key(group, prefix)]


def every_key(group: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, FieldInfo]]:
    """Keys by name; a group inside is followed key by key, and a list of groups by those of an element."""
    for name, field in (*group.model_fields.items(), *own_keys(group)):
        element = _LISTS.get(prefix + name)
        inner = element or _group_of(field.annotation)
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            yield from every_key(inner, f"{prefix}{name}{'[]' if element else ''}.")
        else:
            yield prefix + name, field


def _group_of(annotation: Any) -> Any:
    """The group that may stand in a key, also where null may; a mapping of names to groups is no group."""
    if get_origin(annotation) is dict:
        return annotation
    models = [a for a in get_args(annotation) if isinstance(a, type) and issubclass(a, BaseModel)]
    return models[0] if models else annotation


def _key_row(name: str, field: FieldInfo) -> list[str]:
    default = default_of(field)
    unit = unit_of(field.annotation, field.metadata)
    meaning = (field.description or "").replace("|", "/") + (f" [{unit}]" if unit else "")
    return [f"`{name}`", default, meaning]


def default_of(field: FieldInfo) -> str:
    """Default of a key, as it is read."""
    return "required" if field.is_required() else _default(field.get_default(call_default_factory=True))


def _default(value: Any) -> str:
    if isinstance(value, dict):
        return "no fall, every step, 1 s of standing" if value else "none"
    if value is None:
        return "`null`"
    if isinstance(value, tuple):
        return f"`{list(value)}`"
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _channel(spec: ChannelSpec) -> str:
    rows = []
    for field in spec.fields:
        shape = " x ".join(str(_SYMBOLS.get(size, size)) for size in field.shape) or "1"
        rows.append([f"`{field.name}`", shape, field.unit, field.frame, field.doc])
    fields = table(("field", "shape", "unit", "frame", "meaning"), rows)
    return "\n".join([f"### `{spec.topic}` ({spec.message})", "", spec.doc, "", fields])


if __name__ == "__main__":
    main()
