"""The packages that bring parts of a run: their versions, and digests of their code as it is on the disk."""

import ast
import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import metadata
from importlib.metadata import Distribution, EntryPoint, PackageNotFoundError
from importlib.util import find_spec
from modulefinder import ModuleFinder
from pathlib import Path

from surefoot.parts.plugins import OWN_PACKAGE

GROUPS = f"{OWN_PACKAGE}."
EVERYWHERE = f"{GROUPS}metrics"
"""Group of what is in every run, whether a scenario names it or not."""

NO_PARTS = (f"{GROUPS}commands", f"{GROUPS}files")
"""Groups of what a run has no part of."""

_PASSED_OVER = ("__pycache__", ".dist-info", ".egg-info", ".pyc")


@cache
def packages_of(names: frozenset[str]) -> Mapping[str, str]:
    """Versions and code of the packages that bring parts of these names, or metrics, and of what they require.

    Code is that of packages that bring a part, and of others that are installed in place, such as with ``pip install
    -e``; of all else the version says enough. Asked once: what has been loaded stays the same however long the process
    goes on.
    """
    bringing: dict[str, set[str]] = {}
    for by, entry in _entries():
        if entry.group == EVERYWHERE or entry.name in names:
            bringing.setdefault(by, set()).add(re.split(r"[.:]", entry.value)[0].strip())
    found = {}
    for name, package in _with_required(bringing):
        found[name] = package.version
        if name in bringing or not _is_copied(package):
            code = _code(package, bringing.get(name, set()) | _own(package))
            found[name] += f" {_digest(code)}"
    return found


def _entries() -> Iterator[tuple[str, EntryPoint]]:
    """All parts that packages bring, with their names."""
    for package in metadata.distributions():
        points = (entry for entry in package.entry_points if entry.group.startswith(GROUPS))
        yield from ((_canonical(package.name), entry) for entry in points if entry.group not in NO_PARTS)


def _with_required(names: Iterable[str]) -> Iterator[tuple[str, Distribution]]:
    """Packages and all that they require, but for Surefoot, as far as they are installed."""
    waiting, seen = list(names), {OWN_PACKAGE}
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        try:
            package = metadata.distribution(name)
        except PackageNotFoundError:  # of another platform, or an extra that nobody has asked for
            continue
        yield name, package
        required = (re.match(r"[\w.-]+", requirement) for requirement in package.requires or ())
        waiting += [_canonical(one[0]) for one in required if one is not None]


def _is_copied(package: Distribution) -> bool:
    """Return true if the installer has copied the code, so that the version identifies it."""
    return any(file.suffix in (".py", ".so", ".pyd") for file in package.files or ())


def _own(package: Distribution) -> set[str]:
    """Names of the modules that a package consists of, as far as it says them."""
    return set((package.read_text("top_level.txt") or package.name.replace("-", "_")).split())


def _code(package: Distribution, modules: Iterable[str]) -> dict[str, Path]:
    """Files of a package: those that were copied, and those of its modules, wherever they are."""
    files = {file.as_posix(): Path(str(file.locate())) for file in package.files or ()}
    for module in modules:
        files |= _module(module)
    return files


def _module(name: str) -> dict[str, Path]:
    """Files of a package of modules, or of one module with those beside it that it imports."""
    try:
        spec = find_spec(name)
    except (ImportError, ValueError):
        return {}
    if spec is None:
        return {}
    if spec.submodule_search_locations is None:
        return _imported(Path(spec.origin)) if spec.has_location and spec.origin else {}
    folders = map(Path, spec.submodule_search_locations)
    return {f"{name}/{file.relative_to(folder).as_posix()}": file for folder in folders for file in folder.rglob("*")}


def _imported(module: Path) -> dict[str, Path]:
    """A module, and all of its folder that it imports or names in a text of its own; nothing is executed."""
    folder, found, waiting = module.parent, {module}, [module]
    while waiting:
        new = {file for file in _beside(waiting.pop()) if file.is_file()} - found
        found |= new
        waiting += [file for file in new if file.suffix == ".py"]
    return {file.relative_to(folder).as_posix(): file for file in found}


def _beside(module: Path) -> Iterator[Path]:
    """Files of a module's folder that it imports, and those that its texts name: data, and modules found by name."""
    finder = ModuleFinder([str(module.parent)], excludes=[OWN_PACKAGE])
    try:
        finder.run_script(str(module))
        texts = [node.value for node in ast.walk(ast.parse(module.read_bytes())) if isinstance(node, ast.Constant)]
    except (SyntaxError, ValueError, OSError):
        return
    yield from (Path(file) for one in finder.modules.values() if (file := getattr(one, "__file__", None)))
    for text in texts:
        if isinstance(text, str) and re.fullmatch(r"[\w./-]{1,200}", text) and ".." not in text:
            yield module.parent / text.lstrip("/")
            yield module.parent / f"{text.replace('.', '/')}.py"


def _digest(files: Mapping[str, Path]) -> str:
    """Digest of the content of files; of what Python writes itself, or the installer, nothing is in it."""
    digest = hashlib.sha256()
    for name, path in sorted(files.items()):
        hidden = any(part.startswith(".") and part != ".." for part in name.split("/"))
        if not hidden and not any(part.endswith(_PASSED_OVER) for part in name.split("/")) and path.is_file():
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def _canonical(name: str) -> str:
    """A package's name as all spellings of it are written alike."""
    return re.sub(r"[-_.]+", "-", name).lower()
