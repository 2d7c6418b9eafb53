"""Tests hold laws by public faces: how far they reach into the product is counted, and may only fall."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

TESTS = Path(__file__).parent

AT_MOST = {"private names": 88, "subclasses": 13, "patches": 138}
"""Places in all tests; to be lowered with each that goes, and never to be raised."""

OF_ITS_LIBRARY = {"_replace", "_fields", "_asdict", "_make", "_exit", "_repr_html_"}
"""Public names that begin so: of named tuples, of the standard library, and of notebooks."""

LAYERS = ("surefoot.planner", "surefoot.wbc")


def private(tree: ast.Module) -> Iterator[ast.AST]:
    """Names of others that begin with an underscore: read, written, imported, or patched by their text."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and _is_private(node.attr):
            if not (isinstance(node.value, ast.Name) and node.value.id in ("self", "cls", "super")):
                yield node
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("surefoot"):
            yield from (alias for alias in node.names if _is_private(alias.name))
        elif isinstance(node, ast.Call) and _name(node.func) in ("setattr", "getattr"):
            texts = [one.value for one in node.args if isinstance(one, ast.Constant) and isinstance(one.value, str)]
            yield from (node for text in texts if _is_private(text.rpartition(".")[2]))


def subclasses(tree: ast.Module) -> Iterator[ast.AST]:
    """Classes that derive from one of the planner's or the controller's."""
    home = _imported(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            bases = [home.get(_root(base), "") for base in node.bases]
            if any(base.startswith(LAYERS) for base in bases):
                yield node


def patches(tree: ast.Module) -> Iterator[ast.AST]:
    """Attributes of the product that a test replaces."""
    home = _imported(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "setattr":
            target = node.args[0]
            text = target.value if isinstance(target, ast.Constant) else home.get(_root(target), "surefoot.")
            if str(text).startswith("surefoot"):
                yield node


COUNTED = {"private names": private, "subclasses": subclasses, "patches": patches}


def _is_private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__") and name not in OF_ITS_LIBRARY


def _name(node: ast.AST) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _root(node: ast.AST) -> str:
    while isinstance(node, ast.Attribute | ast.Call | ast.Subscript):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.id if isinstance(node, ast.Name) else ""


def _imported(tree: ast.Module) -> dict[str, str]:
    """Module that each name of a test is from; one that is no import is of nowhere."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            found |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {(alias.asname or alias.name).partition(".")[0]: alias.name for alias in node.names}
    return found


@pytest.mark.parametrize("what", COUNTED)
def test_tests_reach_no_farther_into_the_product(what):
    found = [
        f"{path.relative_to(TESTS)}:{node.lineno}"
        for path in sorted(TESTS.rglob("*.py"))
        for node in COUNTED[what](ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert len(found) <= AT_MOST[what], f"use public faces, parts, profiles or parameters: {', '.join(found)}"


TEXT = """
import surefoot.wbc.controller as home
from surefoot.planner import WalkingPlanner
from surefoot.sim import world
from surefoot.sim.world import _hidden

class Mine(WalkingPlanner):
    def f(self):
        return self._x, other._y, pair._replace(a=1)

def test(monkeypatch):
    monkeypatch.setattr(world, "_z", 1)
    monkeypatch.setattr("surefoot.sim.world.World", 1)
    monkeypatch.setattr(sys, "argv", [])
"""


def test_each_kind_is_seen():
    text = TEXT.replace("import surefoot", "import sys\nimport surefoot", 1)
    assert [len(list(count(ast.parse(text)))) for count in COUNTED.values()] == [3, 1, 2]
