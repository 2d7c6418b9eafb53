"""A motion of anybody's, for the robot of a log: read from a file, and drawn beside the robot."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from surefoot.engines.windowless import mujoco
from surefoot.planner.geometry.plane import headings
from surefoot.scenarios.errors import LogError, nearest
from surefoot.scenarios.palette import GREY
from surefoot.scenarios.show.replay.content import Track
from surefoot.sim.bodies import BodyPoses

Array = NDArray[np.float64]

FPS = {".npz": 50.0, ".csv": 30.0}
"""Frames per second by kind of file, where nothing else is said: a csv file does not tell, and is read as 30 [Hz]."""

MOST_FPS = 1000.0
"""Frames per second at most [Hz]."""

WXYZ, _XYZW = [3, 0, 1, 2], [1, 2, 3, 0]
"""Places of a quaternion's numbers in the other order."""

LAYER = "Reference"
"""Layer of the marks."""

THICK = 0.012
"""Radius of the lines from joint to joint [m]."""

SHORTEST = 1e-3
"""Length of the shortest line that is drawn [m]."""


@dataclass(frozen=True, slots=True)
class Motion:
    """Movement of a robot, frame by frame.

    Attributes:
        fps: frames per second [Hz].
        joint_names: in the order of the angles.
        root_position: of the base in the world, shape (n, 3) [m].
        root_quaternion: of the base in the world, w x y z, shape (n, 4).
        joint_position: shape (n, k) [rad].
    """

    fps: float
    joint_names: tuple[str, ...]
    root_position: Array
    root_quaternion: Array
    joint_position: Array

    def __len__(self) -> int:
        return len(self.root_position)

    def configurations(self, joint_names: Sequence[str], rest: Array) -> Array:
        """Configurations of a robot in Pinocchio's convention, shape (n, 7 + nj).

        Args:
            joint_names: of the robot, in its order.
            rest: angles of joints that the motion does not name, shape (nj,) [rad].
        """
        found = np.tile(np.concatenate((np.zeros(7), rest)), (len(self), 1))
        found[:, :3], found[:, 3:7] = self.root_position, self.root_quaternion[:, _XYZW]
        found[:, [7 + joint_names.index(name) for name in self.joint_names]] = self.joint_position
        return found


_LAYOUTS = (
    ("joint_pos", "joint_names", ("root_pos", "root_quat")),
    ("joint_pos", "joint_names", ("body_pos_w", "body_quat_w")),
    ("dof_positions", "dof_names", ("body_positions", "body_rotations")),
)
"""Names of angles, of the joints' names, and of places and quaternions w x y z of the base, or of all bodies with the
base first: whole_body_tracking and mjlab; Isaac Lab's AMP."""


def read_motion(path: Path, joint_names: Sequence[str]) -> Motion:
    """Read a motion of anybody's.

    Args:
        path: of an npz file in the layout of whole_body_tracking, mjlab or Isaac Lab's AMP, or of a csv file with root
            x y z, its quaternion x y z w, and the joints.
        joint_names: of the robot, in the order that a file means which names none.

    Raises:
        LogError: it cannot be read, or is of another robot.
    """
    reader = {".csv": _read_csv, ".npz": _read_npz}.get(path.suffix.lower())
    if reader is None:
        raise LogError(f"{path}: unknown kind of motion '{path.suffix}'; give a file that ends in .npz or .csv")
    try:
        found = reader(path, joint_names)
    except (OSError, ValueError, EOFError, KeyError, BadZipFile) as error:
        reason = " ".join(str(error).split())[:200]
        raise LogError(f"{path}: no motion that can be read, {reason}; give an npz or csv file") from None
    for name in found.joint_names:
        if name not in joint_names:
            raise LogError(f"{path}: a motion of joint '{name}', which the robot has not; {nearest(name, joint_names)}")
    numbers = np.hstack((found.root_position, found.root_quaternion, found.joint_position))
    if not len(found) or not np.isfinite(numbers).all() or not 0.0 < found.fps <= MOST_FPS:
        raise LogError(f"{path}: a motion without frames, or with numbers that are not finite; give a whole one")
    if np.abs(np.linalg.norm(found.root_quaternion, axis=1) - 1.0).max() > 0.01:
        raise LogError(f"{path}: the quaternions of the base are no rotations; give them w x y z, in a csv x y z w")
    return found


