"""A walk that marches steps in place where its velocity is zero, and stands again when it is told to."""

import pytest

import surefoot
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.unit

G1 = {"robot": "g1", "sized_for": "humanoid100"}
MARCH = [{"time": 0.2, "march": True}, {"time": 4.0, "v_x": 0.0}]


def walked(**keys):
    told = {"gait.steps": 0, "gait.initial_stand": 0.2, "duration": 7.0, "commands": MARCH, "criteria": {"fell": False}}
    with surefoot.Simulation(load("walk-level", {**told, **keys})) as simulation:
        steps, place = set(), []
        while not simulation.done:
            tick = simulation.step()
            steps.add(tick.plan.phase.step)
            place.append(tick.com[:2])
        assert simulation.end.kind == "completed"
    return max(steps), abs(place[-1] - place[0]).max(), tick.plan.phase.kind.name


@pytest.mark.parametrize("keys", [{"fidelity": "pendulum"}, {}, G1], ids=["pendulum", "humanoid100", "g1"])
def test_it_steps_in_place_and_stands_at_the_end(keys):
    steps, away, last = walked(**keys)
    assert steps >= 3
    assert away < 0.05
    assert last == "STAND"


def test_a_zero_velocity_alone_stands():
    commands = [{"time": 0.2, "v_x": 0.1}, {"time": 0.25, "v_x": 0.0}]
    steps, _, last = walked(fidelity="pendulum", commands=commands)
    assert steps <= 2 and last == "STAND"


def test_it_can_be_told_from_a_program():
    scenario = load("commanded", {"fidelity": "pendulum"})
    with surefoot.Simulation(scenario) as simulation:
        for _ in range(10):
            simulation.advance()
        simulation.command(march=True)
        for _ in range(200):
            simulation.advance()
        assert simulation.orders.march and simulation.orders.twist.is_zero
        simulation.command(v_x=0.1)
        for _ in range(200):
            simulation.advance()
        assert not simulation.orders.march


@pytest.mark.parametrize("commands", [[{"time": 0.2, "march": True}]])
def test_a_march_without_an_end_needs_a_duration(commands):
    with pytest.raises(surefoot.ScenarioError, match="commands that do not end with a stop"):
        load("walk-level", {"gait.steps": 0, "commands": commands})
