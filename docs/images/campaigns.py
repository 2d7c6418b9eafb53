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
from surefoot.studies.campaigns.beside_figure import turned
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.spec import Axis
from surefoot.studies.campaigns.thresholds import Found, Threshold, bars, compass

sys.path.insert(0, str(FOLDER.parent))
from measured import MADE, limit_of, rows, searches

WIDTH = 1300
"""Width of a picture that is as wide as a page [px]."""


def push_map(name: str) -> Any:
    """Thresholds of pushes as bars beside their limit and what others have published."""
    spec = read_campaign(MADE[name].campaign).spec
    assert spec.bisect is not None
    found, axes = searches(name)
    return bars(found, axes, spec.bisect.key, lambda labels, _: limit_of(name, labels), spec.records)


PUSH_MAPS = ("push-map", "push-map-pendulum")


def beside(name: str) -> Any:
    """Thresholds of two walkers around the compass, a panel for each phase."""
    kept = rows(name)
    walkers = list(dict.fromkeys(row["walker"] for row in kept))
    campaign = read_campaign("march-ladder")
    found = [Found({key: row[key] for key in list(row)[:3]}, _threshold(row), (0.0, 10.0)) for row in kept]
    axes = [Axis(axis, tuple(one.label for one in campaign.axes[axis])) for axis in ("direction", "phase")]
    laid = turned(campaign, found, [Axis("walker", tuple(walkers)), *axes])
    assert laid is not None
    return compass(*laid, "pushes.0.impulse", lambda *_: None)


def _threshold(row: dict[str, str]) -> Threshold:
    value = row["threshold [N·s/kg]"]
    return Threshold(float(value) if value else None, "inside")


DRAWN = {**dict.fromkeys(PUSH_MAPS, push_map), "ladder-beside": beside}
"""Functions that draw each picture."""


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
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(DRAWN))
    for name in parser.parse_args(arguments).names or DRAWN:
        _save(DRAWN[name](name), f"{name}.png")


if __name__ == "__main__":
    main()
