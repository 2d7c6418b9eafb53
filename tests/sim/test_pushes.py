import mujoco
import numpy as np
import pytest

from surefoot.joints import JointCommand, Servo
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim.errors import WorldError
from surefoot.sim.pushes import Push, PushSchedule
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

FORCE = np.array([75.0, -40.0, 20.0])


def _floating(pushes: tuple[Push, ...], rate: int = 1000) -> World:
    world = World(describe("humanoid100", RobotOptions()), flat(), rate, pushes)
    world.reset(np.concatenate(([0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions)))
    return world


def _momentum(world: World) -> np.ndarray:
    mujoco.mj_forward(world.model, world.data)
    mujoco.mj_subtreeVel(world.model, world.data)
    gravity = np.array([0.0, 0.0, -9.81 * world.description.mass * world.time])
    return world.description.mass * world.data.subtree_linvel[1] - gravity


@pytest.mark.parametrize("control_steps", [1, 2, 7, 40])
@pytest.mark.parametrize(("time", "duration"), [(0.0, 0.01), (0.003, 0.01), (0.0103, 0.0042), (0.0052, 0.0003)])
def test_momentum_is_force_times_duration(control_steps: int, time: float, duration: float) -> None:
    world = _floating((Push(time, duration, FORCE, "torso"),))
    while world.tick < 30:
        world.advance(np.zeros(25), control_steps)
    np.testing.assert_allclose(_momentum(world), FORCE * duration, rtol=0.002, atol=0.002)


@pytest.mark.parametrize("rate", [500, 1000, 777])
def test_schedule_has_the_exact_impulse_at_any_rate(rate: int) -> None:
    pushes = (Push(0.0012, 0.0071, FORCE, "a"), Push(0.0035, 0.01, -FORCE, "b"), Push(0.0, 0.002, FORCE, "a"))
    schedule = PushSchedule(pushes, (1, 2, 1), rate)
    forces, impulse = np.zeros((3, 6)), np.zeros((3, 6))
    schedule.rewind(forces)
    for tick in range(rate // 10):
        if tick >= schedule.next_change:
            schedule.step_over(forces)
        np.testing.assert_allclose(schedule.total, forces[:, :3].sum(axis=0))
        impulse += forces / rate
    np.testing.assert_allclose(impulse[1, :3], FORCE * 0.0091, atol=1e-9)
    np.testing.assert_allclose(impulse[2, :3], -FORCE * 0.01, atol=1e-9)
    assert not impulse[:, 3:].any()
    assert not schedule.active


def test_measurement_reports_the_force_of_the_last_step() -> None:
    world = _floating((Push(0.002, 0.002, FORCE, "torso"),))
    seen = []
    for _ in range(6):
        world.advance(np.zeros(25), 1)
        seen.append(world.measure().external_force[0])
    assert seen == [0.0, 0.0, 75.0, 75.0, 0.0, 0.0]


@pytest.mark.parametrize("control_steps", [1, 2, 7])
@pytest.mark.parametrize(("time", "duration"), [(0.0, 0.01), (0.0005, 0.0004), (0.0103, 0.0042), (0.0017, 0.0013)])
def test_the_measured_forces_add_up_to_the_impulse(control_steps: int, time: float, duration: float) -> None:
    """Some pushes are shorter than a tick, and one comes on the way; `measure` may be asked twice."""
    world, total = _floating((Push(time, duration, FORCE, "torso"),)), np.zeros(3)
    while world.tick < 40:
        if world.tick == 14:
            world.push(Push(0.0145, 0.0006, FORCE, "left_foot"))
        world.advance(np.zeros(25), control_steps)
        world.measure()
        total += world.measure().external_force * control_steps / 1000
    np.testing.assert_allclose(total, FORCE * (duration + 0.0006), rtol=1e-9)
    world.reset(np.array(world.measure().q))
    assert not world.measure().external_force.any()


@pytest.mark.parametrize("body", ["torso", "left_foot"])
def test_a_push_in_the_air_is_no_contact(body: str) -> None:
    world = _floating((Push(0.0, 1.0, FORCE, body), Push(0.0, 1.0, FORCE, body)))
    world.advance(np.zeros(25), 5)
    now = world.measure()
    np.testing.assert_array_equal(now.external_force, 2 * FORCE)
    np.testing.assert_allclose(now.wrench, 0.0, atol=1e-9)
    assert not now.nonfoot_contact


def test_reset_starts_the_pushes_again() -> None:
    world = _floating((Push(0.0, 0.004, FORCE, "torso"),))
    world.advance(np.zeros(25), 10)
    first = _momentum(world)
    world.reset(np.concatenate(([0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions)))
    world.advance(np.zeros(25), 10)
    np.testing.assert_array_equal(_momentum(world), first)


@pytest.mark.parametrize(
    ("push", "key", "message"),
    [
        (Push(0.0, 0.1, FORCE, "torsoo"), "body", "push on unknown body 'torsoo'; did you mean 'torso'"),
        (Push(-0.1, 0.1, FORCE, "torso"), "time", "must start at 0 s"),
        (Push(np.nan, 0.1, FORCE, "torso"), "time", "must start at 0 s"),
        (Push(0.0, 0.0, FORCE, "torso"), "duration", "last longer than 0 s"),
        (Push(0.0, 0.1, FORCE * np.nan, "torso"), "force", "finite force"),
        (Push(0.0, 0.1, FORCE[:2], "torso"), "force", "along x, y, z"),
    ],
)
def test_impossible_pushes_are_refused(push: Push, key: str, message: str) -> None:
    with pytest.raises(WorldError, match=message) as refused:
        _floating((Push(0.0, 0.1, FORCE, "torso"), push))
    assert refused.value.key == ("pushes", 1, key)
    with pytest.raises(WorldError, match=message) as refused:
        _floating(()).push(push)
    assert refused.value.key == ("push", key)


def _advance(world: World, until: int, control_steps: int = 1) -> None:
    while world.tick < until:
        world.advance(np.zeros(25), control_steps)


@pytest.mark.parametrize("control_steps", [1, 2, 5])
@pytest.mark.parametrize(("wait", "duration"), [(0.0, 0.01), (0.0031, 0.0042), (0.0, 0.0003), (0.002, 0.004)])
def test_a_push_added_on_the_way_has_its_whole_impulse(control_steps: int, wait: float, duration: float) -> None:
    world = _floating((Push(0.005, 0.012, -0.5 * FORCE, "pelvis"),))
    _advance(world, 10, control_steps)
    world.push(Push(world.time + wait, duration, FORCE, "torso"))
    _advance(world, 40, control_steps)
    np.testing.assert_allclose(_momentum(world), FORCE * (duration - 0.006), rtol=0.002, atol=0.002)


def test_pushes_added_at_any_tick_leave_the_others_their_impulse() -> None:
    """Bodies 1 and 2 have scheduled pushes, 3 those that come on the way, one of them within another."""
    scheduled = (Push(0.0012, 0.0301, FORCE, "a"), Push(0.02, 0.0205, -FORCE, "b"))
    added = {0: Push(0.0, 0.0015, FORCE, "c"), 7: Push(0.0121, 0.02, FORCE, "c"), 20: Push(0.02, 0.005, -FORCE, "c")}
    schedule = PushSchedule(scheduled, (1, 2), 1000)
    forces, impulse = np.zeros((4, 6)), np.zeros((4, 6))
    schedule.rewind(forces)
    for tick in range(60):
        if tick in added:
            before = schedule.total.copy()
            schedule.add(added[tick], 3, tick)
            np.testing.assert_array_equal(schedule.total, before)
        if tick >= schedule.next_change:
            schedule.step_over(forces)
        np.testing.assert_allclose(schedule.total, forces[:, :3].sum(axis=0), atol=1e-12)
        impulse += forces / 1000
    expected = np.outer((0.0, 0.0301, -0.0205, 0.0015 + 0.02 - 0.005), FORCE)
    np.testing.assert_allclose(impulse[:, :3], expected, atol=1e-9)
    assert not schedule.active


def test_adding_a_push_changes_nothing_before_it_begins() -> None:
    """Bit for bit, in the middle of a scheduled push; afterwards it does."""
    plain, pushed = (_floating((Push(0.003, 0.02, FORCE, "left_foot"),)) for _ in range(2))
    for world in (plain, pushed):
        _advance(world, 8)
    pushed.push(Push(0.0125, 0.01, FORCE, "torso"))
    np.testing.assert_array_equal(pushed.measure().external_force, plain.measure().external_force)
    for world in (plain, pushed):
        _advance(world, 12)
    np.testing.assert_array_equal(pushed.data.qvel, plain.data.qvel)
    for world in (plain, pushed):
        _advance(world, 13)
    np.testing.assert_allclose(pushed.measure().external_force - plain.measure().external_force, 0.5 * FORCE)


def test_reset_drops_the_pushes_that_were_added() -> None:
    q = np.concatenate(([0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 1.0], np.zeros(25)))
    world = _floating((Push(0.0, 0.004, FORCE, "torso"),))
    world.reset(q)
    _advance(world, 30)
    first = world.data.qvel.copy()
    world.reset(q)
    world.push(Push(0.001, 0.5, -FORCE, "head"))
    _advance(world, 30)
    assert np.abs(world.data.qvel - first).max() > 1e-3
    world.reset(q)
    _advance(world, 30)
    np.testing.assert_array_equal(world.data.qvel, first)


def test_a_push_into_the_past_is_refused() -> None:
    world = _floating(())
    _advance(world, 10)
    with pytest.raises(WorldError, match=r"in the past; it must start at 0\.01 s or later") as refused:
        world.push(Push(0.0099, 0.1, FORCE, "torso"))
    assert refused.value.key == ("push", "time")
    world.push(Push(0.1 * 0.1, 0.1, FORCE, "torso"))  # 0.010000000000000002
    world.push(Push(0.01 - 1e-16, 0.1, FORCE, "torso"))


@pytest.mark.parametrize("stiffness", [0.0, 50.0])
@pytest.mark.parametrize(("time", "duration"), [(0.0, 0.01), (0.0103, 0.0042), (0.0017, 0.0013)])
def test_joints_that_follow_targets_by_themselves_leave_the_measured_impulse_as_it_is(
    stiffness: float, time: float, duration: float
) -> None:
    world, total = _floating((Push(time, duration, FORCE, "torso"),)), np.zeros(3)
    still = np.zeros(25)
    servo = Servo(world.description.nominal_joint_positions, still, still + stiffness, still + 0.1 * stiffness)
    while world.tick < 40:
        world.act(JointCommand(still, servo), 0.002)
        total += 0.002 * world.measure().external_force
    np.testing.assert_allclose(total, duration * FORCE, rtol=1e-9)
    np.testing.assert_allclose(_momentum(world), FORCE * duration, rtol=0.005, atol=0.005)
