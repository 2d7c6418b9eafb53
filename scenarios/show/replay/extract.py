"""From a log to what a replay shows of it: which frames, where the bodies are in them, and what they look like."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from surefoot.engine import mujoco
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.body import torso
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.verdict import agenda_of, scenario_of
from surefoot.scenarios.log import Log
from surefoot.scenarios.palette import FEET, Color
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.show.logview import FOOT_NAMES, rows_at
from surefoot.scenarios.show.replay import content
from surefoot.scenarios.show.replay.content import Array, Frames, Replay, ReplayWindow
from surefoot.sim.bodies import BodyPoses
from surefoot.sim.shapes import drawn_shapes
from surefoot.sim.triangles import Triangles, merged, triangles


def choose_frames(run: RunView, window: ReplayWindow) -> Frames:
    """Frames of a window, without those in which the robot's state is not finite.

    Raises:
        LogError: the window holds no tick of the log.
    """
    if len(run.time) == 0:
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
    rows = rows_at(ticks, time)
    sound = np.isfinite(run.field("/truth", "q")[rows]).all(axis=1)
    if not sound.any():
        raise LogError(f"{run.log.path}: the robot's state is never finite; there is nothing to replay")
    return Frames(time[sound], rows[sound])


_SHOWN = ("/truth", "/measurement", "/estimate", "/contact", "/reference")
"""Topics of which a replay is made."""


def extract(log: Log, window: ReplayWindow | None = None) -> Replay:
    """Read what there is to show in a window of a log of full physics, also a truncated one; all of it by default.

    Raises:
        LogError: the log does not describe such a run, or has nothing in that window.
    """
    run, window = RunView(log), window or ReplayWindow()
    if run.constants.fidelity == "pendulum":
        raise LogError(f"{log.path}: a pendulum has no body to replay; run the scenario with fidelity full")
    mjcf, model = world(log)
    log.require("a replay", *_SHOWN)
    log.load(*_SHOWN)
    frames = choose_frames(run, window)
    configurations = run.field("/truth", "q")[frames.rows]
    if configurations.shape[1] != model.nq:
        raise LogError(f"{log.path}: /truth and world.xml are of different robots; replay needs an intact log")
    position, quaternion = _body_poses(model, configurations)
    names = tuple(model.body(body).name for body in range(model.nbody))
    pushed = names.index(body) if (body := _pushed_body(log, run)) in names else 0
    turned = Rotation.from_quat(quaternion[:, pushed], scalar_first=True).apply(model.body_ipos[pushed])
    facts = _facts(run, frames, position[:, pushed] + turned)
    return Replay(
        title=run.constants.scenario,
        frame_rate=window.frame_rate,
        time=frames.time,
        configuration=configurations,
        body_names=names,
        body_position=position,
        body_quaternion=quaternion,
        surfaces=surfaces(model),
        tracks=tuple(content.tracks(facts)),
        footprints=tuple(_taken_footprints(run, frames, facts.sole)),
        mjcf=mjcf,
    )


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
    """What the marks tell; the push is the strongest of the last moments, at a place of shape (n, 3) [m]."""
    rows, count = frames.rows, len(frames.rows)
    ahead, ahead_foot = np.empty((count, 0, 4)), np.empty((count, 0))
    if run.has("/footsteps"):
        planned = run.log["/footsteps"]
        then = rows_at(planned.time, frames.time)
        ahead, ahead_foot = planned.field("next")[then], planned.field("next_foot")[then]
    push = np.nan_to_num(run.field("/measurement", "external_force"))
    return content.Facts(
        com=run.field("/truth", "com")[rows],
        dcm=run.field("/estimate", "dcm")[rows],
        zmp=run.field("/contact", "zmp")[rows],
        planned_com=run.field("/reference", "com")[rows],
        planned_dcm=run.field("/reference", "dcm")[rows],
        planned_zmp=run.field("/reference", "zmp")[rows],
        polygon=run.field("/reference", "support")[rows],
        contacts=run.field("/contact", "planned")[rows] != 0,
        soles=run.soles[rows],
        cop=np.stack([run.field("/contact", f"cop_{side}")[rows] for side in FOOT_NAMES], axis=1),
        force=np.stack([run.field("/measurement", f"wrench_{side}")[rows, :3] for side in FOOT_NAMES], axis=1),
        ahead=ahead,
        ahead_foot=ahead_foot,
        push=push[frames.strongest(np.linalg.norm(push, axis=1), run.time, content.PUSH_SHOWN)],
        pushed=pushed,
        sole=(run.constants.foot_length, run.constants.foot_width),
    )


def _taken_footprints(run: RunView, frames: Frames, sole: content.SoleSize) -> Iterator[content.Footprint]:
    """Where the feet stood at first, and every touchdown until the last frame."""
    if run.has("/footsteps"):
        first = run.log["/footsteps"]
        for color, name in zip(FEET, FOOT_NAMES, strict=True):
            yield content.Footprint(
                color, content.sole_corners(first.field(f"current_{name}")[:1], sole)[0], float(first.time[0])
            )
    if run.has("/footstep"):
        taken = run.log["/footstep"]
        corners = content.sole_corners(taken.field("actual"), sole)
        for time, foot, place in zip(taken.time.tolist(), taken.field("foot").tolist(), corners, strict=True):
            if time <= frames.time[-1] and np.isfinite(place).all():
                yield content.Footprint(FEET[foot == 1], place, time)


def surfaces(model: mujoco.MjModel) -> tuple[content.Surface, ...]:
    """Every visible geom but the endless ground, geoms of one body and one colour merged."""
    groups: dict[tuple[int, Color], list[Triangles]] = {}
    for shape in drawn_shapes(model):
        vertices, faces = triangles(shape)
        placed = vertices @ shape.rotation.T + shape.position, faces
        groups.setdefault((shape.body, shape.color[:3]), []).append(placed)
    return tuple(content.Surface(body, color, *merged(parts)) for (body, color), parts in groups.items())
