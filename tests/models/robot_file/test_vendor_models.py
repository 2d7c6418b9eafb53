"""Models as vendors write them: names used twice, frames that lie, grounds and cameras, files left out, no speeds."""

import re

import biped
import mjcf_biped as mjcf
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.consistency import EnginePair
from surefoot.models.pinocchio import pinocchio_model

pytestmark = pytest.mark.unit

TURNED = pin.rpy.rpyToMatrix(1.1, -0.4, 2.0)
CHEST = (
    '<link name="chest"><inertial><origin xyz="{at}"/><mass value="3"/>'
    '<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="waist" type="revolute"><parent link="base"/><child link="chest"/>'
    '<origin xyz="0 0 0.1" rpy="{rpy}"/><axis xyz="{axis}"/>'
    '<limit lower="-1" upper="1" effort="80" velocity="15"/></joint>'
)
FINGERS = """<body name="hand" pos="0 0.3 0"><joint name="wrist" axis="0 0 1" actuatorfrcrange="-9 9"/>
<geom size="0.03"/><body name="finger" pos="0 0.05 0"><joint name="finger" axis="0 0 1"/>
<geom size="0.01"/><body name="tip" pos="0 0.03 0"><joint name="tip" axis="0 0 1"/><geom size="0.01"/></body></body>
</body>"""
SPHERE = '<collision><origin xyz="{} {} -0.06"/><geometry><sphere radius="0"/></geometry></collision>'


def text(values) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def explained(folder, model, more=""):
    return explain(str(biped.write(folder, model, biped.FILE + more)))


def inertias(robot):
    """Mass matrices of random states."""
    model, rng = pinocchio_model(robot), np.random.default_rng(3)
    states = [np.r_[np.zeros(6), 1.0, rng.uniform(-0.5, 0.5, model.nv - 6)] for _ in range(5)]
    return np.array([pin.crba(model, model.createData(), q) for q in states])


def test_a_link_and_a_joint_may_share_a_name(tmp_path) -> None:
    one = explained(tmp_path, biped.Biped(), "lock: [left_elbow]\n").description
    shared = biped.Biped().urdf().replace("left_shank", "left_knee").replace("left_foot", "left_ankle_roll")
    file = biped.FILE.replace("left_foot", "left_ankle_roll") + "lock: [left_elbow]\n"
    other = describe(str(biped.write(tmp_path, shared, file)), RobotOptions())
    assert other.joint_names == one.joint_names
    assert not set(other.bodies) & set(other.joint_names)
    np.testing.assert_array_equal(inertias(other), inertias(one))


MORE = '<link name="more"/><joint name="{}" type="fixed"><parent link="base"/><child link="more"/></joint>'


@pytest.mark.parametrize("name", ["universe", "floating base", "base", "link base", "left_sole"])
def test_a_fixed_joint_may_have_any_name(tmp_path, name) -> None:
    """Whatever the engines and this package call things of their own."""
    robot = explained(tmp_path, biped.Biped(extra=MORE.format(name)).urdf(), "lock: [left_elbow]\n").description
    plain = explained(tmp_path, biped.Biped().urdf(), "lock: [left_elbow]\n").description
    np.testing.assert_array_equal(inertias(robot), inertias(plain))


@pytest.mark.parametrize("name", ["floating base", "link base", "world"])
def test_a_joint_may_have_a_name_that_the_base_has_here(tmp_path, name) -> None:
    model = biped.Biped().urdf().replace('"left_knee"', f'"{name}"')
    assert name in explained(tmp_path, model, "lock: [left_elbow]\n").description.joint_names


@pytest.mark.parametrize("name", ["universe", "imu", "left_sole"])
@pytest.mark.parametrize("joint", ["left_knee", "left_elbow"])
def test_a_joint_with_the_name_of_a_site_or_of_the_world_is_refused(tmp_path, name, joint) -> None:
    model = biped.Biped().urdf().replace(f'"{joint}"', f'"{name}"')
    with pytest.raises(RobotError, match=f"a joint has the name '{name}', .*; give it another"):
        explained(tmp_path, model)


def test_a_body_without_a_name_gets_none_that_another_has(tmp_path) -> None:
    """Its shapes and mass went to the other one."""
    model = mjcf.TEXT.replace('<body name="left_pad"', "<body")
    plain = mjcf.described(tmp_path, model)
    for number in range(1, 16):
        other = mjcf.described(tmp_path, model.replace('"right_ankle"', f'"body{number}"'))
        np.testing.assert_array_equal(inertias(other), inertias(plain))


def test_what_is_between_two_joints_gets_no_name_that_a_body_has(tmp_path) -> None:
    two = '<joint name="left_roll" axis="1 0 0"/><joint name="left_more" axis="0 0 1" actuatorfrcrange="-9 9"/>'
    model = mjcf.TEXT.replace('<joint name="left_roll" axis="1 0 0"/>', two)
    named = model.replace('"right_ankle"', '"left_roll_link behind left_roll"')
    np.testing.assert_array_equal(*(inertias(mjcf.described(tmp_path, text)) for text in (model, named)))


