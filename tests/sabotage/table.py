"""The table of docs/scenarios.md that says which criteria catch which worse controller.

python tests/sabotage/table.py [SCENARIO]...
"""

import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from controllers import SABOTAGES

import surefoot
from surefoot.scenarios.catalogue import OWN


def caught_by(name: str, sabotage: str) -> str:
    """The criteria that a run with a worse controller misses, or a dash."""
    with tempfile.TemporaryDirectory() as folder:
        parts = surefoot.Parts(controller=SABOTAGES[sabotage])
        reasons = surefoot.run(name, out=Path(folder), parts=parts).verdict.reasons
    missed = dict.fromkeys(reason.partition(" ")[0].partition("[")[0] for reason in reasons)
    first = ", ".join(f"`{criterion}`" for criterion in list(missed)[:2])
    return f"{first}, {len(missed) - 2} more" if len(missed) > 2 else first or "-"


def main() -> None:
    names = sys.argv[1:] or list(OWN)
    print("| scenario | " + " | ".join(SABOTAGES) + " |")
    print("|---" * (1 + len(SABOTAGES)) + "|")
    cells = [(name, sabotage) for name in names for sabotage in SABOTAGES]
    with ProcessPoolExecutor(2) as pool:
        found = dict(zip(cells, pool.map(caught_by, *zip(*cells, strict=True)), strict=True))
    for name in names:
        print(f"| `{name}` | " + " | ".join(found[name, sabotage] for sabotage in SABOTAGES) + " |")


if __name__ == "__main__":
    main()
