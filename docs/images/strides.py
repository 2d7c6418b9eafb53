"""Draw docs/images/strides.png: a walk that lands on its heels from the side, and its joints beside those of people.

    python docs/images/strides.py

Two walks of 0.8 m/s from sensors, one that lands flat and one that lands on its heels, half a minute of computing.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from poses import poses
from sources import KEY, digest

import surefoot
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import digest as gathered
from surefoot.scenarios.judge.people import Curves, curves
from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import BLUE, GREY, ORANGE
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.sim.render import Camera, render_frames

PICTURE = Path(__file__).with_name("strides.png")

GAIT = {
    "gait.steps": 16, "gait.step_length": 0.46, "gait.single_support": 0.42, "gait.double_support": 0.12,
    "gait.heel_off": 0.5, "gait.com_height": 1.01, "criteria": {"fell": False},
}  # fmt: skip
WALKS = {"lands flat": ({}, GREY), "lands on its heels": ({"gait.heel_strike": 0.2}, BLUE)}
"""Settings and colour of each walk."""

JOINTS = ("hip, less its mean", "knee", "ankle")
CAMERA, SIZE = Camera(2.6, 90.0, -3.0, tracking=False), (340, 540)
BEGIN, APART, POSES = 5.0, 0.18, 6
"""First of the poses, time between them, a sixth of a stride, and how many there are [s, s, -]."""

Picture = NDArray[np.uint8]


def walked(settings: dict[str, float], strip: bool) -> tuple[Curves | None, Picture | None]:
    """The joints of a walk over a stride, and the robot from the side where it is asked for."""
    with TemporaryDirectory() as folder:
        log = surefoot.read(surefoot.run(surefoot.load("walk-level", {**GAIT, **settings}), out=folder).log)
        return curves(RunView(gathered(log))), side_by_side(log) if strip else None


def side_by_side(log: Log) -> Picture:
    """The robot from the side at moments of one stride."""
    shown = poses(log, [BEGIN + APART * k for k in range(POSES)])
    world = log.attachments[WORLD_FILE].decode()
    return np.concatenate([np.asarray(next(iter(render_frames(world, [q], SIZE, CAMERA)))) for q in shown], axis=1)


def beside(axes: Axes, joint: int, found: dict[str, Curves]) -> None:
    """A joint of the walks over a stride, and what 95 of 100 people do."""
    share = np.arange(100)
    some = next(iter(found.values()))
    mean, band = np.degrees(some.people[joint]), 2.0 * np.degrees(some.deviation[joint])
    axes.fill_between(share, mean - band, mean + band, color=ORANGE, alpha=0.25, lw=0, label="95 of 100 people")
    axes.plot(share, mean, color=ORANGE, lw=1.0, label="mean of people")
    for name, of in found.items():
        axes.plot(share, np.degrees(of.robot[joint]), color=WALKS[name][1], lw=1.6, label=name)
    axes.set_title(JOINTS[joint], fontsize=10)
    axes.set_xlabel("stride [%]")
    axes.set_xlim(0, 100)


def main(_: list[str] | None = None) -> None:
    """Walk, and write the picture."""
    found, strip = {}, None
    for name, (settings, _colour) in WALKS.items():
        of, picture = walked(settings, bool(settings))
        if of is None:
            raise SystemExit(f"the walk that {name} has no steady stride; give it more steps")
        found[name], strip = of, strip if picture is None else picture
    figure = plt.figure(figsize=(9.0, 6.3), layout="constrained")
    rows = figure.subfigures(2, 1, height_ratios=(1.0, 1.05))
    seen = rows[0].subplots()
    if strip is not None:
        seen.imshow(strip)
    seen.axis("off")
    axes = rows[1].subplots(1, 3)
    for joint, axis in enumerate(axes):
        beside(axis, joint, found)
    axes[0].set_ylabel("flexion [deg]")
    handles, names = axes[0].get_legend_handles_labels()
    rows[1].legend(handles, names, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    figure.savefig(PICTURE, dpi=130, metadata={KEY: digest("strides.png")})


if __name__ == "__main__":
    main()