def test_elements_of_other_programs_in_a_link_are_not_looked_at(tmp_path) -> None:
    others = '<collision_checking><capsule name="leg"/></collision_checking><sensor><origin xyz="a"/></sensor></link>'
    model = biped.Biped().urdf()
    plain = explained(tmp_path, model).description
    assert explained(tmp_path, model.replace("</link>", others)).description.mjcf == plain.mjcf


def test_a_torso_is_named_as_the_description_names_it(tmp_path) -> None:
    """The name that `robot new` proposes for a link that has the name of a joint can be written into the file."""
    model = biped.Biped(extra=CHEST.format(at="0 0 0.2", rpy="0 0 0", axis="0 0 1")).urdf().replace("chest", "waist")
    for name in ("waist", "waist_link"):
        assert explained(tmp_path, model, f"torso: {name}\n").description.torso_body == "waist_link"


def test_a_base_that_is_called_world_is_none_of_the_simulator(tmp_path) -> None:
    world = (
        '<link name="world"/><joint name="root_joint" type="fixed"><parent link="world"/><child link="base"/></joint>'
    )
    robot = explained(tmp_path, biped.Biped(extra=world)).description
    assert robot.pelvis_body == "world_link"
    assert EnginePair(robot)


def test_the_torso_is_upright_at_zero_angles_whatever_its_axes(tmp_path) -> None:
    """The same robot, its chest described in a frame that lies."""
    up = CHEST.format(at="0.01 0 0.2", rpy="0 0 0", axis="0 0 1")
    rpy = text(pin.rpy.matrixToRpy(TURNED))
    lying = CHEST.format(at=text(TURNED.T @ (0.01, 0, 0.2)), rpy=rpy, axis=text(TURNED.T @ (0, 0, 1)))
    one, other = (explained(tmp_path, biped.Biped(extra=chest), "torso: chest\n") for chest in (up, lying))
    np.testing.assert_allclose(inertias(other.description), inertias(one.description), atol=1e-12)
    model = pinocchio_model(other.description)
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    np.testing.assert_allclose(data.oMf[model.getFrameId("chest")].rotation, np.eye(3), atol=1e-12)
    assert any("the frame of 'chest' is turned by" in note for note in other.notes)
    assert not any("the frame of 'chest'" in note for note in one.notes)


@pytest.mark.parametrize("turn", [(np.pi / 2, 0, 0), (0, -np.pi / 2, 0), (np.pi, 0, 0)], ids=["y up", "x up", "z down"])
def test_the_base_is_upright_at_zero_angles_whatever_its_axes(tmp_path, turn) -> None:
    """The same robot, its base described in a frame that lies, and so all that hangs on it."""
    R = pin.rpy.rpyToMatrix(*turn)

    def lying(match: re.Match[str]) -> str:
        xyz = R.T @ np.array([float(part) for part in match[2].split()])
        return f'{match[1]}<origin xyz="{text(xyz)}" rpy="{text(pin.rpy.matrixToRpy(R.T))}"'

    one = explained(tmp_path, biped.Biped()).description
    model = re.sub(
        r'(<parent link="base"/><child link="\w+"/>)<origin xyz="([^"]*)" rpy="0 0 0"', lying, biped.Biped().urdf()
    )
    head, tail = model.split("</link>", 1)
    head = re.sub(r'()<origin xyz="([^"]*)"', lying, head)
    other = explained(tmp_path, f"{head}</link>{tail}").description
    assert (other.leg_length, other.com_height) == pytest.approx((one.leg_length, one.com_height))
    np.testing.assert_allclose(other.nominal_joint_positions, one.nominal_joint_positions, atol=1e-9)
    np.testing.assert_allclose(inertias(other)[:, 6:, 6:], inertias(one)[:, 6:, 6:], atol=1e-12)
    assert pinocchio_model(other).inertias[1].lever == pytest.approx(pinocchio_model(one).inertias[1].lever, abs=1e-12)


def test_a_base_of_an_mjcf_stands_as_its_file_puts_it(tmp_path) -> None:
    lying = mjcf.TEXT.replace(
        '<body name="base" pos="0 0 0.7">',
        '<body name="base" pos="0 0 0.7" euler="1.5708 0 0"><body name="up" euler="-1.5708 0 0">',
    )
    lying = (
        lying.replace("</worldbody>", "</body></worldbody>")
        .replace("<freejoint/>", "")
        .replace('<body name="up"', '<freejoint/><body name="up"')
    )
    one, other = mjcf.described(tmp_path), mjcf.described(tmp_path, lying)
    assert other.com_height == pytest.approx(one.com_height)
    np.testing.assert_allclose(other.nominal_joint_positions, one.nominal_joint_positions, atol=1e-6)


