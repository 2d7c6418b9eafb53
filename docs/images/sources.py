"""The code that draws each picture of the documentation; its digest is in the picture, and the tests compare both."""

import ast
import hashlib
import io
import tokenize
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[1]
KEY = "sources"

_OWN = "docs/images"
PALETTE = "scenarios/palette.py"
_FIGURES = tuple(
    f"scenarios/show/{name}.py" for name in ("figures/motion", "figures/page", "kit/shading", "kit/figures")
)
_RESULTS = "docs/results"
_CAMPAIGNS = (f"{_OWN}/campaigns.py", "scenarios/show/kit/figures.py")
_MAPS = (PALETTE, *_CAMPAIGNS, "studies/campaigns/thresholds.py")
_MOVING = (PALETTE, f"{_OWN}/animate.py", f"{_OWN}/webp.py")

RECOVERIES = tuple(
    f"recovery-{name}.webp" for name in ("forward", "crossing", "standing", "sideways", "stairs", "lasting")
)
ROBOTS = ("humanoid100", "talos", "g1", "alexander", "jvrc1", "gr3")
DRAWINGS = tuple(f"{name}.svg" for name in ("tick", "planner", "qp", "recovery", "estimation"))

SOURCES: dict[str, tuple[str, ...]] = {
    "walk.png": (PALETTE, f"{_OWN}/poses.py"),
    "walk.webp": _MOVING,
    "figures.png": (PALETTE, *_FIGURES),
    "falling.png": (PALETTE, *_FIGURES),
    **dict.fromkeys(DRAWINGS, (PALETTE, f"{_OWN}/drawings.py")),
    "front.webp": (*_MOVING, f"{_OWN}/front.py"),
    **dict.fromkeys(RECOVERIES, (*_MOVING, f"{_OWN}/recoveries.py")),
    **dict.fromkeys([f"robot-{name}.webp" for name in ROBOTS], (*_MOVING, f"{_OWN}/gallery.py")),
    "tour.webp": (PALETTE, f"{_OWN}/tour.py", f"{_OWN}/webp.py"),
    "drive.webp": (f"{_OWN}/drive.py",),
    "courses.png": (
        PALETTE,
        f"{_OWN}/courses.py",
    ),
    "strides.png": (PALETTE, f"{_OWN}/strides.py", f"{_OWN}/poses.py", "scenarios/judge/people.py"),
    "gait-map.png": (PALETTE, f"{_OWN}/gait_map.py", f"{_RESULTS}/gait-map.csv"),
    "push-map.png": (*_MAPS, f"{_RESULTS}/push-map.csv"),
    "push-map-pendulum.png": (*_MAPS, f"{_RESULTS}/push-map-pendulum.csv"),
    "ladder-beside.png": (*_MAPS, "studies/campaigns/beside_figure.py", f"{_RESULTS}/ladder-beside.csv"),
}
"""Files beside its run that a picture follows from: colours, camera, drawing code, and results that are kept."""


def digest(name: str, root: Path = ROOT) -> str:
    """Digest of the sources of a picture, without their docstrings and comments, which draw nothing."""
    return hashlib.sha256("".join(_drawing(root / source) for source in SOURCES[name]).encode()).hexdigest()[:16]


def _drawing(source: Path) -> str:
    """The part of a file that draws: of Python its lines without prose."""
    text = source.read_text(encoding="utf-8")
    if source.suffix != ".py":
        return text
    lines = text.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
    return "".join(f"{line.rstrip()}\n" for line in lines if line.strip())


def noted(name: str, folder: Path = FOLDER) -> str:
    """The digest that a picture was drawn with; empty where it has none."""
    path = folder / name
    if path.suffix == ".svg":
        return path.read_text(encoding="utf-8").partition(f"{KEY}: ")[2][:16]
    with Image.open(path) as picture:
        if path.suffix == ".webp":
            return picture.info.get("xmp", b"").decode().partition(f"{KEY}=")[2][:16]
        found = picture.info.get("comment", b"").decode() or picture.info.get(KEY, "")
    return str(found)


def save_png(picture: Image.Image, name: str) -> None:
    """Save a picture with its digest."""
    info = PngInfo()
    info.add_text(KEY, digest(name))
    picture.save(FOLDER / name, optimize=True, pnginfo=info)
