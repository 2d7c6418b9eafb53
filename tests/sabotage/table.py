"""The tables of docs/scenarios.md and docs/checking.md: which criteria catch which worse controller, and what
`surefoot check` says of everything that is broken.

    python tests/sabotage/table.py --criteria [SCENARIO]... > docs/results/criteria.csv
    python tests/sabotage/table.py --check [SCENARIO]... > docs/results/sabotage.csv

`python docs/reference.py` then puts them onto the pages.
"""

import argparse
import csv
import re
import sys
import tempfile
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from controllers import SABOTAGES
from sabotages import ALL

import surefoot
from surefoot.scenarios.catalogue import CONTROLS, OURS, OWN
from surefoot.scenarios.check.baseline import read_baseline
from surefoot.scenarios.check.check import cases, run_case
from surefoot.scenarios.check.report import lines_of
from surefoot.scenarios.record.provenance import relevant_versions

MAKEFILE = Path(__file__).parents[2] / "Makefile"


def caught_by(name: str, sabotage: str) -> str:
    """The criteria that a run with a worse controller misses, or a dash."""
    with tempfile.TemporaryDirectory() as folder:
        parts = surefoot.Parts(controller=SABOTAGES[sabotage])
        reasons = surefoot.run(name, out=Path(folder), parts=parts).verdict.reasons
    missed = dict.fromkeys(reason.partition(" ")[0].partition("[")[0] for reason in reasons)
    first = ", ".join(f"`{criterion}`" for criterion in list(missed)[:2])
    return f"{first}, {len(missed) - 2} more" if len(missed) > 2 else first or "-"


def criteria_table(names: Sequence[str]) -> None:
    """Print which criteria each worse controller misses in each scenario."""
    cells = [(name, sabotage) for name in names for sabotage in SABOTAGES]
    with ProcessPoolExecutor(2) as pool:
        found = dict(zip(cells, pool.map(caught_by, *zip(*cells, strict=True)), strict=True))
    rows = ([f"`{name}`", *(found[name, sabotage] for sabotage in SABOTAGES)] for name in names)
    printed("--criteria", ("scenario", *SABOTAGES), rows)


def of_make_check() -> list[str]:
    """The scenarios of `make check`."""
    (line,) = re.findall(r"surefoot check (control.*)", MAKEFILE.read_text(encoding="utf-8"))
    return str(line).split()


def short_first(names: Sequence[str]) -> list[str]:
    """In the order in which they are likely to catch something soon: controls, those of `make check`, the shortest."""
    order = {name: index for index, name in enumerate((*CONTROLS, *of_make_check()))}
    length = {case.reference: read_baseline(case.baseline).metrics["duration"] for case in cases(names)}
    return sorted(names, key=lambda name: (order.get(name, len(order)), length[name]))


def first_that_catches(sabotage: str, names: Sequence[str]) -> str:
    """The first of some scenarios that `surefoot check` does not let pass, with what it says of it; or a dash."""
    for case in cases(names):
        with ALL[sabotage].at_work(), tempfile.TemporaryDirectory() as folder:
            checked = run_case(case, Path(folder))
            if not checked.passed:
                said = lines_of(checked)[0].removeprefix("parts first: ").replace("|", "\\|")
                return f"`{case.reference}` {checked.status}: {said}"
    return "-"


def check_table(names: Sequence[str]) -> None:
    """Print what `surefoot check` says of everything that is broken."""
    everything = short_first(names)
    some = [name for name in everything if name in of_make_check()]
    rows = []
    for sabotage in ALL:
        by_some = first_that_catches(sabotage, some)
        by_all = by_some if everything[: len(some)] == some else "-"
        by_all = first_that_catches(sabotage, everything) if by_all == "-" else by_all
        rows.append((sabotage, by_all, "the same" if by_some == by_all != "-" else by_some))
    printed("--check", ("broken", "caught by the whole", "by `make check`"), rows)


def printed(option: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table as docs/results keeps it."""
    code = relevant_versions()
    print(f"# python tests/sabotage/table.py {option}")
    print(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}")
    csv.writer(sys.stdout, lineterminator="\n").writerows([head, *rows])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--criteria", action="store_true")
    which.add_argument("--check", action="store_true")
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO")
    told = parser.parse_args()
    if told.criteria:
        criteria_table(told.scenarios or list(OWN))
    else:
        check_table(told.scenarios or list(OURS))


if __name__ == "__main__":
    main()
