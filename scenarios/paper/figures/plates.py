"""The figures of the page: which runs stand side by side in each, and what is drawn of them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scenarios.paper import studies
from scenarios.paper.experiment import Study, World
from scenarios.paper.figures import panels
from scenarios.paper.figures.grid import Column, Row, Views, grid
from scenarios.paper.figures.preview import preview_chart
from scenarios.paper.results import Results
from scenarios.paper.tables import WORLD_NAMES


@dataclass(frozen=True, slots=True)
class Plate:
    """A figure of the page.

    Attributes:
        name: its anchor.
        caption: what it shows.
        draw: draws it.
        half: whether it takes half of the page's width.
    """

    name: str
    caption: str
    draw: Callable[[Results], Figure]
    half: bool = False


def _position(axes: Axes, views: Views, axis: int) -> None:
    panels.position(axes, views[0][1], axis)


def _jerk(axes: Axes, views: Views, axis: int) -> None:
    panels.jerk(axes, views[0][1], axis)


def _height(axes: Axes, views: Views) -> None:
    panels.height(axes, views[0][1])


POSITIONS = tuple(Row(f"{name} [m]", partial(_position, axis=axis), 1.7) for axis, name in enumerate("xy"))
JERKS = tuple(
    Row(f"jerk {name} [m/s³]", partial(_jerk, axis=axis), 1.1, shared=False) for axis, name in enumerate("xy")
)
HEIGHT = Row("CoM z [m]", _height, 1.4)
ZMPS = tuple(Row(f"ZMP {name} [m]", partial(panels.zmp_of_several, axis=axis), 2.0) for axis, name in enumerate("xy"))

Run = tuple[str, World]
SIDE_BY_SIDE: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "full"))
ON_STAIRS: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "pendulum"))


def _study(results: Results, study: Study, runs: tuple[Run, ...], rows: tuple[Row, ...]) -> Figure:
    columns = [
        Column(f"{profile}, {WORLD_NAMES[world]}", (("", results.sample(study, profile, world)),))
        for profile, world in runs
    ]
    return grid(columns, rows)


def _heights(results: Results) -> Figure:
    columns = [
        Column(
            f"{profile}, {WORLD_NAMES[world]}",
            tuple(
                (f"error {studies.with_sign(error)} m", results.sample(study, profile, world))
                for error, study in zip(studies.HEIGHT_ERRORS, studies.HEIGHTS, strict=True)
            ),
        )
        for profile, world in SIDE_BY_SIDE
    ]
    return grid(columns, ZMPS)


def _pushes(results: Results, profile: str, world: World) -> Figure:
    columns = [
        Column(f"{studies.with_sign(force)} N in x and y", (("", results.sample(study, profile, world)),))
        for force, study in zip(studies.PUSH_FORCES, studies.PUSHES, strict=True)
    ]
    return grid(columns, POSITIONS)


PLATES: dict[str, tuple[Plate, ...]] = {
    "diagonal-walk": (
        Plate(
            "figure-walk",
            "Diagonal walk: reference and measured ZMP and CoM in x and y, and the jerk that the planner commands; "
            "dotted, the paper's bound of ±1.5 m/s³. The axes of the paper's figure 2.",
            partial(_study, study=studies.WALK, runs=SIDE_BY_SIDE, rows=(*POSITIONS, *JERKS)),
        ),
    ),
    "stairs": (
        Plate(
            "figure-stairs",
            "Stairs of 0.10 m: CoM height with single and double support shaded, ZMP and CoM in x and y. "
            "The axes of the paper's figure 3.",
            partial(_study, study=studies.STAIRS[0], runs=ON_STAIRS, rows=(HEIGHT, *POSITIONS)),
        ),
        Plate(
            "figure-preview",
            "ZMP error over riser height: norm of the RMS in x and y, median over seeds, with the range over seeds. "
            "lti keeps everything of default but the preview of the changing dynamics.",
            preview_chart,
            half=True,
        ),
    ),
    "noise": (
        Plate(
            "figure-noise-walk",
            "Diagonal walk with noise of ±0.02 m on the measured ZMP and 2 mm on the CoM. "
            "First row of the paper's figure 4.",
            partial(_study, study=studies.NOISE_WALK, runs=SIDE_BY_SIDE, rows=POSITIONS),
        ),
        Plate(
            "figure-noise-stairs",
            "Stairs of 0.10 m with the same noise. Second row of the paper's figure 4.",
            partial(_study, study=studies.NOISE_STAIRS, runs=ON_STAIRS, rows=POSITIONS),
        ),
    ),
    "height-error": (
        Plate(
            "figure-height",
            "True ZMP when the planner's CoM height is wrong by −0.2, −0.1, +0.1 and +0.2 m. The paper's figure 5.",
            _heights,
        ),
    ),
    "pushes": tuple(
        Plate(
            f"figure-push-{profile}",
            f"{profile}, {WORLD_NAMES[world]}: pushes of 10 ms at 2.2 s, with noise. The axes of the paper's figure 6.",
            partial(_pushes, profile=profile, world=world),
        )
        for profile, world in SIDE_BY_SIDE
    ),
}
"""Figures by the section that they stand in."""
