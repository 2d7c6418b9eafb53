"""The page of each folder of the code is true: its rooms, its nouns, who calls it, and what it imports."""

import ast
import re
import sys
from functools import cache
from pathlib import Path

import pytest
from sentences import too_long

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
FLOORS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps")
FOLDERS = (*FLOORS, "surefoot")
LONGEST = 24
"""Lines of a page, its table of rooms among them."""


def page(folder):
    return (ROOT / folder / "README.md").read_text(encoding="utf-8")


def told(folder, what):
    """Names that a page gives after a word in bold."""
    (text,) = re.findall(rf"(?s)- \*\*{what}:\*\* (.*?)\.\n(?=-|\n|$)", page(folder) + "\n")
    return {name.strip("`") for name in re.split(r",\s+", text) if name != "nobody"}


def files_of(folder):
    """Its own modules, without those of the folders that surefoot/ holds as links."""
    found = (file for file in (ROOT / folder).rglob("*.py"))
    return [file for file in found if file.relative_to(ROOT / folder).parts[0] not in FLOORS or folder != "surefoot"]


def imported(text):
    """Imports of a module: folders of the code by name, others by their first name; None for Python's own."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [one.name for one in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"surefoot.{one.name}" for one in node.names] if node.module == "surefoot" else [node.module]
        else:
            continue
        for first, *rest in (name.split(".") for name in names):
            if first == "surefoot":
                yield rest[0] if rest and rest[0] in FLOORS else "surefoot"
            elif first not in {*sys.stdlib_module_names, "_typeshed"}:
                yield first


@cache
def imports(folder):
    return {name for file in files_of(folder) for name in imported(file.read_text(encoding="utf-8"))} - {folder}


@cache
def classes(folder):
    """Names of all classes."""
    trees = (ast.parse(file.read_text(encoding="utf-8")) for file in files_of(folder))
    return {node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef)}


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_page_names_every_room_and_no_other(folder):
    held = {path.name for path in (ROOT / folder).iterdir() if path.is_dir()} - {"__pycache__"}
    assert set(re.findall(r"(?m)^\| `(\w+)/` \|", page(folder))) == held
    assert len(page(folder).splitlines()) <= LONGEST
    assert too_long(page(folder)) == []


@pytest.mark.parametrize("folder", FOLDERS)
def test_the_nouns_of_the_page_are_classes_there(folder):
    nouns = told(folder, "Nouns")
    assert len(nouns) >= 4
    assert nouns <= classes(folder)


@pytest.mark.parametrize("folder", FOLDERS)
def test_who_calls_is_who_imports(folder):
    assert told(folder, "Called by") == {other for other in FLOORS if folder in imports(other)}


@pytest.mark.parametrize("folder", FOLDERS)
def test_what_is_imported_is_what_the_page_says(folder):
    assert told(folder, "Imports") == imports(folder) - {"surefoot"}


def test_an_import_is_seen_wherever_it_stands():
    text = (
        "import os, numpy.linalg\ndef f():\n    from surefoot.apps.drive import x\n    from surefoot import wbc, run\n"
    )
    assert list(imported(text)) == ["numpy", "apps", "wbc", "surefoot"]


def test_the_architecture_names_every_folder():
    told_there = (ROOT / "README.md").read_text(encoding="utf-8")
    assert set(re.findall(r"(?m)^\| `(\w+)/` \|", told_there)) == set(FLOORS)
