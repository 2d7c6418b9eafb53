"""Make the map of `touches`: watch each test module run, in a clone whose compiled modules tell of their calls.

    python tests/touched/survey.py [TEST_MODULE...] [--missing]

With test modules only their part of the map is made anew, with `--missing` that of modules that the map does not know.
The map is written after each, so that a survey that was interrupted can be gone on with. Each module runs in a process
of its own, forked from one that has imported the code: none finds what another has cached. It needs a C compiler.
"""

import argparse
import gc
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import redirect_stdout
from functools import cache
from importlib import import_module
from pathlib import Path

import edited
import touches
import witness

ROOT = Path(__file__).parents[2]
CLONE = ROOT / "build" / "survey"
CODE = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")

FIRST = "first.json"
"""Written by the process of a test module itself; those that it starts write files by their numbers."""

BUILD = """
import ctypes, os, sys
sys.orig_argv.append("surefoot.native")  # nothing is compiled at import
from surefoot.native import modules
late = modules.stale()
modules.ARRAYS = modules.OTHERS = "-O1"
modules.DIRECTIVES["profile"] = "True"
modules.build(late)
del modules.DIRECTIVES["profile"]
# Cython 3.3 leaves out a function of its own in some modules that it compiles so: these tell of no calls.
silent = []
for name in late:
    try:
        ctypes.CDLL(str(modules.ROOT / modules.target(modules.sources()[name])), os.RTLD_NOW)
    except OSError:
        silent.append(name)
modules.build(silent)
# Imports are to find nothing stale.
modules.STAMP.write_text(modules.json.dumps({"made": modules.made(), **modules.digests()}))
"""
"""Compiles the modules of a clone so that each call is told to the hook of `sys.setprofile`."""

PYTEST = (
    "-q",
    "-p",
    "no:cacheprovider",
    "-p",
    "no:xdist",
    "-p",
    "no:pytest_cov",
    "-m",
    "unit and not physics and not long",
)


def clone() -> str:
    """Make the clone of the present commit, or bring it there, and compile it; the commit is returned."""
    if not CLONE.exists():
        subprocess.run(["git", "clone", "--quiet", ROOT, CLONE], check=True)
    commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    subprocess.run(["git", "fetch", "--quiet", "origin"], cwd=CLONE, check=True)
    subprocess.run(["git", "checkout", "--quiet", "--detach", commit.strip()], cwd=CLONE, check=True)
    compiler = f"{os.environ.get('CC', 'cc')} -DCYTHON_TRACE_NOGIL=1"
    subprocess.run([sys.executable, "-c", BUILD], cwd=CLONE, check=True, env=_environment(CC=compiler))
    subprocess.run([sys.executable, "-m", "compileall", "-q", *CODE], cwd=CLONE, check=True, stdout=subprocess.DEVNULL)
    return commit.strip()


def _environment(**more: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(CLONE), "OMP_NUM_THREADS": "1", **more}


def watch(tests: list[str], folder: Path) -> Iterator[tuple[str, float, list[Path]]]:
    """Run test modules one by one: processor time [s], and the files that its processes wrote.

    This process is one of the clone.
    """
    import pytest

    for path in sorted(Path("surefoot").rglob("*.py")):
        if path.name != "__main__.py":
            _imported(".".join(path.with_suffix("").parts).removesuffix(".__init__"))
    _imported("hypothesis.internal.observability")  # its plug-in does in each session
    with redirect_stdout(sys.stderr):
        pytest.main(["--version"])  # so that its plug-ins are imported, too
    gc.freeze()
    for number, test in enumerate(tests):
        place = folder / str(number)
        place.mkdir()
        os.environ[witness.PLACE] = str(place)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        child = os.fork()
        if child == 0:
            with (place / "output.txt").open("w") as output:
                os.dup2(output.fileno(), 1)
                os.dup2(output.fileno(), 2)
            _run(test, place / FIRST)
            os._exit(0)
        os.waitpid(child, 0)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        yield test, round(took, 2), sorted(place.glob("*.json"))


def _run(test: str, path: Path) -> None:
    """Run a test module, watched from its collection on; nothing is written of one that does not pass."""
    import pytest

    class Watcher:
        seen: witness.Witness | None = None

        @pytest.hookimpl(tryfirst=True)
        def pytest_collection(self) -> None:
            self.seen = witness.Witness()

    watcher = Watcher()
    code = pytest.main([*PYTEST, test], plugins=[watcher])
    if watcher.seen is not None and code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        watcher.seen.write(path)


