"""Several joints in one body, and links without mass between joints: both engines hold what the file says."""

import re

import biped
import mjcf_biped as mjcf
import mujoco
import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import pinocchio_to_mujoco, velocity_map
from surefoot.models.facts import shank_outline
from surefoot.models.pinocchio import pinocchio_model
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

HIP = {
    "yaw": '<joint name="{0}_yaw" axis="0 0 1" pos="0 0 0.02" armature="{1}"/>',
    "roll": '<joint name="{0}_roll" axis="1 0 0" pos="0.01 0 0" armature="{1}"/>',
    "pitch": '<joint name="{0}_pitch" axis="0 1 0" pos="0 0.005 -0.01" armature="{1}"/>',
}
LEG = """
  <body name="{0}_thigh" pos="0 {3} 0" quat="0.995 0 0.0998 0">{1}
    <geom type="capsule" fromto="0 0 -0.05 0 0 -0.25" size="0.04" density="900"/>
    <body name="{0}_shank" pos="0 0 -0.28" quat="0.98 0 0.199 0">
      <joint name="{0}_knee" axis="0 1 0" pos="0.01 0 0.01" range="0.1 2"/>
      <geom type="capsule" fromto="0 0 -0.05 0 0 -0.2" size="0.03"/>
      <body name="{0}_foot" pos="0 0 -0.27" quat="0.96 0 -0.28 0">{2}
        <geom type="box" pos="0.03 0 -0.05" size="0.09 0.04 0.01"/></body></body></body>"""
ANKLE = {
    "pitch": '<joint name="{0}_ankle_pitch" axis="0 1 0" pos="0 0 0.02"/>',
    "roll": '<joint name="{0}_ankle_roll" axis="1 0 0" pos="0 0 -0.01"/>',
}
NAMES = ("yaw", "roll", "pitch", "knee", "ankle_pitch", "ankle_roll")
MOTORS = "".join(f'<motor joint="{side}_{name}" ctrlrange="-90 90"/>' for side in ("left", "right") for name in NAMES)
ANKLES = (("pitch", "roll"), ("roll", "pitch"))
ORDERS = (("yaw", "roll", "pitch"), ("roll", "yaw", "pitch"), ("pitch", "roll", "yaw"), ("roll", "pitch", "yaw"))


def text(hip=ORDERS[0], ankle=("pitch", "roll"), armature=0.0, more: str = "", **changes: str) -> str:
    """A biped with three hinges in each thigh and two in each foot, each about a point of its own."""
    legs = ""
    for side, y in (("left", 0.08), ("right", -0.08)):
        above = "".join(HIP[name].format(side, armature) for name in hip)
        legs += LEG.format(side, above, "".join(ANKLE[name].format(side) for name in ankle), y)
    found = f"""<mujoco model="biped"><compiler angle="radian"/>
      <default><geom density="500"/><joint range="-1 1" limited="true"/></default>
      <worldbody><body name="base" pos="0 0 0.7"><freejoint/><geom type="box" size="0.08 0.1 0.08"/>
      {legs}{more}</body></worldbody><actuator>{MOTORS}</actuator></mujoco>"""
    for old, new in changes.values():
        assert old in found
        found = found.replace(old, new)
    return found


