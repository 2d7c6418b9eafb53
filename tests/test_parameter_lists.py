"""Functions are short, and few take more than seven arguments by position: a value holds what belongs together."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[1]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")

MOST, AT_MOST = 7, 5
"""Parameters of a function, and functions that have more; the latter is to be lowered with each that goes."""


LONGEST = 60
"""Lines of a function, with its docstring."""


def functions() -> Iterator[tuple[str, ast.FunctionDef | ast.AsyncFunctionDef]]:
    """Every function of the product, with its place."""
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            if not any(part.is_symlink() for part in path.parents):
                for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                        yield f"{path.relative_to(ROOT)}:{node.lineno} {node.name}", node


def lines(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines from its name to its end."""
    return (node.end_lineno or node.lineno) - node.lineno + 1


def test_no_function_is_long():
    lengths = {place: lines(node) for place, node in functions()}
    assert len(lengths) > 5000, "not all was looked at"
    assert {place: length for place, length in lengths.items() if length > LONGEST} == {}


def has_a_long_list(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """True where it has more parameters by position, without the object itself."""
    names = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
    return len(names) - (names[:1] in (["self"], ["cls"])) > MOST


def test_few_functions_have_many_parameters():
    found = [place for place, node in functions() if has_a_long_list(node)]
    assert found, "nothing was looked at"
    assert len(found) <= AT_MOST, f"give what belongs together as one value: {', '.join(found)}"


def test_each_is_seen():
    text = "def f(a, b, c, d, e, f, g, h): ...\nclass C:\n    def f(self, a, b, c, d, e, f, g): ...\n"
    found = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    assert [(node.lineno, has_a_long_list(node), lines(node)) for node in found] == [(1, True, 1), (3, False, 1)]
