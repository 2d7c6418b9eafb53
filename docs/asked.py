"""Tables of what tests and campaigns ask the robot for, from the tests and campaigns themselves."""

import importlib.util
from collections.abc import Iterator
from functools import lru_cache
from math import prod
from pathlib import Path
from types import ModuleType
from typing import Any

import yaml
from page_table import table

from surefoot.studies.campaigns.spec import with_unit

ROOT = Path(__file__).parents[1]
RUNS = ROOT / "tests" / "scenarios" / "run"

WALKS = {
    "stairs-up": "`stairs-up`",
    "stairs-down": "`stairs-down`",
    "blocks": "`blocks`, six steps",
    "slope-up": "`slope`, up",
    "slope-down": "`slope`, down",
    "turn": "`walk-turn`",
    "natural": "natural gait",
    "heel-off": "natural gait with `gait.heel_off`",
}
"""In words, by the names of the tests."""


@lru_cache
def tests(name: str) -> ModuleType:
    """A module of tests."""
    spec = importlib.util.spec_from_file_location(name, RUNS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pushes() -> ModuleType:
    """The tests of pushes."""
    return tests("test_push_tables")


def goals() -> dict[str, dict[str, float]]:
    """Goals of the natural gait's pushes by phase and direction [N·s/kg]."""
    module = pushes()
    return {phase: dict(zip(module.DIRECTIONS, most, strict=True)) for phase, most in module.NATURAL_GOALS.items()}


def goals_table() -> str:
    """The largest pushes of both gaits by phase and direction."""
    module = pushes()
    papers = {direction: impulses[-1] for direction, impulses in module.PAPER_IMPULSES.items()}
    rows = [("natural", phase, most) for phase, most in goals().items()]
    rows.append(("paper's", "each of them", papers))
    heads = ("gait", "phase", "forward", "left, to the swing foot", "backward", "right, over the stance foot")
    return table(heads, ([gait, phase, *(f"{one:g}" for one in most.values())] for gait, phase, most in rows))


def elsewhere_table() -> str:
    """Table of pushes that are survived elsewhere than in the third step on flat ground."""
    rows = ([what, f"{impulse:g}", str(runs)] for what, impulse, runs in _elsewhere())
    return table(("pushed", "with, N·s/kg", "runs"), rows)


def _elsewhere() -> Iterator[tuple[str, float, int]]:
    module = pushes()
    (cases,) = (mark for mark in module.test_standing.pytestmark if mark.args and "keys" in mark.args[0])
    for posture, (_, impulse, _) in zip(cases.kwargs["ids"], cases.args[1], strict=True):
        yield f"standing, {posture}, from eight sides", impulse, _count(module.test_standing) // len(cases.args[1])
    twice = module.test_two_pushes_a_step_apart
    yield "two pushes a step apart, in one direction or one after another", module.TWICE, _count(twice)
    (cases,) = (mark for mark in module.test_elsewhere.pytestmark if mark.args and "walk" in mark.args[0])
    each = _count(module.test_elsewhere) // len(cases.args[1])
    for walk, step, impulse in cases.args[1]:
        yield f"{WALKS[walk]}, step {step}", impulse, each


def _count(test: object) -> int:
    """Number of runs of a test."""
    marks = test.pytestmark  # type: ignore[attr-defined]
    return prod(len(list(mark.args[1])) for mark in marks if mark.name == "parametrize")


def largest() -> dict[str, tuple[float, ...]]:
    """Largest pushes of the natural gait in four directions, by when [N·s/kg]."""
    most = [[phase[direction] for direction in ("forward", "backward", "left", "right")] for phase in goals().values()]
    return {
        "in mid-swing": tuple(most[list(goals()).index("SS 0.5")]),
        "at any time": tuple(map(min, zip(*most, strict=True))),
    }


def readme_table() -> str:
    """The largest pushes of the natural gait, and those that are survived from every side."""
    heads = ("push", "forward", "backward", "to the swing foot", "over the stance foot")
    by_side = table(heads, ([when, *(f"{one:g}" for one in most)] for when, most in largest().items()))
    return f"{by_side}\n\n{table(('push', 'any side'), _from_any_side())}"


def _from_any_side() -> Iterator[list[str]]:
    """Rows of pushes that are survived from every side."""
    standing, *_ = (impulse for what, impulse, _ in _elsewhere() if what.startswith("standing"))
    stairs = min(impulse for what, impulse, _ in _elsewhere() if what.startswith("`stairs"))
    yield from (["standing", f"{standing:g}"], ["on stairs", f"{stairs:g}"])


def lasting_table() -> str:
    """Forces that last, and weights that are not believed in."""
    module = tests("test_lasting_forces")
    phases = f"{len(module.FORCES)} directions, {len(module.PHASES)} phases"
    rows = [[gait, f"{force:g} N for {module.LASTING:g} s, in {phases}"] for gait, force in module.HELD.items()]
    scales = f"{min(module.SCALES):g} to {max(module.SCALES):g}"
    rows.append(["`walk` and `diagonal-walk`", f"`errors.mass_scale` {scales}"])
    return table(("walk", "what acts"), rows)


def _campaign(name: str) -> Any:
    path = ROOT / "studies" / "campaigns" / "campaigns" / f"{name}.yaml"
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def drawn_table() -> str:
    """Table of the errors of the campaign `robustness`, and of what it draws for each run."""
    campaign = _campaign("robustness")
    fixed = {key: value for key, value in campaign["set"].items() if key.startswith(("errors", "start", "wbc"))}
    drawn = {key: next(iter(spread.items())) for key, spread in campaign["sample"].items()}
    rows = [[f"`{with_unit(key)}`", f"{value:g}"] for key, value in fixed.items() if isinstance(value, float)]
    for key, (kind, values) in drawn.items():
        text = " to ".join(f"{value:g}" for value in values) if kind == "uniform" else ", ".join(map(str, values))
        rows.append([f"`{with_unit(key)}`", text])
    return table(("key", "value, or drawn from"), rows)


def bounds_table() -> str:
    """Bounds of the catalogue, whose scenarios walk from good sensors, that the campaign `truth` holds more tightly."""
    metrics = {"zmp_inside_fraction": "least", "zmp_error_rms": "most", "com_error_rms": "most"}
    rows = []
    for name, keys in _campaign("truth")["grid"]["walk"].items():
        path = ROOT / "scenarios" / "catalogue" / f"{keys['scenario']}.yaml"
        own = yaml.safe_load(path.read_text(encoding="utf-8"))["criteria"]
        bounds = [_bound(keys, own, metric) for metric in metrics]
        if any(bounds):
            rows.append([f"`{name}`", *bounds])
    return table(("walk", *(f"`{metric}`, at {end}" for metric, end in metrics.items())), rows)


def _bound(keys: dict[str, Any], own: dict[str, Any], metric: str) -> str:
    """A bound with that of the truth, as they are read; empty where they are one."""
    given = keys.get(f"criteria.{metric}")
    if given is None:
        return ""
    (end,) = given
    scale, unit = (1e3, " mm") if metric.endswith("rms") else (1e2, " %")
    wide, narrow = (", ".join(f"{scale * one:g}" for one in _each(bound[end])) for bound in (own[metric], given))
    return f"{wide}{unit} for {narrow}"


def _each(bound: float | list[float]) -> list[float]:
    return bound if isinstance(bound, list) else [bound]


def commanded_table() -> str:
    """Walks on commands that are drawn at random."""
    module = tests("test_commanded_walks")
    rows = []
    for feet, (name, (ahead, aside, turn), _) in module.FEET.items():
        most = f"{ahead:g} m/s, {aside:g} m/s, {turn:g} rad/s"
        rows.append([f"`{name}`", feet, most, f"{module.SEEDS} times {module.MINUTES} minutes"])
    return table(("walk", "feet", "forward, sideways, turn up to", "for"), rows)


TABLES = {
    "robustness-drawn": ("campaigns.md", drawn_table),
    "commanded": ("drive.md", commanded_table),
    "sensors-bounds": ("sensors.md", bounds_table),
    "push-goals": ("recovery-results.md", goals_table),
    "pushes-elsewhere": ("recovery-results.md", elsewhere_table),
    "lasting-forces": ("recovery-results.md", lasting_table),
    "pushes": ("../README.md", readme_table),
}
"""Tables by name: the page, and what makes the table."""
