"""Parameters of a command get what Typer would give them, and pydantic only where it is needed."""

import subprocess
import sys
from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from surefoot.scenarios.cli.words import Commands
from surefoot.scenarios.errors import ScenarioError

pytestmark = pytest.mark.unit


def app(cls):
    """Two commands, of a group of a class; they print what they are given."""
    made = typer.Typer(cls=cls)

    @made.command()
    def take(
        name: str,
        words: Annotated[list[str] | None, typer.Option("--word")] = None,
        number: Annotated[int | None, typer.Option(min=1)] = None,
        path: Path | None = None,
        flag: Annotated[bool, typer.Option("--flag")] = False,
    ) -> None:
        typer.echo(repr((name, words, number, path, flag)))

    @made.command()
    def other() -> None:
        pass

    return made


GIVEN = [
    "a",
    "ü",
    "a --word b --word ü",
    "a --number 3",
    "a --path b/c",
    "a --flag",
    "a --number 3 --word x --path . --flag",
]


@pytest.mark.parametrize("words", GIVEN)
def test_a_parameter_is_given_what_typer_gives(words):
    theirs, ours = (CliRunner().invoke(app(cls), ["take", *words.split()]) for cls in (typer.core.TyperGroup, Commands))
    assert theirs.exit_code == ours.exit_code == 0, theirs.output
    assert ours.output == theirs.output


@pytest.mark.parametrize("words", ["", "a --number 0", "a --number b", "a --no", "a b"])
def test_what_typer_refuses_is_refused(words):
    assert CliRunner().invoke(app(typer.core.TyperGroup), ["take", *words.split()]).exit_code == 2
    assert isinstance(CliRunner().invoke(app(Commands), ["take", *words.split()]).exception, ScenarioError)


@pytest.mark.parametrize(("words", "needed"), [("['a']", False), ("['a', '--number', '3']", True)])
def test_plain_text_needs_no_pydantic(words, needed):
    code = f"""
import sys
sys.path.insert(0, {str(Path(__file__).parent)!r})
import test_words
try:
    test_words.app(test_words.Commands)(["take", *{words}])
except SystemExit:
    print("pydantic" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == str(needed)
