"""Write docs/catalogue.yaml: what the robots that come along make of the scenarios of the catalogue.

    python docs/catalogue.py [ROBOT]...

It is `surefoot robot check ROBOT --walk` for each, by default all, a minute or two each. `python docs/reference.py`
then makes the table of docs/robots.md of it.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml

FILE = Path(__file__).with_suffix(".yaml")
ROBOTS = ("talos", "g1", "jvrc1", "gr3", "alexander")
"""In the order of the table."""


def examined(robot: str) -> list[dict[str, Any]]:
    """Every scenario with what the robot makes of it, as `--json` tells it."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "surefoot", "robot", "check", robot, "--walk", "--json", "--jobs", "1"]
        done = subprocess.run([*command, "--out", folder], capture_output=True, text=True, check=False)
    if not done.stdout:
        sys.exit(done.stderr)
    return list(json.loads(done.stdout)["scenarios"])


def counted(scenarios: list[dict[str, Any]]) -> dict[str, list[str]]:
    """Names of scenarios by what became of them."""
    found: dict[str, list[str]] = {"met": [], "missed": [], "fell": [], "refused": []}
    for one in scenarios:
        fell = any(reason.startswith("fell ") for reason in one["why"])
        found[{"walks": "met", "refused": "refused"}.get(one["outcome"], "fell" if fell else "missed")].append(
            one["scenario"]
        )
    return found


def main() -> None:
    """Examine the robots that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help=", ".join(ROBOTS))
    known = yaml.safe_load(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    for robot in parser.parse_args().robots or ROBOTS:
        known[robot] = counted(examined(robot))
        FILE.write_text(yaml.safe_dump(known, sort_keys=False), encoding="utf-8")
        print(robot, {name: len(names) for name, names in known[robot].items()})


if __name__ == "__main__":
    main()
