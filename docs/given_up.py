"""After how many plans on end a fall may be announced, and after how many it is taken back.

    python docs/given_up.py --out runs/given-up

It pushes walks at random (docs/campaigns/given-up.yaml) and rides tours of G1, all with joints that never give way. So
it shows which robots would have been given up and walked on. docs/results/given-up.csv keeps the counts.
"""

import argparse
import csv
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.parameters import RecoveryParameters
from surefoot.planner.recovery.falling import counted, falling
from surefoot.planner.types import Balance
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import RunConstants, relevant_versions
from surefoot.similarity import Similarity
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.sweep import sweep
from surefoot.studies.tour.ride import Ride
from surefoot.studies.tour.rows import ROWS
from surefoot.studies.tour.rules import DURATION

FOLDER = Path(__file__).parent
KEPT = FOLDER / "results" / "given-up.csv"
COUNTS = tuple((tell, back) for back in (1, 5) for tell in (1, 2, 3, 4, 5, 6, 8))
"""Plans on end that tell a fall, and that take it back."""

LOW = 0.5
"""Height of the pelvis of a tour below which G1 has fallen [m]."""

SOON = 1.0
"""A fall that was taken back so shortly before it came was announced rightly [s]."""


class Watched(NamedTuple):
    """A walk whose joints never give way.

    Attributes:
        kind: pushes or tours.
        time: of its plans [s].
        margin: of each, steps moved [m].
        fall: when it fell, None where it did not [s].
        size: of the robot.
    """

    kind: str
    time: NDArray[np.float64]
    margin: NDArray[np.float64]
    fall: float | None
    size: Similarity


class Warnings(NamedTuple):
    """The warnings of walks of a kind, by some counts.

    Attributes:
        kind: of walk.
        tell: plans on end that tell a fall.
        back: that take it back.
        walked: walks that did not fall.
        wrong: falls that were announced of these, or more than a second before one was taken back.
        falls: walks that fell.
        told: of these, those whose fall was announced when it came.
        early: of these, announced at least 0.2 s before.
        lost: falls that were announced, and taken back in the last second before they came.
    """

    kind: str
    tell: int
    back: int
    walked: int
    wrong: int
    falls: int
    warnings_of: int
    early: int
    lost: int


def pushed(folder: Path, jobs: int) -> Iterator[Watched]:
    """Walks that are pushed at random."""
    spec = read_campaign(str(FOLDER / "campaigns" / "given-up.yaml"))
    for _, record in sweep(spec, folder, jobs).runs:
        log = read(folder / record.log)
        plan, size = log["/plan"], RunConstants.from_metadata(log.metadata, record.log).similarity
        yield Watched("pushes", plan.time, plan.field("capture_margin")[:, 1], record.metrics["fall_time"], size)


def toured(seed: int) -> Watched:
    """A tour of the row `torque`."""
    ride, plans, height = Ride(ROWS["torque"], seed), {}, []
    while len(height) < round(DURATION * ride.entrant.rate) and (not height or height[-1] >= 0.2):
        ride.step()
        plan = ride.walker.controller.planning.plan
        plans[plan.time] = plan.balance.movable
        height.append(float(ride.world.pelvis[2]))
    upright = np.flatnonzero(np.array(height) > LOW)[-1] + 1
    fall = None if upright == len(height) else upright / ride.entrant.rate
    return Watched("tours", np.array([*plans]), np.array([*plans.values()]), fall, ride.walker.controller.walk.size)


def spells(walk: Watched, numbers: RecoveryParameters) -> list[tuple[float, float]]:
    """Begin and end of the time in which a fall is announced; infinite where it is announced to the end [s]."""
    balance, said, found = Balance(), False, []
    for time, margin in zip(walk.time, walk.margin, strict=True):
        if walk.fall is not None and time > walk.fall:
            break
        lost, safe = counted(balance, margin, numbers)
        balance = replace(balance, lost=lost, safe=safe)
        now = falling(balance, said, numbers)
        if now and not said:
            found.append((float(time), np.inf))
        elif said and not now:
            found[-1] = (found[-1][0], float(time))
        said = now
    return found


def warnings_of(walks: Sequence[Watched], kind: str, tell: int, back: int) -> Warnings:
    """Count the warnings of walks of a kind."""
    wrong, lost, fell = 0, 0, 0
    leads = []
    of_kind = [walk for walk in walks if walk.kind == kind]
    for walk in of_kind:
        numbers = replace(walk.size.scaled(RecoveryParameters()), fall_plans=tell, regained_plans=back)
        found = spells(walk, numbers)
        if walk.fall is None:
            wrong += len(found)
            continue
        fell += 1
        ended = [walk.fall - end for _, end in found if end < np.inf]
        wrong += sum(before > SOON for before in ended)
        lost += sum(before <= SOON for before in ended)
        leads += [walk.fall - begin for begin, end in found if end == np.inf]
    early = sum(lead >= 0.2 for lead in leads)
    return Warnings(kind, tell, back, len(of_kind) - fell, wrong, fell, len(leads), early, lost)


def main() -> int:
    """Run it, print and keep the counts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("runs/given-up"), help="folder of the campaign")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once")
    parser.add_argument("--tours", type=int, default=12, help="tours of G1")
    given = parser.parse_args()
    walks = [*pushed(given.out, given.jobs), *map(toured, range(given.tours))]
    found = [warnings_of(walks, kind, *counts) for kind in ("pushes", "tours") for counts in COUNTS]
    code = relevant_versions()
    with KEPT.open("w", newline="", encoding="utf-8") as file:
        file.write("# python docs/given_up.py\n")
        file.write(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(Warnings._fields)
        writer.writerows(found)
    print(KEPT.read_text(encoding="utf-8"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
