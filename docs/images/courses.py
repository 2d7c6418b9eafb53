"""Draw docs/images/courses.png: ten random courses of five places, walked in full physics.

    python docs/images/courses.py

It takes about five minutes on two cores.
"""

import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from sources import KEY, digest

import surefoot
from surefoot.planner.geometry.plane import sole_corners
from surefoot.planner.types import Foot, Footstep
from surefoot.scenarios.palette import BLUE, COM_PLANNED, FEET

PICTURE = Path(__file__).with_name("courses.png")
COURSES, PLACES = 10, 5

Place = dict[str, float]
Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Walked:
    """A course as it was walked.

    Attributes:
        places: that were asked for.
        com: true path of the CoM on the ground, shape (n, 2) [m].
        footsteps: left or right, x, y, z and yaw of the sole of each, in order.
        error: distance of the stance from the last place [m].
        turned: difference of its heading from the one there [rad].
        passed: whether all criteria were met.
    """

    places: list[Place]
    com: Array
    footsteps: list[tuple[int, Array]]
    error: float
    turned: float
    passed: bool


def course(seed: int) -> list[Place]:
    """Places 0.3 to 2 m apart in any direction, with any heading."""
    rng, x, y, places = np.random.default_rng(seed), 0.0, 0.0, []
    for _ in range(PLACES):
        way, bearing, yaw = rng.uniform(0.3, 2.0), rng.uniform(-math.pi, math.pi), rng.uniform(-math.pi, math.pi)
        x, y = x + way * math.cos(bearing), y + way * math.sin(bearing)
        places.append({"x": round(x, 3), "y": round(y, 3), "yaw": round(yaw, 3)})
    return places


def walked(seed: int) -> Walked:
    """Walk a course in full physics."""
    places = course(seed)
    scenario = surefoot.load("waypoints", {"gait.waypoints": places, "seed": seed})
    with TemporaryDirectory() as folder:
        result = surefoot.run(scenario, out=folder)
        log, metrics = surefoot.read(result.log), result.verdict.metrics
        taken = zip(log["/footstep"].field("foot").tolist(), log["/footstep"].field("actual"), strict=True)
        com = log["/truth"].field("com")[::25, :2]
        errors = metrics["place_error"], metrics["heading_error"]
        return Walked(places, com, list(taken), *errors, result.verdict.passed)


def draw(axis: Axes, seed: int, found: Walked) -> None:
    """Draw soles, CoM and places from above."""
    for foot, (x, y, _, yaw) in found.footsteps:
        corners = sole_corners(Footstep(Foot(foot), np.array([x, y, 0.0]), yaw), np.array([0.11, 0.055]))
        axis.fill(*corners[:, :2].T, color=FEET[foot], alpha=0.6, linewidth=0)
    axis.plot(*found.com.T, color=COM_PLANNED, linewidth=0.8)
    for number, place in enumerate(found.places, 1):
        way = 0.25 * np.array([math.cos(place["yaw"]), math.sin(place["yaw"])])
        axis.annotate("", (place["x"] + way[0], place["y"] + way[1]), (place["x"], place["y"]), arrowprops=ARROW)
        axis.annotate(
            f"{number}", (place["x"], place["y"]), color="white", ha="center", va="center", bbox=DOT, fontsize=8
        )
    verdict = "" if found.passed else ", criteria missed"
    axis.set_title(f"{seed}: {1e3 * found.error:.1f} mm, {math.degrees(found.turned):.2f}°{verdict}", fontsize=9)
    axis.set_aspect("equal", "datalim")
    axis.tick_params(labelsize=8)


ARROW = {"arrowstyle": "-|>", "color": BLUE, "linewidth": 1.6}
DOT = {"boxstyle": "circle,pad=0.25", "color": BLUE}


def main(_: Sequence[str] = ()) -> None:
    """Walk the courses and write the picture."""
    with ProcessPoolExecutor() as pool:
        found = list(pool.map(walked, range(1, COURSES + 1)))
    figure, axes = plt.subplots(2, COURSES // 2, figsize=(10.0, 4.8), layout="constrained")
    for seed, axis in enumerate(axes.flat, 1):
        draw(axis, seed, found[seed - 1])
        print(seed, found[seed - 1].passed, found[seed - 1].error, found[seed - 1].turned)
    figure.supxlabel("x [m]", fontsize=8)
    figure.supylabel("y [m]", fontsize=8)
    figure.savefig(PICTURE, dpi=110, metadata={KEY: digest(PICTURE.name)})


if __name__ == "__main__":
    main()
