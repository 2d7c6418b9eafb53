"""Measures false alarms and power of `surefoot check --seeds`, and writes the table.

    python -m benchmarks.power [--jobs 2] [--out runs/power] [--result docs/results/power.csv]

Real runs with seeds of their own fill a pool, of the program as it is and of one with each change. A check is made of
what is drawn from the pool: a baseline, and the runs of today, look after look. Fresh: the two have no seed in
common. Paired: they have the same seeds. Replicas share runs, so that they are not independent.

A push margin of 5 % less is that of a robot that is pushed 5 % harder: a search over a range that is 5 % higher, whose
thresholds are told 5 % lower. Begun again, it goes on where it stopped.
"""

import argparse
import csv
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

from surefoot.scenarios.check.check import Case, cases
from surefoot.scenarios.check.findings import Asked, decided, findings
from surefoot.scenarios.check.sample import MARGIN, SeedSample
from surefoot.scenarios.check.sampled import FIRST, size_of
from surefoot.scenarios.check.seeds import SeedRuns
from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.many.journal import Journal
from surefoot.scenarios.many.slots import CampaignBar, run_cells, workers_of
from surefoot.scenarios.record.provenance import versions
from surefoot.scenarios.run.processes import cores

HERE = Path(__file__).parent
RESULT = HERE.parents[1] / "docs" / "results" / "power.csv"
SCENARIOS = ("walk", "turn", "push")
HEADS = (
    "changed",
    "seeds",
    "replicas",
    "alarms",
    "share [%]",
    "runs in the mean",
    "minutes of two cores, at most",
    "named most",
)

POOL, CHANGED, COUNT = 24, 12, 12
"""Runs of the program as it is, of one with a change, and seeds of a check."""

REPLICAS = 200
HARDER = 1.05

CHANGES: Mapping[str, tuple[str, ...]] = {
    "DCM gain 10 % less": ("wbc.balance.dcm=2.7",),
    "gyroscope twice as noisy": ("sensing.gyro_density=0.00034",),
}
"""Changes of a program that keys can make."""

MARGIN_LESS = "push margin 5 % less"


@dataclass(frozen=True, slots=True)
class Pool:
    """Runs of a scenario: of the program as it is, and of each change."""

    case: Case
    margins: Mapping[str, Bisect]
    unchanged: SeedSample
    changed: Mapping[str, SeedSample]
    minutes: float


def pool(name: str, folder: Path, jobs: int) -> Pool:
    """Fill the pool of a scenario."""
    (case,) = cases([str(HERE / f"{name}.yaml")])
    runs = SeedRuns.of(case, range(POOL))
    unchanged, minutes = made(runs, folder, jobs)
    changed = {}
    for change, overrides in CHANGES.items():
        (other,) = cases([str(HERE / f"{name}.yaml")], None, overrides)
        own = replace(other, scenario=other.scenario.model_copy(update={"margins": None}))
        changed[change] = made(SeedRuns.of(own, range(CHANGED)), folder, jobs)[0]
    if runs.margins:
        changed[MARGIN_LESS] = less(made(SeedRuns.of(harder(case), range(CHANGED)), folder, jobs)[0])
    return Pool(case, runs.margins, unchanged, changed, minutes)


def harder(case: Case) -> Case:
    """A case whose searches go over ranges of harder pushes."""
    margins = {
        name: one.model_copy(
            update={end: HARDER * getattr(one, end) for end in ("low", "high", "tolerance")},
        )
        for name, one in (case.scenario.margins or {}).items()
    }
    return replace(case, scenario=case.scenario.model_copy(update={"margins": margins}))


def less(sample: SeedSample) -> SeedSample:
    """A sample whose thresholds are told as much lower as the pushes were harder."""
    values = {
        name: tuple(float(one or 0.0) / HARDER for one in column) if name.startswith(MARGIN) else column
        for name, column in sample.values.items()
    }
    return replace(sample, values=values)


