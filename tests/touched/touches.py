"""The map: which test modules run which function, read which file, and how long they take.

`survey.py` makes it by watching the tests. It is allowed to be old. A file that it does not know has the tests of the
folder that mirrors its own and those that name it. A function that it does not know has those of its file. Tests that
moved keep their names. A test module that was never watched is taken to touch what its folder mirrors, and modules that
it names.
"""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from edited import MODULE, Edit

MAP = Path(__file__).with_name("map.json")

READ = "<read>"
"""Stands for reading a file as text or data, which also tests of sources and pages do."""


@dataclass(frozen=True)
class Touches:
    """The map.

    Attributes:
        commit: that was watched.
        seconds: processor time of each test module, by its path.
        files: of each file of the repository, by its path: test modules that run a function of it, by the function's
            qualified name, and under `READ` those that read it.
    """

    commit: str
    seconds: Mapping[str, float]
    files: Mapping[str, Mapping[str, frozenset[str]]]

    def of(self, edit: Edit, root: Path, near: frozenset[str]) -> frozenset[str]:
        """Test modules that an edit touches, those near its file among them; empty where nothing is known of it."""
        if is_test(edit.path):
            return frozenset({edit.path} if (root / edit.path).exists() else ())
        known = self.entries(edit, root)
        found = self._there((test for name in _names(edit, known) for test in known.get(name, ())), root)
        if known and not edit.functions and edit.functions is not None:
            return found  # words alone: whoever reads them
        return found | {test for test in near if self.time(test) is None} if found else near

    def entries(self, edit: Edit, root: Path) -> Mapping[str, frozenset[str]]:
        """Entries that are known of the file of an edit, under its path now or before, and under one that it had once.

        A map that is made anew in part has both.
        """
        paths = [path for path in (edit.path, edit.before) if path]
        sources = [one for path in paths for one in (path, str(PurePosixPath(path).with_suffix(".py")))]
        known = [self.files[one] for one in sources if one in self.files][:1]
        name = PurePosixPath(edit.path).name
        moved = [path for path in self.files if PurePosixPath(path).name == name and not (root / path).exists()]
        known += [self.files[moved[0]]] if len(moved) == 1 else []
        names = {name for entries in known for name in entries}
        return {name: frozenset().union(*(entries.get(name, ()) for entries in known)) for name in names}

    def _there(self, found: Iterable[str], root: Path) -> frozenset[str]:
        """Tests that exist, under the path of now: names of test modules are unique."""
        tests = frozenset(found)
        gone = {PurePosixPath(test).name for test in tests if not (root / test).exists()}
        moved = {str(path.relative_to(root).as_posix()) for name in gone for path in (root / "tests").rglob(name)}
        return frozenset(test for test in tests if (root / test).exists()) | moved

    def time(self, test: str) -> float | None:
        """Processor time of a test module [s]; None where it was not watched."""
        name = PurePosixPath(test).name
        return next((took for path, took in self.seconds.items() if PurePosixPath(path).name == name), None)


def _names(edit: Edit, known: Mapping[str, frozenset[str]]) -> set[str]:
    """Entries of a file's map that an edit concerns."""
    functions = edit.functions
    if functions is None or MODULE in functions or not functions <= known.keys():
        return set(known)
    return {*functions, READ}


def is_test(path: str) -> bool:
    """True if a path is that of a test module."""
    pure = PurePosixPath(path)
    return pure.parts[0] == "tests" and pure.name.startswith("test_") and pure.suffix == ".py"


def mirrored(path: str, root: Path) -> frozenset[str]:
    """Test modules of the folder that mirrors that of a file: the innermost that there is, below `tests` itself."""
    folder = PurePosixPath(path).parent
    if folder.parts[:1] == ("tests",):
        folder = folder.relative_to("tests")
    for one in (folder, *folder.parents):
        place = root / "tests" / one
        if one.parts and place.is_dir():
            return frozenset(str(test.relative_to(root).as_posix()) for test in place.rglob("test_*.py"))
    return frozenset()


def named(path: str, root: Path) -> frozenset[str]:
    """Test modules that import from a module of the package, by its dotted name."""
    words = PurePosixPath(path).with_suffix("").parts
    dotted = ".".join(words if words[0] == "surefoot" else ("surefoot", *words))
    package = re.escape(dotted.rpartition(".")[0])
    whole = rf"(from|import) {re.escape(dotted)}\b(?!\.)"
    imports = re.compile(rf"{whole}|from {package} import [^#\n]*\b{words[-1]}\b")
    texts = ((test, test.read_text(encoding="utf-8")) for test in (root / "tests").rglob("test_*.py"))
    return frozenset(test.relative_to(root).as_posix() for test, text in texts if imports.search(text))


def read(path: Path = MAP) -> Touches:
    """The map that is kept; one that knows nothing where there is none."""
    if not path.exists():
        return Touches("", {}, {})
    kept = json.loads(path.read_text(encoding="utf-8"))
    tests = list(kept["seconds"])
    files = {
        file: {name: frozenset(tests[index] for index in which) for which, names in groups for name in names}
        for file, groups in kept["files"].items()
    }
    return Touches(kept["commit"], kept["seconds"], files)


def write(touches: Touches, path: Path = MAP) -> None:
    """Keep a map: a line for each file, in which functions with the same tests stand together."""
    place = {test: index for index, test in enumerate(sorted(touches.seconds))}
    seconds = {test: touches.seconds[test] for test in place}
    rows = []
    for file in sorted(touches.files):
        groups: dict[tuple[int, ...], list[str]] = {}
        for name, tests in sorted(touches.files[file].items()):
            groups.setdefault(tuple(sorted(place[test] for test in tests)), []).append(name)
        told = json.dumps([[list(which), names] for which, names in groups.items()], separators=(",", ":"))
        rows.append(f"{json.dumps(file)}:{told}")
    head = f'"commit":{json.dumps(touches.commit)},\n"seconds":{json.dumps(seconds, indent=0)},\n"files":{{\n'
    path.write_text("{" + head + ",\n".join(rows) + "\n}}\n", encoding="utf-8")
