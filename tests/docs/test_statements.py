"""One statement stands on a line: no assignment packs four things of different kinds, ruff finds semicolons."""

import ast
import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps")
MOST = 3
"""Most values of different kinds that one assignment gives to as many names [-]."""


class _Masked(ast.NodeTransformer):
    def visit_Constant(self, node):
        return ast.copy_location(ast.Constant(0), node)


def alike(values):
    """Return true for components of one or two things, and for plain letters, as the coordinates of a point."""
    kinds = {ast.dump(_Masked().visit(ast.parse(ast.unparse(value), mode="eval"))) for value in values}
    return len(kinds) <= 2 or all(re.fullmatch(r"-?\w", ast.unparse(value)) for value in values)


def packed(text):
    """Lines with an assignment of more than MOST values of different kinds; constants of a module may be listed."""
    tree = ast.parse(text)
    listed = {id(node) for node in tree.body}
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple)):
            continue
        values = node.value.elts if isinstance(node.value, ast.Tuple) else ()
        constants = id(node) in listed and all(isinstance(value, ast.Constant) for value in values)
        if len(values) > MOST and not constants and not alike(values):
            yield node.lineno


@pytest.mark.parametrize("folder", [*FOLDERS, "surefoot"])
def test_no_line_packs_statements(folder):
    own = FOLDERS if folder == "surefoot" else ()
    files = [one for one in (ROOT / folder).rglob("*.py") if one.relative_to(ROOT / folder).parts[0] not in own]
    found = {file.relative_to(ROOT).as_posix(): [*packed(file.read_text(encoding="utf-8"))] for file in files}
    assert len(found) >= 5
    assert {name: lines for name, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "line",
    [
        "clock, lower, leaves, numbers = state.clock, state.lowering, False, parameters.recovery",
        "def f(self):\n    self.a, self.b, self.c, self.d = 0.0, [], model, None",
    ],
)
def test_a_line_that_packs_statements_is_found(line):
    assert [*packed(line)]


@pytest.mark.parametrize(
    "line",
    [
        "w, x, y, z = q[3], q[4], q[5], q[6]",
        "c, s, cp, sp = cos(angles[0]), sin(angles[0]), cos(angles[1]), sin(angles[1])",
        "x, y, z, w = -x, -y, -z, -w",
        "HIPS, KNEES, ANKLES, FEET = 0, 2, 4, 6",
        "a, b, c, d = function(x)",
        "model, count, clock = state.model, 0, state.clock",
    ],
)
def test_components_of_one_thing_may_share_a_line(line):
    assert [*packed(line)] == []
