"""The distance of public humanoids from the bounds on the sizes of a robot.

    python -m benchmarks.magnitudes [FOLDER]... [--csv FILE]

It drafts a robot file of each model of `benchmarks/robots.py` that is found, listens to every law of
`models.robot_file.magnitudes` that is asked, and keeps of each the model that comes nearest to a bound. The folders may
be clones of the models' repositories.
"""

import argparse
import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

from benchmarks.robots import MODELS, found
from surefoot.apps.robots.draft import draft
from surefoot.models.robot_file import magnitudes
from surefoot.models.robot_file.magnitudes import Law
from surefoot.models.types import RobotError
from surefoot.scenarios.record.provenance import relevant_versions

LAWS = {name: law for name, law in vars(magnitudes).items() if isinstance(law, Law)}
HEADS = ("law", "ratio", "model", "models")


@dataclass(frozen=True, slots=True)
class Nearest:
    """The model that comes nearest to a bound of a law.

    Attributes:
        law: its name.
        ratio: of the model [-].
        model: its name.
        models: how many models the law was asked of.
    """

    law: str
    ratio: float
    model: str
    models: int


def asked(model: str) -> dict[str, list[float]]:
    """Ratios of a model by law, as its draft asks for them; none where it cannot be read.

    The cache is not asked, since a draft that comes from it asks nothing.
    """
    heard: dict[str, list[float]] = {name: [] for name in LAWS}
    names = {id(law): name for name, law in LAWS.items()}
    holds = Law.holds

    def listening(law: Law, value: float, size: float) -> bool:
        heard[names[id(law)]].append(value / size)
        return holds(law, value, size)

    with patch.object(Law, "holds", listening), patch("surefoot.models.robot_file.cache.load", lambda key: None):
        try:
            draft(model, Path())
        except RobotError as error:
            print(f"{model}: {error}")
    return heard


def nearest(models: dict[str, dict[str, list[float]]]) -> Iterator[Nearest]:
    """Find for each law the model that comes nearest to its bounds, by the share of the way to one."""
    for name, law in LAWS.items():
        ratios = [(ratio, model) for model, heard in models.items() for ratio in heard[name]]
        if ratios:
            ratio, model = max(ratios, key=lambda one: _share(law, one[0]))
            yield Nearest(name, ratio, model, len({of for _, of in ratios}))


def _share(law: Law, ratio: float) -> float:
    """Share of the way of a ratio to a bound: 1 at one, more beyond [-]."""
    below = law.least / ratio if ratio > 0.0 else 0.0
    return max(ratio / law.most, below)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure all that are found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--csv", type=Path)
    given = parser.parse_args(arguments)
    places = {model.name: found(model, given.folders) for model in MODELS}
    rows = list(nearest({name: asked(place) for name, place in places.items() if place is not None}))
    for row in rows:
        print(f"{row.law:<9} {row.ratio:>9.3g} {row.model} of {row.models}")
    if given.csv:
        with given.csv.open("w", newline="", encoding="utf-8") as file:
            code = relevant_versions()
            file.write("# python -m benchmarks.magnitudes FOLDER...\n")
            file.write(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(HEADS)
            writer.writerows((row.law, f"{row.ratio:.3g}", row.model, row.models) for row in rows)


if __name__ == "__main__":
    main()
