"""Files that differ from another commit, and those of their functions that mean something else than there.

Docstrings, comments and layout mean nothing to a test that runs a function: it is the same without them.
"""

import ast
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

MODULE = "<module>"
"""Stands for what a file has outside its functions: constants, fields of classes, imports."""

_Definition = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Edit:
    """A file that differs.

    Attributes:
        path: relative to the root, as it is now; of a file that is gone, as it was.
        before: its path at the other commit; empty for a new file.
        functions: functions that differ, as `Class.method`, and `MODULE`; None where the file is no Python that
            can be read, or gives the types of a compiled module, so that all of it counts.
    """

    path: str
    before: str
    functions: frozenset[str] | None


def edits(root: Path, base: str) -> list[Edit]:
    """Files of a working tree that differ from a commit, with those that git does not know yet."""
    found = list(_tracked(root, base))
    new = _git(root, "ls-files", "--others", "--exclude-standard", "-z").split("\0")
    return sorted(
        [*found, *(_edit(root, base, "", path) for path in new if path)], key=lambda edit: (edit.path, edit.before)
    )


def _tracked(root: Path, base: str) -> Iterator[Edit]:
    words = iter(_git(root, "diff", "--name-status", "-z", "-M", base, "--").split("\0"))
    for status in words:
        if not status:
            continue
        before = next(words)
        path = next(words) if status[0] in "RC" else before
        yield _edit(root, base, "" if status[0] == "A" else before, path)


def _edit(root: Path, base: str, before: str, path: str) -> Edit:
    if PurePosixPath(path).suffix != ".py":
        return Edit(path, before, None)
    now = root / path
    texts = (
        _git(root, "show", f"{base}:{before}") if before else "",
        now.read_text(encoding="utf-8") if now.is_file() else "",
    )
    try:
        old, new = map(functions, texts)
    except (SyntaxError, ValueError):
        return Edit(path, before, None)
    return Edit(path, before, frozenset(name for name in old.keys() | new.keys() if old.get(name) != new.get(name)))


def functions(text: str) -> Mapping[str, str]:
    """Meaning of each function of a file by its qualified name, and of the rest; inner ones belong to their outer.

    Raises:
        SyntaxError: the text is no Python.
    """
    tree = _bare(ast.parse(text))
    found: dict[str, str] = {}
    for name, node in _defined(tree.body):
        found[name] = found.get(name, "") + ast.dump(node)  # a property and its setter share a name
    return {**found, MODULE: ast.dump(_without_functions(tree))}


def lines(text: str) -> list[tuple[range, str]]:
    """Lines of each function with its decorators, and its qualified name."""
    return [
        (range(min(node.lineno, *(one.lineno for one in node.decorator_list), node.lineno), node.end_lineno + 1), name)
        for name, node in _defined(ast.parse(text).body)
        if node.end_lineno is not None
    ]


def _defined(body: list[ast.stmt], within: str = "") -> Iterator[tuple[str, _Definition]]:
    for node in body:
        if isinstance(node, _Definition):
            yield f"{within}{node.name}", node
        elif isinstance(node, ast.ClassDef):
            yield from _defined(node.body, f"{within}{node.name}.")
        else:
            for part in ("body", "orelse", "finalbody"):
                yield from _defined(getattr(node, part, []), within)


def _bare(tree: ast.Module) -> ast.Module:
    """The tree without strings that stand alone."""
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [one for one in body if not _is_text(one)]  # type: ignore[attr-defined]
    return tree


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _without_functions(tree: ast.Module) -> ast.Module:
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list) and not isinstance(node, _Definition):
            node.body = [one for one in body if not isinstance(one, _Definition)]  # type: ignore[attr-defined]
    return tree


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, encoding="utf-8", errors="replace")
    if done.returncode:
        raise SystemExit(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout
