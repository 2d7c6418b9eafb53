"""Inputs of a result, and their digests: the code that its maker imports, scenarios, robots and versions.

A source counts by its meaning: another docstring, comment or layout makes no other result.
"""

import ast
import hashlib
import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]

PACKAGE = "surefoot"

PARTS = ("mujoco", "pin", "proxsuite", "qpsolvers", "daqp", "piqp", "numpy", "scipy", "example-robot-data")
"""Packages whose version moves numbers; `constraints.txt` has the versions."""

_DOTTED = re.compile(rf"{PACKAGE}(\.\w+)+")


def code(makers: Iterable[str], root: Path = ROOT) -> frozenset[Path]:
    """Source files of modules and of all that these import of the package, at whatever moment.

    Args:
        makers: names of modules, or paths of scripts relative to the root.
        root: of the repository.

    Returns:
        Paths relative to the root, with the types of compiled modules.
    """
    found: dict[Path, None] = {}
    left = [root / one if one.endswith(".py") else _required(one, root) for one in makers]
    while left:
        path = left.pop()
        if path in found:
            continue
        found[path] = None
        left += _imported(path, root)
    typed = {path.with_suffix(end) for path in found for end in (".pxd", ".pyx")}
    return frozenset(
        path.resolve().relative_to(root.resolve()) for path in (*found, *(one for one in typed if one.exists()))
    )


def _module(name: str, root: Path) -> Path | None:
    path = root.joinpath(*name.split("."))
    for one in (path.with_suffix(".py"), path / "__init__.py"):
        if one.is_file():
            return one
    return None


def _required(name: str, root: Path) -> Path:
    path = _module(name, root)
    if path is None:
        raise SystemExit(f"there is no module {name} in {root}; mend docs/made.yaml")
    return path


def _stamp(path: Path) -> tuple[int, int]:
    """Other where a file was written meanwhile: making results takes hours."""
    found = path.stat()
    return found.st_mtime_ns, found.st_size


@cache
def _imports_at(path: Path, stamp: tuple[int, int]) -> tuple[tuple[str, str], ...]:
    """Modules that a source imports itself, each alone or with a name that is taken from it."""
    found: list[tuple[str, str]] = []
    for node in _running(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found += [*((node.module, alias.name) for alias in node.names), (node.module, "")]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            name = node.value.partition(":")[0]
            found += [(name, "")] if _DOTTED.fullmatch(name) else []
    return tuple(dict.fromkeys(found))


def _imported(path: Path, root: Path) -> Iterator[Path]:
    """Files that a source imports itself; a name of a face is its home."""
    for module, taken in _imports_at(path, _stamp(path)):
        for name in _homes(module, taken, root) if taken else (module,):
            yield from _with_parents(name, root)
            beside = path.parent / f"{name}.py"  # a script of the same folder
            if "." not in name and beside.is_file():
                yield beside


def _with_parents(name: str, root: Path) -> Iterator[Path]:
    words = name.split(".")
    if words[0] not in (PACKAGE, "benchmarks"):
        return
    for end in range(1, len(words) + 1):
        path = _module(".".join(words[:end]), root)
        if path is not None:
            yield path


def _homes(package: str, name: str, root: Path) -> Iterator[str]:
    """Origin of a name that is imported: a module of the package, or what its face imports for checkers."""
    if _module(f"{package}.{name}", root) is not None:
        yield f"{package}.{name}"
        return
    path = _module(package, root)
    if path is not None and path.name == "__init__.py":
        yield from _face(path).get(name, ())


def _face(path: Path) -> dict[str, list[str]]:
    """Modules that a face imports names from, by the name."""
    return _face_at(path, _stamp(path))


@cache
def _face_at(path: Path, stamp: tuple[int, int]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                found.setdefault(alias.asname or alias.name, []).append(node.module)
    return found


def _running(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes of a source but for those that only type checkers read."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            if isinstance(node.test, ast.Name):
                for other in node.orelse:
                    yield from (other, *_running(other))
            continue
        yield node
        yield from _running(node)


def data(texts: Iterable[str], root: Path = ROOT) -> frozenset[Path]:
    """Scenarios and robots of the project that texts name by a word, and those that these name in turn.

    Args:
        texts: of campaigns and commands.
        root: of the repository.

    Returns:
        Paths relative to the root. The reference robot is code.
    """
    folders = (root / "scenarios" / "catalogue", root / "models" / "robots")
    known = {path.stem: path for folder in folders for path in folder.rglob("*.yaml")}
    found, left = set[Path](), [*texts]
    while left:
        fresh = {known[word] for word in set(re.findall(r"[\w-]+", left.pop())) & known.keys()} - found
        found |= fresh
        left += [path.read_text(encoding="utf-8") for path in fresh]
    return frozenset(path.relative_to(root) for path in found)


def versions(root: Path = ROOT) -> str:
    """Pinned versions of what moves numbers."""
    lines = (root / "constraints.txt").read_text(encoding="utf-8").splitlines()
    return "\n".join(sorted(line for line in lines if line.partition("==")[0].lower() in PARTS))


def digest(files: Iterable[Path], root: Path = ROOT) -> str:
    """Digest of files by their meaning, and of their paths."""
    made = hashlib.sha256()
    for path in sorted(set(files)):
        made.update(f"{path.as_posix()}\0{_meaning(root / path, _stamp(root / path))}\0".encode())
    return made.hexdigest()[:16]


def of_text(text: str) -> str:
    """Digest of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@cache
def _meaning(path: Path, stamp: tuple[int, int]) -> str:
    text = path.read_bytes()
    if path.suffix != ".py":
        return hashlib.sha256(text).hexdigest()
    tree = ast.parse(text)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [one for one in body if not _is_text(one)]  # type: ignore[attr-defined]
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest()


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
