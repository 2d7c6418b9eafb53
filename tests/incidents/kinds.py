"""The table of docs/incidents.md: ten falls, what of each is needed, and what `surefoot check` says of it.

    python tests/incidents/kinds.py [KIND]... > docs/results/incidents.csv

`python docs/reference.py` then puts it onto the page. With ``--seconds S`` the scenarios begin in the state of the log
so long before the fall.
"""

import argparse
import csv
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from falls import FALLS, logged

from surefoot.scenarios.check.check import Checked, cases, run_case, updated
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.studies.incident import report
from surefoot.studies.incident.causes import settings
from surefoot.studies.incident.regression import Incident, Regression, Trial, Trials, regression, write


@dataclass(frozen=True)
class Told:
    """A fall and the scenario that was made of its log.

    Attributes:
        found: the regression.
        path: of the scenario.
        again: the run of that file.
        red: what `surefoot check` says of it.
        green: what it says without a cause: each with what became of its run, and of the run after its update.
    """

    found: Regression
    path: Path
    again: Trial
    red: Checked
    green: tuple[tuple[str, Checked, Checked], ...]


def told(kind: str, folder: Path, seconds: float | None = None) -> Told:
    """Let a robot fall, make a scenario of its log, and check that with its causes and without each of them."""
    folder.mkdir(parents=True, exist_ok=True)
    incident = Incident.of(logged(kind, folder))
    path = folder / f"{incident.scenario.name}-incident.yaml"
    trials = Trials(incident, path.stem)
    found = regression(incident, trials, None, seconds)
    write(found, path, report.comment(found, path))
    green = []
    for number, cause in enumerate(found.needed):
        baselines = folder / f"baselines-{number}"
        taken = settings(found.values, found.in_file(cause))
        (case,) = cases([str(path)], baselines, taken)
        first = updated(run_case(case, folder / "checked"))
        green.append((cause.text, first, run_case(case, folder / "checked")))
    return Told(found, path, trials.of_file(path), run_case(cases([str(path)])[0], folder / "checked"), tuple(green))


def row(kind: str, one: Told) -> list[str]:
    """The row of a fall."""
    found, again = one.found, one.again
    assert found.again.likeness is not None
    assert again.likeness is not None
    exact = found.again.likeness.parts is None
    cured = [
        text.partition(" ")[0] for text, first, second in one.green if (first.passed, second.status) == (True, "same")
    ]
    return [
        kind,
        f"{found.incident.harm.time:.3f}",
        "to the bit" if exact else f"{1e3 * found.again.likeness.distance:.2g}",
        str(len(found.causes)),
        str(len(found.needed)),
        ", ".join(f"`{cause.text.partition(' ')[0]}`" for cause in found.needed) or "-",
        str(len(found.trials)),
        f"{found.incident.harm.time + again.likeness.later:.3f}" if again.same else "-",
        f"{1e3 * again.likeness.distance:.2g}",
        one.red.status,
        ", ".join(f"`{name}`" for name in cured) or "-",
    ]


HEAD = (
    *("fall", "falls at [s]", "run again, CoM apart [mm]", "causes", "needed", "which", "runs"),
    *("the smallest falls at [s]", "its CoM apart [mm]", "`surefoot check`", "green without"),
)


def main(words: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", default=list(FALLS))
    parser.add_argument("--seconds", type=float)
    given, code = parser.parse_args(words), relevant_versions()
    print(f"# python tests/incidents/kinds.py\n# surefoot {code['surefoot']}, source_digest {code['source_digest']}")
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(HEAD)
    for number, kind in enumerate(given.kinds):
        with tempfile.TemporaryDirectory() as folder:
            writer.writerow(row(kind, told(kind, Path(folder) / str(number), given.seconds)))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
