"""Joints of a leg that follow others are kept as one driven joint, with the limits and the inertia of all."""

from dataclasses import replace

import biped
import mjcf_biped
import mujoco
import numpy as np
import pinocchio as pin
import pytest
from rolling_knees import GAP, equality, mimic, mjcf, motors, urdf

import surefoot
from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import Coordinates, velocity_map
from surefoot.models.facts import knee_turn, shank_outline
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.robot_file.files import originals
from surefoot.models.robot_file.reduced import reduced
from surefoot.models.robot_file.schema import read
from surefoot.models.robot_file.source import read_source
from surefoot.models.similar import scaled
from surefoot.models.types import Coupling, ImuPlace
from surefoot.scenarios.run.run import run_scenario
from surefoot.sim.imu_motion import ImuChain, rotation_of
from surefoot.sim.world import World

WIDE = '<limit lower="-2" upper="2" effort="60" velocity="12"/>'
MJCF_FILE = biped.FILE.replace("biped.urdf", "biped.xml") + mjcf_biped.LIMITS


def of_urdf(folder, text=None, more=""):
    return describe(str(biped.write(folder, text or urdf(), biped.FILE + more)), RobotOptions())


def reduced_urdf(folder, text, more=""):
    path = biped.write(folder, text, biped.FILE + more)
    file = read(path)
    made_of = originals(file, folder)
    return reduced(made_of, read_source(file, made_of.document))


def of_mjcf(folder, text, more=""):
    return describe(str(biped.write(folder, text, MJCF_FILE + more, "biped.xml")), RobotOptions())


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    """With a ratio of 0.8 and an offset of its knees."""
    return of_urdf(tmp_path_factory.mktemp("robot"), urdf(mimic("knee", 0.8, -0.05), limit=WIDE))


def of_knee(robot, name):
    return getattr(robot, name)[robot.joint_names.index("left_knee")]


@pytest.mark.unit
def test_two_hinges_are_one_joint_of_a_description(robot):
    assert robot.couplings == tuple(
        Coupling(f"{side}_second", f"{side}_knee", 0.8, -0.05) for side in ("left", "right")
    )
    assert not any("second" in name for name in robot.joint_names) and len(robot.joint_names) == 16
    assert robot.roles.knees == ("left_knee", "right_knee") and len(robot.roles.left_leg) == 6
    assert not robot.left_out


@pytest.mark.unit
@pytest.mark.parametrize(
    ("text", "torque"),
    [
        (mjcf(equality(), motors()), 160.0 + 50.0),
        (mjcf(equality("0.1 -0.5 0 0 0"), motors()), 160.0 + 0.5 * 50.0),
        (mjcf(equality("0 2 0 0 0"), motors(), knee=False), 2.0 * 50.0),
        (mjcf(equality("0 2 0 0 0")), 160.0),
        (mjcf(equality("0 0.5 0 0 0", "knee", "second"), motors()), 160.0 + 2.0 * 50.0),
    ],
    ids=["both", "backward", "second alone", "first alone", "second leads"],
)
def test_torques_of_an_mjcf_add_up_by_virtual_work(tmp_path, text, torque):
    assert of_knee(of_mjcf(tmp_path, text), "torque_limit") == pytest.approx(torque, rel=1e-12)


@pytest.mark.unit
@pytest.mark.parametrize(
    ("second", "first", "more", "torque"),
    [
        (mimic("knee", 0.5), "", "", 80.0),
        ("", mimic("second", 0.5), "", 2.0 * 60.0),
        (mimic("knee", 0.5), "", "torque_limit: {'*_second': 30}\n", 80.0 + 0.5 * 30.0),
        (mimic("knee", 0.5), "", "torque_limit: {'*_knee': 100}\n", 100.0),
    ],
    ids=["first leads", "second leads", "motor of the file", "limit of the file"],
)
def test_a_joint_that_mimics_another_has_no_motor_but_one_that_the_file_gives(tmp_path, second, first, more, torque):
    robot = of_urdf(tmp_path, urdf(second, first, WIDE), more)
    assert of_knee(robot, "torque_limit") == pytest.approx(torque, rel=1e-12)


