"""A controller under a loop that is not Surefoot's: the same to the bit, on readings that come as they like."""

import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.scenarios.run.planning import RunFault
from surefoot.scenarios.setup.stances.start import pressed
from surefoot.sim.world import World
from surefoot.wbc.body.statics import LEVER, standing_torque

pytestmark = pytest.mark.unit

ROBOTS = [("humanoid100", {}), ("g1", {"robot": "g1", "sized_for": "humanoid100"})]


class Bench:
    """A world and a controller in it, driven by hand."""

    def __init__(self, name, overrides, place=(0.0, 0.0, 0.0)):
        scenario = surefoot.load(name, {"sensing.source": "truth", **overrides})
        self.controller = controller = surefoot.Controller(scenario.robot, scenario)
        self.walk = walk = controller.walk
        self.world = World(walk.robot, walk.ground.terrain, walk.rates.physics, (), walk.size)
        x, y, yaw = place
        q = pressed(controller.posture, walk.size.length)
        moved = pin.SE3(pin.utils.rotate("z", yaw), np.array([x, y, 0.0])) * pin.XYZQUATToSE3(q[:7])
        self.start = np.concatenate((pin.SE3ToXYZQUAT(moved), q[7:]))
        if place == (0.0, 0.0, 0.0):
            self.start = q
        torque = standing_torque(controller.body.model, controller.body.frames, q, LEVER * walk.size.length)
        self.world.reset(self.start, torque=torque)
        controller.reset(self.start)
        self.ghost = 0.0  # The largest lasting force that the controller found [N]; nobody applies one.
        self.in_air = []  # Normal forces that it took feet in the air to bear [N].

    def walk_for(self, time, steps=lambda: 2, blind=False):
        """Control every so many steps of the physics; returns the highest tilt and the last measurement."""
        worst = 0.0
        while self.world.time < time:
            seen = self.world.measure()
            in_air = seen.wrench[:, 2] <= 0.0
            if blind:
                seen = surefoot.Measurement.of_state(seen.time, seen.q, seen.v)
            command = self.controller.step(seen)
            self.in_air.extend(self.controller.wrench[in_air, 2])
            self.ghost = max(self.ghost, float(np.hypot(*self.controller.report.load.force[:2])))
            self.world.advance(command.torque, steps())
            worst = max(worst, float(1.0 - self.controller.terms.torso_rotation[2, 2]))
        return worst, self.world.measure()


@pytest.mark.parametrize(("robot", "overrides"), ROBOTS)
def test_a_loop_of_ones_own_is_the_simulation_to_the_bit(robot, overrides):
    bench = Bench("walk-level", {**overrides, "gait.steps": 1})
    with surefoot.Simulation(
        surefoot.load("walk-level", {"sensing.source": "truth", **overrides, "gait.steps": 1})
    ) as simulation:
        every = bench.walk.rates.physics // bench.walk.rates.control
        for _ in range(400):
            tick = simulation.step()
            seen = bench.world.measure()
            command = bench.controller.step(seen)
            assert np.array_equal(seen.q, tick.measurement.q)
            assert np.array_equal(command.torque, tick.report.torque)
            bench.world.advance(command.torque, every)


@pytest.mark.parametrize(("robot", "overrides"), ROBOTS)
def test_readings_may_come_at_any_time_and_some_never(robot, overrides):
    bench, rng = Bench("walk-level", {**overrides, "gait.steps": 2}), np.random.default_rng(1)
    end = bench.walk.duration
    worst, seen = bench.walk_for(end, steps=lambda: int(rng.choice([1, 2, 3, 4, 12], p=[0.2, 0.4, 0.3, 0.08, 0.02])))
    assert worst < 0.01
    assert seen.q[0] > 0.8 * bench.walk.gait.step_length
    assert bench.controller.planning.plan.phase.step == 2


def test_feet_that_feel_nothing_walk():
    bench = Bench("walk-level", {"gait.steps": 2})
    worst, seen = bench.walk_for(bench.walk.duration, blind=True)
    assert worst < 0.01
    assert seen.q[0] > 0.25
    assert bench.ghost == 0.0, "wrenches that follow from torques are not so sure"
    # A command that counted half a tick late would be 1.6 N.
    assert 0.0 < np.sqrt(np.mean(np.square(bench.in_air))) < 0.8


def test_a_walk_begins_anywhere_and_again():
    bench = Bench("walk-level", {"gait.steps": 2}, place=(3.0, -2.0, 1.2))
    for _ in range(2):
        bench.world.reset(bench.start)
        bench.controller.reset(bench.start)
        worst, seen = bench.walk_for(bench.walk.duration)
        assert worst < 0.01
        ahead = (seen.q[:2] - (3.0, -2.0)) @ (np.cos(1.2), np.sin(1.2))
        assert ahead > 0.25


