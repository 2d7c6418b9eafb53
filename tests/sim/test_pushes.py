import mujoco
import numpy as np
import pytest

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
    ("push", "message"),
    [
        (Push(0.0, 0.1, FORCE, "torsoo"), "push on unknown body 'torsoo': did you mean 'torso'"),
        (Push(-0.1, 0.1, FORCE, "torso"), "must start at 0 s"),
        (Push(0.0, 0.0, FORCE, "torso"), "last longer than 0 s"),
        (Push(0.0, 0.1, FORCE * np.nan, "torso"), "finite force"),
    ],
)
def test_impossible_pushes_are_refused(push: Push, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        _floating((push,))
