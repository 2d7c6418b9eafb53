import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import Box, Terrain, flat
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.pushes import Push
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

HUMAN_FEET = RobotOptions(foot_length=0.22, foot_width=0.11)


def _world(options: RobotOptions = HUMAN_FEET, terrain: Terrain | None = None, pushes: tuple[Push, ...] = ()) -> World:
    return World(describe("humanoid100", options), terrain or flat(), 1000, pushes)


def _momentum(world: World) -> np.ndarray:
    """Linear and angular centroidal momentum in world axes."""
    mujoco.mj_forward(world.model, world.data)
    mujoco.mj_subtreeVel(world.model, world.data)
    return np.concatenate((world.description.mass * world.data.subtree_linvel[1], world.data.subtree_angmom[1]))


@pytest.fixture
def hold(standing_configuration, make_holder):
    """Stand and hold for a number of physics steps."""

    def run(world: World, steps: int) -> None:
        make_holder(world, standing_configuration(world)).hold(world, steps)

    return run


@pytest.mark.parametrize("options", [RobotOptions(), HUMAN_FEET, RobotOptions(0.22, 0.11, payload_mass=10.0)])
def test_wrenches_of_a_held_robot_sum_to_its_weight(options: RobotOptions, hold) -> None:
    world = _world(options)
    hold(world, 500)
    now = world.measure()
    assert now.wrench[:, 2].sum() == pytest.approx(9.81 * world.description.mass, rel=0.02)
    np.testing.assert_allclose(now.wrench[0, :3] * (1, -1, 1), now.wrench[1, :3], atol=2.0)
    assert not now.nonfoot_contact


def test_boxes_carry_the_robot_like_the_plane(standing_configuration, make_holder) -> None:
    """Also with the seam of two boxes below the soles."""
    halves = [Box(np.array([x, 0.0, 0.05]), np.array([0.5, 1.0, 0.05]), np.eye(3)) for x in (-0.5, 0.5)]
    world = _world(terrain=Terrain(tuple(halves)))
    q = standing_configuration(world)
    q[2] += 0.1
    make_holder(world, q).hold(world, 500)
    assert world.measure().wrench[:, 2].sum() == pytest.approx(981.0, rel=0.02)
    for site in world.description.sole_sites:
        assert world.data.site(site).xpos[2] == pytest.approx(0.1, abs=1e-4)


def test_wrenches_and_weight_are_the_rate_of_centroidal_momentum(standing_configuration, make_holder) -> None:
    """Newton and Euler over 0.2 s of a moving robot: impulse of the soles and of gravity against momentum."""
    world = _world()
    q = standing_configuration(world)
    holder = make_holder(world, q)
    v = np.zeros(31)
    v[:6] = 0.3, 0.2, 0.0, 0.1, -0.2, 0.3
    world.reset(q, v)
    start = _momentum(world)
    linear, angular = np.zeros(3), np.zeros(3)
    for _ in range(200):
        holder.hold(world, 1)
        now = world.measure()
        com = world.data.subtree_com[1]
        for wrench, site in zip(now.wrench, world.description.sole_sites, strict=True):
            sole = world.data.site(site)
            R = sole.xmat.reshape(3, 3)
            force = R @ wrench[:3]
            linear += force / 1000
            angular += (np.cross(sole.xpos - com, force) + R @ wrench[3:]) / 1000
    linear[2] -= 9.81 * world.description.mass * 0.2
    change = _momentum(world) - start
    assert np.abs(change).max() > 5.0
    np.testing.assert_allclose(np.concatenate((linear, angular)), change, atol=0.02 * np.abs(change).max())


def test_wrench_sensor_agrees_with_a_scan_of_the_contacts(standing_configuration) -> None:
    """In a tilted, turned, moving state; the scan is the slow definition of what the sensor computes."""
    world = _world(pushes=(Push(0.0, 1.0, np.array([80.0, 50.0, 0.0]), "left_foot"),))
    q = standing_configuration(world)
    turn = pin.Quaternion(pin.rpy.rpyToMatrix(0.02, 0.03, 0.8))
    q[3:7] = turn.coeffs()
    q[2] += 0.01
    world.reset(q)
    world.advance(np.zeros(25), 40)
    now = world.measure()
    expected = np.zeros((2, 6))
    force = np.zeros(6)
    for index, contact in enumerate(world.data.contact):
        body = world.model.geom_bodyid[contact.geom[1]]
        for foot, site in enumerate(world.description.sole_sites):
            sole = world.data.site(site)
            if world.model.site_bodyid[sole.id] == body:
                mujoco.mj_contactForce(world.model, world.data, index, force)
                f = contact.frame.reshape(3, 3).T @ force[:3]
                R = sole.xmat.reshape(3, 3)
                expected[foot] += np.concatenate((R.T @ f, R.T @ np.cross(contact.pos - sole.xpos, f)))
    assert (expected[:, 2] > 10.0).any()
    np.testing.assert_allclose(now.wrench, expected, atol=1e-8)


