"""Arms that a push throws about are kept from torso, base and thighs."""

import math
from collections.abc import Iterator

import pytest

import surefoot
from surefoot.scenarios.setup.load import read_scenario
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells

pytestmark = pytest.mark.physics


LASTS = 2.0
"""Time from a push on in which arms are thrown about and the steps that catch the body are taken [s]."""


def touches(robot: str, seed: int, **more: object) -> Iterator[bool]:
    """Tell tick by tick whether the robot touches itself, in a walk of the campaign `random-pushes`."""
    cell = list(cells(read_campaign("random-pushes", (f"robot={robot}",))))[seed]
    point = cell.point(seed, {})
    return touching(read_scenario(*point.base.written, {**point.settings, **more}), LASTS)


def touching(scenario: surefoot.Scenario, lasts: float) -> Iterator[bool]:
    """The same of any walk, until so long after its push [s]."""
    with surefoot.Simulation(scenario) as simulation:
        end = math.inf
        while simulation.time < end:
            tick = simulation.step()
            assert not tick.fell
            yield tick.measurement.self_contact
            if tick.measurement.external_force.any():
                end = tick.time + lasts


@pytest.mark.parametrize(
    ("robot", "seed"),
    [("talos", 2), ("talos", 16), ("humanoid100", 67)],
)
def test_a_pushed_robot_does_not_hit_itself(robot, seed):
    """Upper arms of TALOS hit its torso where they are not kept off; a forearm of humanoid100 hit its own body."""
    assert not any(touches(robot, seed))


def test_one_whose_limbs_are_not_kept_apart_does():
    """Negative control."""
    assert any(touches("talos", 2, **{"wbc.separation.slots": 0}))


def pushed_on_stairs(slots: int) -> Iterator[bool]:
    """The same of a walk down stairs that is pushed over its stance foot in its seventh step."""
    push = {"step": 7, "phase": "single", "fraction": 0.2, "duration": 0.1, "impulse": 0.2, "direction": -math.pi / 2}
    start = {"gait.initial_stand": 0.4, "start.position_noise": 0.0005, "sensing.source": "truth"}
    keys = {**start, "duration": 17.0, "pushes": [push], "wbc.separation.slots": slots}
    return touching(surefoot.load("stairs-down", keys), 0.6)


def test_an_arm_is_seen_beside_legs_that_cross():
    """Legs that cross are near each other in several pairs, which left none of three for an arm."""
    assert not any(pushed_on_stairs(6))
    assert any(pushed_on_stairs(3))  # negative control
