"""Forces as arrows: what the ground does to each sole, and pushes."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from scenarios.errors import LogError
from scenarios.log import Log
from scenarios.metrics.view import RunView
from scenarios.replay import palette
from scenarios.replay.content import Array, Track
from scenarios.replay.frames import Frames
from scenarios.verdict import scenario_of

CONTACT_SCALE = 0.0005
"""Length of a contact force's arrow [m/N]: 1000 N are 0.5 m."""

PUSH_SCALE = 0.002
"""Length of a push's arrow [m/N]: 200 N are 0.4 m."""

PUSH_SHOWN = 0.3
"""How long a push stays in sight after its end, since many last less than a frame [s]."""

LEAST_FORCE = 5.0
"""Weaker forces are not drawn [N]."""


def contact_forces(run: RunView, frames: Frames) -> Iterator[Track]:
    """Contact force on each sole, from its centre of pressure."""
    for foot, name in enumerate(("left", "right")):
        pose = run.soles[frames.rows, foot]
        rotation = Rotation.from_quat(pose[:, 3:])
        cop = run.field("/contact", f"cop_{name}")[frames.rows]
        tail = pose[:, :3] + rotation.apply(np.column_stack([cop, np.zeros(len(cop))]))
        force = rotation.apply(run.field("/measurement", f"wrench_{name}")[frames.rows, :3])
        yield Track("Contact forces", name, "arrow", palette.FEET[foot], 0.012, _arrow(tail, force, CONTACT_SCALE))


def push(log: Log, run: RunView, frames: Frames, body_names: tuple[str, ...], body_com: Array) -> Track:
    """The strongest push of the last moments, with its head at the body it acts on.

    Args:
        log: tells which body the scenario pushes.
        run: the run.
        frames: what is shown.
        body_names: by body.
        body_com: centres of mass of the bodies, shape (n, bodies, 3) [m].
    """
    forces = run.field("/measurement", "external_force")
    force = forces[frames.strongest(np.linalg.norm(forces, axis=1), run.time, PUSH_SHOWN)]
    head = body_com[:, body_names.index(body)] if (body := _pushed_body(log)) in body_names else body_com[:, 0]
    arrow = _arrow(head - PUSH_SCALE * force, force, PUSH_SCALE)
    return Track("Pushes", "push", "arrow", palette.YELLOW, 0.02, arrow)


def _pushed_body(log: Log) -> str:
    """Body that the pushes of the scenario act on; the torso when they name several or none."""
    try:
        bodies = {settings.body for settings in scenario_of(log).pushes}
    except LogError:
        bodies = set()
    return next(iter(bodies)) or "torso" if len(bodies) == 1 else "torso"


def _arrow(tail: Array, force: Array, scale: float) -> Array:
    """Tails and heads, NaN for forces too weak to draw, shape (n, 2, 3) [m]."""
    arrow = np.stack([tail, tail + scale * force], axis=1)
    arrow[np.linalg.norm(force, axis=1) < LEAST_FORCE] = np.nan
    return arrow
