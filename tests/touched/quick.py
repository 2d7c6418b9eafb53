"""Run the tests that a change touches, as many as fit into a minute, and say what is left to the gate.

    python tests/touched/quick.py [--base COMMIT] [--seconds 55] [--list]

The change is what differs from where the branch left `main`, with what is not committed. It passes only if tests ran
and passed; where nothing is known of a change it says so and fails.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from edited import Edit, edits
from touches import Touches, is_test, mirrored, named, read

ROOT = Path(__file__).parents[2]

STARTING = 9.0
"""Until the first test runs [s]."""

UNWATCHED = 2.0
"""Processor time that a test module is given that the map does not know [s]."""

DEAR = 0.1
"""Share of the time from which on a test module waits until the others have their place [-]."""

NOTHING_RAN = 2
"""Exit code where no test ran that the change touches."""


@dataclass(frozen=True)
class Choice:
    """Tests that a change touches.

    Attributes:
        runs: test modules that fit into the time, with their processor time [s].
        left: the others.
        unknown: files that changed and that no test is known to touch.
    """

    runs: Mapping[str, float]
    left: Mapping[str, float]
    unknown: tuple[str, ...]


def choose(changed: Iterable[Edit], known: Touches, root: Path, processor_time: float) -> Choice:
    """Changed tests come first, then those that name a changed module, those beside it, others; quick ones first.

    Of the others dear ones come last: in the time of one of them many quick ones run.
    """
    ranks: dict[str, int] = {}
    unknown = []
    for edit in changed:
        near = (frozenset(), named(edit.path, root), mirrored(edit.path, root))
        tests = known.of(edit, root, near[1] | near[2])
        if not tests:
            unknown.append(edit.path)
        for test in tests:
            rank = 0 if is_test(edit.path) else next((n for n, some in enumerate(near) if test in some), len(near))
            ranks[test] = min(ranks.get(test, rank), rank)
    times = {test: UNWATCHED if (took := known.time(test)) is None else took for test in ranks}
    runs: dict[str, float] = {}
    dear = {test for test, rank in ranks.items() if rank and times[test] > DEAR * processor_time}
    for test in sorted(ranks, key=lambda test: (test in dear, ranks[test], times[test], test)):
        if sum(runs.values()) + times[test] <= processor_time or (ranks[test] == 0 and not runs):
            runs[test] = times[test]
    return Choice(runs, {test: took for test, took in times.items() if test not in runs}, tuple(unknown))


def base_of(root: Path) -> str:
    """The commit where the branch left `main`; the present one on `main`, or without it."""
    for main in ("main", "origin/main"):
        done = subprocess.run(["git", "merge-base", "HEAD", main], cwd=root, capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout.strip()
    return "HEAD"


def told(choice: Choice, changed: list[Edit], base: str) -> list[str]:
    """Sentences on what runs and what is left to the gate."""
    cores = os.cpu_count() or 1
    wall = STARTING + sum(choice.runs.values()) / cores
    lines = [f"{len(changed)} files differ from {base[:8]}."]
    if choice.runs:
        lines.append(f"{len(choice.runs)} test modules that they touch run, in about {wall:.0f} s on {cores} cores.")
    if choice.left:
        slow = sorted(choice.left, key=lambda test: -choice.left[test])
        named = ", ".join(f"{test} ({choice.left[test]:.0f} s)" for test in slow[:5])
        more = f" and {len(slow) - 5} more" if len(slow) > 5 else ""
        lines.append(f"Left to `make test`: {len(slow)} test modules that they touch, {named}{more}.")
    if choice.unknown:
        lines.append(f"No unit test is known to touch {', '.join(choice.unknown)}.")
    return [*lines, "Lint, types and physics tests are left to `make test`."]


def main() -> int:
    """Choose, run and tell; the exit code is 0 only if tests ran and passed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--base", help="commit to compare with; by default where the branch left main")
    parser.add_argument("--seconds", type=float, default=55.0, help="that it may take on idle cores")
    parser.add_argument("--list", action="store_true", help="say what would run, and run nothing")
    options = parser.parse_args()
    base = options.base or base_of(ROOT)
    changed = edits(ROOT, base)
    if not changed:
        print(f"Nothing differs from {base[:8]}, so that nothing was tested; give --base COMMIT.")
        return NOTHING_RAN
    cores = os.cpu_count() or 1
    choice = choose(changed, read(), ROOT, (options.seconds - STARTING) * cores)
    summary = told(choice, changed, base)
    if options.list:
        print("\n".join([*summary, *sorted(choice.runs)]))
        return 0
    if not choice.runs:
        print("\n".join([*summary, "Nothing was tested."]))
        return NOTHING_RAN
    print(summary[1], flush=True)
    command = [sys.executable, "-m", "pytest", "-q", "-n", str(min(cores, len(choice.runs))), "--dist", "loadscope"]
    code = subprocess.run([*command, *sorted(choice.runs)], cwd=ROOT, check=False).returncode
    print("\n".join(summary))
    return code


if __name__ == "__main__":
    sys.exit(main())
