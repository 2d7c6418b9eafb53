"""What commands tell of the package's own parts is what follows from the sources."""

import importlib.util
from pathlib import Path

import pytest

from surefoot.scenarios.cli import texts

pytestmark = pytest.mark.unit

_SPEC = importlib.util.spec_from_file_location("told", Path(__file__).parents[2] / "docs" / "told.py")
told = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(told)


@pytest.mark.parametrize("name", told.TEXTS)
def test_a_text_in_the_package_follows_from_the_sources(name):
    assert texts.text(name) == told.made(name), "run python docs/told.py"


def test_nothing_else_is_there():
    assert {file.stem for file in texts.FOLDER.iterdir()} == set(told.TEXTS)