def test_measurement_is_the_true_state_in_pinocchio_convention(standing_configuration) -> None:
    world = _world()
    rng = np.random.default_rng(2)
    q = standing_configuration(world)
    q[2] += 1.0
    q[3:7] = pin.Quaternion(pin.rpy.rpyToMatrix(0.3, -0.2, 1.0)).coeffs()
    v = rng.normal(size=31)
    world.reset(q, v)
    now = world.measure()
    np.testing.assert_allclose(now.q, q, atol=1e-14)
    np.testing.assert_allclose(now.v, v, atol=1e-14)
    np.testing.assert_allclose(now.gyro, v[3:6], atol=1e-14)
    model = pinocchio_model(world.description)
    data = model.createData()
    pin.centerOfMass(model, data, now.q, now.v)
    mujoco.mj_subtreeVel(world.model, world.data)
    np.testing.assert_allclose(data.vcom[0], world.data.subtree_linvel[1], atol=1e-12)


def test_accelerometer_feels_nothing_in_free_fall_and_gravity_when_standing(hold, standing_configuration) -> None:
    world = _world()
    q = standing_configuration(world)
    q[2] += 10.0
    world.reset(q)
    world.advance(np.zeros(25), 20)
    np.testing.assert_allclose(world.measure().accelerometer, 0.0, atol=1e-6)
    hold(world, 500)
    np.testing.assert_allclose(world.measure().accelerometer, (0.0, 0.0, 9.81), atol=0.2)


def test_gyro_and_accelerometer_integrate_to_the_true_motion(standing_configuration) -> None:
    """Strapdown integration with the simulator's own step reproduces orientation and velocity exactly."""
    world = _world()
    q = standing_configuration(world)
    q[2] += 0.05
    world.reset(q, np.concatenate(([0.1, 0.2, 0.0, 0.5, -0.4, 0.3], np.zeros(25))))
    now = world.measure()
    R, velocity = pin.Quaternion(now.q[3:7]).matrix(), pin.Quaternion(now.q[3:7]).matrix() @ now.v[:3]
    for _ in range(200):
        world.advance(np.zeros(25), 1)
        now = world.measure()
        velocity = velocity + (R @ now.accelerometer + (0.0, 0.0, -9.81)) * 0.001
        R = R @ pin.exp3(now.gyro * 0.001)
    np.testing.assert_allclose(R, pin.Quaternion(now.q[3:7]).matrix(), atol=1e-10)
    np.testing.assert_allclose(R.T @ velocity, now.v[:3], atol=1e-9)


def test_torques_are_clipped_to_the_limits_and_reported(standing_configuration) -> None:
    world = _world()
    world.reset(standing_configuration(world))
    world.advance(np.full(25, 1e4), 1)
    np.testing.assert_array_equal(world.measure().joint_torque, world.description.torque_limit)
    world.advance(np.linspace(-5.0, 5.0, 25), 1)
    np.testing.assert_array_equal(world.measure().joint_torque, np.linspace(-5.0, 5.0, 25))


def test_without_torque_the_robot_falls_on_the_floor(standing_configuration) -> None:
    world = _world()
    world.reset(standing_configuration(world))
    world.advance(np.zeros(25), 3000)
    now = world.measure()
    assert now.nonfoot_contact
    assert 0.0 < now.q[2] < 0.6
    heights = world.data.xpos[1:, 2]
    assert heights.min() > -0.01  # it lies on the floor, not in it