def apart(robot, source: str) -> float:
    """Largest difference between a description in Pinocchio and its file in MuJoCo, over states at random.

    Of mass matrix and gravity, of the CoM, and of the velocity of the left foot over that of the joints.
    """
    model, theirs = pinocchio_model(robot), mujoco.MjModel.from_xml_string(source)
    ours, data = model.createData(), mujoco.MjData(theirs)
    rng, worst = np.random.default_rng(0), 0.0
    for _ in range(30):
        q, v = EnginePair(robot).random_state(rng)
        pinocchio_to_mujoco(q, v, data.qpos, data.qvel)
        data.qpos[7:] += theirs.qpos0[7:]
        data.qvel[:] = 0.0
        mujoco.mj_forward(theirs, data)
        T, M, jacobian = velocity_map(data.qpos, theirs.nv), np.zeros((theirs.nv, theirs.nv)), np.zeros((3, theirs.nv))
        mujoco.mj_fullM(theirs, data, M)
        mujoco.mj_jacBody(theirs, data, None, jacobian, theirs.body("left_foot").id)
        pin.computeJointJacobians(model, ours, q)
        turns = pin.getFrameJacobian(model, ours, model.getFrameId("left_sole"), pin.LOCAL_WORLD_ALIGNED)[3:]
        pairs = (
            (T.T @ M @ T, pin.crba(model, ours, q)),
            (T.T @ data.qfrc_bias, pin.computeGeneralizedGravity(model, ours, q)),
            (data.subtree_com[1], pin.centerOfMass(model, ours, q)),
            (jacobian @ T, turns),
        )
        worst = max(worst, *(float(np.abs(a - b).max()) for a, b in pairs))
    return worst


@pytest.mark.parametrize(
    ("hip", "ankle", "armature"),
    [(hip, ANKLES[at % 2], 0.01 * (at == 3)) for at, hip in enumerate(ORDERS)],
)
def test_both_engines_hold_the_robot_of_the_file(tmp_path, hip, ankle, armature) -> None:
    source = text(hip, ankle, armature)
    robot = mjcf.described(tmp_path, source)
    assert apart(robot, source) < 1e-9
    pair, rng = EnginePair(robot), np.random.default_rng(1)
    assert max(pair.difference(*pair.random_state(rng)).largest for _ in range(30)) < 1e-9
    assert robot.roles.left_leg == tuple(f"left_{name}" for name in (*hip, "knee", *(f"ankle_{a}" for a in ankle)))
    assert set(robot.bodies) == set(re.findall(r'<body name="(\w+)"', source))


def test_a_joint_a_tenth_of_a_millimetre_aside_is_seen(tmp_path) -> None:
    """Negative control: of the comparison with the file."""
    source = text()
    assert apart(mjcf.described(tmp_path, source.replace('pos="0.01 0 0"', 'pos="0.01 0 1e-4"')), source) > 1e-7


def test_angles_count_from_where_the_file_has_the_joints(tmp_path) -> None:
    """A joint's ref is the number that its file gives to that; its ends go with it."""
    source = text(ref=('name="left_roll"', 'name="left_roll" ref="0.1"'))
    found = explain(str(_written(tmp_path, source)))
    robot = found.description
    at = robot.joint_names.index("left_roll")
    assert (robot.position_lower[at], robot.position_upper[at]) == pytest.approx((-1.1, 0.9))
    assert any("'left_roll' is at its ref 0.1 in the model" in note for note in found.notes)
    assert apart(robot, source) < 1e-9


def _written(folder, source, more: str = ""):
    file = biped.FILE.replace("biped.urdf", "biped.xml") + mjcf.LIMITS + more
    return biped.write(folder, source, file, "biped.xml")


ARM = (
    """<body name="arm" pos="0 {0} 0.1"><joint name="shoulder" type="{1}"/><geom size="0.04" pos="0 0 -0.2"/></body>"""
)


@pytest.mark.parametrize(("kind", "limited"), [("ball", 'limited="false"'), ("slide", "")])
def test_only_hinges_are_joints_of_legs_and_others_are_locked_elsewhere(tmp_path, kind, limited) -> None:
    arm = ARM.format(0.2, f'{kind}" {limited} name="shoulder').replace('name="shoulder" type', "type")
    found = explain(str(_written(tmp_path, text(more=arm))))
    assert "locked, not revolute: shoulder" in found.notes
    leg = text(kind=('name="left_knee"', f'name="left_knee" type="{kind}" {limited}'))
    with pytest.raises(RobotError, match="joint 'left_knee' of biped is in a leg and cannot be driven"):
        explain(str(_written(tmp_path, leg)))


TWICE = '<joint name="left_more" axis="1 0 0" pos="0.01 0 0" actuatorfrcrange="-9 9"/>'