def _imported(name: str) -> None:
    try:
        import_module(name)
    except Exception as error:  # an extra that is not installed
        print(f"{name} is not imported: {error}", file=sys.stderr)


@cache
def _lines(path: Path) -> list[tuple[range, str]]:
    return edited.lines(path.read_text(encoding="utf-8"))


@cache
def _path(name: str) -> Path | None:
    """A file of the clone, relative to it, without the links of the package."""
    path = (CLONE / name).resolve()
    return path.relative_to(CLONE) if path.is_relative_to(CLONE) and path.is_file() else None


def touched(test: str, told: Mapping[str, list]) -> Iterator[tuple[str, str]]:
    """Each file of the repository with a function that was run, or with `touches.READ`."""
    for name, line in told["ran"]:
        path = _path(name)
        if path is None or path.suffix != ".py" or str(path) == test:
            continue
        function = next((function for lines, function in _lines(CLONE / path) if line in lines), None)
        if function is not None:
            yield path.as_posix(), function
    for name in told["read"]:
        path = _path(name)
        if path is not None and "__pycache__" not in path.parts and path.parts[0] not in (".git", "build", "runs"):
            yield path.as_posix(), touches.READ


def surveyed(known: touches.Touches, commit: str, tests: list[str]) -> Iterator[tuple[str, touches.Touches]]:
    """Each test module with the map after it; what was known of it before is dropped."""
    seconds = {test: took for test, took in known.seconds.items() if test not in tests}
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for file, functions in known.files.items():
        for name, which in functions.items():
            found[file][name] |= which & seconds.keys()
    with tempfile.TemporaryDirectory() as folder:
        for test, took, written in _watched(tests, Path(folder)):
            if not any(Path(path).name == FIRST for path in written):
                print(f"{test} does not pass here, and stays unknown", flush=True)
                yield test, touches.Touches(commit, dict(seconds), _frozen(found))
                continue
            seconds[test] = took
            for path in map(Path, written):
                for file, function in touched(test, json.loads(path.read_text(encoding="utf-8"))):
                    found[file][function].add(test)
            yield test, touches.Touches(commit, dict(seconds), _frozen(found))


def _frozen(found: Mapping[str, Mapping[str, set[str]]]) -> dict[str, dict[str, frozenset[str]]]:
    made = {
        file: {name: frozenset(which) for name, which in functions.items() if which}
        for file, functions in found.items()
    }
    return {file: functions for file, functions in made.items() if functions}


def _watched(tests: list[str], folder: Path) -> Iterator[tuple[str, float, list[str]]]:
    """Answer of `watch`, by a process of the clone."""
    site = folder / "site"
    site.mkdir()
    shutil.copy(witness.__file__, site)
    (site / "sitecustomize.py").write_text("import witness\n\nwitness.begin()\n", encoding="utf-8")
    environment = _environment(PYTHONPATH=f"{site}{os.pathsep}{CLONE}")
    command = [sys.executable, __file__, "--in-clone", str(folder), *tests]
    with subprocess.Popen(command, cwd=CLONE, env=environment, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        for row in running.stdout:
            yield tuple(json.loads(row))
    if running.returncode:
        raise SystemExit(f"the tests were not watched to the end: exit code {running.returncode}")


def main() -> None:
    """Make the map, or a part of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tests", nargs="*", help="paths of test modules; by default all")
    parser.add_argument("--missing", action="store_true", help="of these only those that the map does not know")
    parser.add_argument("--in-clone", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.in_clone:
        for test, took, written in watch(options.tests, options.in_clone):
            print(json.dumps([test, took, list(map(str, written))]), flush=True)
        return
    commit, known = clone(), touches.read()
    tests = options.tests or sorted(str(path.relative_to(CLONE)) for path in (CLONE / "tests").rglob("test_*.py"))
    if options.missing:
        tests = [test for test in tests if known.time(test) is None]
    elif not options.tests:
        known = touches.Touches(commit, {}, {})
    for number, (test, now) in enumerate(surveyed(known, commit, tests), 1):
        touches.write(now)
        print(f"{number} of {len(tests)}: {test}, {now.seconds.get(test)} s", flush=True)


if __name__ == "__main__":
    main()
