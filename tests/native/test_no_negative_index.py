"""Modules with arrays of C count no index from the end: there that reads memory before a list's first item."""

import ast
from collections.abc import Iterator

import pytest

from surefoot.native import modules

pytestmark = pytest.mark.unit


def negative(text: str) -> Iterator[str]:
    """Expressions of a source with an index that is counted from the end."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Subscript):
            indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            if any(isinstance(index, ast.UnaryOp) and isinstance(index.op, ast.USub) for index in indices):
                yield ast.unparse(node)


UNCHECKED = sorted(name for name, path in modules.sources().items() if modules.has_arrays(path))


@pytest.mark.parametrize("name", UNCHECKED)
def test_no_index_is_counted_from_the_end(name):
    source = modules.ROOT / modules.sources()[name]
    if source.suffix == ".py":
        assert not list(negative(source.read_text(encoding="utf-8")))


def test_one_is_seen():
    assert list(negative("a = phases[-1]\nb = A[0, -2]\nc = A[-3:]\nd = A[1]")) == ["phases[-1]", "A[0, -2]"]
