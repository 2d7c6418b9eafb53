"""Draw the pictures of campaigns from their results, which take hours.

    surefoot sweep push-map --set fidelity=full --out runs/push-map
    python docs/images/campaigns.py push-map runs/push-map
    surefoot sweep push-map --set fidelity=pendulum --out runs/push-map-pendulum
    python docs/images/campaigns.py push-map-pendulum runs/push-map-pendulum
    python docs/images/campaigns.py robustness runs/robustness

What is drawn is read from the tables of the campaign, and the limit of a push from the logs beside them. The table of a
map is printed as it stands on the page.
"""

import argparse
import csv
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from PIL import Image
from sources import save_png

from surefoot.scenarios.show.kit.figures import PAGE_WIDTH, save
from surefoot.scenarios.study.campaigns.campaign import read_campaign
from surefoot.scenarios.study.campaigns.capturability import Limits
from surefoot.scenarios.study.campaigns.points import Threshold
from surefoot.scenarios.study.campaigns.spec import Axis, text, with_unit
from surefoot.scenarios.study.campaigns.success import Histogram, distributions
from surefoot.scenarios.study.campaigns.table import wilson
from surefoot.scenarios.study.campaigns.thresholds import Found, LimitOf, bars

FOLDER = Path(__file__).parent
WIDTH = 1300
"""Of a picture that is as wide as a page [px]."""


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


def push_map(folder: Path, name: str) -> None:
    """Thresholds of pushes as bars beside their limit and what others have published, and as a table."""
    campaign = read_campaign(str(folder / "campaign.yaml"))
    axes = [Axis(axis, tuple(one.label for one in settings)) for axis, settings in campaign.axes.items()]
    search = campaign.spec.bisect
    assert search is not None
    ranges = {
        str(labels): (own.low, own.high)
        for labels, keys in campaign.combinations()
        if (own := campaign.bisect(keys)) is not None
    }
    found, logs = [], []
    for row in rows(folder / "thresholds.csv"):
        labels = {axis.name: row[axis.name] for axis in axes}
        value = None if row["threshold"] == "" else row["threshold"]
        found.append(Found(labels, Threshold(value, row["side"]), ranges[str(labels)]))
        logs += [(labels, folder / row["log"])] if row["log"] else []
    limits = Limits(search.key, logs, "")
    for line in table(found, axes, limits.at):
        print(line)
    _save(bars(found, axes, search.key, limits.at, campaign.spec.records), name)


def table(found: Sequence[Found], axes: Sequence[Axis], limit: LimitOf) -> Iterator[str]:
    """Thresholds of all shades of a group in one cell, and the limit of the last shade, in the style of the page."""
    *others, columns, shades, groups = axes
    cells: dict[str, dict[Any, dict[Any, str]]] = {}
    for one in found:
        row = ", ".join(text(one.labels[axis.name]) for axis in (*others, groups) if len(axis.values) > 1)
        shown = f"{'< ' if one.threshold.side == 'below' else ''}{one.shown:.2f}"
        most = limit(one.labels, None) if one.labels[shades.name] == shades.values[-1] else None
        cell = cells.setdefault(row, {}).setdefault(one.labels[columns.name], {})
        cell[one.labels[shades.name]] = shown if most is None else f"{shown} ({most:.2f})"
    yield "| N·s/kg | " + " | ".join(map(text, columns.values)) + " |"
    yield "|---" * (1 + len(columns.values)) + "|"
    for row, values in cells.items():
        every = (values.get(column, {}) for column in columns.values)
        yield (
            f"| {row} | " + " | ".join(", ".join(cell.get(one, "–") for one in shades.values) for cell in every) + " |"
        )


def robustness(folder: Path, name: str) -> None:
    """What was drawn in runs that passed and in runs that failed."""
    spec = specification(folder)
    runs = [row for row in rows(folder / "table.csv") if row["status"] in ("pass", "fail")]
    passed, failed = ([row for row in runs if row["status"] == status] for status in ("pass", "fail"))
    spreads = [
        Histogram(with_unit(key), [row[key] for row in passed], [row[key] for row in failed]) for key in spec["sample"]
    ]
    for combination in sorted({tuple(str(row[name]) for name in spec.get("grid", {})) for row in runs}):
        of_it = [row for row in runs if tuple(str(row[name]) for name in spec.get("grid", {})) == combination]
        met = sum(row["status"] == "pass" for row in of_it)
        rate = wilson(met, len(of_it))
        print(*combination, f"{met} of {len(of_it)}: {rate.rate:.1%}, 95 % interval {rate.low:.1%} to {rate.high:.1%}")
    _save(distributions(spreads), name)


def _save(figure: Any, name: str) -> None:
    save(figure, FOLDER / name, replace=True)
    with Image.open(FOLDER / name) as drawn:
        picture = drawn.convert("RGB")
    width = round(WIDTH * figure.get_figwidth() / PAGE_WIDTH)
    height = round(picture.height * width / picture.width)
    save_png(picture.resize((width, height), Image.Resampling.LANCZOS), name)
    print(FOLDER / name)


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the picture that is asked for."""
    drawers = {"push-map": push_map, "push-map-pendulum": push_map, "robustness": robustness}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", choices=drawers)
    parser.add_argument("folder", type=Path, help="of a campaign")
    options = parser.parse_args(arguments)
    drawers[options.picture](options.folder, f"{options.picture}.png")


if __name__ == "__main__":
    main()
