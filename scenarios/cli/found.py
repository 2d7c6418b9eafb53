"""Commands by entry point, imported when one is given: those of the floors above the core, and of other packages.

[project.entry-points."surefoot.commands"]
survey = "my_package.commands:survey"    # a function as Typer takes it, or an app of Typer with several
"""

from collections.abc import Callable, Iterator, Mapping, MutableMapping
from functools import partial
from typing import TYPE_CHECKING, Any, NoReturn, cast

import typer
from typer._click.exceptions import UsageError
from typer.core import TyperCommand, TyperGroup
from typer.main import get_group

from surefoot.errors import PluginError
from surefoot.parts.guard import Guard
from surefoot.parts.plugins import OWN_PACKAGE, Registry
from surefoot.scenarios.cli.words import Commands
from surefoot.scenarios.errors import LinkError, LogError, ScenarioError

if TYPE_CHECKING:
    from typer._click.core import Command, Context

MEANT = (typer.TyperException, typer.Exit, typer.Abort, ScenarioError, LinkError, LogError)
"""Errors by which a command of another package may end, as one of Surefoot's own does."""


class CommandTable(Mapping[str, "Command"]):
    """Commands by name: the core's, then those that are found, each of which is made when it is first looked up.

    A found command whose package cannot be used is one that says so.

    Args:
        own: commands of the core, whose names always mean them.

    Attributes:
        registry: all of them, with the packages that bring them.
    """

    def __init__(self, own: Mapping[str, "Command"]) -> None:
        self.registry: Registry[Callable[..., Any]] = Registry("surefoot.commands", None, own)
        self._made = dict(own)

    def __getitem__(self, name: str) -> "Command":
        """The command of that name.

        Raises:
            KeyError: there is none.
        """
        if name not in self._made:
            try:
                self._made[name] = _made(name, self.registry[name], self.registry.guard(name))
            except PluginError as refusal:
                self._made[name] = _refused(name, refusal)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.registry)

    def __len__(self) -> int:
        return len(self.registry)

    def __contains__(self, name: object) -> bool:
        return name in self.registry


class AllCommands(Commands):
    """The group of all commands, also of those that are found."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.table = CommandTable(self.commands)
        self.commands = cast("MutableMapping[str, Command]", self.table)

    def resolve_command(self, ctx: "Context", args: list[str]) -> "tuple[str | None, Command | None, list[str]]":
        """Find the command of the words."""
        try:
            return super().resolve_command(ctx, args)
        except UsageError as error:
            registry = self.table.registry
            if OWN_PACKAGE not in map(registry.package, registry.others()):
                error.message = f"{error.message.rstrip('.')}, and surefoot is installed without all of its commands"
            raise

    def list_commands(self, ctx: "Context") -> list[str]:
        """Names of all commands, of which none is imported for that."""
        return list(self.table)


def _made(name: str, thing: Callable[..., Any], guard: Guard) -> "Command":
    """The command that a function or an app of Typer is."""
    root = typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False)
    with guard:
        if isinstance(thing, typer.Typer):
            root.add_typer(thing, name=name, cls=Commands)
        else:
            root.command(name)(thing)
        command = get_group(root).commands[name]
    _stand_around(command, Guard(guard.who, MEANT))
    return command


def _stand_around(command: "Command", guard: Guard) -> None:
    """Put a guard around what a command does, and around all commands of a group."""
    if isinstance(command, TyperGroup):
        for one in command.commands.values():
            _stand_around(one, guard)
    if command.callback is not None:
        command.callback = guard.function(command.callback)


def _refused(name: str, refusal: PluginError) -> "Command":
    """A command that says why it cannot be used, whatever its words are."""

    def refuse(refusal: PluginError, **_: Any) -> NoReturn:
        raise refusal

    taken = {"ignore_unknown_options": True, "allow_extra_args": True}
    return TyperCommand(
        name, callback=partial(refuse, refusal), help=f"Cannot be used: {refusal}", context_settings=taken,
        add_help_option=False, rich_markup_mode=None,
    )  # fmt: skip
