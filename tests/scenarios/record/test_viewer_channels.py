"""Messages for viewers: every one decodes with the published classes and says what the numeric channels say."""

import importlib

import numpy as np
import pinocchio as pin
import pytest
from google.protobuf.message import Message
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from surefoot.models.pinocchio import pinocchio_model
from surefoot.planner.ground.terrain import flat
from surefoot.scenarios.log import read
from surefoot.scenarios.record.foxglove.drawing import FINEST, METRES_PER_NEWTON, force_arrow, world_scene
from surefoot.scenarios.record.foxglove.views import RATE
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.robot.robots import describe
from surefoot.sim.bodies import BodyPoses
from surefoot.sim.world import World

pytestmark = pytest.mark.unit

TOPICS = {
    "/tf": "FrameTransforms",
    "/joint_states": "JointStates",
    "/scene/world": "SceneUpdate",
    "/scene/points": "SceneUpdate",
    "/scene/forces": "SceneUpdate",
    "/scene/support": "SceneUpdate",
    "/events": "Log",
}
PUSH = "pushes=[{time: 1.5, duration: 0.1, force: [40, 0, 20]}]"


@pytest.fixture(scope="module")
def walk():
    """The first step of a walk with a push."""
    return load_scenario("diagonal-walk", ["duration=3.9", "gait.single_support=0.7", PUSH])


@pytest.fixture(scope="module")
def log(walk, tmp_path_factory):
    return read(run_scenario(walk, tmp_path_factory.mktemp("runs")).log)


def published(name: str) -> type[Message]:
    message: type[Message] = getattr(importlib.import_module(f"foxglove_schemas_protobuf.{name}_pb2"), name)
    return message


def decoded(log, topic):
    return [(time, published(TOPICS[topic]).FromString(data)) for time, data in log.messages(topic)]


def vector(v):
    return np.array([v.x, v.y, v.z])


def seconds(stamp):
    return stamp.seconds * 10**9 + stamp.nanos


def test_every_message_decodes_with_its_published_class_and_nothing_is_unknown(log):
    assert set(log.topics) - set(log.numeric) == set(TOPICS)
    for topic in TOPICS:
        messages = decoded(log, topic)
        assert messages
        for _, message in messages:
            again = published(TOPICS[topic]).FromString(message.SerializeToString())
            assert again == message
            message.DiscardUnknownFields()
            assert again == message


def test_the_schemas_in_the_file_decode_too(log):
    with log.path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        schemas = {channel.topic: schema.name for schema, channel, _, _ in reader.iter_decoded_messages()}
    assert {topic: schemas[topic] for topic in TOPICS} == {t: f"foxglove.{name}" for t, name in TOPICS.items()}


def test_frame_transforms_are_the_forward_kinematics_of_the_logged_state(log, walk):
    model = pinocchio_model(describe(walk.robot, walk.robot_options))
    data, truth = model.createData(), log["/truth"]
    messages = decoded(log, "/tf")
    assert len(messages) == pytest.approx(RATE * 3.9, abs=1)
    for time, message in messages[::7]:
        q = truth.field("q")[np.searchsorted(truth.time_ns, time)]
        pin.framesForwardKinematics(model, data, q)
        assert len(message.transforms) == 26
        for transform in message.transforms:
            assert transform.parent_frame_id == "world"
            assert seconds(transform.timestamp) == time
            body = data.oMf[model.getFrameId(transform.child_frame_id, pin.FrameType.BODY)]
            r = transform.rotation
            rotation = pin.Quaternion(r.w, r.x, r.y, r.z).toRotationMatrix()
            assert np.abs(vector(transform.translation) - body.translation).max() < 1e-9
            assert np.abs(rotation - body.rotation).max() < 1e-9


def test_joint_states_are_the_measured_ones(log, walk):
    measured = log["/measurement"]
    for time, message in decoded(log, "/joint_states")[::11]:
        row = np.searchsorted(measured.time_ns, time)
        assert tuple(joint.name for joint in message.joints) == describe(walk.robot, walk.robot_options).joint_names
        for name, field in (("position", "position"), ("velocity", "velocity"), ("effort", "torque")):
            values = [getattr(joint, name) for joint in message.joints]
            assert np.array_equal(values, measured.field(f"joint_{field}")[row])