def test_joints_above_both_legs_are_locked_where_the_trunk_is_the_root(tmp_path) -> None:
    chest = CHEST.replace('value="3"', 'value="30"').replace(
        '<parent link="base"/><child link="chest"/>', '<parent link="chest"/><child link="base"/>'
    )
    found = explained(tmp_path, biped.Biped(extra=chest.format(at="0 0 0.2", rpy="0 0 0", axis="0 0 1")))
    assert "waist" not in found.description.joint_names
    assert any(note.startswith("locked, above both legs") and "waist" in note for note in found.notes)


def test_feet_may_be_points(tmp_path) -> None:
    """Contact points at the corners of a sole, which have no volume."""
    points = "".join(SPHERE.format(x, y) for x in (-0.05, 0.12) for y in (-0.04, 0.04))
    model = biped.Biped(feet=False).urdf()
    for side in ("left", "right"):
        model = re.sub(rf'(<link name="{side}_foot">.*?)</link>', rf"\1{points}</link>", model)
    robot = explained(tmp_path, model).description
    assert (robot.sole_length, robot.sole_width) == pytest.approx((0.17, 0.08))


def test_speed_limits_that_a_model_lacks_are_taken_and_told(tmp_path) -> None:
    found = explained(
        tmp_path, biped.Biped(changes={'velocity="15"': 'velocity="0"'}), "velocity_limit: {left_knee: 9}\n"
    )
    speeds = dict(zip(found.description.joint_names, found.description.velocity_limit, strict=True))
    assert speeds.pop("left_knee") == 9.0
    assert set(speeds.values()) == {12.0}
    assert any("velocity_limit: 12 rad/s is taken for 15 joints" in note for note in found.notes)


@pytest.mark.parametrize("reference", ["meshes/cap.stl", "package://biped_meshes/cap.stl", "biped.yaml"])
def test_what_is_drawn_may_be_missing(tmp_path, reference) -> None:
    cap = f'<link name="cap"><visual><geometry><mesh filename="{reference}"/></geometry></visual>{{}}</link>'
    fixed = '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'
    found = explained(tmp_path, biped.Biped(extra=cap.format("") + fixed))
    assert any(note.startswith("left out: link 'cap' of") and note.endswith("is not drawn") for note in found.notes)
    box = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    touches = cap.replace("visual", "collision").format(box)
    found = explained(tmp_path, biped.Biped(extra=touches + fixed))
    assert any(note.startswith("link 'cap' of") and "by what is drawn" in note for note in found.notes)


WORLDS = {
    "a contact with a ground that is elsewhere": (
        "</mujoco>",
        "<contact><pair geom1='sole' geom2='ground'/></contact></mujoco>",
    ),
    "a keyframe of another world": ("</mujoco>", "<keyframe><key qpos='1 2'/></keyframe></mujoco>"),
    "a thing beside the robot": ("</worldbody>", "<body name='stand'><joint/><geom size='1'/></body></worldbody>"),
    "a mesh that is drawn": (
        '<geom type="box" size="0.08 0.1 0.08"/>',
        '<inertial pos="0 0 0" mass="3" diaginertia="0.02 0.02 0.02"/>'
        '<geom type="mesh" mesh="no" contype="0" conaffinity="0"/>',
    ),
    "locked joints below another": (
        '<geom type="box" size="0.08 0.1 0.08"/>',
        f'<geom type="box" size="0.08 0.1 0.08"/>{FINGERS}',
    ),
    "joints without names": (
        '<geom type="box" size="0.08 0.1 0.08"/>',
        f'<geom type="box" size="0.08 0.1 0.08"/>{re.sub("joint name=.[a-z]+.", "joint", FINGERS)}',
    ),
}


@pytest.mark.parametrize("case", WORLDS)
def test_an_mjcf_reads_as_it_is_delivered(tmp_path, case) -> None:
    model = mjcf.TEXT.replace(*WORLDS[case], 1).replace(
        "<worldbody>", '<asset><mesh name="no" file="no.stl"/></asset><worldbody>', 1 if "mesh" in case else 0
    )
    robot = mjcf.described(tmp_path, model)
    assert len(robot.roles.legs) == 12
    rng = np.random.default_rng(0)
    pair = EnginePair(robot)
    assert pair.difference(*pair.random_state(rng)).largest < 1e-9


def test_a_mesh_that_an_mjcf_touches_with_is_missed_by_name(tmp_path) -> None:
    model = mjcf.TEXT.replace("<worldbody>", '<asset><mesh name="no" file="no.stl"/></asset><worldbody>', 1)
    model = model.replace('<geom type="box" size="0.08 0.1 0.08"/>', '<geom type="mesh" mesh="no"/>', 1)
    with pytest.raises(RobotError, match=r"body 'base' of .*biped.xml: mesh no.stl is not there; put it at .*no.stl"):
        mjcf.described(tmp_path, model)