@pytest.mark.parametrize(("friction", "slips"), [(0.02, True), (0.8, False)])
def test_friction_decides_whether_a_push_moves_the_feet(
    friction: float, slips: bool, standing_configuration, make_holder
) -> None:
    world = _world(terrain=flat(friction), pushes=(Push(0.1, 0.2, np.array([0.0, 100.0, 0.0]), "pelvis"),))
    q = standing_configuration(world)
    holder = make_holder(world, q)
    holder.hold(world, 100)
    before = [world.data.site(site).xpos.copy() for site in world.description.sole_sites]
    holder.hold(world, 200)
    after = [world.data.site(site).xpos for site in world.description.sole_sites]
    moved = np.linalg.norm(np.subtract(after, before), axis=1)
    assert (moved.min() > 0.005) if slips else (moved.max() < 2e-4)


def test_steps_together_are_the_same_as_steps_apart(standing_configuration) -> None:
    push = Push(0.0105, 0.02, np.array([50.0, 0.0, 0.0]), "torso")
    ends = []
    for chunk in (1, 2, 25):
        world = _world(pushes=(push,))
        world.reset(standing_configuration(world))
        while world.tick < 100:
            world.advance(np.zeros(25), chunk)
        ends.append(world.measure().q.copy())
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])


def test_a_torque_that_is_no_number_is_reported_with_its_time(standing_configuration) -> None:
    world = _world()
    world.reset(standing_configuration(world))
    world.advance(np.zeros(25), 4)
    before = world.measure().q.copy()
    with pytest.raises(SimulationDiverged, match="torque") as caught:
        world.advance(np.full(25, np.nan), 2)
    assert caught.value.time == pytest.approx(0.004)
    np.testing.assert_array_equal(world.measure().q, before)


@pytest.mark.parametrize("speed", [1e200, np.nan])
def test_divergence_is_reported_and_the_last_finite_state_kept(
    speed: float, tmp_path, monkeypatch, standing_configuration
) -> None:
    monkeypatch.chdir(tmp_path)
    world = _world()
    q = standing_configuration(world)
    world.reset(q)
    world.advance(np.zeros(25), 4)
    before = world.measure().q.copy()
    world.data.xfrc_applied[3, 0] = speed
    with pytest.raises(SimulationDiverged, match=r"after t = 0\.0040 s: .*not finite") as caught:
        world.advance(np.zeros(25), 2)
    assert caught.value.time == pytest.approx(0.004)
    world.data.xfrc_applied[3, 0] = 0.0
    now = world.measure()
    np.testing.assert_array_equal(now.q, before)
    assert not list(tmp_path.iterdir())  # the engine wrote no log file of its own


def test_measurements_cannot_be_written_to(standing_configuration) -> None:
    world = _world()
    world.reset(standing_configuration(world))
    with pytest.raises(ValueError, match="read-only"):
        world.measure().q[0] = 1.0


def test_the_world_text_is_the_world() -> None:
    world = _world()
    again = mujoco.MjModel.from_xml_string(world.mjcf())
    np.testing.assert_array_equal(again.body_inertia, world.model.body_inertia)
    np.testing.assert_array_equal(again.body_mass, world.model.body_mass)
    assert again.opt.timestep == world.model.opt.timestep == 0.001
    assert again.ngeom > world.model.ngeom


def test_a_model_that_is_changed_is_that_of_one_world(standing_configuration) -> None:
    """Before its first step or after some; those around it fall and weigh as ever, to the bit."""
    one, other = _world(), _world()
    q = standing_configuration(one)
    q[2] += 0.5
    fallen = []
    for world in (one, other):
        world.reset(q)
        world.advance(np.zeros(25), 50)
        fallen.append(world.measure().q.copy())
    np.testing.assert_array_equal(*fallen)
    one.reset(q)
    one.model.opt.gravity[:], one.model.body_mass[:] = 0.0, 2.0 * one.model.body_mass
    assert one.model is one.model is not other.model
    third = _world()
    heights = []
    for world in (one, other, third):
        world.reset(q)
        world.advance(np.zeros(25), 50)
        heights.append(world.measure().q[2])
    assert heights[0] == pytest.approx(q[2])
    assert heights[1] == heights[2] == fallen[0][2] < q[2] - 0.01


def test_bodies_are_drawn_as_they_were_made(standing_configuration) -> None:
    one, other = _world(), _world()
    one.model.body_pos[2:] += 1.0
    q = standing_configuration(one)
    poses = one.poses()
    poses.update(q)
    other.reset(q)
    np.testing.assert_allclose(poses.position, other.data.xpos[1:], atol=1e-12)
    assert not np.shares_memory(other.poses().position, poses.position)
