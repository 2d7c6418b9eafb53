"""The rate at which the first line of `surefoot inspect` names the known cause of a fall.

    python docs/known_falls.py --out runs/known-falls

It runs the campaigns known-falls*.yaml of docs/campaigns, prints the first line of each fall, and keeps the result in
docs/results/known-falls.csv. Begun again, it goes on where it stopped. The first word of a case is its cause.
"""

import argparse
import csv
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.log import read
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.sweep import sweep

FOLDER = Path(__file__).parent
KEPT = FOLDER / "results" / "known-falls.csv"
CAMPAIGNS = ("known-falls", "known-falls-held-out", "known-falls-mixed")


class Fall(NamedTuple):
    """A fall of known cause, and what is said first of it.

    Attributes:
        campaign: that it is of.
        case: in words.
        cause: that is known.
        check: of the first line; empty of a run that did not fall.
        line: the first line itself.
    """

    campaign: str
    case: str
    cause: str
    check: str
    line: str

    @property
    def right(self) -> bool:
        """True if the first line names the cause."""
        return self.check == self.cause


def falls(campaign: str, folder: Path, jobs: int = 1) -> Iterator[Fall]:
    """Run a campaign, and say what stands first of each of its falls."""
    out = folder / campaign
    for point, record in sweep(read_campaign(str(FOLDER / "campaigns" / f"{campaign}.yaml")), out, jobs).runs:
        yield first_finding(campaign, str(point.labels["fall"]), out / record.log)


def first_finding(campaign: str, case: str, log: Path) -> Fall:
    """The first finding on a fall by its log."""
    found = inspect(read(log))
    first = next(one for one in found.health if one.check != "file")
    fell, cause = bool(found.verdict.metrics["fell"]), case.partition(",")[0].replace(" ", "_")
    return Fall(campaign, case, cause, first.check if fell else "", first.cause if fell else "")


def keep(found: Sequence[Fall], log: Path) -> None:
    """Keep the result, with the code that made a log of it."""
    code = read(log).metadata["versions"]
    with KEPT.open("w", newline="", encoding="utf-8") as file:
        file.write(
            f"# python docs/known_falls.py\n# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n"
        )
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow((*Fall._fields, "right"))
        writer.writerows((*fall, "yes" if fall.right else "no") for fall in found)


def rows() -> list[dict[str, str]]:
    """Rows of the result that is kept."""
    with KEPT.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("# ")))


def main() -> int:
    """Run the campaigns, print and keep what is found; exit code 1 where fewer than nine of ten lines are right."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("runs/known-falls"), help="folder of the campaigns")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once")
    given = parser.parse_args()
    every: list[Fall] = []
    for campaign in CAMPAIGNS:
        found = list(falls(campaign, given.out, given.jobs))
        for fall in found:
            print(f"{'right' if fall.right else 'WRONG'}  {fall.case}: {fall.check}: {fall.line}")
        print(f"{campaign}: the first line is right in {sum(fall.right for fall in found)} of {len(found)}")
        every += found
    keep(every, next(given.out.glob("*/logs/*/log.mcap")))
    return 0 if sum(fall.right for fall in every) >= 0.9 * len(every) else 1


if __name__ == "__main__":
    sys.exit(main())
