"""Words that name many things at once stay out of names and prose of the code: each place says which is meant."""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")
TOLD = re.compile(r"(?i)(?<![a-z])told(?![a-z])")
"""A word for what is commanded, measured, reported, given, noted or shown."""
CONTRACT = {
    "driven_told": "a key of scenarios",
    "told": "an attribute of controllers and a method of estimators that packages have: docs/extending.md",
}
"""Names that others write, each with what it is."""
HOLDERS = {
    "scenarios/file/control.py": "driven_told",
    "scenarios/run/driven.py": "driven_told",
    "scenarios/run/full.py": "driven_told",
    "scenarios/policy/controller.py": "told",
    "scenarios/policy/trial.py": "told",
    "scenarios/run/seat.py": "told",
    "scenarios/run/sensed.py": "told",
    "scenarios/run/sensing.py": "told",
    "studies/training/learner.py": "told",
    "wbc/estimation/estimator.py": "told",
}


def names(text):
    """Names of a source with the word, each once."""
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return {token.string for token in tokens if token.type == tokenize.NAME and TOLD.search(token.string)}


def prose(text):
    """Docstrings and comments of a source with the word, but for names between backticks."""
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    comments = [token.string for token in tokens if token.type == tokenize.COMMENT]
    values = (node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Expr))
    said = (value.value for value in values if isinstance(value, ast.Constant) and isinstance(value.value, str))
    return [said for said in (*comments, *said) if TOLD.search(re.sub(r"`+[^`]*`+", "", said))]


def sources():
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            if folder != "surefoot" or path.relative_to(ROOT / folder).parts[0] not in FOLDERS:
                yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def test_a_name_says_which_of_them_is_meant():
    found = {path: names(text) for path, text in sources()}
    assert {path: said for path, said in found.items() if said - {HOLDERS.get(path)}} == {}
    assert set(HOLDERS.values()) == set(CONTRACT)


def test_prose_says_which_of_them_is_meant():
    found = {path: prose(text) for path, text in sources()}
    assert {path: said for path, said in found.items() if said} == {}


def test_the_word_is_found_in_names_and_prose():
    text = '"""The walk is told."""\ntold_once = 1  # as told\ntoldo = "told"\n"""See `told`."""\n'
    assert names(text) == {"told_once"}
    assert prose(text) == ["# as told", "The walk is told."]