def made(runs: SeedRuns, folder: Path, jobs: int) -> tuple[SeedSample, float]:
    """Runs of seeds, made where the journal has none, and the minutes of two cores that one of them takes."""
    with Journal(folder) as journal:
        cells = list(runs.cells(len(runs.seeds)))
        with CampaignBar(len(cells), runs.case.scenario.name) as bar:
            run_cells(cells, journal, workers_of(folder, jobs, None, False), bar.run, bar.cell)
        found = runs.sampled(journal, len(runs.seeds))
    if isinstance(found, str):
        raise SystemExit(f"{runs.case.scenario.name}: {found}")
    return found.sample, found.took / (120.0 * len(runs.seeds))


@dataclass(frozen=True, slots=True)
class Replica:
    """A check that was drawn: the names of its alarms, and the runs and minutes that it took."""

    alarms: tuple[str, ...]
    runs: int
    minutes: float


def check(pools: Mapping[str, Pool], drawn: Mapping[str, tuple[SeedSample, SeedSample]]) -> Replica:
    """Hold today's runs of each scenario against its baseline, look after look, as `surefoot check --seeds` does."""
    alarms: list[str] = []
    runs, minutes = 0, 0.0
    for name, (before, now) in drawn.items():
        look, one = 0, pools[name]
        while True:
            look += 1
            size = size_of(look, len(now.seeds))
            asked = Asked(one.case.scenario.criteria, one.margins, len(pools), look)
            found = findings(before, now.at(now.seeds[:size]), asked)
            if decided(found) or size == len(now.seeds):
                break
        alarms += [f"{name}: {finding.name}" for finding in found if finding.verdict in ("worse", "moved")]
        runs, minutes = runs + size, minutes + size * one.minutes
    return Replica(tuple(alarms), runs, minutes)


def replicas(pools: Mapping[str, Pool], change: str, paired: bool, random: Random) -> Iterator[Replica]:
    """Checks of a program with a change; of none with an empty one."""
    for _ in range(REPLICAS):
        drawn = {}
        for name, one in pools.items():
            today = one.changed.get(change, one.unchanged)
            common = [seed for seed in today.seeds if seed in one.unchanged.seeds]
            now = random.sample(common, min(COUNT, len(common)))
            if paired:
                before = now
            else:
                rest = [seed for seed in one.unchanged.seeds if seed not in now]
                before = random.sample(rest, COUNT)
            drawn[name] = one.unchanged.at(before), today.at(now)
        yield check(pools, drawn)


def rows(pools: Mapping[str, Pool]) -> Iterator[dict[str, str]]:
    """Rows of the table."""
    random = Random(1)
    for change in ("", *CHANGES, MARGIN_LESS):
        for paired in (False, True):
            found = list(replicas(pools, change, paired, random))
            hit = [one for one in found if one.alarms]
            names = [alarm for one in hit for alarm in one.alarms]
            most = max(sorted(set(names)), key=names.count, default="")
            cells = (
                change or "nothing",
                "the same" if paired else "fresh",
                str(len(found)),
                str(len(hit)),
                f"{100 * len(hit) / len(found):.1f}",
                f"{sum(one.runs for one in found) / len(found):.0f}",
                f"{max(one.minutes for one in found):.1f}",
                most,
            )
            yield dict(zip(HEADS, cells, strict=True))


def main() -> None:
    """Fill the pools, draw, and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.power", description=__doc__)
    parser.add_argument("--jobs", type=int, default=cores())
    parser.add_argument("--out", type=Path, default=Path("runs/power"))
    parser.add_argument("--result", type=Path, default=RESULT)
    options = parser.parse_args()
    assert COUNT >= FIRST
    pools = {name: pool(name, options.out, options.jobs) for name in SCENARIOS}
    found = list(rows(pools))
    code = versions()
    with options.result.open("w", newline="", encoding="utf-8") as file:
        file.write("# python -m benchmarks.power\n")
        file.write(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
        writer = csv.DictWriter(file, HEADS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(found)
    for row in found:
        print(row)


if __name__ == "__main__":
    main()
