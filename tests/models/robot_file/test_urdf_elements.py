"""Each element of a URDF is used, refused by name, or told by name as left out; joints that follow others as well."""

import re

import biped
import pytest

from surefoot.models import RobotError, explain
from surefoot.models.robot_file.bindings import rolling
from surefoot.models.robot_file.files import originals
from surefoot.models.robot_file.mjcf_schema import Fate
from surefoot.models.robot_file.reduced import reduced
from surefoot.models.robot_file.schema import read
from surefoot.models.robot_file.source import read_source
from surefoot.models.robot_file.urdf_schema import URDF_ELEMENTS

pytestmark = pytest.mark.unit

KNEE = '<joint name="left_knee" type="revolute">'
SHANK = '<link name="left_shank">'
ENTRIES = [(path, group.fate) for group in URDF_ELEMENTS for path in group.paths]
USED = ("link", "joint", "material")
INSIDE = {"dynamics": 'damping="0.5"', "safety_controller": 'k_velocity="9"', "contact": 'x="1"'}


def read_text(folder, text, more=""):
    path = biped.write(folder, text, biped.FILE + more)
    file = read(path)
    made_of = originals(file, folder)
    return reduced(made_of, read_source(file, made_of.document))


def with_element(path: str) -> str:
    """The biped with an element of a path."""
    around, _, tag = path.rpartition("/")
    element = f"<{tag} {INSIDE.get(tag, '')}/>"
    places = {"link": (SHANK, SHANK + element), "joint": (KNEE, KNEE + element)}
    if around in places:
        return biped.Biped(changes=dict([places[around]])).urdf()
    return biped.Biped(extra=f"<{around}>{element}</{around}>" if around else element).urdf()


def of(*fates):
    return [path for path, fate in ENTRIES if fate in fates and path.partition("/")[0] != "material"]


@pytest.mark.parametrize("path", of(Fate.LEFT_OUT))
def test_an_element_that_is_left_out_is_told_by_name(tmp_path, path):
    around, _, tag = path.rpartition("/")
    (line,) = read_text(tmp_path, with_element(path)).left_out
    assert line.startswith(f"left out: {tag} of {around}: " if around else f"left out: {tag}: ")
    assert read_text(tmp_path, biped.Biped().urdf()).left_out == []


@pytest.mark.parametrize("path", of(Fate.REFUSED))
def test_an_element_that_closes_a_loop_is_refused_by_name(tmp_path, path):
    around, _, tag = path.rpartition("/")
    text = with_element(path).replace("<robot ", '<robot xmlns:drake="d" ')
    named = re.escape(f"{tag} of {around}" if around else tag)
    with pytest.raises(RobotError, match=rf"biped\.urdf:1: {named} closes a loop or couples joints; give a serial"):
        read_text(tmp_path, text)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((KNEE, f"{KNEE}<spring stiffness='9'/>"), "spring of joint"),
        ((SHANK, f"{SHANK}<buoyancy value='9'/>"), "buoyancy of link"),
        (("</robot>", "<plugin/></robot>"), "plugin"),
        ((KNEE, KNEE.replace(">", ' dont_collapse="true">')), "dont_collapse of joint"),
        (('velocity="15"', 'velocity="15" jerk="9"'), "jerk of limit of joint"),
    ],
)
def test_what_no_urdf_has_is_told(tmp_path, change, said):
    assert read_text(tmp_path, biped.Biped().urdf().replace(*change, 1)).left_out == [
        f"left out: {said}: other programs read it"
    ]


def test_a_transmission_between_joints_is_told_with_its_joints(tmp_path):
    joints = "".join(f'<joint name="left_ankle_{name}"/>' for name in ("pitch", "roll"))
    text = biped.Biped(extra=f"<transmission>{joints}</transmission>").urdf()
    (line,) = read_text(tmp_path, text).left_out
    assert line.startswith(
        "left out: transmission between left_ankle_pitch and left_ankle_roll: each joint has one motor"
    )


def test_losses_of_zero_are_no_losses(tmp_path):
    text = biped.Biped(changes={KNEE: f'{KNEE}<dynamics damping="0.0" friction="0"/>'}).urdf()
    assert read_text(tmp_path, text).left_out == []


def test_a_joint_of_a_leg_that_follows_another_is_refused_by_both_names(tmp_path):
    text = biped.Biped(changes={KNEE: f'{KNEE}<mimic joint="left_roll" multiplier="-2"/>'}).urdf()
    said = r"joint 'left_knee' of biped is in a leg and cannot be driven \(by mimic it follows 'left_roll'\)"
    with pytest.raises(RobotError, match=said):
        read_text(tmp_path, text)


@pytest.mark.parametrize(("offset", "angle"), [("", 0.0), (' offset="0.3"', 0.3), (' offset="9"', 0.5)])
def test_a_joint_of_an_arm_that_follows_another_is_held_where_it_would_rest(tmp_path, offset, angle):
    elbow = '<joint name="left_elbow" type="revolute">'
    text = biped.Biped(changes={elbow: f'{elbow}<mimic joint="left_shoulder"{offset}/>'}).urdf()
    found = read_text(tmp_path, text)
    assert found.left_out == ["left out: motion of left_elbow, and mimic: locked, follow others"]
    held = read_text(tmp_path, biped.Biped().urdf(), f"lock: {{left_elbow: {angle}}}\n")
    arm = found.model.getJointId("left_shoulder")
    assert found.model.inertias[arm].isApprox(held.model.inertias[arm], 1e-12)


def test_a_joint_that_the_srdf_calls_passive_is_told_where_it_moves(tmp_path):
    passive = "".join(f'<passive_joint name="left_{name}"/>' for name in ("elbow", "knee"))
    (tmp_path / "biped.srdf").write_text(f'<robot name="biped">{passive}</robot>')
    (line,) = read_text(tmp_path, biped.Biped().urdf(), "lock: [left_elbow]\n").left_out
    assert line == "left out: passive_joint of the SRDF: left_knee: they have motors here"


def knees(second: str, at: str = "0 0 -0.05") -> str:
    """A biped whose left knee is two joints, the second as given."""
    link = '<link name="left_roller"><inertial><mass value="0.2"/>'
    link += '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    joint = f'<joint name="left_second" type="revolute"><parent link="left_roller"/><child link="left_shank"/>{second}'
    joint += f'<origin xyz="{at}"/><axis xyz="0 1 0"/></joint>'
    changes = {'<child link="left_shank"/>': '<child link="left_roller"/>', "</robot>": f"{link}{joint}</robot>"}
    return biped.Biped(changes=changes).urdf()


ALIKE = '<limit lower="0.0" upper="2.0" effort="80" velocity="15"/>'


@pytest.mark.parametrize(
    ("second", "at", "rolls"),
    [
        (ALIKE, "0 0 -0.05", True),
        (ALIKE.replace("2.0", "1.5"), "0 0 -0.05", False),
        (ALIKE.replace("80", "40"), "0 0 -0.05", False),
        (ALIKE, "0 0 0", False),
    ],
)
def test_two_joints_that_look_like_one_that_rolls_are_told(tmp_path, second, at, rolls):
    found = explain(str(biped.write(tmp_path, knees(second, at))))
    told = [line for line in found.description.left_out if "roll on each other" in line]
    assert len(told) == rolls
    assert all("left_knee and left_second" in line and line in found.notes for line in told)


def test_a_leg_of_six_joints_has_none_to_spare(tmp_path):
    model = read_text(tmp_path, biped.Biped().urdf()).model
    assert rolling(model, tuple(range(2, 8))) is None
