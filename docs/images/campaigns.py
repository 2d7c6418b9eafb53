"""Draw the pictures of campaigns from their results, which take hours.

    surefoot sweep push-map --out runs/push-map
    python docs/images/campaigns.py push-map runs/push-map
    python docs/images/campaigns.py robustness runs/robustness

What is drawn is read from the tables of the campaign, and the limit of a push from the logs beside them. A map of
several campaigns, each of other gaits, is drawn when several folders are given.
"""

import argparse
import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml
from PIL import Image

from surefoot.scenarios.show.figures.style import save
from surefoot.scenarios.sweep.capturability import Limits
from surefoot.scenarios.sweep.figures import Axis, Found, Spread, compass, distributions, with_unit
from surefoot.scenarios.sweep.points import Threshold
from surefoot.scenarios.sweep.table import wilson

FOLDER = Path(__file__).parent
WIDTH = 1300
"""Of a picture [px]."""


def rows(table: Path) -> Iterator[dict[str, Any]]:
    """Rows of a table, numbers as numbers, by the names of its columns without units."""
    with table.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            yield {name.partition(" [")[0]: _value(text) for name, text in row.items()}


def _value(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def specification(folder: Path) -> Mapping[str, Any]:
    """What was run."""
    return dict(yaml.safe_load((folder / "campaign.yaml").read_text(encoding="utf-8")))


def push_map(folders: list[Path]) -> None:
    """Thresholds of pushes around the compass beside their limit: a panel for each gait, a curve for each phase."""
    found, logs, searched = [], [], specification(folders[0])["bisect"]
    key = searched["key"]
    for folder in folders:
        axes = list(specification(folder)["grid"])
        for row in rows(folder / "thresholds.csv"):
            labels = {name: row[name] for name in axes}
            value = None if row["threshold"] == "" else row["threshold"]
            found.append(Found(labels, Threshold(value, row["side"]), (searched["low"], searched["high"])))
            logs += [(labels, folder / row["log"])] if row["log"] else []
    names = {name: tuple(dict.fromkeys(one.labels[name] for one in found)) for name in found[0].labels}
    angle = next(name for name in names if name.endswith(".direction"))
    limits = Limits(key, logs, angle)
    varied = [Axis(name, values) for name, values in names.items()]
    _save(compass(found, varied, key, limits.at), "push-map.png")


def robustness(folders: list[Path]) -> None:
    """What was drawn in runs that passed and in runs that failed."""
    (folder,) = folders
    spec = specification(folder)
    runs = [row for row in rows(folder / "table.csv") if row["status"] in ("pass", "fail")]
    passed, failed = ([row for row in runs if row["status"] == status] for status in ("pass", "fail"))
    spreads = [
        Spread(with_unit(key), [row[key] for row in passed], [row[key] for row in failed]) for key in spec["sample"]
    ]
    for combination in sorted({tuple(str(row[name]) for name in spec.get("grid", {})) for row in runs}):
        of_it = [row for row in runs if tuple(str(row[name]) for name in spec.get("grid", {})) == combination]
        met = sum(row["status"] == "pass" for row in of_it)
        rate = wilson(met, len(of_it))
        print(*combination, f"{met} of {len(of_it)}: {rate.rate:.1%}, 95 % interval {rate.low:.1%} to {rate.high:.1%}")
    _save(distributions(spreads), "robustness.png")


def _save(figure: Any, name: str) -> None:
    save(figure, FOLDER / name, replace=True)
    with Image.open(FOLDER / name) as drawn:
        picture = drawn.convert("RGB")
    height = round(picture.height * WIDTH / picture.width)
    picture.resize((WIDTH, height), Image.Resampling.LANCZOS).save(FOLDER / name, optimize=True)
    print(FOLDER / name)


def main() -> None:
    """Draw the picture that is asked for."""
    drawers = {"push-map": push_map, "robustness": robustness}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", choices=drawers)
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER", help="of a campaign")
    options = parser.parse_args()
    drawers[options.picture](options.folders)


if __name__ == "__main__":
    main()
