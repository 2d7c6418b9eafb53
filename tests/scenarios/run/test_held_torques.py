import pytest

from surefoot.planner.plan.sampling import PlanSampler
from surefoot.scenarios.run import planning
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.load import load as load_scenario

pytestmark = pytest.mark.unit


def test_what_is_decided_for_a_tick_is_what_is_planned_for_its_middle(monkeypatch):
    """A torque is held for a tick; planned for its begin, the ZMP would lag by half of it."""
    acted = []

    class Noting(PlanSampler):
        def tick(self, time, middle):
            acted.append(middle)
            return super().tick(time, middle)

    monkeypatch.setattr(planning, "PlanSampler", Noting)
    with Simulation(load_scenario("walk-level", ("fidelity=pendulum",))) as simulation:
        ticks = [simulation.step() for _ in range(20)]
        rate = simulation.walk.rates.control
    assert acted == pytest.approx([tick.time + 0.5 / rate for tick in ticks])
    assert [tick.reference.time for tick in ticks] == pytest.approx([tick.time for tick in ticks])
