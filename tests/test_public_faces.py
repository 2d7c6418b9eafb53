"""Tests hold laws by public faces: how far they reach into the product is counted, and may only fall."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

TESTS = Path(__file__).parent

AT_MOST = {"private names": 48, "subclasses": 8, "patches": 56}
"""Places in all tests; to be lowered with each that goes, and never to be raised."""

OF_ITS_LIBRARY = {"_replace", "_fields", "_asdict", "_make", "_exit", "_repr_html_"}
"""Public names that begin so: of named tuples, of the standard library, and of notebooks."""

REPLACING = {"setattr", "setitem", "delattr", "delitem"}
"""Methods of pytest's monkeypatch, whatever a test calls it."""

LAYERS = ("surefoot.planner", "surefoot.wbc")

TO_DERIVE_FROM = {"surefoot.planner.PlannerParameters"}
"""Classes of theirs that a law of one's own derives from."""


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
            if any(base.startswith(LAYERS) and base not in TO_DERIVE_FROM for base in bases):
                yield node


def patches(tree: ast.Module) -> Iterator[ast.AST]:
    """Attributes and entries of the product that a test replaces, by pytest or by the standard library."""
    home = _imported(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args and _replaces(node.func):
            target = node.args[0]
            text = _text(target) or home.get(_root(target), "surefoot.")
            if text.startswith("surefoot"):
                yield node


COUNTED = {"private names": private, "subclasses": subclasses, "patches": patches}


def _replaces(function: ast.expr) -> bool:
    """Return true for the functions that put something else in a place for a while."""
    if isinstance(function, ast.Attribute) and _name(function.value) == "patch":
        return function.attr in ("object", "dict", "setattr", "setitem")
    return _name(function) == "patch" or (isinstance(function, ast.Attribute) and function.attr in REPLACING)


def _text(node: ast.AST) -> str:
    """The text that an expression begins with; empty where it is none."""
    first = node.values[0] if isinstance(node, ast.JoinedStr) else node
    return first.value if isinstance(first, ast.Constant) and isinstance(first.value, str) else ""


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
    monkeypatch.setitem(world.TABLE, "a", 1)
    monkeypatch.setitem(sys.modules, "a", None)
    with patch.object(world, "z", 1), patch(f"surefoot.{name}", 1), patch.dict(world.TABLE, {}):
        pass
"""


def test_each_kind_is_seen():
    text = TEXT.replace("import surefoot", "import sys\nimport surefoot", 1)
    assert [len(list(count(ast.parse(text)))) for count in COUNTED.values()] == [3, 1, 6]
