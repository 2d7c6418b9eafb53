"""Draw docs/images/gait-map.png: where the robot walks, step length x step time x riser, and what stops it elsewhere.

    python docs/images/gait_map.py [--jobs N]

Human-size feet in full physics, six steps, a fifth of each step in double support, the CoM as high as the legs reach
(at most 0.99 m; a lower one walks faster, see docs/fast-walking.md). On stairs a step is a tread. A cell takes a few
seconds, the whole map about five minutes on two cores.
"""

import argparse
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

RISERS = (0.0, 0.1, 0.185)
LENGTHS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
TIMES = (0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0)
HEIGHTS = tuple(round(0.99 - 0.03 * i, 2) for i in range(6))
OUTCOMES = ("walks", "refused", "torque", "ZMP", "fall")
COLOURS = ("#2a9d5c", "#b9c0c9", "#e9a23b", "#8f6bb5", "#c8452f")
PICTURE = Path(__file__).with_name("gait-map.png")


@dataclass(frozen=True)
class Cell:
    """One gait: riser [m], step length [m] and step time [s]."""

    riser: float
    length: float
    time: float


@dataclass(frozen=True)
class Answer:
    """What became of a cell: index into OUTCOMES, CoM height used [m], largest torque ratio and CoP ratio [-]."""

    outcome: int
    height: float
    torque: float
    cop: float


def overrides(cell: Cell, height: float) -> list[str]:
    """A cell's keys of a scenario, with a CoM height [m]."""
    double = round(0.2 * cell.time / 0.02) * 0.02
    settings = {
        "robot_options.foot_length": 0.22,
        "robot_options.foot_width": 0.11,
        "gait.steps": 6,
        "gait.step_length": cell.length,
        "gait.single_support": round(cell.time - double, 2),
        "gait.double_support": round(double, 2),
        "gait.com_height": height,
    }
    stairs = {"terrain.kind": "stairs", "terrain.riser": cell.riser, "terrain.tread": cell.length, "terrain.count": 5}
    return [f"{key}={value}" for key, value in {**settings, **(stairs if cell.riser else {})}.items()]


def answer(cell: Cell) -> Answer:
    """Walk a cell with the CoM as high as its steps are accepted."""
    from surefoot.scenarios.errors import ScenarioError, SetupError
    from surefoot.scenarios.loop.run import run_scenario
    from surefoot.scenarios.setup.load import load as load_scenario

    for height in HEIGHTS:
        try:
            scenario = load_scenario("stand", ["duration=null", *overrides(cell, height)])
            with tempfile.TemporaryDirectory() as folder:
                metrics = run_scenario(scenario, Path(folder)).verdict.metrics
        except (ScenarioError, SetupError):
            continue
        torque, cop = metrics["torque_at_limit_fraction"], metrics["cop_ratio_p99"] or np.inf
        done = not metrics["fell"] and metrics["steps_taken"] == metrics["steps_planned"]
        outcome = 2 if torque > 0.01 else 3 if cop >= 1.0 else 0 if done else 4
        return Answer(outcome, height, metrics["torque_ratio_max"], cop)
    return Answer(1, np.nan, np.nan, np.nan)


def draw(answers: dict[Cell, Answer]) -> None:
    """Write the picture."""
    figure, axes = plt.subplots(1, len(RISERS), figsize=(11.0, 3.9), sharey=True, layout="constrained")
    for axis, riser in zip(axes, RISERS, strict=True):
        table = np.array([[answers[Cell(riser, length, time)].outcome for length in LENGTHS] for time in TIMES])
        axis.imshow(table, origin="lower", aspect="auto", cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=4.5)
        axis.set_xticks(range(len(LENGTHS)), [f"{length:g}" for length in LENGTHS])
        axis.set_yticks(range(len(TIMES)), [f"{time:g}" for time in TIMES])
        axis.set_title("flat ground" if riser == 0.0 else f"stairs up, riser {riser:g} m", fontsize=10)
        axis.set_xlabel("step length [m]" if riser == 0.0 else "step length = tread [m]")
        for row, time in enumerate(TIMES):
            for column, length in enumerate(LENGTHS):
                found = answers[Cell(riser, length, time)]
                if found.outcome != 1:
                    text = f"{length / time:.2f} m/s\n{100 * found.torque:.0f} %"
                    axis.text(column, row, text, ha="center", va="center", fontsize=6.5, color="white")
    axes[0].set_ylabel("step time [s]")
    patches = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in COLOURS]
    names = ["walks", "refused (reach, sole on tread, swing)", "stopped by torque", "by ZMP", "by a fall"]
    figure.legend(patches, names, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    figure.suptitle("Where the robot walks (speed, and largest torque in % of its limit)", fontsize=11)
    figure.savefig(PICTURE, dpi=110)


def main(arguments: Sequence[str] | None = None) -> None:
    """Walk every cell and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    cells = [Cell(riser, length, time) for riser in RISERS for length in LENGTHS for time in TIMES]
    with ProcessPoolExecutor(options.jobs, get_context("forkserver")) as pool:
        answers = dict(zip(cells, pool.map(answer, cells), strict=True))
    for cell, found in answers.items():
        print(cell, OUTCOMES[found.outcome], found.height, f"{found.torque:.2f} {found.cop:.2f}")
    draw(answers)


if __name__ == "__main__":
    main()
