"""Draw docs/images/strides.png: two walks from the side, as stick figures, and their joints beside those of people.

    python docs/images/strides.py

Two walks of 0.8 m/s from sensors, one on level feet and bent knees, one by its speed, half a minute of computing.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import mujoco
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from numpy.typing import NDArray
from poses import poses
from sources import KEY, digest

import surefoot
from surefoot.models.convert import Coordinates
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import digest as gathered
from surefoot.scenarios.judge.people import Curves, curves
from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import BLUE, GREY, ORANGE
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.sim.render import Camera, render_frames

PICTURE = Path(__file__).with_name("strides.png")

LEVEL = {"gait.step_length": 0.46, "gait.single_support": 0.45, "gait.double_support": 0.125}
WALKS = {
    "on level feet": ("walk-level", {"gait.steps": 16, **LEVEL, "criteria": {"fell": False}}, GREY),
    "by its speed": ("walk", {"gait.steps": 16, "gait.speed": 0.8, "criteria": {"fell": False}}, BLUE),
}
"""Scenario, settings and colour of each walk."""

JOINTS = ("hip, less its mean", "knee", "ankle")
CAMERA, SIZE = Camera(2.6, 90.0, -3.0, tracking=False), (340, 540)
BEGIN, APART, POSES = 5.0, 0.18, 6
"""First of the poses, time between them, a sixth of a stride, and how many there are [s, s, -]."""

STICKS, STEP, ASIDE = 16, 0.08, 0.8
"""Stick figures of a walk, time between them, and their distance in the picture [-, s, m]."""

HEEL, TOE = (-0.08, 0.0, -0.06), (0.14, 0.0, -0.06)
"""Ends of a foot in its frame [m]."""

HAND, CROWN = (0.0, 0.0, -0.26), (0.0, 0.0, 0.12)
"""End of a forearm, and middle of the head, in their frames [m]."""

Picture = NDArray[np.uint8]


def walked(scenario: str, settings: dict[str, Any]) -> Log:
    """The log of a walk, read whole."""
    with TemporaryDirectory() as folder:
        log = surefoot.read(surefoot.run(surefoot.load(scenario, settings), out=folder).log)
        log["/truth"], log.attachments
        return log


def side_by_side(log: Log) -> Picture:
    """The robot from the side at moments of one stride."""
    shown = poses(log, [BEGIN + APART * k for k in range(POSES)])
    world = log.attachments[WORLD_FILE].decode()
    return np.concatenate([np.asarray(next(iter(render_frames(world, [q], SIZE, CAMERA)))) for q in shown], axis=1)


def sticks(axes: Axes, log: Log) -> None:
    """The robot as lines between its joints, from the side, at moments of more than one stride."""
    model = mujoco.MjModel.from_xml_string(log.attachments[WORLD_FILE].decode())
    data, coordinates = mujoco.MjData(model), Coordinates(model)

    def at(body: str, point: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
        found = data.body(body)
        return np.asarray(found.xpos + found.xmat.reshape(3, 3) @ point)[[0, 2]]

    for k, q in enumerate(poses(log, [BEGIN + STEP * k for k in range(STICKS)])):
        coordinates.to_mujoco(q, np.zeros(model.nv), data.qpos, data.qvel)
        mujoco.mj_kinematics(model, data)
        aside = np.array([ASIDE * k - at("pelvis")[0], 0.0])
        for side, grey in (("right", "0.6"), ("left", "0.1")):
            ankle = at(f"{side}_foot")
            leg = at(f"{side}_thigh"), at(f"{side}_shank"), ankle
            foot = ankle, at(f"{side}_foot", TOE), at(f"{side}_foot", HEEL), ankle
            arm = at(f"{side}_upper_arm"), at(f"{side}_forearm"), at(f"{side}_forearm", HAND)
            for line in (leg, foot, arm):
                axes.plot(*(np.array(line) + aside).T, color=grey, lw=1.4)
        axes.plot(*(np.array([at("pelvis"), at("left_upper_arm")]) + aside).T, color="0.1", lw=1.4)
        axes.add_patch(Circle(tuple(at("head", CROWN) + aside), 0.11, fill=False, color="0.1"))
    axes.axhline(0.0, color="0.8", lw=0.8)
    axes.set_aspect("equal")
    axes.axis("off")


def beside(axes: Axes, joint: int, found: dict[str, Curves]) -> None:
    """A joint of the walks over a stride, and what 95 of 100 people do."""
    share = np.arange(100)
    some = next(iter(found.values()))
    mean, band = np.degrees(some.people[joint]), 2.0 * np.degrees(some.deviation[joint])
    axes.fill_between(share, mean - band, mean + band, color=ORANGE, alpha=0.25, lw=0, label="95 of 100 people")
    axes.plot(share, mean, color=ORANGE, lw=1.0, label="mean of people")
    for name, of in found.items():
        axes.plot(share, np.degrees(of.robot[joint]), color=WALKS[name][2], lw=1.6, label=name)
    axes.set_title(JOINTS[joint], fontsize=10)
    axes.set_xlabel("stride [%]")
    axes.set_xlim(0, 100)


def main(_: list[str] | None = None) -> None:
    """Walk, and write the picture."""
    logs = {name: walked(scenario, settings) for name, (scenario, settings, _) in WALKS.items()}
    found = {name: curves(RunView(gathered(log))) for name, log in logs.items()}
    if lacking := [name for name, of in found.items() if of is None]:
        raise SystemExit(f"the walk {lacking[0]} has no steady stride; give it more steps")
    figure = plt.figure(figsize=(9.0, 8.6), layout="constrained")
    rows = figure.subfigures(3, 1, height_ratios=(1.0, 0.75, 1.05))
    seen = rows[0].subplots()
    seen.imshow(side_by_side(logs["by its speed"]))
    seen.axis("off")
    for axis, (name, log) in zip(rows[1].subplots(2, 1), logs.items(), strict=True):
        sticks(axis, log)
        axis.set_title(name, fontsize=9, loc="left")
    axes = rows[2].subplots(1, 3)
    for joint, axis in enumerate(axes):
        beside(axis, joint, {name: of for name, of in found.items() if of is not None})
    axes[0].set_ylabel("flexion [deg]")
    handles, names = axes[0].get_legend_handles_labels()
    rows[2].legend(handles, names, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    figure.savefig(PICTURE, dpi=130, metadata={KEY: digest("strides.png")})


if __name__ == "__main__":
    main()
