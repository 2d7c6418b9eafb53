"""A controller in the seat of the planner: where it begins to stand, when it hears commands, and what its time was."""

import time

import numpy as np
import pytest

import surefoot
from surefoot.joints import JointCommand, Servo
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.scenarios.file.registries import CONTROLLERS
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.run.seat import placed, standing
from surefoot.scenarios.setup.robot.body import body_of, feet_at
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

NAME = "listener"


class Listener:
    """A controller that holds its posture, and notes what it hears and when."""

    def __init__(self, walk, **options):
        self.parameters, self.posture = {}, np.array(walk.robot.nominal_joint_positions)
        self.heard = []

    def reset(self, q):
        self.heard.clear()

    def step(self, readings, command=None):
        if command is not None:
            self.heard.append((round(500 * readings.time), command.twist.x))
        still, stiff = np.zeros_like(self.posture), np.full_like(self.posture, 500.0)
        return JointCommand(still, Servo(self.posture, still, stiff, 0.05 * stiff))


@pytest.fixture(autouse=True)
def registered():
    CONTROLLERS.add(NAME, Listener)
    yield
    CONTROLLERS.discard(NAME)


def walk_of(**keys):
    return resolve(surefoot.load("stand", {"controller.name": NAME, "duration": 0.6, **keys}))


@pytest.mark.parametrize("ground", [{"terrain.kind": "flat"}, {"terrain.kind": "blocks", "terrain.riser": 0.05}])
@pytest.mark.parametrize(("x", "y", "yaw"), [(0.0, 0.0, 0.0), (0.4, -0.3, 0.8)])
def test_it_stands_where_the_walk_begins_on_the_ground_that_is_there(ground, x, y, yaw):
    """Whatever its posture: with the middle of its soles over the start, and the lower one on the ground."""
    walk = walk_of(**ground, **{"start.x": x, "start.y": y, "start.yaw": yaw})
    body, posture = body_of(walk.robot), np.array(walk.robot.nominal_joint_positions)
    posture += 0.05 * np.random.default_rng(4).normal(size=len(posture))
    soles = feet_at(body, standing(walk, body, posture)).position
    np.testing.assert_allclose(soles[:, :2].mean(axis=0), [x, y], atol=1e-12)
    assert soles[:, 2].min() == pytest.approx(walk.ground.start_height, abs=1e-12)
    assert (walk.ground.start_height > 0.0) is ("terrain.riser" in ground)


@pytest.mark.parametrize("yaw", [0.0, 0.8])
def test_a_walk_that_is_placed_begins_as_wide_as_its_feet_stand(yaw):
    walk = walk_of(**{"start.x": 0.4, "start.y": -0.3, "start.yaw": yaw})
    body = body_of(walk.robot)
    q = standing(walk, body, np.array(walk.robot.nominal_joint_positions))
    feet = feet_at(body, q).position
    assert placed(walk, q).gait.step_width == pytest.approx(np.linalg.norm(np.diff(feet[:, :2], axis=0)))


def test_it_hears_a_command_in_the_tick_of_its_time_whatever_rounding_makes_of_that():
    """Commands that are not due wait."""
    loop = closed_loop(walk_of(), NoLog())
    ticks = [1, 7, 29, 58, 115]
    for tick, late in zip(reversed(ticks), (1e-10, -1e-10, 0.0, 1e-10, -1e-10), strict=True):
        loop.walker.command(Command(Twist(0.001 * tick)), tick / 500 + late)
    seen = []
    while loop.tick < 120:
        loop.sense()
        seen.append(loop.walker.sees(loop.time)[1])
        loop.step()
    assert loop.walker.mind.heard == [(tick, pytest.approx(0.001 * tick)) for tick in ticks]
    assert [tick for tick, command in enumerate(seen) if command is not None] == ticks


def test_all_of_its_time_is_that_of_the_state(monkeypatch):
    """The clock is a second later whenever it is looked at."""
    walker, looks = closed_loop(walk_of(), NoLog()).walker, iter(range(1, 100))
    walker.sense(0, 0.0)
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(looks)))
    assert walker.control(0, 0.0) == (None, (1.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize("above", [0.0, 1.0, 3.0])
def test_a_body_lies_where_it_is_low_over_its_lower_sole_however_high_that_is(above):
    walk = walk_of()
    body, upright = body_of(walk.robot), np.array(walk.robot.nominal_joint_positions)
    names, folded = walk.robot.joint_names, upright.copy()
    for side in ("left", "right"):
        for joint, angle in (("hip_pitch", -1.9), ("knee", 2.2), ("ankle_pitch", -0.3)):
            folded[names.index(f"{side}_{joint}")] = angle
    for posture, lies in ((upright, False), (folded, True)):
        walker = closed_loop(walk, NoLog()).walker
        q = standing(walk, body, posture)
        q[2] += above
        walker.plant.reset(q)
        walker.sense(0, 0.0)
        walker.control(0, 0.0)
        assert not walker.measurement.nonfoot_contact
        assert walker.fallen(None) is lies
