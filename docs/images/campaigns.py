"""Draw the pictures of campaigns from their results, as `docs/measured.py` keeps them.

python docs/images/campaigns.py [NAME]...
"""

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from PIL import Image
from sources import FOLDER, save_png

from surefoot.scenarios.show.kit.figures import PAGE_WIDTH, save
from surefoot.scenarios.study.campaigns.campaign import read_campaign
from surefoot.scenarios.study.campaigns.spec import with_unit
from surefoot.scenarios.study.campaigns.success import Histogram, distributions
from surefoot.scenarios.study.campaigns.thresholds import bars

sys.path.insert(0, str(FOLDER.parent))
from measured import MADE, limit_of, rows, searches

WIDTH = 1300
"""Of a picture that is as wide as a page [px]."""


def push_map(name: str) -> Any:
    """Thresholds of pushes as bars beside their limit and what others have published."""
    spec = read_campaign(MADE[name].campaign).spec
    assert spec.bisect is not None
    found, axes = searches(name)
    return bars(found, axes, spec.bisect.key, lambda labels, _: limit_of(name, labels), spec.records)


def robustness(name: str) -> Any:
    """What was drawn in runs that passed and in runs that failed."""
    kept = rows(name)
    sampled = [column for column in kept[0] if column not in ("gait", "status")]
    spreads = []
    for key in sampled:
        passed, failed = ([_value(row[key]) for row in kept if row["status"] == one] for one in ("pass", "fail"))
        spreads.append(Histogram(with_unit(key), passed, failed))
    return distributions(spreads)


def _value(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


DRAWERS = {"push-map": push_map, "push-map-pendulum": push_map, "robustness": robustness}


def _save(figure: Any, name: str) -> None:
    save(figure, FOLDER / name, replace=True)
    with Image.open(FOLDER / name) as drawn:
        picture = drawn.convert("RGB")
    width = round(WIDTH * figure.get_figwidth() / PAGE_WIDTH)
    height = round(picture.height * width / picture.width)
    save_png(picture.resize((width, height), Image.Resampling.LANCZOS), name)


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the pictures that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(DRAWERS))
    for name in parser.parse_args(arguments).names or DRAWERS:
        _save(DRAWERS[name](name), f"{name}.png")


if __name__ == "__main__":
    main()