def test_readings_that_are_older_than_the_last_change_nothing():
    bench = Bench("walk-level", {})
    old = bench.world.measure()
    old = surefoot.Measurement.of_state(old.time, old.q.copy(), old.v.copy())
    bench.walk_for(0.1)
    report = bench.controller.report
    assert bench.controller.step(old) is bench.controller.step(old)
    assert bench.controller.report is report


def test_readings_that_stay_away_end_the_walk():
    bench = Bench("walk-level", {})
    bench.walk_for(0.1)
    seen = bench.world.measure()
    with pytest.raises(RunFault, match="nothing was measured for"):
        bench.controller.step(surefoot.Measurement.of_state(seen.time + 5.0, seen.q, seen.v))


def test_a_command_is_taken_by_the_next_plan():
    bench = Bench("commanded", {})
    bench.walk_for(0.1)
    command = surefoot.Command(twist=surefoot.Twist(0.2, 0.0, 0.1))
    bench.controller.step(bench.world.measure(), command)
    bench.walk_for(0.2)
    assert bench.controller.orders.twist == command.twist


@pytest.mark.parametrize("blind", [False, True])
def test_a_robot_let_down_from_a_crane_stands_and_walks(blind):
    bench = Bench("walk-level", {"gait.steps": 2})
    controller, world = bench.controller, bench.world
    hung = bench.start.copy()
    hung[2] += 0.05
    world.reset(hung)
    controller.reset()
    pelvis = world.model.body(world.description.pelvis_body).id
    weight, walked = 9.81 * world.description.mass, 0.0
    while walked < bench.walk.duration:
        seen = world.measure()
        if blind:
            seen = surefoot.Measurement.of_state(seen.time, seen.q, seen.v, seen.joint_torque)
        command = controller.step(seen)
        # A rope that is paid out, with a damper beside it.
        slack = max(hung[2] - 0.04 * world.time - seen.q[2], 0.0) if world.time < 3.0 else 0.0
        rope = max(4.0 * weight * slack / 0.1 - 0.5 * weight * world.data.qvel[2], 0.0) if slack else 0.0
        world.data.xfrc_applied[pelvis, 2] = rope
        world.advance(command.torque, 2)
        walked = controller.time
    assert controller.terms.torso_rotation[2, 2] > 0.99
    assert world.measure().q[0] > 0.25


def test_a_scenario_of_another_robot_is_refused():
    with pytest.raises(surefoot.ParameterError, match="a scenario of humanoid100 for g1"):
        surefoot.Controller("g1", surefoot.load("walk-level"))


def test_what_another_estimator_reads_is_refused():
    bench = Bench("walk-level", {"sensing.source": "ekf"})
    with pytest.raises(surefoot.ParameterError, match=r"give what sensors say, as surefoot\.Readings"):
        bench.controller.step(bench.world.measure())


def test_no_simulator_is_loaded_by_a_controller_that_steps():
    code = (
        "import sys, surefoot\n"
        "stand = surefoot.load('stand', {'sensing.source': 'truth'})\n"
        "c = surefoot.Controller('humanoid100', stand); c.reset(c.posture)\n"
        "q = c.posture\n"
        "import numpy as np\n"
        "c.step(surefoot.Measurement.of_state(0.0, q, np.zeros(len(q) - 1)))\n"
        "print([m for m in sys.modules if m.startswith('surefoot.sim.')])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "world" not in done.stdout
    assert "surefoot.sim.measurement" in done.stdout


def test_a_walk_is_the_same_whenever_its_first_readings_come():
    """Its clock begins with them."""
    benches = [Bench("walk-level", {"gait.steps": 1}) for _ in range(2)]
    every = benches[0].walk.rates.physics // benches[0].walk.rates.control
    for _ in range(250):
        torques = []
        for bench, begin in zip(benches, (0.0, 64.0), strict=True):
            seen = bench.world.measure()
            command = bench.controller.step(replace(seen, time=begin + seen.time))
            bench.world.advance(command.torque, every)
            torques.append(command.torque)
        assert benches[0].controller.time == pytest.approx(benches[1].controller.time, abs=1e-9)
        np.testing.assert_allclose(*torques, atol=1e-4)


def test_the_time_of_finding_the_state_is_that_between_two_looks_at_the_clock(monkeypatch):
    """The clock is a second later whenever it is looked at."""
    bench, looks = Bench("walk-level", {}), iter(range(1, 100))
    seen = bench.world.measure()
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(looks)))
    bench.controller.step(seen)
    assert bench.controller.spent.state == 1.0
