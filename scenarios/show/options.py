"""Options that commands share, what a shell completes of them, and commands whose options are one value."""

import inspect
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_args, get_origin

import typer

if TYPE_CHECKING:
    from pydantic import BaseModel

T = TypeVar("T")

MISSED, INTERRUPTED = 1, 130
"""Exit codes: criteria were missed; the user stopped it."""

_FARTHEST = 1e9


def _finite(value: float | None) -> float | None:
    """Refuse what is no time of a log."""
    if value is not None and not abs(value) <= _FARTHEST:
        raise typer.BadParameter(f"{value} is no time of a log; give seconds, such as 2.5")
    return value


def scenarios_from(incomplete: str) -> list[str]:
    """Catalogue names that begin so; where there is none, shells go on to complete file names."""
    from surefoot.scenarios import catalogue

    return [name for name in catalogue.names() if name.startswith(incomplete)]


def keys_from(incomplete: str) -> list[str]:
    """Keys of scenarios that begin so."""
    from surefoot.scenarios.file.schema import Scenario

    return [key for key, _ in keys(Scenario) if key.startswith(incomplete)]


def keys(group: "type[BaseModel]", prefix: str = "") -> Iterator[tuple[str, str]]:
    """Every key of a group by its dotted name with its meaning, groups before what is in them."""
    from surefoot.scenarios.file.group import groups_in
    from surefoot.scenarios.file.schema import own_keys

    for name, field in (*group.model_fields.items(), *own_keys(group)):
        yield prefix + name, field.description or ""
        parts = get_args(field.annotation) or (field.annotation,)
        for inner in (group for part in parts if get_origin(part) is not dict for group in groups_in(part)):
            yield from keys(inner, f"{prefix}{name}.")


def _settings_from(incomplete: str) -> list[str]:
    """Keys that begin so, each as the beginning of a setting."""
    return [f"{key}=" for key in keys_from(incomplete)]


def settings(what: str) -> Any:
    """An option that sets keys; what it does to a key."""
    return typer.Option("--set", metavar="KEY=VALUE", help=f"{what}; repeatable.", autocompletion=_settings_from)


def overrides(set_: list[str] | None, seed: int | None = None, policy: str | None = None) -> list[str]:
    """Settings of keys by ``--policy``, ``--set`` and ``--seed``."""
    return [*seat(policy), *(set_ or ()), *([] if seed is None else [f"seed={seed}"])]


def seat(policy: str | None) -> list[str]:
    """Setting by ``--policy``: the file or folder of a policy, or the name of a controller, that gets the seat."""
    if policy is None:
        return []
    if not Path(policy).exists():
        from surefoot.scenarios.file.registries import CONTROLLERS

        if policy in CONTROLLERS.others():
            return [f"controller.name={json.dumps(policy)}"]
    return [f"controller.policy={json.dumps(policy)}"]


From = Annotated[float | None, typer.Option("--from", metavar="T", help="From this time on [s].", callback=_finite)]
To = Annotated[float | None, typer.Option("--to", metavar="T", help="Up to this time [s].", callback=_finite)]
Replace = Annotated[bool, typer.Option("--force", "-f", help="Replace the file if it exists.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Settings = Annotated[list[str] | None, settings("Set a key")]
Seed = Annotated[int | None, typer.Option(min=0, help="Seed, over that of the scenario.")]
SeatOf = Annotated[
    str | None,
    typer.Option(
        "--policy",
        metavar="FILE",
        help="Contract or folder of a policy, in place of planner and whole-body controller.",
    ),
]
Jobs = Annotated[int | None, typer.Option(min=1, help="Runs at once; as many as cores by default.")]
Cluster = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="Run on the cluster of this dask scheduler instead.")
]
LogFile = Annotated[Path, typer.Argument(help="A log, also a truncated one.")]


def with_options(kind: Callable[..., T]) -> Callable[[Callable[[T], None]], Callable[..., None]]:
    """Make a command of a function of a dataclass, whose fields are annotated as parameters of commands are."""

    def decorate(act: Callable[[T], None]) -> Callable[..., None]:
        def command(**given: Any) -> None:
            act(kind(**given))

        command.__name__, command.__doc__ = act.__name__, act.__doc__
        command.__signature__ = inspect.signature(kind)  # type: ignore[attr-defined]
        return command

    return decorate