@pytest.mark.unit
@pytest.mark.parametrize(
    ("ratio", "offset", "ends", "speed"),
    [
        (1.0, 0.0, (0.0, 1.0), 12.0),
        (2.0, 0.0, (0.0, 0.5), 6.0),
        (0.25, 0.5, (0.0, 2.0), 15.0),
        (-1.0, 1.2, (0.2, 1.3), 12.0),
    ],
)
def test_ranges_and_speeds_are_those_that_all_joints_allow(tmp_path, ratio, offset, ends, speed):
    """The knee goes from 0 to 2 rad at 15 rad/s, the other hinge from -0.1 to 1 rad at 12 rad/s."""
    axis = "0 1 0" if ratio > 0.0 else "0 -1 0"
    model = reduced_urdf(tmp_path, urdf(mimic("knee", ratio, offset), axis=axis)).model
    knee = model.getJointId("left_knee")
    at = model.idx_qs[knee]
    assert (model.lowerPositionLimit[at], model.upperPositionLimit[at]) == pytest.approx(ends, abs=1e-12)
    assert model.upperVelocityLimit[model.idx_vs[knee]] == pytest.approx(speed)


@pytest.mark.unit
def test_a_rotor_is_felt_with_the_ratio_squared(tmp_path):
    given = "armature: {'*_knee': 0.03, '*_second': 0.02}\n"
    robot = of_urdf(tmp_path, urdf(mimic("knee", 0.5), limit=WIDE), given)
    model = pinocchio_model(robot)
    joint = model.idx_vs[model.getJointId("left_knee")]
    assert model.armature[joint] == pytest.approx(0.03 + 0.25 * 0.02, rel=1e-12)


@pytest.mark.unit
def test_dynamics_are_those_of_mujoco_within_its_own_equalities(robot):
    """The mass matrix, on the null space of the constraint Jacobian that MuJoCo makes of the text, to 1e-9."""
    pair, rng = EnginePair(robot), np.random.default_rng(3)
    model, data = pair.mj_model, mujoco.MjData(pair.mj_model)
    for _ in range(3):
        q, v = pair.random_state(rng)
        assert pair.difference(q, v).largest < 1e-9
        Coordinates(model).to_mujoco(q, v, data.qpos, data.qvel)
        mujoco.mj_forward(model, data)
        rows = data.efc_type == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)
        J = data.efc_J.reshape(-1, model.nv)[rows]
        assert len(J) == 2 and np.abs(data.efc_pos[rows]).max() < 1e-12
        G = Coordinates(model).G @ velocity_map(data.qpos, len(v))
        assert np.abs(J @ G).max() < 1e-12 and np.linalg.matrix_rank(G) == model.nv - 2
        M = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, M)
        ours = pinocchio_model(robot)
        np.testing.assert_allclose(G.T @ M @ G, pin.crba(ours, ours.createData(), q), rtol=0.0, atol=1e-9)


@pytest.mark.unit
def test_a_torque_at_the_knee_makes_the_motion_that_the_controller_expects(robot):
    """MuJoCo, whose equality is a stiff spring, against the inverse of the reduced mass matrix; without it, not."""
    model, ours = mujoco.MjModel.from_xml_string(robot.mjcf), pinocchio_model(robot)
    model.opt.gravity[:] = 0.0
    q = pin.neutral(ours)
    q[7:] = robot.nominal_joint_positions
    torque = np.zeros(len(robot.joint_names))
    torque[robot.joint_names.index("left_knee")] = 20.0
    expected = np.linalg.solve(pin.crba(ours, ours.createData(), q), np.concatenate((np.zeros(6), torque)))
    own = Coordinates(model)
    for held in (True, False):
        data = mujoco.MjData(model)
        data.eq_active[:] = held
        own.to_mujoco(q, np.zeros(ours.nv), data.qpos, data.qvel)
        data.ctrl[:] = torque
        mujoco.mj_forward(model, data)
        error = np.abs(data.qacc[own.velocities] - expected[6:]).max() / np.abs(expected[6:]).max()
        assert error < 5e-3 if held else error > 0.1, "MuJoCo's greatest impedance is 0.9999"


