"""The terminal's side of the command line: words that make no command, and output that nobody takes."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from typer._click.exceptions import NoArgsIsHelpError, NoSuchOption, UsageError
from typer.core import TyperGroup

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.output import reason
from surefoot.scenarios.show.options import keys_from

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer
    from typer._click.core import Context

BAD_INPUT, UNREAD = 2, 141


@contextmanager
def _one_sentence() -> Iterator[None]:
    """Say what is wrong with the words of a command as of any other bad input: what, where, and what would be right."""
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


class Commands(TyperGroup):
    """All commands."""

    def parse_args(self, ctx: "Context", args: list[str]) -> list[str]:
        """Find the command."""
        with _one_sentence():
            return super().parse_args(ctx, args)

    def invoke(self, ctx: "Context") -> Any:
        """Give it its words and run it."""
        with _one_sentence():
            return super().invoke(ctx)


class _Stream(io.FileIO):
    """Standard output or error, whose end ends the program and is no defect: a pipe is closed, a disk is full."""

    ended = False

    def write(self, data: "ReadableBuffer") -> int:
        """Write, unless there is no use in it any more."""
        size = memoryview(data).nbytes
        if self.ended:
            return size
        try:
            return super().write(data) or 0
        except OSError as error:
            self.ended = True
            if isinstance(error, BrokenPipeError):
                raise SystemExit(UNREAD) from None
            if self.fileno() == 1:
                typer.echo(f"standard output: cannot be written, {reason(error)}; give it more room", err=True)
            raise SystemExit(BAD_INPUT) from None


def set_up_streams() -> None:
    """Set up standard output and error; a name that is no text is shown escaped."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by whoever has started the program
            setattr(sys, name, Path(os.devnull).open("w"))  # noqa: SIM115  as long as the program
        elif stream is getattr(sys, f"__{name}__") and isinstance(stream, io.TextIOWrapper):
            stream.flush()
            raw = io.BufferedWriter(_Stream(stream.fileno(), "w", closefd=False))
            on_screen = name == "stderr" or stream.isatty()
            safe = io.TextIOWrapper(raw, stream.encoding, "backslashreplace", line_buffering=on_screen)
            setattr(sys, name, safe)
