"""Draw the pictures of the documentation, moving ones too, from runs that it makes.

    pip install pillow
    python docs/images/make.py [NAME]... [--campaigns]

Names are those of the files. By default all are drawn but those of campaigns, which take hours and come with
`--campaigns`. Pictures of the robot need off-screen OpenGL (see `sim.gl`), that of the page to drive a Chromium. Most
take seconds or a minute, courses and gait map some five minutes on two cores. What else than its run a picture follows
from goes into it as a digest (`sources.py`), which the tests compare with the code.
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
"""Of the figure, which on the page is as wide as the text. It keeps all colours: few of them make thin curves alike."""
FALLING = (3.0, 4.4)
"""What is shown of the walk that falls [s]."""


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

    with run("walk") as log:
        save_png(composite(read(log)), "walk.png")


def animation() -> None:
    """A stretch of the walk with its marks."""
    from animate import WALK, palette, pictures, save

    from surefoot.scenarios.log import read

    with run("walk") as log:
        images, period = pictures(read(log), WALK)
    save(FOLDER / "walk.gif", images, period, palette(images), comment=digest("walk.gif").encode())


def figures() -> None:
    """ZMP, CoM and DCM as `surefoot plot --what balance` draws them."""
    with run("diagonal-walk") as log:
        _balance(log, "figures.png")


def falling() -> None:
    """The same of the walk of docs/falling.md."""
    sys.path.insert(0, str(FOLDER.parent))
    with run("walk", import_module("falling").SETTINGS) as log:
        _balance(log, "falling.png", *FALLING)


def _balance(log: Path, name: str, start: float | None = None, end: float | None = None) -> None:
    from surefoot.scenarios.show.figures.page import plot

    drawn = plot(log, log.with_name("balance.png"), what="balance", start=start, end=end)
    with Image.open(drawn.path) as picture:
        height = SIZE[1] if start is None else round(SIZE[0] * picture.height / picture.width)
        save_png(picture.convert("RGB").resize((SIZE[0], height), Image.Resampling.LANCZOS), name)


def gait_map() -> None:
    """Where the robot walks, by a campaign of some minutes."""
    with campaign("gait-map") as folder:
        import_module("gait_map").main([str(folder / "table.csv")])


@contextmanager
def campaign(name: str, *settings: str) -> Iterator[Path]:
    """The folder of a campaign that is run."""
    from surefoot.scenarios.study.campaigns.campaign import read_campaign
    from surefoot.scenarios.study.campaigns.sweep import cores, sweep

    with tempfile.TemporaryDirectory() as folder:
        yield sweep(read_campaign(name, settings), Path(folder) / name, cores()).folder


def drawing(name: str) -> Callable[[], None]:
    """Boxes and arrows, which follow from no run."""

    def draw() -> None:
        from drawings import DRAWINGS as DRAWN

        (FOLDER / name).write_text(DRAWN[name].svg(digest(name)), encoding="utf-8")

    return draw


def by(module: str, *arguments: str) -> Callable[[], None]:
    """What another module of this folder draws, when it is given these words."""
    return lambda: import_module(module).main(list(arguments))


def of_campaign(name: str, *settings: str) -> Callable[[], None]:
    """A picture of a campaign that takes hours."""

    def draw() -> None:
        spec = name.removesuffix("-pendulum")
        with campaign(spec, *settings) as folder:
            import_module("campaigns").main([name, str(folder)])

    return draw


PICTURES: dict[str, Callable[[], None]] = {
    "walk.png": walk,
    "walk.gif": animation,
    "figures.png": figures,
    "falling.png": falling,
    **{name: drawing(name) for name in DRAWINGS},
    "front.webp": by("front"),
    **{name: by("recoveries", name) for name in RECOVERIES},
    **{f"robot-{name}.webp": by("gallery", name) for name in ROBOTS},
    "drive.webp": by("drive"),
    "courses.png": by("courses"),
    "gait-map.png": gait_map,
}
"""What draws a picture."""

OF_CAMPAIGNS: dict[str, Callable[[], None]] = {
    "push-map.png": of_campaign("push-map", "fidelity=full"),
    "push-map-pendulum.png": of_campaign("push-map-pendulum", "fidelity=pendulum"),
    "robustness.png": of_campaign("robustness"),
}
"""Likewise, in hours."""

GIVEN = ("robot-h1.webp", "push-map-as-it-was.png")
"""Not drawn here: a robot whose model does not come along, by `gallery.py FILE`, and a map of earlier code."""

WITHOUT_DIGEST = ("gait-map.png", *OF_CAMPAIGNS, "push-map-as-it-was.png")
"""Of campaigns that were run before their pictures had digests."""


def main() -> None:
    """Draw the pictures that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join((*PICTURES, *OF_CAMPAIGNS)))
    parser.add_argument("--campaigns", action="store_true", help="also those of campaigns that take hours")
    told = parser.parse_args()
    every = {**PICTURES, **OF_CAMPAIGNS}
    names = told.names or [*PICTURES, *(OF_CAMPAIGNS if told.campaigns else ())]
    if unknown := set(names) - set(every):
        parser.error(f"no picture {', '.join(sorted(unknown))}; there are {', '.join(every)}")
    for name in names:
        every[name]()
        print(FOLDER / name)


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main()
