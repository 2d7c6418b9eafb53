"""Documentation of functions and classes that the program shows: meanings of metrics, channels, keys and commands."""

import ast
import inspect
import sys
import textwrap
from typing import Any


def doc_of(documented: Any) -> str:
    """Documentation of a function or class, empty if it has none.

    Python that was started with ``-OO`` or ``PYTHONOPTIMIZE=2`` keeps none in memory, so it is read from the source.
    A dataclass then has its signature in ``__doc__``: the source goes first.
    """
    if sys.flags.optimize < 2:
        return documented.__doc__ or ""
    try:
        (definition,) = ast.parse(textwrap.dedent(inspect.getsource(documented))).body
    except (OSError, TypeError, SyntaxError, ValueError):
        return documented.__doc__ or ""
    if not isinstance(definition, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return documented.__doc__ or ""
    return ast.get_docstring(definition, clean=False) or ""
