"""Cost of a command before it does anything: the modules that it imports, and its processor time."""

import json
import os
import resource
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.table import Section

COMMANDS: dict[str, tuple[str, ...]] = {
    "--help": ("--help",),
    "list": ("list",),
    "list --json": ("list", "--json"),
    "show walk": ("show", "walk"),
    "schema": ("schema",),
    "run diagonal-walk": ("run", "diagonal-walk", "--set", "duration=0.02"),
}
"""Commands by what they are called in tables; the run is cut to ten control ticks."""

_TELL = """
import json, runpy, sys
sys.argv[1:] = sys.argv[2:]
try:
    runpy.run_module("surefoot", run_name="__main__", alter_sys=True)
finally:
    with open({path!r}, "w") as file:
        json.dump(sorted(sys.modules), file)
"""


def imported(words: Sequence[str]) -> list[str]:
    """Names of the modules that a command has imported at its end, if what it keeps in the cache folder is there."""
    with TemporaryDirectory() as folder:
        listed = Path(folder, "modules.json")
        code = _TELL.format(path=str(listed))
        for _ in range(2):
            _run(["-c", code, "surefoot", *words], folder)
        return list(json.loads(listed.read_text()))


def processor_time(words: Sequence[str], tries: int) -> float:
    """User and system time of a command, the least of some tries [s]."""
    spent = []
    with TemporaryDirectory() as folder:
        for _ in range(tries):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            _run(["-m", "surefoot", *words], folder)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(spent)


def _run(words: Sequence[str], folder: str) -> None:
    """Python with these words, in a folder of its own that gets what a run writes; its exit code is a verdict."""
    root = str(Path(__file__).parents[1])
    path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr)


def startup(quick: bool) -> Section:
    """Measure what each command costs before it does anything."""
    rows = []
    for name, words in COMMANDS.items():
        modules = imported(words)
        own = sum(module.partition(".")[0] == "surefoot" for module in modules)
        rows.append((name, processor_time(words, 1 if quick else 5), len(modules), own))
    help_, listed = rows[0][1], rows[1][1]
    columns = ("command", "processor s", "modules", "of surefoot")
    return Section("start-up", columns, tuple(rows), "the least of five", {"list over --help": listed / help_})
