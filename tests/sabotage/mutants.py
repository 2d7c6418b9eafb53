"""Small faults in one module, one at a time, and whether its tests find them.

    python tests/sabotage/mutants.py planner/laws/qp.py [--tests PATH]... [--limit N]

The tests are by default those of the folder that mirrors the module's. Each mutant lies in a copy of the folders of the
code, so that the checkout is never touched. A mutant survives when all tests pass; each survivor is printed with its
line. Some survivors are equivalent to the code, so that a score of 100 % is not the goal.
"""

import argparse
import ast
import copy
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
CODE = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")
FOLDERS = (*CODE, "tests", "docs", "examples", "benchmarks")
FILES = ("pyproject.toml", "Makefile", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "constraints.txt")
LONGEST = 1800.0
"""Longest time of the tests of one mutant [s]; a mutant that takes longer runs without end and counts as found."""

SWAPS: dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.And: ast.Or, ast.Or: ast.And,
    ast.USub: ast.UAdd,
}  # fmt: skip
"""Replacements of an operator."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A module with one fault.

    Attributes:
        line: of the fault.
        before: the expression as it is.
        after: the expression with the fault.
        text: of the whole module.
    """

    line: int
    before: str
    after: str
    text: str


def mutants(text: str) -> Iterator[Mutant]:
    """Every mutant of a module: operators swapped, conditions denied, numbers more than doubled."""
    tree = ast.parse(text)
    skipped = _left_alone(tree)
    for index, node in enumerate(ast.walk(tree)):
        if id(node) in skipped:
            continue
        for variant in range(_variants(node)):
            changed = copy.deepcopy(tree)
            target = next(other for place, other in enumerate(ast.walk(changed)) if place == index)
            before = ast.unparse(target)
            _hurt(target, variant)
            yield Mutant(node.lineno, before, ast.unparse(target), ast.unparse(ast.fix_missing_locations(changed)))


def _left_alone(tree: ast.Module) -> set[int]:
    """Nodes that are left alone: type annotations, and decorators such as `dataclass(frozen=True)`."""
    roots = [getattr(node, field, None) for node in ast.walk(tree) for field in ("annotation", "returns")]
    roots += [one for node in ast.walk(tree) for one in getattr(node, "decorator_list", ())]
    return {id(node) for root in roots if root is not None for node in ast.walk(root)}


def _variants(node: ast.AST) -> int:
    match node:
        case ast.Compare(ops=ops):
            return sum(type(op) in SWAPS for op in ops)
        case ast.BinOp(op=op) | ast.BoolOp(op=op) | ast.UnaryOp(op=op):
            return int(type(op) in SWAPS)
        case ast.If() | ast.IfExp() | ast.While():
            return 1
        case ast.Constant(value=bool() | int() | float()):
            return 1
    return 0


def _hurt(node: ast.AST, variant: int) -> None:
    match node:
        case ast.Compare(ops=ops):
            place = [index for index, op in enumerate(ops) if type(op) in SWAPS][variant]
            ops[place] = SWAPS[type(ops[place])]()
        case ast.BinOp() | ast.BoolOp() | ast.UnaryOp():
            node.op = SWAPS[type(node.op)]()
        case ast.If() | ast.IfExp() | ast.While():
            node.test = ast.UnaryOp(ast.Not(), node.test)
        case ast.Constant(value=value):
            node.value = not value if isinstance(value, bool) else 2 * value + 1


def copied(place: Path) -> None:
    """Copy what the tests need to a folder; links stay links."""
    for folder in FOLDERS:
        shutil.copytree(ROOT / folder, place / folder, symlinks=True, ignore=shutil.ignore_patterns("__pycache__"))
    for file in FILES:
        shutil.copy(ROOT / file, place / file)


def builds(place: Path) -> str:
    """Message of the compiler about the code of a folder; empty where it compiles."""
    command = [sys.executable, "-c", "import surefoot"]
    done = subprocess.run(command, cwd=place, env=_environment(place), capture_output=True, text=True, check=False)
    return done.stderr if done.returncode else ""


def found_by(place: Path, tests: list[str]) -> str:
    """The first test that fails with the code of a folder, or what else ended them; empty where all pass."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--no-header", *tests]
    try:
        done = subprocess.run(
            command, cwd=place, env=_environment(place), capture_output=True, timeout=LONGEST, check=False, text=True
        )
    except subprocess.TimeoutExpired:
        return f"a test that does not end in {LONGEST:.0f} s"
    if done.returncode > 1 and "error" not in done.stdout.lower():
        raise SystemExit(f"pytest cannot run {' '.join(tests)}:\n{done.stdout}{done.stderr}")
    failed = re.findall(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", done.stdout, re.MULTILINE)
    return (failed or [f"an end with code {done.returncode}"])[0] if done.returncode else ""


def _environment(place: Path) -> dict[str, str]:
    """Environment of a process that imports the code of a folder."""
    return {**os.environ, "PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}


def main() -> None:
    """Try the mutants of a module, and print those that survive and the score."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("module", help="path of the module from the root, such as planner/laws/qp.py")
    parser.add_argument("--tests", action="append", help="tests to run; by default those of the folder of the module")
    parser.add_argument("--limit", type=int, help="try so many mutants, drawn at random with seed 0")
    options = parser.parse_args()
    module = Path(options.module)
    if not (ROOT / module).is_file():
        parser.error(f"{module} is no file; give the path of a module from {ROOT}, such as planner/laws/qp.py")
    tests = options.tests or [str(Path("tests") / module.parent)]
    tried = list(mutants((ROOT / module).read_text(encoding="utf-8")))
    if options.limit and options.limit < len(tried):
        tried = sorted(random.Random(0).sample(tried, options.limit), key=lambda mutant: mutant.line)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        copied(place)
        if found := found_by(place, tests):
            raise SystemExit(f"{found}: it fails without a mutant")
        survivors, refused = 0, 0
        for mutant in tried:
            (place / module).write_text(mutant.text, encoding="utf-8")
            if builds(place):
                refused += 1
            elif not found_by(place, tests):
                survivors += 1
                print(f"survived: {module}:{mutant.line}: {mutant.before}  ->  {mutant.after}", flush=True)
    count = len(tried) - refused
    found = count - survivors
    share = f" ({100.0 * found / count:.0f} %)" if count else ""
    print(f"{module}: {found} of {count} mutants found{share}, by {' '.join(tests)}; {refused} do not compile")


if __name__ == "__main__":
    main()
