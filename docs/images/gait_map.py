"""Draw docs/images/gait-map.png: where the robot walks, step length x step time x riser, and what stops it elsewhere.

    python docs/images/gait_map.py

The result of the campaign is kept by `docs/measured.py`.
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from sources import FOLDER, KEY, digest

from surefoot.scenarios.palette import FAIL, GREY, ORANGE, PASS, PURPLE, paler

sys.path.insert(0, str(FOLDER.parent))
from measured import rows

OUTCOMES = ("walks", "refused", "torque", "ZMP", "fall")
COLOURS = (PASS, paler(GREY, 0.6), ORANGE, PURPLE, FAIL)
NAMES = ("walks", "refused (reach, tread, swing)", "stopped by torque", "by ZMP", "by a fall")
PICTURE = Path(__file__).with_name("gait-map.png")

Row = Mapping[str, str]
Cell = tuple[float, float, float]
"""Riser [m], step length [m] and step time [s]."""


def cells() -> dict[Cell, Row]:
    """The run that counts of every cell: the last, which is the first that was not refused, if there is one."""
    return {(float(row["riser"]), float(row["step_length"]), float(row["step_time"])): row for row in rows("gait-map")}


def outcome(row: Row) -> str:
    """Outcome of a cell."""
    if row["status"] == "refused":
        return "refused"
    if float(row["torque_at_limit_fraction"]) > 0.01:
        return "torque"
    if float(row["cop_ratio_p99"] or np.inf) >= 1.0:
        return "ZMP"
    return "walks" if row["status"] == "pass" else "fall"


def draw(found: Mapping[Cell, Row]) -> None:
    """Write the picture."""
    risers, lengths, times = (sorted({cell[axis] for cell in found}) for axis in range(3))
    figure, axes = plt.subplots(1, len(risers), figsize=(9.0, 4.2), sharey=True, layout="constrained")
    for axis, riser in zip(axes, risers, strict=True):
        table = [[OUTCOMES.index(outcome(found[riser, length, time])) for length in lengths] for time in times]
        axis.imshow(table, origin="lower", aspect="auto", cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=4.5)
        axis.set_xticks(range(len(lengths)), [f"{length:g}" for length in lengths])
        axis.set_yticks(range(len(times)), [f"{time:g}" for time in times])
        axis.set_title("flat ground" if riser == 0.0 else f"stairs up, riser {riser:g} m", fontsize=10)
        axis.set_xlabel("step length [m]" if riser == 0.0 else "step length = tread [m]")
        for row, time in enumerate(times):
            for column, length in enumerate(lengths):
                cell = found[riser, length, time]
                if cell["status"] != "refused":
                    text = f"{100 * float(cell['torque_ratio_max']):.0f}"
                    axis.text(column, row, text, ha="center", va="center", fontsize=11)
    axes[0].set_ylabel("step time [s]")
    patches = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in COLOURS]
    figure.legend(
        patches,
        NAMES,
        loc="outside lower center",
        ncols=5,
        frameon=False,
        fontsize=10,
        handlelength=1.0,
        columnspacing=1.2,
    )
    figure.suptitle("Where the robot walks, with the largest torque in % of its limit", fontsize=12)
    figure.savefig(PICTURE, dpi=130, metadata={KEY: digest(PICTURE.name)})


def main(_: Sequence[str] = ()) -> None:
    """Draw the result that is kept."""
    draw(cells())


if __name__ == "__main__":
    main()