@pytest.mark.unit
def test_legs_are_straight_and_bent_with_both_hinges(robot):
    model = pinocchio_model(robot)
    for angles, bend in ((robot.straight_joint_positions, 0.0), (robot.nominal_joint_positions, 0.65)):
        q = pin.neutral(model)
        q[7:] = angles
        data = model.createData()
        pin.framesForwardKinematics(model, data, q)
        sole = data.oMf[model.getFrameId("left_sole")]
        np.testing.assert_allclose(sole.rotation, np.eye(3), atol=1e-6)
        thigh, shank = (data.oMi[model.getJointId(f"left_{name}")].rotation for name in ("pitch", "second"))
        assert abs(pin.log3(thigh.T @ shank)[1]) == pytest.approx(bend, abs=2e-3)
    assert robot.leg_length == pytest.approx(biped.THIGH + GAP + biped.SHANK + biped.ANKLE, abs=1e-3)
    assert [knee_turn(robot, foot) for foot in (0, 1)] == pytest.approx([1.8, 1.8])
    # The shank is what hangs on the second hinge, whose box is 0.05 m wide.
    assert np.ptp(shank_outline(robot, 0)[:, 0]) == pytest.approx(0.05, abs=1e-3)


@pytest.mark.unit
def test_both_formats_tell_both_joints_and_what_drives_them(tmp_path):
    tree = explain(str(biped.write(tmp_path, urdf(mimic("knee", 0.5, 0.1), limit=WIDE))))
    text = mjcf(equality("0.1 0.5 0 0 0"))
    for found, torque in ((tree, 80), (explain(str(biped.write(tmp_path, text, MJCF_FILE, "biped.xml"))), 160)):
        lines = [note for note in found.notes if note.startswith("coupled: ")]
        assert lines[0] == (
            "coupled: left_second turns by 0.5 times left_knee from 0.1 rad on; "
            f"both are one joint, of {torque} N m at left_knee"
        )
        assert len(lines) == 2
        assert not any("roll on each other" in line for line in found.description.left_out)


@pytest.mark.unit
def test_three_hinges_in_a_row_are_one_joint(tmp_path):
    text = urdf(mimic("knee", 0.5), limit=WIDE)
    for side in ("left", "right"):
        link = f'<link name="{side}_disc"><inertial><mass value="0.2"/>'
        link += '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        joint = f'<joint name="{side}_third" type="revolute"><parent link="{side}_disc"/><child link="{side}_shank"/>'
        joint += f'<origin xyz="0 0 -0.03"/><axis xyz="0 1 0"/>{WIDE}{mimic("second", 2.0).format(side=side)}</joint>'
        text = text.replace(f'<child link="{side}_shank"/>', f'<child link="{side}_disc"/>')
        text = text.replace("</robot>", f"{link}{joint}</robot>")
    robot = of_urdf(tmp_path, text)
    assert [(one.follower, one.leader, one.ratio) for one in robot.couplings[:2]] == [
        ("left_second", "left_knee", 0.5),
        ("left_third", "left_knee", 1.0),
    ]
    pair = EnginePair(robot)
    assert pair.difference(*pair.random_state(np.random.default_rng(0))).largest < 1e-9


@pytest.mark.unit
def test_a_leader_that_is_locked_holds_its_follower_where_that_belongs(tmp_path):
    following = reduced_urdf(tmp_path, urdf(mimic("knee", 0.5, 0.1), limit=WIDE), "lock: {'*_knee': 0.4}\n")
    given = reduced_urdf(tmp_path, urdf("", limit=WIDE), "lock: {'*_knee': 0.4, '*_second': 0.3}\n")
    assert following.couplings == () and tuple(following.model.names) == tuple(given.model.names)
    for one, other in zip(following.model.inertias, given.model.inertias, strict=True):
        assert one.isApprox(other, 1e-12)


