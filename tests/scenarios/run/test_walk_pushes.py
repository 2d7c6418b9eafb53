"""A small robot that walks is pushed hard at its torso, catches itself with a long step, and goes on."""

import math

import pytest
from enough import at_least
from one_walk import pushed, stands

from surefoot.planner.steps import adaptation
from surefoot.wbc.qp import solvers
from surefoot.wbc.types import SolveStatus

pytestmark = pytest.mark.physics


LASTS = 2.0
"""Time after a push within which those fall that do not catch themselves [s]."""


def hard(impulses, direction):
    """Tell whether it falls after pushes late in its third step, and the ticks at which its QP drops all limits."""
    push = {"step": 3, "phase": "single", "fraction": 0.65, "duration": 0.1}
    keys = {"robot": "g1", "sensing.source": "truth"}
    for simulation in pushed(keys, push, [(impulse, direction) for impulse in impulses]):
        dropped, end = 0, simulation.time + LASTS
        while not simulation.fell and simulation.time < end:
            dropped += simulation.step().report.status is SolveStatus.EQUALITIES_ONLY
        yield simulation.fell, dropped


@pytest.mark.parametrize("direction", [0.25, -0.3])
def test_a_long_step_does_not_throw_it_as_it_lands(direction):
    """At least four of five neighbours stand, and none of them meets a QP whose limits are all dropped."""
    runs = list(hard((0.55, 0.58, 0.61, 0.64, 0.67), direction))
    assert sum(fell for fell, _ in runs) <= 1
    assert not any(dropped for fell, dropped in runs if not fell)


PHASES = (("double", 0.5), ("single", 0.2), ("single", 0.5), ("single", 0.8))


def around(adaptation, phases):
    """Tell whether it stands, from good sensors, after two opposite pushes of 0.4 N·s/kg in each of some phases."""
    for n in phases:
        push = dict(zip(("phase", "fraction"), PHASES[n], strict=True), step=5, duration=0.1)
        keys = {"robot": "g1", "seed": n % 3, "planner.step_adaptation": adaptation}
        keys |= {"sensing.source": "ekf", "sensing.preset": "good"}
        ways = [(0.4, n * math.pi / 4.0), (0.4, (n + 4) * math.pi / 4.0)]
        for simulation in pushed(keys, push, ways):
            yield stands(simulation, LASTS)


def test_half_the_pushes_of_the_walking_ladder_do_not_fell_it_anywhere_around_the_compass():
    """The campaign `walk-ladder` has all directions in all phases; of one in hundreds a walk falls all the same."""
    assert at_least(7, around("crossing", range(4)))  # of eight
    # Negative control.
    assert at_least(3, (not stood for stood in around("none", (0, 2))))  # of four


NEVER, SLOW = 1e-6, 0.034
"""Value of `again_cost` with which no foot that has landed steps again [-]; twice the least double support [s]."""


def in_double_support(**recovery):
    """Tell whether it stands after each of three pushes to the right as the right foot has landed."""
    push = {"step": 5, "phase": "double", "fraction": 0.05, "duration": 0.1}
    keys = {"robot": "g1", "sensing.source": "truth"}
    keys |= {f"planner.recovery.{name}": value for name, value in recovery.items()}
    ways = [(impulse, -1.33) for impulse in (0.5, 0.55, 0.6)]
    return (stands(simulation, LASTS) for simulation in pushed(keys, push, ways))


def test_a_foot_that_landed_steps_again_after_a_push_aside():
    """Double supports are slow: after quicker ones the other foot crosses in time."""
    assert all(in_double_support()) and all(in_double_support(least_double=SLOW))
    # Negative control.
    assert at_least(2, (not stood for stood in in_double_support(least_double=SLOW, again_cost=NEVER)))


def test_with_a_heel_rolled_in_no_time_and_soles_held_at_any_price_the_qp_drops_all_limits(monkeypatch):
    """Negative control."""
    monkeypatch.setattr(adaptation, "with_roll", lambda schedule, *_: schedule)
    held = property(lambda solver: False, lambda solver, value: None)
    monkeypatch.setattr(solvers.Daqp, "_lets_go", held, raising=False)
    assert all(dropped for _, dropped in hard((0.67, 0.7, 0.73), 0.25))
