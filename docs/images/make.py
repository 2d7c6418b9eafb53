"""Draw the pictures of the documentation, moving ones too, from runs that it makes.

    pip install pillow
    python docs/images/make.py [NAME]... [--campaigns]

Names are those of the files. By default all are drawn. Those of campaigns are drawn from the results in docs/results;
with `--campaigns` the campaigns are run before, which takes an hour or more. Pictures of the robot need off-screen
OpenGL (see `sim.gl`), that of the page to drive a Chromium. Most take seconds or a minute. What else than its run a
picture follows from goes into it as a digest (`sources.py`), which the tests compare with the code.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from PIL import Image
from sources import DRAWINGS, FOLDER, RECOVERIES, ROBOTS, ROOT, digest, save_png

SIZE = (1300, 750)
"""Size of the figure, which on the page is as wide as the text.

It keeps all colours: few of them make thin curves alike.
"""
FALLING = (3.0, 4.4)
"""Part that is shown of the walk that falls [s]."""


@contextmanager
def run(scenario: str, settings: object = ()) -> Iterator[Path]:
    """The log of a run."""
    import surefoot

    with tempfile.TemporaryDirectory() as folder:
        yield surefoot.run(surefoot.load(scenario, settings), out=Path(folder)).log


def walk() -> None:
    """The robot at several moments."""
    from poses import composite

    from surefoot.scenarios.log import read

    with run("walk-level") as log:
        save_png(composite(read(log)), "walk.png")


def animation() -> None:
    """A stretch of the walk with its marks."""
    from animate import WALK, pictures
    from webp import save_webp

    from surefoot.scenarios.log import read

    with run("walk-level") as log:
        save_webp(FOLDER / "walk.webp", *pictures(read(log), WALK))


def figures() -> None:
    """ZMP, CoM and DCM as `surefoot plot --what balance` draws them."""
    with run("diagonal-walk") as log:
        _balance(log, "figures.png")


def falling() -> None:
    """The same of the walk of docs/falling.md."""
    sys.path.insert(0, str(FOLDER.parent))
    with run("walk-level", import_module("falling").SETTINGS) as log:
        _balance(log, "falling.png", *FALLING)


def _balance(log: Path, name: str, start: float | None = None, end: float | None = None) -> None:
    from surefoot.scenarios.show.figures.page import plot

    drawn = plot(log, log.with_name("balance.png"), what="balance", start=start, end=end)
    with Image.open(drawn.path) as picture:
        height = SIZE[1] if start is None else round(SIZE[0] * picture.height / picture.width)
        save_png(picture.convert("RGB").resize((SIZE[0], height), Image.Resampling.LANCZOS), name)


def run_anew(name: str) -> None:
    """Run the campaign of a picture and keep its result."""
    from surefoot.scenarios.run.processes import cores
    from surefoot.studies.campaigns.campaign import read_campaign
    from surefoot.studies.campaigns.sweep import sweep

    measured = import_module("measured")
    made = measured.MADE[name]
    with tempfile.TemporaryDirectory() as folder:
        campaign = read_campaign(made.campaign, made.settings, made.seeds)
        measured.keep(name, sweep(campaign, Path(folder) / name, cores()).folder)


def drawing(name: str) -> Callable[[], None]:
    """Boxes and arrows, which follow from no run."""

    def draw() -> None:
        from drawings import DRAWINGS as DRAWN

        (FOLDER / name).write_text(DRAWN[name].svg(digest(name)), encoding="utf-8")

    return draw


def by(module: str, *arguments: str) -> Callable[[], None]:
    """A function that another module of this folder is, given these words."""
    return lambda: import_module(module).main(list(arguments))


PICTURES: dict[str, Callable[[], None]] = {
    "walk.png": walk,
    "walk.webp": animation,
    "figures.png": figures,
    "falling.png": falling,
    **{name: drawing(name) for name in DRAWINGS},
    "front.webp": by("front"),
    **{name: by("recoveries", name) for name in RECOVERIES},
    **{f"robot-{name}.webp": by("gallery", name) for name in ROBOTS},
    "tour.webp": by("tour"),
    "drive.webp": by("drive"),
    "courses.png": by("courses"),
    "strides.png": by("strides"),
    "gait-map.png": by("gait_map"),
    **{f"{name}.png": by("campaigns", name) for name in ("push-map", "push-map-pendulum", "ladder-beside")},
}
"""Functions that draw the pictures."""

OF_CAMPAIGNS = ("gait-map.png", "ladder-beside.png", "push-map-pendulum.png", "push-map.png")
"""Drawn from the results of campaigns in docs/results."""


def main() -> None:
    """Draw the pictures that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    parser.add_argument("--campaigns", action="store_true", help="run the campaigns anew, for an hour or more")
    options = parser.parse_args()
    names = options.names or [*PICTURES]
    if unknown := set(names) - set(PICTURES):
        parser.error(f"no picture {', '.join(sorted(unknown))}; there are {', '.join(PICTURES)}")
    for name in names:
        if name in OF_CAMPAIGNS and (
            options.campaigns or not (FOLDER.parent / "results" / f"{Path(name).stem}.csv").exists()
        ):
            run_anew(Path(name).stem)
        PICTURES[name]()
        print(FOLDER / name)


if __name__ == "__main__":
    sys.path[:0] = [str(ROOT), str(FOLDER.parent)]
    main()
