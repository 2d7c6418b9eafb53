"""The bodies of the robot that touch each other in a run, by the states and the world of its log."""

from typing import NamedTuple

import numpy as np

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Log

MOST_TICKS = 200
"""Ticks whose contacts are looked at; of more, so many from the first to the last."""


class Touch(NamedTuple):
    """Two bodies, and when they are first found to touch [s]."""

    one: str
    other: str
    time: float


def touching(log: Log) -> tuple[Touch, ...]:
    """Pairs of bodies that touch in ticks with ``self_contact``, in the order of their times.

    A log without such ticks has none, and neither has one whose world cannot be read.
    """
    if "/truth" not in log.numeric or all(field.name != "self_contact" for field in log.fields("/truth")):
        return ()
    truth = log.gather({"/truth": ("self_contact",)})["/truth"]
    ticks = np.flatnonzero(truth.field("self_contact"))
    if not ticks.size:
        return ()
    # Few runs get here, and the others need no engine.
    from surefoot.engines.windowless import mujoco
    from surefoot.models.convert import Coordinates
    from surefoot.scenarios.show.replay.extract import world

    try:
        _, model = world(log)
    except LogError:
        return ()
    data, found, coordinates = mujoco.MjData(model), dict[tuple[str, str], float](), Coordinates(model)
    chosen = np.unique(np.linspace(0, ticks.size - 1, min(ticks.size, MOST_TICKS)).astype(int))
    for time in truth.time[ticks[chosen]].tolist():
        state = log.window("/truth", time, time).field("q")[0]
        if state.shape != (coordinates.size,):
            return ()
        coordinates.to_mujoco(state, np.zeros(coordinates.size - 1), data.qpos, data.qvel)
        mujoco.mj_fwdPosition(model, data)
        for bodies in model.geom_bodyid[data.contact.geom]:
            if bodies.all():
                one, other = sorted(model.body(body).name for body in bodies)
                found.setdefault((one, other), time)
    return tuple(Touch(*pair, time) for pair, time in found.items())
