"""From a log to what a replay shows of it: which frames, where the bodies are in them, and what they look like."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Coordinates
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.body import torso
from surefoot.scenarios.judge.digest import RunView, Window, always
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.judge.verdict import agenda_of
from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import FEET, Color
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.record.provenance import WORLD_FILE, RunConstants
from surefoot.scenarios.show.logview import FOOT_NAMES, rows_at
from surefoot.scenarios.show.replay import content
from surefoot.scenarios.show.replay.content import Array, Frames, Replay, ReplayWindow
from surefoot.sim.bodies import BodyPoses
from surefoot.sim.shapes import drawn_shapes
from surefoot.sim.triangles import Triangles, merged, triangles

READS: Reads = {
    "/truth": ("q", "com", "left_sole", "right_sole"),
    "/measurement": ("external_force", "wrench_left", "wrench_right"),
    "/estimate": ("dcm",),
    "/contact": ("zmp", "planned", "felt", "cop_left", "cop_right"),
    "/reference": ("com", "dcm", "zmp", "support"),
    "/footsteps": ("next", "next_foot"),
}
"""Fields of which a replay shows something in each frame."""


def choose_frames(run: RunView, window: ReplayWindow, whole: tuple[float, float]) -> Frames:
    """Frames of a window, without those in which the robot's state is not finite.

    Args:
        run: the run, in the window at least.
        window: what is asked for.
        whole: first and last time of the log [s].

    Raises:
        LogError: the window holds no tick of the log.
    """
    ticks = run.time
    first, last = (ticks[0], ticks[-1]) if len(ticks) else (math.inf, -math.inf)
    start = first if window.start is None else max(window.start, first)
    end = last if window.end is None else min(window.end, last)
    if not start <= end:
        raise _nothing(run.log.path, window, whole)
    inside, rate = ticks[(ticks >= start - 1e-9) & (ticks <= end + 1e-9)] - start, window.frame_rate
    numbers = _numbers(inside, rate)
    if window.most is not None and len(numbers) > window.most:
        rate *= window.most / (len(numbers) + 1)
        numbers = _numbers(inside, rate)
    if not len(numbers):
        raise LogError(f"{run.log.path}: no control tick from {start:g} s to {end:g} s; choose another part")
    time = start + numbers / rate
    rows = rows_at(ticks, time)
    sound = np.isfinite(run.field("/truth", "q")[rows]).all(axis=1)
    if not sound.any():
        raise LogError(f"{run.log.path}: the robot's state is never finite; there is nothing to replay")
    return Frames(time[sound], rows[sound], rate)


def _numbers(times: Array, rate: float) -> Array:
    """Numbers of the frames that have a tick of their own, so that one damaged time stamp does not make hours of them.

    Args:
        times: of the ticks, from the first frame on, shape (n,) [s].
        rate: frames per second [Hz].
    """
    return np.unique(np.floor(times * rate + 1e-6))


def _nothing(path: Path, window: ReplayWindow, whole: tuple[float, float]) -> LogError:
    """A window holds nothing of a log that goes from one time to another [s]."""
    asked = " ".join(f"{word} {t:g} s" for word, t in (("from", window.start), ("to", window.end)) if t is not None)
    return LogError(f"{path}: nothing {asked}; the log goes from {whole[0]:g} s to {whole[1]:g} s")


_SHOWN = ("/truth", "/measurement", "/estimate", "/contact", "/reference")
"""Topics of which a replay is made; of a seat those that are not of a planner."""


def extract(log: Log, window: ReplayWindow | None = None) -> Replay:
    """Read what there is to show in a window of a log of full physics, also a truncated one; all of it by default.

    Raises:
        LogError: the log does not describe such a run, or has nothing in that window.
    """
    constants, window = RunConstants.from_metadata(log.metadata, str(log.path)), window or ReplayWindow()
    if constants.fidelity == "pendulum":
        raise LogError(f"{log.path}: a pendulum has no body to replay; run the scenario with fidelity full")
    mjcf, model = world(log)
    log.require("a replay", *(topic for topic in _SHOWN if topic in always(constants.walker)))
    if "/truth" not in log or not log.count("/truth"):
        raise LogError(f"{log.path}: ends before the first control tick; there is nothing to replay")
    if not all(math.isfinite(time) for time in (window.start, window.end) if time is not None):
        raise _nothing(log.path, window, log.time_range())
    before = None if window.start is None else window.start - content.PUSH_SHOWN
    run = RunView(Window(log, log.gather(READS, before, window.end)), constants)
    frames = choose_frames(run, window, log.time_range())
    configurations = run.field("/truth", "q")[frames.rows]
    if configurations.shape[1] != Coordinates(model).size:
        raise LogError(f"{log.path}: /truth and world.xml are of different robots; replay needs an intact log")
    position, quaternion = _body_poses(model, configurations)
    names = tuple(model.body(body).name for body in range(model.nbody))
    pushed = names.index(body) if (body := _pushed_body(log, run)) in names else 0
    turned = Rotation.from_quat(quaternion[:, pushed], scalar_first=True).apply(model.body_ipos[pushed])
    facts = _facts(run, frames, position[:, pushed] + turned)
    return Replay(
        title=run.constants.scenario,
        frame_rate=frames.rate,
        time=frames.time,
        configuration=configurations,
        body_names=names,
        body_position=position,
        body_quaternion=quaternion,
        surfaces=surfaces(model),
        tracks=(*content.tracks(facts), *_beside(log, window, model, constants, frames)),
        footprints=tuple(_taken_footprints(log, frames, facts.sole)),
        mjcf=mjcf,
    )


def _beside(
    log: Log, window: ReplayWindow, model: mujoco.MjModel, constants: RunConstants, frames: Frames
) -> Iterator[content.Track]:
    """The motion that is asked for, from the log's first tick on."""
    if window.beside is None:
        return
    from surefoot.scenarios.show.replay.reference import reference_tracks

    begin = next(log.parts("/truth"))
    time = frames.time - float(begin.time[0])
    yield from reference_tracks(window.beside, model, constants.joint_names, begin.field("q")[0], time)


