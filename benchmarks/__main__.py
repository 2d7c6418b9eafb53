"""Measures what Surefoot costs on this machine.

    python -m benchmarks [SECTION ...] [--json FILE] [--append] [--quick]

Run it on an idle machine with OMP_NUM_THREADS=1. Without a section it measures all, in about ten minutes.
"""

import argparse
import json
import platform
import sys
from pathlib import Path

from benchmarks import counts, history, log, memory, plan, scaling, solvers, startup, tick
from benchmarks.table import Measure

SECTIONS: dict[str, Measure] = {
    "tick": tick.parts,
    "deadlines": tick.deadlines,
    "plan": plan.profiles,
    "adaptation": plan.adaptation,
    "counts": counts.counts,
    "startup": startup.startup,
    "runs": scaling.runs,
    "steps": scaling.steps,
    "robots": scaling.robots,
    "cores": scaling.cores,
    "solvers": solvers.solvers,
    "log": log.reading,
    "memory": memory.reading,
}


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=", ".join(SECTIONS))
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="also write all numbers to this file, - for the screen"
    )
    parser.add_argument("--append", action="store_true", help=f"add the ratios to {history.FILE.name}, with the commit")
    parser.add_argument(
        "--quick", action="store_true", help="little work, to see that it runs: the numbers mean nothing"
    )
    asked = parser.parse_args()
    unknown = set(asked.sections) - set(SECTIONS)
    if unknown:
        parser.error(f"no section {', '.join(sorted(unknown))}; there are {', '.join(SECTIONS)}")
    if asked.quick and asked.append:
        parser.error("--quick measures nothing that could be kept")
    found, ratios = {}, {}
    for name in asked.sections or SECTIONS:
        section = SECTIONS[name](asked.quick)
        found[name] = section.to_json()
        ratios |= section.ratios
        print(section.text(), file=sys.stderr if str(asked.json) == "-" else sys.stdout, flush=True)
    if asked.json:
        machine = {"python": platform.python_version(), "machine": f"{platform.system()} {platform.machine()}"}
        text = json.dumps({"machine": machine, "sections": found}, indent=2) + "\n"
        sys.stdout.write(text) if str(asked.json) == "-" else asked.json.write_text(text)
    if asked.append:
        history.append(ratios)


if __name__ == "__main__":
    main()
