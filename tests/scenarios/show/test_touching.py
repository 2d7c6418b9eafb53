"""A run in which limbs meet tells which they are; one in which none do, and a log that cannot tell, name none."""

import pytest

import surefoot
from surefoot.scenarios.show.touching import touching


@pytest.mark.physics
def test_bodies_that_touch_are_named_with_the_time_of_the_first_touch(tmp_path):
    log = surefoot.read(surefoot.run("control-push", out=tmp_path).log)
    touches = touching(log)
    truth = log["/truth"]
    first = truth.time[truth.field("self_contact") != 0][0]
    assert touches[0].time == pytest.approx(first)
    assert any("left" in name and "arm" in name for touch in touches for name in touch[:2])
    assert all(touch.time >= first for touch in touches)


@pytest.mark.unit
def test_a_pendulum_touches_nothing(tmp_path):
    keys = {"fidelity": "pendulum", "gait.steps": 1, "duration": 1.0, "criteria": {"fell": False}}
    assert touching(surefoot.read(surefoot.run(surefoot.load("walk-level", keys), out=tmp_path).log)) == ()
