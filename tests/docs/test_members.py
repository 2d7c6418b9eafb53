"""Pages name members that their classes have, as `StepBounds.left`."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted(ROOT.glob("*/README.md"))]

NAMED = re.compile(r"`(?:[a-z_]+\.)*([A-Z][A-Za-z0-9]+)\.([a-z_][A-Za-z0-9_]*)")


def classes() -> Iterator[ast.ClassDef]:
    """Every class of the product."""
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*.py"):
            if not any(part.is_symlink() for part in path.parents):
                yield from (node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if type(node) is ast.ClassDef)


def members(node: ast.ClassDef) -> Iterator[str]:
    """Methods, fields and attributes that a class sets."""
    for inside in ast.walk(node):
        if isinstance(inside, ast.FunctionDef):
            yield inside.name
        elif isinstance(inside, ast.Name | ast.Attribute) and isinstance(inside.ctx, ast.Store):
            yield inside.id if isinstance(inside, ast.Name) else inside.attr


@pytest.fixture(scope="module")
def known():
    """Members of the classes by name, those of the classes that they derive from among them."""
    own, bases = defaultdict(set), defaultdict(set)
    for node in classes():
        own[node.name] |= set(members(node))
        bases[node.name] |= {base.id for base in node.bases if isinstance(base, ast.Name)}

    def all_of(name: str) -> set[str]:
        return own[name].union(*map(all_of, (base for base in bases[name] if base in own and base != name)))

    return {name: all_of(name) for name in list(own)}


def missing(text: str, known: Mapping[str, set[str]]) -> set[str]:
    """Members in a text that their classes have not; classes of others are left out."""
    return {f"{name}.{member}" for name, member in NAMED.findall(text) if name in known and member not in known[name]}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_members_that_a_page_names_are_there(page, known):
    assert missing(page.read_text(encoding="utf-8"), known) == set()


def test_one_that_is_not_there_is_found(known):
    there = "`StepBounds.left`, `planner.recovery.reach.StepReach.swung()`, `MjSpec.from_file`"
    text = f"{there}, `StepBounds.lost`, `LegReach.edges`"
    assert missing(text, known) == {"StepBounds.lost", "LegReach.edges"}