def test_points_and_forces_are_where_the_numbers_say(log):
    truth, contact, measured, reference = log["/truth"], log["/contact"], log["/measurement"], log["/reference"]
    for (time, points), (_, forces) in zip(decoded(log, "/scene/points"), decoded(log, "/scene/forces"), strict=True):
        row = np.searchsorted(truth.time_ns, time)
        at = {entity.id: vector(entity.spheres[0].pose.position) for entity in points.entities}
        assert np.array_equal(at["CoM"], truth.field("com")[row])
        assert np.allclose(at["ZMP"], contact.field("zmp")[row], atol=1e-12)
        dcm = truth.field("com")[row, :2] + truth.field("com_velocity")[row, :2] / reference.field("omega")[row]
        assert np.allclose(at["DCM"][:2], dcm, rtol=0.0, atol=1e-12)
        for name in ("CoM", "ZMP", "DCM"):
            known = reference.field(name.lower())[row]
            assert np.allclose(at[f"{name} planned"][: len(known)], known, rtol=0.0, atol=1e-12)
        drawn = {entity.id: entity.arrows[0] for entity in forces.entities}
        for foot in ("left", "right"):
            wrench, arrow = measured.field(f"wrench_{foot}")[row], drawn[f"{foot} contact"]
            assert arrow.shaft_length == pytest.approx(METRES_PER_NEWTON * np.linalg.norm(wrench[:3]))
            if wrench[2] > 50.0:  # It acts where it has no moment along the sole.
                sole, r = pin.XYZQUATToSE3(truth.field(f"{foot}_sole")[row]), arrow.pose.orientation
                at, along = sole.actInv(vector(arrow.pose.position)), pin.Quaternion(r.w, r.x, r.y, r.z) * np.eye(3)[0]
                assert np.allclose(along, sole.rotation @ wrench[:3] / np.linalg.norm(wrench[:3]), atol=1e-9)
                assert np.allclose([*np.cross(at, wrench[:3])[:2], at[2]], [*wrench[3:5], 0.0], atol=1e-6)
        push = np.linalg.norm(measured.field("external_force")[row])
        assert drawn["push"].shaft_length == pytest.approx(METRES_PER_NEWTON * push)


def test_the_scene_has_every_link_in_its_own_frame(log, walk):
    (_, scene), *_ = decoded(log, "/scene/world")
    entities = {entity.id: entity for entity in scene.entities}
    assert set(entities) <= {"world", *describe(walk.robot, walk.robot_options).bodies}
    assert {"torso", "left_foot", "right_shank", "head"} <= set(entities)
    assert all(entity.frame_locked and entity.frame_id == entity.id for entity in entities.values())


def test_meshes_are_triangles_in_the_frame_of_their_link(meshed):
    scene = world_scene(World(meshed.robot, flat(), 1000).mjcf())
    entities = {entity.id: entity for entity in scene.entities}
    assert {name for name, entity in entities.items() if entity.triangles} == set(meshed.looks)
    for body, looks in meshed.looks.items():
        for triangles, (expected, _) in zip(entities[body].triangles, looks, strict=True):
            turn = triangles.pose.orientation
            R = pin.Quaternion(turn.w, turn.x, turn.y, turn.z).toRotationMatrix()
            points = np.array([vector(point) for point in triangles.points]) @ R.T + vector(triangles.pose.position)
            np.testing.assert_allclose(points[list(triangles.indices)].reshape(-1, 3, 3), expected, atol=FINEST)
            assert triangles.color.a == 1.0


def test_events_tell_the_story(log):
    messages = [message for _, message in decoded(log, "/events")]
    kinds = [message.name for message in messages]
    assert kinds[:2] == ["push", "push"]
    assert kinds[2] == "lift-off"
    assert "touchdown" in kinds
    assert [seconds(message.timestamp) for message in messages[:2]] == [1_502_000_000, 1_602_000_000]


def test_arrows_point_along_their_force():
    rng = np.random.default_rng(0)
    for force in (*rng.normal(size=(20, 3)), [1, 0, 0], [-1, 0, 0], [0, 0, 5.0]):
        *place, qx, qy, qz, qw, length = force_arrow(np.array([1.0, 2.0, 3.0]), np.array(force, float))
        axis = pin.Quaternion(qw, qx, qy, qz).toRotationMatrix()[:, 0]
        assert place == [1.0, 2.0, 3.0]
        assert np.allclose(axis * length / METRES_PER_NEWTON, force, atol=1e-9)
    assert force_arrow(np.zeros(3), np.zeros(3))[-1] == 0.0


def test_body_poses_belong_to_the_state_given_not_to_the_step_before(walk):
    robot = describe(walk.robot, walk.robot_options)
    world = World(robot, flat(), 1000)
    model = pinocchio_model(robot)
    q = pin.neutral(model)
    q[2], q[7:] = 1.0, robot.nominal_joint_positions
    world.reset(q)
    world.advance(np.full(25, 20.0), 20)
    poses = BodyPoses(world.model)
    poses.update(world.measure().q)
    data = model.createData()
    pin.framesForwardKinematics(model, data, world.measure().q)
    foot = poses.names.index("left_foot")
    expected = data.oMf[model.getFrameId("left_foot", pin.FrameType.BODY)].translation
    assert np.abs(poses.position[foot] - expected).max() < 1e-12
    assert np.abs(world.data.body("left_foot").xpos - expected).max() > 1e-6
