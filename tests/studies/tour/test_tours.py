"""The tour in full physics, ten seconds of it."""

from dataclasses import replace

import pytest

from surefoot.studies.tour.ride import Setting, run_tour
from surefoot.studies.tour.rows import ROWS

pytestmark = pytest.mark.physics


@pytest.mark.parametrize("seed", [0, 1])
def test_the_first_ten_seconds_are_survived_and_places_are_reached(seed):
    result = run_tour(ROWS["torque"], seed, 10.0)
    assert result.completed and not result.fault
    assert len(result.punches) == len(result.position_errors) == 2
    assert max(result.position_errors) < 0.1 and max(result.heading_errors) < 0.1
    assert 50.0 < sum(result.energy) < 2000.0


def test_wrenches_that_follow_from_torques_push_nobody():
    """At 50 Hz they are of instants: taken for sure they told of 95 N, and robots ran past their places and fell."""
    row = ROWS["contract"]
    doubted = replace(row, name="doubted", keys=(*row.keys, ("sensing.force_estimate", True)))
    result = run_tour(doubted, 1, 11.0, Setting(punched=False))
    assert result.completed
    assert max(result.position_errors) < 0.06


def test_a_controller_that_gives_up_falls(monkeypatch):
    from surefoot.scenarios.run.controller import Controller
    from surefoot.scenarios.run.planning import RunFault
    from surefoot.studies.tour import rows
    from surefoot.studies.tour.ride import Ride

    class Weary(Controller):
        def step(self, *given):
            if self.time > 0.0:
                raise RunFault("given up")
            return super().step(*given)

    monkeypatch.setattr(rows, "Controller", Weary)
    ride = Ride(ROWS["torque"], 0)
    ride.step()
    result = ride.run(5.0)
    assert not result.completed and result.fault == "given up" and result.survival < 3.0