CASES = {
    "another leg": (mimic("knee").replace("{side}_knee", "right_knee"), "", "by mimic it follows 'right_knee'"),
    "not its neighbour": (mimic("yaw"), "", "by mimic it follows 'left_yaw'"),
    "no joint": (mimic("nothing"), "", "by mimic it follows 'left_nothing'"),
    "nothing moves it": (mimic("knee", 0.0), "", "by mimic it follows 'left_knee'"),
    "each other": (mimic("knee"), mimic("second"), "cannot be driven"),
    "no turn": (mimic("knee", -1.0), "", "by mimic it follows 'left_knee'"),
}


@pytest.mark.unit
@pytest.mark.parametrize("name", CASES)
def test_what_is_no_single_joint_is_refused_by_both_names(tmp_path, name):
    second, first, said = CASES[name]
    with pytest.raises(RobotError, match=r"^joint 'left_(knee|second)' of biped is in a leg") as refused:
        of_urdf(tmp_path, urdf(second, first, WIDE))
    assert said in str(refused.value) and "it may follow the joint next to it in the leg" in str(refused.value)


@pytest.mark.unit
def test_axes_that_are_not_parallel_are_refused(tmp_path):
    with pytest.raises(RobotError, match="is in a leg and cannot be driven"):
        of_urdf(tmp_path, urdf(limit=WIDE, axis="0 0.9 0.1"))


@pytest.mark.unit
def test_ranges_that_never_meet_are_refused(tmp_path):
    with pytest.raises(RobotError, match="joint 'left_second' of biped follows 'left_knee' to where its range"):
        of_urdf(tmp_path, urdf(mimic("knee", 1.0, -9.0)))


@pytest.mark.unit
@pytest.mark.parametrize(
    ("text", "said"),
    [
        (equality("0 1 0.2 0 0"), "by equality joint 'left' it follows 'left_knee'"),
        (equality() + equality().replace('name="', 'name="again_').replace("_knee", "_pitch"), "binds joints"),
    ],
    ids=["no constant ratio", "two leaders"],
)
def test_an_equality_that_is_no_coupling_is_refused(tmp_path, text, said):
    with pytest.raises(RobotError) as refused:
        of_mjcf(tmp_path, mjcf(text, motors()))
    assert said in str(refused.value)


@pytest.mark.unit
def test_a_leg_that_a_coupling_leaves_too_few_joints_is_refused_and_says_so(tmp_path):
    knees = {side: f'<joint name="{side}_knee" type="revolute">' for side in ("left", "right")}
    changes = {knee: f'{knee}<mimic joint="{side}_pitch" multiplier="-2"/>' for side, knee in knees.items()}
    with pytest.raises(
        RobotError, match=r"left_foot.*has 5 joints with a motor, one of which 'left_knee' follows"
    ) as refused:
        of_urdf(tmp_path, biped.Biped(changes=changes).urdf())
    assert "none of which pitches the foot" in str(refused.value)


@pytest.mark.unit
def test_an_imu_between_the_hinges_is_refused(tmp_path):
    with pytest.raises(RobotError, match="imu of biped is 'left_roller', between two joints that turn as one"):
        of_urdf(tmp_path, None, "imu: left_roller\n")


