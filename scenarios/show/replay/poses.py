"""The frames of a replay, evenly spaced in time, and where the bodies are in them."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from surefoot.models.convert import pinocchio_to_mujoco
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.log import Log
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.show.replay.content import Array


@dataclass(frozen=True, slots=True)
class Window:
    """What is asked for of a run.

    Attributes:
        start: first time, the log's if None [s].
        end: last time, the log's if None [s].
        frame_rate: frames per simulated second [Hz].
    """

    start: float | None = None
    end: float | None = None
    frame_rate: float = 30.0


@dataclass(frozen=True, slots=True)
class Frames:
    """Which ticks are shown.

    Attributes:
        time: of each frame, shape (n,) [s].
        rows: of the control-rate channels, shape (n,).
    """

    time: Array
    rows: NDArray[np.intp]

    def strongest(self, strength: Array, ticks: Array, seconds: float) -> NDArray[np.intp]:
        """Row of the largest value within some seconds before each frame, the frame's own included.

        Args:
            strength: by control tick.
            ticks: time of the control ticks [s].
            seconds: how far to look back [s].
        """
        first = np.minimum(np.searchsorted(ticks, self.time - seconds), self.rows)
        windows = zip(first.tolist(), self.rows.tolist(), strict=True)
        return np.array([begin + int(strength[begin : end + 1].argmax()) for begin, end in windows])


def choose_frames(run: RunView, window: Window) -> Frames:
    """Frames of a window, without those in which the robot's state is not finite.

    Raises:
        LogError: the window holds no tick of the log.
    """
    if run.ticks == 0:
        raise LogError(f"{run.log.path}: ends before the first control tick; there is nothing to replay")
    ticks = run.time
    first, last = float(ticks[0]), float(ticks[-1])
    start = first if window.start is None else max(window.start, first)
    end = last if window.end is None else min(window.end, last)
    if not start <= end:
        asked = " ".join(f"{word} {t:g} s" for word, t in (("from", window.start), ("to", window.end)) if t is not None)
        raise LogError(f"{run.log.path}: nothing {asked}; the log goes from {first:g} s to {last:g} s")
    # Only frames with a tick of their own, so that one damaged time stamp does not make hours of them.
    numbers = np.unique(
        np.floor((ticks[(ticks >= start - 1e-9) & (ticks <= end + 1e-9)] - start) * window.frame_rate + 1e-6)
    )
    if not len(numbers):
        raise LogError(f"{run.log.path}: no control tick from {start:g} s to {end:g} s; choose another part")
    time = start + numbers / window.frame_rate
    rows = np.maximum(np.searchsorted(ticks, time + 1e-9, side="right") - 1, 0)
    sound = np.isfinite(run.field("/truth", "q")[rows]).all(axis=1)
    if not sound.any():
        raise LogError(f"{run.log.path}: the robot's state is never finite; there is nothing to replay")
    return Frames(time[sound], rows[sound])


def world_text(log: Log) -> str:
    """MJCF text of the world that was simulated.

    Raises:
        LogError: the log has none.
    """
    try:
        return log.attachments[WORLD_FILE].decode()
    except (KeyError, UnicodeDecodeError):
        raise LogError(f"{log.path}: holds no readable {WORLD_FILE}; replay needs a log of fidelity full") from None


def compile_world(log: Log) -> mujoco.MjModel:
    """Compile the world of a log.

    Raises:
        LogError: the log has no world, or it is damaged.
    """
    try:
        return mujoco.MjModel.from_xml_string(world_text(log))
    except ValueError as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{log.path}: {WORLD_FILE} is damaged, {reason}; replay needs an intact one") from None


def body_poses(model: mujoco.MjModel, configurations: Array) -> tuple[Array, Array]:
    """Poses of the bodies.

    Args:
        model: the world.
        configurations: in Pinocchio's convention, shape (n, nq).

    Returns:
        positions, shape (n, bodies, 3) [m], and quaternions w x y z, shape (n, bodies, 4).
    """
    data, rest = mujoco.MjData(model), np.zeros(model.nv)
    positions = np.empty((len(configurations), model.nbody, 3))
    quaternions = np.empty((len(configurations), model.nbody, 4))
    for q, position, quaternion in zip(configurations, positions, quaternions, strict=True):
        pinocchio_to_mujoco(q, rest, data.qpos, data.qvel)
        mujoco.mj_kinematics(model, data)
        position[:], quaternion[:] = data.xpos, data.xquat
    return positions, quaternions