def test_joints_that_repeat_each_other_are_refused_by_the_names_of_the_file(tmp_path) -> None:
    """Two hinges on one line have a motion without inertia, unless a rotor tells them apart."""
    source = text(more_joint=('<joint name="left_roll"', f'{TWICE}<joint name="left_roll"'))
    with pytest.raises(RobotError) as refusal:
        explain(str(_written(tmp_path, source)))
    said = str(refusal.value)
    assert "joints 'left_more' and 'left_roll' of biped repeat each other's motion" in said
    assert "give armature" in said
    assert " behind " not in said
    robot = explain(str(_written(tmp_path, source, "armature: {left_more: 0.01}\n"))).description
    assert EnginePair(robot).difference(*EnginePair(robot).random_state(np.random.default_rng(0))).largest < 1e-9


def test_joints_that_repeat_each_other_at_the_end_of_a_range_are_told(tmp_path) -> None:
    """With the middle one of three at a right angle the outer ones turn about one line."""
    wide = ('axis="1 0 0" pos="0.01 0 0"', 'axis="1 0 0" pos="0.01 0 0" range="-1.5707963 1"')
    straight = (' pos="0 0 0.02"', ' pos="0 0 0"'), (' pos="0 0.005 -0.01"', ' pos="0 0 0"')
    source = text(wide=wide, one=straight[0], other=straight[1])
    notes = explain(str(_written(tmp_path, source))).notes
    assert any("repeat each other's motion somewhere in their ranges" in note for note in notes), notes
    calm = explain(str(_written(tmp_path, text(armature=0.02, wide=wide, one=straight[0], other=straight[1])))).notes
    assert not any("repeat" in note for note in calm)


MASSLESS = r'(<link name="(?:left|right)_(?:yaw_link|roll_link|ankle)">)<inertial>.*?</inertial>'


def test_links_without_mass_between_joints_are_joints_of_what_hangs_on_them(tmp_path) -> None:
    """A URDF with links without mass in hips and ankles is the MJCF whose thighs and feet have several hinges."""
    urdf = re.sub(MASSLESS, r"\1", biped.Biped(arms=False).urdf())
    robot = describe(str(biped.write(tmp_path, urdf)), RobotOptions())
    pair, rng = EnginePair(robot), np.random.default_rng(0)
    theirs, data = mujoco.MjModel.from_xml_string(_joined(robot)), None
    data = mujoco.MjData(theirs)
    assert theirs.nbody == 8
    for _ in range(20):
        q, v = pair.random_state(rng)
        assert pair.difference(q, v).largest < 1e-9
        pinocchio_to_mujoco(q, v, data.qpos, data.qvel)
        mujoco.mj_forward(theirs, data)
        T, M = velocity_map(data.qpos, theirs.nv), np.zeros((theirs.nv, theirs.nv))
        mujoco.mj_fullM(theirs, data, M)
        ours = pinocchio_model(robot)
        np.testing.assert_allclose(T.T @ M @ T, pin.crba(ours, ours.createData(), q), rtol=0.0, atol=1e-9)


def _joined(robot) -> str:
    """Another text of a biped without arms: joints that are at one place in one body."""
    mass = lambda name: re.search(rf'<body name="{name}"[^>]*>\s*(<inertial [^>]*>)', robot.mjcf)[1]  # noqa: E731
    text = f'<mujoco><compiler angle="radian"/><worldbody><body name="base"><freejoint/>{mass("base")}'
    for side, sign in (("left", 1), ("right", -1)):
        hinge = lambda name, axis: f'<joint name="{side}_{name}" axis="{axis}"/>'  # noqa: E731, B023
        hip = hinge("yaw", "0 0 1") + hinge("roll", "1 0 0") + hinge("pitch", "0 1 0")
        ankle = hinge("ankle_pitch", "0 1 0") + hinge("ankle_roll", "1 0 0")
        text += f'<body pos="0 {sign * biped.HIP} 0">{hip}{mass(f"{side}_thigh")}'
        text += f'<body pos="0 0 {-biped.THIGH}">{hinge("knee", "0 1 0")}{mass(f"{side}_shank")}'
        text += f'<body pos="0 0 {-biped.SHANK}">{ankle}{mass(f"{side}_foot")}</body></body></body>'
    return f"{text}</body></worldbody></mujoco>"