def _read_csv(path: Path, joint_names: Sequence[str]) -> Motion:
    with path.open(encoding="utf-8") as file:
        first = file.readline().split(",")
    rows = np.atleast_2d(np.loadtxt(path, delimiter=",", skiprows=0 if _is_number(first[0]) else 1))
    if rows.shape[1] != 7 + len(joint_names):
        raise ValueError(f"{rows.shape[1]} columns, and the robot has 7 and {len(joint_names)} joints")
    return Motion(FPS[".csv"], tuple(joint_names), rows[:, :3], rows[:, 3:7][:, WXYZ], rows[:, 7:])


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _read_npz(path: Path, joint_names: Sequence[str]) -> Motion:
    with np.load(path, allow_pickle=False) as file:
        known = [layout for layout in _LAYOUTS if all(name in file for name in (layout[0], *layout[2], "fps"))]
        if not known:
            held = ", ".join(file.files[:8])
            raise ValueError(f"its arrays {held} are of no layout that is known")
        angles, names, (places, turns) = known[0]
        joints = tuple(str(name) for name in file[names]) if names in file else tuple(joint_names)
        position, place, turn = (np.asarray(file[name], dtype=np.float64) for name in (angles, places, turns))
        fps = float(np.asarray(file["fps"]).ravel()[0])
    if place.ndim == 3:
        place, turn = place[:, 0], turn[:, 0]
    if position.ndim != 2 or place.shape != (len(position), 3) or turn.shape != (len(position), 4):
        raise ValueError(f"{angles}, {places} and {turns} are not of one number of frames")
    if position.shape[1] != len(joints):
        raise ValueError(f"{angles} has {position.shape[1]} joints, and {len(joints)} are named or the robot's")
    return Motion(fps, joints, place, turn, position)


def reference_tracks(
    path: Path, model: mujoco.MjModel, joint_names: Sequence[str], first: Array, time: Array
) -> Iterator[Track]:
    """A motion as lines from joint to joint, which begins with the log, at the place and heading of the robot.

    Args:
        path: of the motion.
        model: of the world with the robot.
        joint_names: of the robot, in the order of its configurations.
        first: configuration with which the log begins, shape (7 + nj,).
        time: of the frames since then, shape (n,) [s].

    Raises:
        LogError: it cannot be read, or is of another robot.
    """
    motion = read_motion(path, joint_names)
    q = placed(motion.configurations(joint_names, first[7:]), first)
    poses, positions = BodyPoses(model), np.full((len(time), model.nbody, 3), np.nan)
    frames = np.floor(time * motion.fps + 1e-6).astype(int)
    for index, frame in enumerate(frames.tolist()):
        if 0 <= frame < len(q):
            poses.update(q[frame])
            positions[index, 1:] = poses.position
    for body in np.flatnonzero(model.body_rootid == 1).tolist()[1:]:
        if np.linalg.norm(model.body_pos[body]) > SHORTEST:
            ends = positions[:, [model.body_parentid[body], body]]
            yield Track(LAYER, model.body(body).name, "outline", GREY, THICK, ends)


def placed(q: Array, first: Array) -> Array:
    """Configurations, shape (n, 7 + nj), turned and shifted on the level so that the first one is where another is."""
    turn, found = Rotation.from_euler("z", headings(first[None, 3:7])[0] - headings(q[:1, 3:7])[0]), q.copy()
    shift = first[:2] - turn.apply(q[0, :3])[:2]
    found[:, :3] = turn.apply(q[:, :3])
    found[:, :2] += shift
    found[:, 3:7] = (turn * Rotation.from_quat(q[:, 3:7])).as_quat()
    return found
