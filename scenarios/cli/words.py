"""The words of a command line: which command they name, and what its parameters are given."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from typer._click.exceptions import NoArgsIsHelpError, NoSuchOption, UsageError
from typer._coercion import RuntimeParam, build_runtime_param
from typer.core import TyperGroup, _TyperParameter

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.show.options import keys_from

if TYPE_CHECKING:
    from typer._click.core import Command, Context


@contextmanager
def _one_sentence() -> Iterator[None]:
    """Report bad words of a command as any other bad input: what, where, and what would be right."""
    try:
        yield
    except NoArgsIsHelpError:
        raise
    except UsageError as error:
        path = error.ctx.command_path if error.ctx else "surefoot"
        what = error.format_message().rstrip(".")
        right = f"`{path} -h` tells what there is"
        if isinstance(error, NoSuchOption) and path.endswith(" run"):
            key = error.option_name.lstrip("-").replace("-", "_")
            right = f"a key of the scenario is given as --set {key}=VALUE" if key in keys_from(key) else right
        raise ScenarioError([f"{path}: {what[:1].lower()}{what[1:]}; {right}"]) from None


class _OnDemand(RuntimeParam):
    """Typer's own coercion, for which pydantic is imported where a value needs it: plain text and no value do not."""

    def coerce(self, value: Any, param: _TyperParameter, ctx: "Context") -> Any:
        """The value of a parameter."""
        several = param.multiple or param.nargs == -1
        if value is None:
            return () if several else None
        if self.annotation is str and isinstance(value, str) and value.isascii() and not several:
            return value
        return self._coerce_value(value, param, ctx)

    def _coerce_value(self, value: Any, param: _TyperParameter, ctx: "Context") -> Any:
        return build_runtime_param(param.type_descriptor).coerce(value, param, ctx)


class Commands(TyperGroup):
    """All commands."""

    def get_params(self, ctx: "Context") -> list[Any]:
        """The options before a command."""
        return _on_demand(super().get_params(ctx))

    def get_command(self, ctx: "Context", cmd_name: str) -> "Command | None":
        """The command of that name, if there is one."""
        found = super().get_command(ctx, cmd_name)
        if found is not None:
            _on_demand(found.get_params(ctx))
        return found

    def parse_args(self, ctx: "Context", args: list[str]) -> list[str]:
        """Find the command."""
        with _one_sentence():
            return super().parse_args(ctx, args)

    def invoke(self, ctx: "Context") -> Any:
        """Give it its words and run it."""
        with _one_sentence():
            return super().invoke(ctx)


def _on_demand(parameters: list[Any]) -> list[Any]:
    """The same parameters, none of which imports pydantic before a value needs it."""
    for parameter in parameters:
        if isinstance(parameter, _TyperParameter) and parameter._runtime_param is None:
            described = parameter.type_descriptor
            parameter._runtime_param = _OnDemand(described.parameter_info, described.annotation)
    return parameters
