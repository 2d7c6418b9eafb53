"""Texts of commands on the package's own parts are what follows from the sources."""

import importlib.util
from pathlib import Path

import pytest

from surefoot.scenarios.cli import texts

pytestmark = pytest.mark.unit

_SPEC = importlib.util.spec_from_file_location("made_texts", Path(__file__).parents[2] / "docs" / "texts.py")
made_texts = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(made_texts)


@pytest.mark.parametrize("name", made_texts.TEXTS)
def test_a_text_in_the_package_follows_from_the_sources(name):
    assert texts.text(name) == made_texts.made(name), "run python docs/texts.py"


def test_nothing_else_is_there():
    assert {file.stem for file in texts.FOLDER.iterdir()} == set(made_texts.TEXTS)
