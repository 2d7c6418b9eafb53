"""Functions that take more than seven arguments by position are few: a value holds what belongs together."""

import ast
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[1]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")

MOST, AT_MOST = 7, 5
"""Parameters of a function, and functions that have more; the latter is to be lowered with each that goes."""


def long_lists(tree: ast.Module) -> list[ast.FunctionDef]:
    """Functions with more parameters by position, without the object itself."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            names = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
            found += [node] if len(names) - (names[:1] in (["self"], ["cls"])) > MOST else []
    return found


def test_few_functions_have_many_parameters():
    found = [
        f"{path.relative_to(ROOT)}:{node.lineno} {node.name}"
        for folder in FOLDERS
        for path in sorted((ROOT / folder).rglob("*.py"))
        if not any(part.is_symlink() for part in path.parents)
        for node in long_lists(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert found, "nothing was looked at"
    assert len(found) <= AT_MOST, f"give what belongs together as one value: {', '.join(found)}"


def test_each_is_seen():
    text = "def f(a, b, c, d, e, f, g, h): ...\nclass C:\n    def f(self, a, b, c, d, e, f, g): ...\n"
    assert [node.lineno for node in long_lists(ast.parse(text))] == [1]
