"""Draw the pictures of the documentation, from runs that it makes.

    pip install pillow
    python docs/images/make.py [NAME]...

Names are those of the files, by default all. Pictures of the robot need off-screen OpenGL (see `sim.gl`). The map takes
some five minutes on two cores, the animation one or two, the others seconds. What else than the log a picture follows
from, its colours and the way it is drawn, goes into it as a digest, which the tests compare with the code.
"""

import argparse
import hashlib
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[1]
KEY = "sources"
SIZE = (1300, 750)
"""Of the figure, which on the page is as wide as the text. It keeps all colours: few of them make thin curves alike."""

PALETTE = "scenarios/palette.py"
SOURCES: dict[str, tuple[str, ...]] = {
    "walk.png": (PALETTE, "docs/images/poses.py"),
    "walk.gif": (PALETTE, "docs/images/animate.py"),
    "figures.png": (
        PALETTE,
        *(f"scenarios/show/{name}.py" for name in ("figures/motion", "figures/page", "kit/shading", "kit/figures")),
    ),
    **{f"{name}.svg": ("docs/images/drawings.py",) for name in ("tick", "planner", "qp", "recovery", "estimation")},
}
"""What a picture looks like by; the map's looks are its own, and its content changes with every part of the stack."""


def digest(name: str) -> str:
    """Of the sources of a picture."""
    return hashlib.sha256(b"".join((ROOT / source).read_bytes() for source in SOURCES[name])).hexdigest()[:16]


def noted(name: str) -> str:
    """The digest that a picture was drawn with."""
    if name.endswith(".svg"):
        return (FOLDER / name).read_text(encoding="utf-8").partition(f"{KEY}: ")[2][:16]
    with Image.open(FOLDER / name) as picture:
        found = picture.info.get("comment", b"").decode() or picture.info.get(KEY, "")
    return str(found)


def save_png(picture: Image.Image, name: str) -> None:
    """Save a picture with its digest."""
    info = PngInfo()
    info.add_text(KEY, digest(name))
    picture.save(FOLDER / name, optimize=True, pnginfo=info)


def walk(log: Path) -> None:
    """The robot at several moments."""
    from poses import composite

    from surefoot.scenarios.log import read

    save_png(composite(read(log)), "walk.png")


def animation(log: Path) -> None:
    """A stretch of the walk with its marks."""
    from animate import WALK, palette, pictures, save

    from surefoot.scenarios.log import read

    images, period = pictures(read(log), WALK)
    save(FOLDER / "walk.gif", images, period, palette(images), comment=digest("walk.gif").encode())


def figures(log: Path) -> None:
    """ZMP, CoM and DCM as `surefoot plot --what balance` draws them."""
    from surefoot.scenarios.show.figures.page import plot

    drawn = plot(log, log.with_name("balance.png"), what="balance")
    with Image.open(drawn.path) as picture:
        save_png(picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS), "figures.png")


def gait_map(_: Path) -> None:
    """Where the robot walks, by a campaign of some minutes."""
    from gait_map import main as draw_map

    from surefoot.scenarios.study.campaigns.campaign import read_campaign
    from surefoot.scenarios.study.campaigns.sweep import cores, sweep

    with tempfile.TemporaryDirectory() as folder:
        swept = sweep(read_campaign("gait-map"), Path(folder) / "gait-map", cores())
        draw_map([str(swept.folder / "table.csv")])


def drawing(name: str) -> Callable[[Path], None]:
    """Boxes and arrows, which follow from no run."""

    def draw(_: Path) -> None:
        from drawings import DRAWINGS

        (FOLDER / name).write_text(DRAWINGS[name].svg(digest(name)), encoding="utf-8")

    return draw


PICTURES: dict[str, tuple[str, Callable[[Path], None]]] = {
    "walk.png": ("walk", walk),
    "walk.gif": ("walk", animation),
    "figures.png": ("diagonal-walk", figures),
    "gait-map.png": ("", gait_map),
    **{name: ("", drawing(name)) for name in SOURCES if name.endswith(".svg")},
}
"""The scenario that a picture shows, if it is one, and what draws it from its log."""

OF_CAMPAIGNS = (
    "front.webp",
    "push-map.png",
    "push-map-pendulum.png",
    "push-map-as-it-was.png",
    "robustness.png",
    "courses.png",
    "drive.webp",
    *(f"recovery-{name}.webp" for name in ("forward", "crossing", "standing", "sideways", "stairs", "lasting")),
    *(f"robot-{name}.webp" for name in ("talos", "g1", "alexander", "jvrc1", "gr3", "h1")),
)
"""Pictures that others draw: `campaigns.py` those of campaigns that take hours, one as it drew it before, `courses.py`,
`drive.py`, `recoveries.py`, `gallery.py` and `front.py`."""


def main() -> None:
    """Draw the pictures that are asked for; each scenario is run once."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    names = parser.parse_args().names or list(PICTURES)
    if unknown := set(names) - set(PICTURES):
        parser.error(f"no picture {', '.join(sorted(unknown))}; there are {', '.join(PICTURES)}")
    logs: dict[str, Path] = {"": Path()}
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            scenario, draw = PICTURES[name]
            logs[scenario] = logs.get(scenario) or run(scenario, Path(folder))
            draw(logs[scenario])
            print(FOLDER / name)


def run(scenario: str, folder: Path) -> Path:
    """Run a scenario; its log."""
    import surefoot

    return surefoot.run(surefoot.load(scenario), out=folder).log


if __name__ == "__main__":
    main()