def world(log: Log) -> tuple[str, mujoco.MjModel]:
    """The world that was simulated, as MJCF and compiled.

    Raises:
        LogError: the log has none, or it is damaged.
    """
    try:
        text = log.attachments[WORLD_FILE].decode()
    except (KeyError, UnicodeDecodeError):
        raise LogError(f"{log.path}: holds no readable {WORLD_FILE}; replay needs a log of fidelity full") from None
    try:
        return text, mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{log.path}: {WORLD_FILE} is damaged, {reason}; replay needs an intact one") from None


def _body_poses(model: mujoco.MjModel, configurations: Array) -> tuple[Array, Array]:
    """Positions, shape (n, bodies, 3) [m], and quaternions w x y z of the bodies, the world first."""
    poses, count = BodyPoses(model), len(configurations)
    positions, quaternions = np.zeros((count, model.nbody, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (count, model.nbody, 1))
    for q, position, quaternion in zip(configurations, positions, quaternions, strict=True):
        poses.update(q)
        position[1:], quaternion[1:] = poses.position, poses.quaternion
    return positions, quaternions


def _pushed_body(log: Log, run: RunView) -> str:
    """Body that the pushes of the run act on; the torso when they act on several or on none that is known."""
    try:
        bodies = agenda_of(log, scenario_of(log)).bodies
    except LogError:
        bodies = ()
    return bodies[0] if len(bodies) == 1 else torso(run.constants.roles)


def _facts(run: RunView, frames: Frames, pushed: Array) -> content.Facts:
    """Extract the facts; the push is the strongest of the last moments, at a place of shape (n, 3) [m]."""
    rows, count = frames.rows, len(frames.rows)
    ahead, ahead_foot = np.empty((count, 0, 4)), np.empty((count, 0))
    if run.has("/footsteps"):
        footsteps = run.log["/footsteps"]
        then = rows_at(footsteps.time, frames.time)
        ahead, ahead_foot = footsteps.field("next")[then], footsteps.field("next_foot")[then]
    push = np.nan_to_num(run.field("/measurement", "external_force"))
    planned = run.has("/reference")

    def field(topic: str, name: str, *shape: int) -> Array:
        """A field, which is nowhere to be seen where nothing is planned."""
        return run.field(topic, name)[rows] if planned else np.full((count, *shape), np.nan)

    return content.Facts(
        com=run.field("/truth", "com")[rows],
        dcm=field("/estimate", "dcm", 2),
        zmp=run.field("/contact", "zmp")[rows],
        planned_com=field("/reference", "com", 3),
        planned_dcm=field("/reference", "dcm", 2),
        planned_zmp=field("/reference", "zmp", 2),
        polygon=field("/reference", "support", SUPPORT_VERTICES, 2),
        contacts=run.field("/contact", "planned" if planned else "felt")[rows] != 0,
        soles=np.stack([run.sole(foot)[rows] for foot in (0, 1)], axis=1),
        cop=np.stack([run.field("/contact", f"cop_{side}")[rows] for side in FOOT_NAMES], axis=1),
        force=np.stack([run.field("/measurement", f"wrench_{side}")[rows, :3] for side in FOOT_NAMES], axis=1),
        ahead=ahead,
        ahead_foot=ahead_foot,
        push=push[frames.strongest(np.linalg.norm(push, axis=1), run.time, content.PUSH_SHOWN)],
        pushed=pushed,
        sole=(run.constants.foot_length, run.constants.foot_width),
    )


def _taken_footprints(log: Log, frames: Frames, sole: content.SoleSize) -> Iterator[content.Footprint]:
    """Footprints of the feet at first, and of every touchdown until the last frame."""
    first = next(log.parts("/footsteps"), None) if "/footsteps" in log.numeric else None
    if first is not None:
        for color, name in zip(FEET, FOOT_NAMES, strict=True):
            corners = content.sole_corners(first.field(f"current_{name}")[:1], sole)[0]
            yield content.Footprint(color, corners, float(first.time[0]))
    if "/footstep" in log.numeric:
        taken = log.window("/footstep", None, float(frames.time[-1]))
        corners = content.sole_corners(taken.field("actual"), sole)
        for time, foot, place in zip(taken.time.tolist(), taken.field("foot").tolist(), corners, strict=True):
            if np.isfinite(place).all():
                yield content.Footprint(FEET[foot == 1], place, time)


def surfaces(model: mujoco.MjModel) -> tuple[content.Surface, ...]:
    """Every visible geom but the endless ground, geoms of one body and one colour merged."""
    groups: dict[tuple[int, Color], list[Triangles]] = {}
    for shape in drawn_shapes(model):
        vertices, faces = triangles(shape)
        placed = vertices @ shape.rotation.T + shape.position, faces
        groups.setdefault((shape.body, shape.color[:3]), []).append(placed)
    return tuple(content.Surface(body, color, *merged(parts)) for (body, color), parts in groups.items())
