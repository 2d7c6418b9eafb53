"""From a log to what a replay shows of it."""

import numpy as np
from scipy.spatial.transform import Rotation

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.replay.content import Replay
from surefoot.scenarios.show.replay.overlays import (
    balance,
    contact_forces,
    planned_footprints,
    push,
    taken_footprints,
)
from surefoot.scenarios.show.replay.poses import Window, body_poses, choose_frames, compile_world, surfaces, world_text


def extract(log: Log, window: Window | None = None) -> Replay:
    """Read what there is to show.

    Args:
        log: of a run in full physics, also a truncated one.
        window: what part of it; all by default.

    Raises:
        LogError: the log does not describe such a run, or has nothing in that window.
    """
    run = RunView(log)
    if run.constants.fidelity == "pendulum":
        raise LogError(f"{log.path}: a pendulum has no body to replay; run the scenario with fidelity full")
    model = compile_world(log)
    log.load("/truth", "/measurement", "/estimate", "/contact", "/reference")
    frames = choose_frames(run, window or Window())
    configurations = run.field("/truth", "q")[frames.rows]
    if configurations.shape[1] != model.nq:
        raise LogError(f"{log.path}: /truth and world.xml are of different robots; replay needs an intact log")
    position, quaternion = body_poses(model, configurations)
    names = tuple(model.body(body).name for body in range(model.nbody))
    com = position + Rotation.from_quat(quaternion, scalar_first=True).apply(
        np.broadcast_to(model.body_ipos, position.shape)
    )
    return Replay(
        title=run.constants.scenario,
        frame_rate=(window or Window()).frame_rate,
        time=frames.time,
        configuration=configurations,
        body_names=names,
        body_position=position,
        body_quaternion=quaternion,
        surfaces=surfaces(model),
        tracks=(
            *balance(run, frames).tracks(),
            *planned_footprints(run, frames),
            *contact_forces(run, frames),
            push(log, run, frames, names, com),
        ),
        footprints=tuple(taken_footprints(run, frames)),
        mjcf=world_text(log),
    )