def test_a_shank_of_two_joints_touches_and_clears_edges(tmp_path) -> None:
    """Its shapes are on the last of its joints, and the knee is the first."""
    knee = '<joint name="{0}_knee" axis="0 1 0" pos="0.01 0 0.01" range="0.1 2"/>'
    twist = '<joint name="{0}_twist" axis="0 0 1" pos="0 0 -0.02" actuatorfrcrange="-30 30"/>'
    pairs = {side: (knee.format(side), knee.format(side) + twist.format(side)) for side in ("left", "right")}
    one, two = (explain(str(_written(tmp_path, source))).description for source in (text(), text(**pairs)))
    assert "left_twist" in two.roles.left_leg and two.roles.knees == one.roles.knees
    assert {name for pair in two.kept_apart for name in pair} == {name for pair in one.kept_apart for name in pair}
    np.testing.assert_allclose(shank_outline(two, 0), shank_outline(one, 0), atol=1e-6)


def test_a_joint_that_moves_nothing_is_locked(tmp_path) -> None:
    head = '<link name="lidar"/><joint name="spin" type="revolute"><parent link="base"/><child link="lidar"/>'
    head += '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="5"/></joint>'
    found = explain(str(biped.write(tmp_path, biped.Biped(extra=head))))
    assert "locked, move nothing: spin" in found.notes
    assert found.description.mass == describe(str(biped.write(tmp_path, biped.Biped())), RobotOptions()).mass


def test_a_foot_that_weighs_nothing_is_refused(tmp_path) -> None:
    model = re.sub(r'(<link name="left_foot">)<inertial>.*?</inertial>', r"\1", biped.Biped().urdf())
    with pytest.raises(RobotError, match="link 'left_foot' of biped moves with 0 kg"):
        explain(str(biped.write(tmp_path, model)))


@pytest.mark.parametrize("scale", [0.1, 3.0])
def test_a_robot_of_another_size_has_such_joints_too(tmp_path, scale) -> None:
    """A body without mass has none in any size: MuJoCo would not take the power of it."""
    one, other = (explain(str(_written(tmp_path, text(), more))).description for more in ("", f"scale: {scale}\n"))
    assert other.mass == pytest.approx(scale**3 * one.mass)
    assert EnginePair(other).difference(*EnginePair(other).random_state(np.random.default_rng(0))).largest < 1e-9


def test_a_run_is_that_of_its_log_and_of_a_process_of_its_own(tmp_path) -> None:
    """A robot with several joints in a body, through a log, and beside another one in spawned processes."""
    file = str(_written(tmp_path, text()))
    short = {"robot": file, "gait.steps": 3, "sensing.source": "truth"}
    first = run_scenario(surefoot.load("walk-level", short), tmp_path / "first")
    again = run_scenario(surefoot.load(str(first.log)), tmp_path / "again")
    one, other = (surefoot.read(run.log)["/truth"].field("com") for run in (first, again))
    np.testing.assert_array_equal(one, other)
    assert first.verdict["fell"] is False and first.verdict["steps_taken"] == 3


@pytest.mark.physics
@pytest.mark.parametrize(("hip", "ankle", "armature"), [(*pair, 0.0) for pair in zip(ORDERS, ANKLES, strict=False)])
def test_it_walks(tmp_path, hip, ankle, armature) -> None:
    """From sensors, with every criterion of the scenario met, in legs without rotors."""
    result = run_scenario(
        surefoot.load("walk-level", {"robot": str(_written(tmp_path, text(hip, ankle, armature)))}), tmp_path
    )
    assert result.verdict.passed, result.verdict.reasons
