"""A walk up to the point of its gait at which it is pushed, walked once for many pushes that come there."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import surefoot
from surefoot.planner.laws.profiles import Profile
from surefoot.scenarios.file.schema import PushSettings
from surefoot.scenarios.setup.groups.gait import PushPoint, push_force


def pushed(
    keys: Mapping[str, Any],
    push: Mapping[str, Any],
    ways: Iterable[tuple[float, float]],
    planner: Profile | None = None,
) -> Iterator[surefoot.Simulation]:
    """Simulations of a walk that is pushed at a point of its gait, each in another way, as the push begins.

    Args:
        keys: of `walk-level`.
        push: keys of a push: the point of the gait, and its duration.
        ways: impulses and directions [N·s/kg, rad].
        planner: a profile in place of the scenario's.
    """
    point = PushPoint.of(PushSettings(**push))
    assert point is not None
    with surefoot.Simulation(surefoot.load("walk-level", {**keys, "pushes": []}), planner=planner) as simulation:
        left, tick = math.inf, 1.0 / simulation.walk.rates.control
        while left > 1.5 * tick:
            seen = simulation.step()
            left = seen.plan.time + point.left(seen.plan.phase) - seen.time
        state = simulation.save()
        for impulse, direction in ways:
            simulation.restore(state)
            settings = PushSettings(**{**push, "impulse": impulse, "direction": direction})
            simulation.push(push_force(settings, simulation.walk.true_mass), settings.duration)
            yield simulation


def stands(simulation: surefoot.Simulation, lasts: float) -> bool:
    """Return true if it does not fall within a time [s] from now."""
    end = simulation.time + lasts
    while not (simulation.done or simulation.fell) and simulation.time < end:
        simulation.advance()
    return not simulation.fell
