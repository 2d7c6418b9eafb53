"""A planner of one's own hears what a walk is told if it has what hears, and is refused by name if not."""

import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.commands import Command
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.unit

STAND = {"fidelity": "pendulum", "duration": 0.5, "gait.steps": 0, "criteria": {"fell": False}}


class Deaf:
    """It plans as ours does."""

    def __init__(self, *given):
        self.inner = WalkingPlanner(*given)
        self.parameters, self.update = self.inner.parameters, self.inner.update


class Hearing(Deaf):
    """It hears, too."""

    heard: list[Command]

    def __init__(self, *given):
        super().__init__(*given)
        self.heard = []

    @property
    def orders(self):
        return self.inner.orders

    def command(self, command):
        self.heard.append(command)
        if command.swing_height == 0.04:
            raise RuntimeError("too low")
        self.inner.command(command)


def profile(planner):
    default = PROFILES["default"]
    return Profile("own", "plans", default.parameters, default.law, moves=True, planner=planner)


@pytest.fixture(params=[Deaf, Hearing])
def named(request):
    yield PROFILES.add("own", profile(request.param))
    PROFILES.discard("own")


def test_one_that_hears_is_told_and_its_orders_are_known():
    with surefoot.Simulation(load("stand", STAND), planner=profile(Hearing)) as sim:
        sim.step()
        sim.command(v_x=0.1)
        (heard,) = sim.planner.heard
        while sim.orders.twist is None:
            sim.step()
        assert heard == Command(sim.orders.twist, time=heard.time)


def test_what_it_raises_is_told_with_its_name():
    with surefoot.Simulation(load("stand", STAND), planner=profile(Hearing)) as sim:
        sim.step()
        with pytest.raises(surefoot.PartError, match=r"profile 'own' of this program: RuntimeError: too low"):
            sim.command(swing_height=0.04)


def test_one_that_does_not_hear_refuses():
    with surefoot.Simulation(load("stand", STAND), planner=profile(Deaf)) as sim:
        sim.step()
        with pytest.raises(surefoot.ParameterError, match="a command to Deaf, which takes none"):
            sim.command(v_x=0.1)


def test_a_scenario_with_commands_is_refused_for_one_that_does_not_hear(named):
    keys = {**STAND, "planner.profile": "own", "commands": [{"time": 0.1, "v_x": 0.0}]}
    if hasattr(named.planner, "command"):
        assert load("stand", keys).commands
        return
    with pytest.raises(ScenarioError, match=r"planner.profile own, whose planner takes no commands"):
        load("stand", keys)
