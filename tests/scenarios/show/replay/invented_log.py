"""A log of the real robot in an invented motion: smooth joints, a sideways drift, two steps, one short push."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import AttachedFile, LogWriter
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.provenance import RECORD, SCENARIO_FILE, WORLD_FILE
from surefoot.scenarios.run.run import run_constants
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim.world import World

RATE = 500
DURATION = 1.0
PUSH = (0.51, 0.52, np.array([0.0, 150.0, 0.0]))
"""Begin, end and force of the push."""

TOUCHDOWNS = ((0.4, 0, (0.2, 0.11, 0.0, 0.1)), (0.8, 1, (0.3, -0.11, 0.0, -0.1)))


def configuration(time: float, posture: np.ndarray, speed: float = 0.3) -> np.ndarray:
    """The robot's configuration."""
    quaternion = Rotation.from_euler("zyx", [0.5 * time, 0.1, -0.1 * time]).as_quat()
    return np.concatenate(([speed * time, 0.1 * time, 0.95], quaternion, posture + 0.2 * np.sin(4 * time)))


def sole(time: float, foot: int) -> np.ndarray:
    """Pose of a sole."""
    quaternion = Rotation.from_euler("zy", [0.3 * time, 0.2 * foot]).as_quat()
    return np.concatenate(([0.1 * time, 0.11 - 0.22 * foot, 0.02 * foot], quaternion))


def wrench(foot: int) -> np.ndarray:
    """Contact wrench of a sole; the right one is in the air."""
    return np.array([20.0, -10.0, 900.0, 1.0, 2.0, 0.0]) if foot == 0 else np.zeros(6)


def cop(foot: int) -> np.ndarray:
    """Centre of pressure of a sole."""
    return np.array([0.01, -0.02]) if foot == 0 else np.full(2, np.nan)


def write(
    path: Path, duration: float = DURATION, world: bytes | None = None, fidelity: str = "full", speed: float = 0.3
) -> Path:
    """Write the log."""
    robot = describe("humanoid100", RobotOptions())
    scenario = Scenario(name="invented", pushes=[{"time": 0.51, "force": (0, 150, 0), "body": "pelvis"}])
    constants = run_constants(resolve(scenario.model_copy(update={"fidelity": fidelity}), robot))
    text = World(robot, flat(), 1000).mjcf().encode() if world is None else world
    attached = [AttachedFile(SCENARIO_FILE, "application/yaml", scenario_yaml(scenario).encode())]
    attached += [AttachedFile(WORLD_FILE, "application/xml", text)] if text else []
    nj = len(robot.joint_names)
    sizes = channels.Sizes(nj=nj, nq=nj + 7, nv=nj + 6, horizon=50)
    with LogWriter(path, {RECORD: constants.to_metadata()}, attached) as writer:
        _fill(writer, sizes, robot.nominal_joint_positions, duration, speed)
    return path


def _fill(writer: LogWriter, sizes: channels.Sizes, posture: np.ndarray, duration: float, speed: float) -> None:
    makers = (channels.measurement, channels.truth, channels.estimate, channels.contact, channels.reference)
    out = {make.__name__: writer.channel(make(sizes)) for make in (*makers, channels.footsteps, channels.footstep)}
    zero, support = np.zeros(3), np.array([[-0.1, 0.1], [-0.1, 0.0], [0.1, 0.0], *[[0.1, 0.1]] * 5])
    for tick in range(round(duration * RATE)):
        time, ns = tick / RATE, tick * 10**9 // RATE
        com, force = np.array([0.3 * time, 0.0, 1.0]), PUSH[2] if PUSH[0] <= time < PUSH[1] else zero
        joints = np.zeros(sizes.nj)
        out["measurement"].append(ns, joints, joints, joints, zero, zero, wrench(0), wrench(1), force)
        q = configuration(time, posture, speed)
        out["truth"].append(ns, q, np.zeros(sizes.nv), com, zero, zero, sole(time, 0), sole(time, 1), 0.0, 0, 0)
        out["estimate"].append(ns, com, zero, com[:2] + 0.01, zero, np.zeros(6), zero, zero, 100.0)
        zmp = np.array([time, 0.0, 0.0]) if time < 0.9 else np.full(3, np.nan)
        out["contact"].append(ns, zmp, (900, 0), (1, 0), (1, 0), (1, 0), cop(0), cop(1), (0, 0))
        clock = (2, 0, 0, 0.0, 0.5)
        out["reference"].append(
            ns, com, zero, zero, zero[:2], zero[:2], 3.1, zero[:2], zero, zero, *clock, support, 4, zero[:2]
        )
        if tick % 10 == 0:
            ahead = np.full((3, 4), np.nan)
            ahead[0] = (0.2 + time, 0.11, 0.0, 0.0)
            here = (0.0, 0.11, 0.0, 0.0), (0.0, -0.11, 0.0, 0.0)
            out["footsteps"].append(ns, *here, ahead, (0, -1, -1), np.full(3, np.nan))
        for touchdown, foot, pose in TOUCHDOWNS:
            if tick == round(touchdown * RATE):
                out["footstep"].append(ns, 1, foot, pose, pose)