@pytest.mark.unit
@pytest.mark.parametrize("body", ["left_thigh", "left_shank", "left_foot"])
def test_an_imu_behind_the_hinges_moves_with_both(robot, body):
    place, rng = ImuPlace(body, (0.05, -0.02, 0.1), (0.5, 0.5, -0.5, 0.5)), np.random.default_rng(2)
    model, ours = mujoco.MjModel.from_xml_string(robot.mjcf), pinocchio_model(robot)
    q = pin.integrate(ours, pin.neutral(ours), 0.5 * rng.normal(size=ours.nv))
    v, data, motion = rng.normal(size=ours.nv), mujoco.MjData(model), np.zeros(6)
    Coordinates(model).to_mujoco(q, v, data.qpos, data.qvel)
    mujoco.mj_forward(model, data)
    found = ImuChain(model, model.body(robot.pelvis_body).id, place, np.zeros(3), np.zeros(3)).motion(q, v)
    at = model.body(body).id
    R = data.xmat[at].reshape(3, 3)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, at, motion, 0)
    expected = motion[3:] + np.cross(motion[:3], R @ np.array(place.position))
    np.testing.assert_allclose(found.rotation, R @ rotation_of(np.array(place.quaternion)), rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(np.asarray(found.rotation) @ found.angular_velocity, motion[:3], rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(found.velocity, expected, rtol=0.0, atol=1e-11)


@pytest.mark.unit
def test_the_similar_robot_is_coupled_alike(robot):
    small = scaled(robot, 0.8)
    assert small.couplings == robot.couplings
    pair = EnginePair(small)
    assert pair.difference(*pair.random_state(np.random.default_rng(0))).largest < 1e-9


@pytest.mark.unit
def test_a_description_of_which_a_follower_is_driven_is_refused(robot):
    with pytest.raises(RobotError, match="follows by 1 times 'left_knee' and 0; it must have no motor"):
        replace(robot, couplings=(Coupling("left_pitch", "left_knee", 1.0),))
    with pytest.raises(RobotError, match=r"couplings\.0\.leader of biped names 'knee', which is no joint of it"):
        replace(robot, couplings=(Coupling("left_second", "knee", 1.0),))


@pytest.mark.physics
@pytest.mark.parametrize("kind", ["urdf", "mjcf"])
def test_it_walks_from_sensors_and_its_log_tells_that_the_coupling_holds(tmp_path, kind):
    robot = biped.write(tmp_path, urdf()) if kind == "urdf" else None
    robot = robot or biped.write(tmp_path, mjcf(equality(), motors(), armature=0.02), MJCF_FILE, "biped.xml")
    keys = {"robot": str(robot), "gait.steps": 4, "gait.initial_stand": 0.4, "criteria.speed_mean": {"min": 0.2}}
    result = run_scenario(surefoot.load("walk-level", keys), tmp_path)
    assert result.verdict.passed, result.verdict.reasons
    assert 0.0 < result.verdict["coupling_error"] < 5e-5
    log = surefoot.read(result.log)
    assert log["/coupling"].field("apart").shape == (len(log["/truth"]), 2)
    if kind == "mjcf":
        return  # how its log is run again does not hang on what the robot was read from
    again = run_scenario(surefoot.load(str(result.log)), tmp_path / "again")
    then = surefoot.read(again.log)
    for topic in ("/coupling", "/truth", "/torque"):
        for field in log.fields(topic):
            np.testing.assert_array_equal(log[topic].field(field.name), then[topic].field(field.name))


@pytest.mark.physics
def test_damped_joints_give_way_more_and_the_log_tells_it(tmp_path):
    keys = {"robot": str(biped.write(tmp_path, urdf())), "gait.steps": 2, "motors": {"damping": 0.5}, "criteria": {}}
    verdict = run_scenario(surefoot.load("walk-level", keys), tmp_path).verdict
    assert not verdict["fell"] and 5e-5 < verdict["coupling_error"] < 1e-3


@pytest.mark.physics
def test_without_the_equality_the_log_tells_that_nothing_holds(tmp_path, monkeypatch):
    """The negative control: a world that has lost what couples its joints is no walk, and no small error either."""
    robot = of_urdf(tmp_path)

    class Lost(World):
        def reset(self, *args, **kwargs):
            super().reset(*args, **kwargs)
            self.data.eq_active[:] = False

    monkeypatch.setattr("surefoot.scenarios.run.full.World", Lost)
    walk = surefoot.load("walk-level", {"robot": str(tmp_path / "biped.yaml")})
    verdict = surefoot.run(walk, out=tmp_path / "lost").verdict
    assert robot.couplings and not verdict.passed
    assert verdict["coupling_error"] > 0.1
