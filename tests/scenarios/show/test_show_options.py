"""A command whose options are one value takes them as any command does."""

from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.show.options import From, keys, keys_from, with_options

pytestmark = pytest.mark.unit


@dataclass(frozen=True)
class Told:
    name: Annotated[str, typer.Argument(help="Of the thing.")]
    set_: Annotated[list[str] | None, typer.Option("--set", help="Set a key.")] = None
    start: From = None
    loud: Annotated[bool, typer.Option("--loud", help="Shout.")] = False


@pytest.fixture
def invoke():
    told, app = [], typer.Typer(rich_markup_mode=None)

    @app.command()
    @with_options(Told)
    def act(given: Told) -> None:
        """Do it."""
        told.append(given)

    return lambda *words: (CliRunner().invoke(app, words), told)


def test_fields_are_arguments_and_options_with_their_defaults(invoke):
    assert invoke("x")[1] == [Told("x")]
    words = ("x", "--set", "a=1", "--set", "b=2", "--from", "2.5", "--loud")
    assert invoke(*words)[1][-1] == Told("x", ["a=1", "b=2"], 2.5, True)


def test_the_help_is_that_of_the_function_and_of_the_fields(invoke):
    result, told = invoke("--help")
    for text in ("Do it.", "Of the thing.", "Set a key.", "From this time on [s].", "Shout."):
        assert text in result.output
    assert not told


@pytest.mark.parametrize("words", [(), ("x", "--start", "1"), ("x", "--from", "nan"), ("x", "--from", "soon")])
def test_what_is_no_option_or_no_value_of_it_is_refused(invoke, words):
    result, told = invoke(*words)
    assert result.exit_code == 2
    assert not told


def test_keys_are_those_of_the_schema_groups_first():
    found = dict(keys(Scenario))
    assert {"gait", "gait.steps", "terrain.friction", "pushes"} <= found.keys()
    names = list(found)
    assert names.index("gait") < names.index("gait.steps")
    assert keys_from("gait.st") == [name for name in names if name.startswith("gait.st")]
