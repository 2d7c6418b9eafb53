"""Texts in the encoding that they name, xacros, Git LFS pointers, references of all spellings, missing limits."""

import re
from pathlib import Path

import biped
import mjcf_biped as mjcf
import pytest
from mesh_files import POINTER, body, dae, stl

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.robot_file.document import UnexpandedError
from surefoot.models.robot_file.mesh_file import colour_in_file
from surefoot.models.robot_file.paths import resolve

pytestmark = pytest.mark.unit

SOUND = biped.Biped().urdf()


def refused(file: Path) -> str:
    with pytest.raises(RobotError) as error:
        describe(str(file), RobotOptions())
    assert "\n" not in str(error.value)
    return str(error.value)


ENCODINGS = (
    "ISO-8859-1",
    "windows-1252",
    "UTF-16",
    "UTF-16-LE",
    "UTF-16-BE",
    "UTF-8",
    "UTF-8-sig",
    "shift_jis",
    "UTF-32",
)


@pytest.mark.parametrize("kind", ["urdf", "xml"])
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_a_model_is_read_in_the_encoding_that_it_names(tmp_path, encoding, kind) -> None:
    """A foot whose name is none of ASCII is found by the robot file, which is UTF-8."""
    name = "足" if encoding == "shift_jis" else "Fuß_links"
    text = (SOUND if kind == "urdf" else mjcf.TEXT).replace("left_foot", name)
    head = f'<?xml version="1.0" encoding="{encoding.removesuffix("-sig").removesuffix("-LE").removesuffix("-BE")}"?>\n'
    path = biped.write(tmp_path, SOUND)
    (tmp_path / f"biped.{kind}").write_bytes((head + text).encode(encoding))
    file = biped.FILE.replace("left_foot", name).replace("biped.urdf", f"biped.{kind}")
    path.write_text(file + (mjcf.LIMITS if kind == "xml" else ""), encoding="utf-8")
    assert name in describe(str(path), RobotOptions()).bodies


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_robot_file_may_begin_with_its_byte_order(tmp_path, encoding) -> None:
    path = biped.write(tmp_path)
    path.write_bytes(biped.FILE.encode(encoding))
    assert describe(str(path), RobotOptions()).name == "biped"


def test_an_encoding_that_a_file_is_not_in_is_not_believed(tmp_path) -> None:
    """Programs write UTF-8 under the name of another, and XML has no names of programs."""
    path = biped.write(tmp_path)
    for name in ("utf-16", "ascii", "no-such-thing", "zlib", "unicode_escape", "punycode"):
        text = f'<?xml version="1.0" encoding="{name}"?>{SOUND.replace("left_foot", "Fuß")}'
        (tmp_path / "biped.urdf").write_bytes(text.encode())
        path.write_text(biped.FILE.replace("left_foot", "Fuß"), encoding="utf-8")
        assert "Fuß" in describe(str(path), RobotOptions()).bodies
    (tmp_path / "biped.urdf").write_bytes(
        f'<?xml version="1.0" encoding="ascii"?>{SOUND}<!-- Fuß -->'.encode("latin-1")
    )
    assert "it is no ascii or UTF-8 text" in refused(path)


X = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LEFT = {
    "include": (f'<robot name="biped" {X}><xacro:include filename="a.xacro"/>', "xacro:include"),
    "macro": (f'<robot name="biped" {X}><xacro:macro name="arm" params="side"/>', "xacro:macro"),
    "call": (f'<robot name="biped" {X}><xacro:arm side="left"/>', "xacro:arm"),
    "if": (f'<robot name="biped" {X}><xacro:if value="1"/>', "xacro:if"),
    "property": (f'<robot name="biped" {X}><xacro:property name="a" value="1"/>', "xacro:property"),
    "insert_block": (f'<robot name="biped" {X}><xacro:insert_block name="a"/>', "xacro:insert_block"),
    "another prefix": (
        '<robot name="biped" xmlns:x="http://ros.org/wiki/xacro"><x:property name="a" value="1"/>',
        "x:property",
    ),
    "no name space": ('<robot name="biped"><xacro:arg name="a" default="1"/>', "xacro:arg"),
    "of before": ('<robot name="biped"><include filename="arm.xacro"/>', "include"),
    "macro of before": ('<robot name="biped"><macro name="arm" params="side"/>', "macro"),
    "within others": (f'<robot name="biped" {X}><gazebo><xacro:if value="1"/></gazebo>', "xacro:if"),
}


@pytest.mark.parametrize("case", LEFT)
def test_what_is_left_of_xacro_is_to_be_expanded(tmp_path, case) -> None:
    head, left = LEFT[case]
    said = refused(biped.write(tmp_path, SOUND.replace('<robot name="biped">', head)))
    place = tmp_path / "biped.urdf"
    assert f"{place}:1: has xacro's '{left}' left in it; expand it: xacro {place} > robot.urdf" in said


@pytest.mark.parametrize(
    ("old", "new", "left"),
    [
        ('value="8.0"', 'value="${m}"', "${m}"),
        ('name="left_yaw_link"', 'name="${side}_yaw_link"', "${side}"),
        ('value="8.0"', 'value="$(arg mass)"', "$(arg mass)"),
        (
            "<collision>",
            '<visual><geometry><mesh filename="$(find b)/a.stl"/></geometry></visual><collision>',
            "$(find b)",
        ),
    ],
)
def test_what_xacro_would_fill_in_is_to_be_expanded(tmp_path, old, new, left) -> None:
    said = refused(biped.write(tmp_path, SOUND.replace(old, new, 1)))
    assert f"has xacro's '{left}' left in it; expand it: xacro " in said
    with pytest.raises(UnexpandedError):
        mjcf.described(tmp_path, mjcf.TEXT.replace('mass="0.5"', 'mass="${m}"', 1))


def test_what_xacro_leaves_of_itself_is_no_fault(tmp_path) -> None:
    """Its name space, and places that other programs fill in."""
    others = '<gazebo><plugin filename="$(find b)/c.so" name="${n}"/></gazebo></robot>'
    text = SOUND.replace('<robot name="biped">', f'<robot name="biped" {X}>').replace("</robot>", others)
    assert describe(str(biped.write(tmp_path, text)), RobotOptions()).name == "biped"


def test_a_git_lfs_pointer_is_called_one_wherever_it_stands(tmp_path) -> None:
    said = "a Git LFS pointer, not the file itself; run 'git lfs pull'"
    path = biped.write(tmp_path)
    for name in ("biped.urdf", "biped.yaml"):
        before = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(POINTER)
        assert said in refused(path)
        assert name in refused(path)
        (tmp_path / name).write_bytes(before)
    path.write_text(f"{biped.FILE}srdf: biped.srdf\n")
    (tmp_path / "biped.srdf").write_bytes(POINTER)
    assert said in refused(path)
    (tmp_path / "part.xml").write_bytes(POINTER)
    text = mjcf.TEXT.replace("<worldbody>", '<include file="part.xml"/><worldbody>', 1)
    assert said in refused(biped.write(tmp_path, text, biped.FILE.replace(".urdf", ".xml") + mjcf.LIMITS, "biped.xml"))


CAP = (
    '<link name="cap"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'
    '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'
)
SPELLINGS = (
    "my%20parts/a cap.stl",
    "my%20parts/a%20cap.stl",
    "./my parts/a%20cap.stl",
    "package://my%20robot/no",
    "file://{folder}/my%20parts/a%20cap.stl",
    "file:{folder}/my parts/a cap.stl",
    "file://localhost{folder}/my parts/a cap.stl",
    "model://parts_of_it/a cap.stl",
    "Package://parts_of_it/a%20cap.stl",
    "my parts\\a cap.stl",
)


@pytest.mark.parametrize("written", SPELLINGS)
def test_a_mesh_is_found_however_its_name_is_spelt(tmp_path, written) -> None:
    path = biped.write(tmp_path, biped.Biped(extra=CAP.format(written.format(folder=tmp_path))))
    for folder in ("my parts", "parts_of_it"):
        (tmp_path / folder).mkdir()
        vertices, faces = body()
        (tmp_path / folder / "a cap.stl").write_bytes(stl(vertices, faces))
    found = explain(str(path)).description
    assert bool(found.left_out) == ("no" in written)
    assert found.mjcf.count("base_look") == (2 if "no" in written else 4)


def test_what_is_written_is_there_before_what_it_may_mean(tmp_path) -> None:
    for name in ("a%20b.stl", "a b.stl"):
        (tmp_path / name).touch()
    assert resolve("a%20b.stl", tmp_path).name == "a%20b.stl"
    with pytest.raises(RobotError, match=r"http://x\.org/a\.stl is not on this machine; put a copy of it beside"):
        resolve("http://x.org/a.stl", tmp_path)


@pytest.mark.parametrize("encoding", ["UTF-16", "ISO-8859-1"])
def test_the_colour_of_a_collada_file_in_another_encoding(tmp_path, encoding) -> None:
    vertices, faces = body()
    colour = '<contributor/><extra><diffuse><color sid="diffuse">0.1 0.2 0.3 1</color></diffuse></extra>'
    data = dae(vertices, faces, colour, encoding=encoding)
    (tmp_path / "m.dae").write_bytes(data)
    assert colour_in_file(tmp_path / "m.dae") == (0.1, 0.2, 0.3)


def joint(name: str, limit: str, kind: str = "revolute") -> str:
    """The robot with another limit, or none, of one joint."""
    pattern = rf'(<joint name="{name}" type=")revolute(".*?)<limit[^>]*/>'
    text, count = re.subn(pattern, rf"\g<1>{kind}\g<2>{limit}", SOUND, count=1, flags=re.DOTALL)
    assert count == 1
    return text


LIMITS = {
    "none": ("left_knee", "", "joint 'left_knee' of biped has no range, it turns from 0 to 0 rad; give it limits"),
    "no range": ("left_knee", '<limit effort="9" velocity="9"/>', "joint 'left_knee' of biped has no range"),
    "no effort": ("left_knee", '<limit lower="0" upper="2" velocity="9"/>', "joint 'left_knee' of biped has no torque"),
    "no velocity": (
        "left_elbow",
        '<limit lower="-2" upper="1" effort="9"/>',
        "12 rad/s is taken for joint 'left_elbow'",
    ),
    "none of an arm": ("left_elbow", "", "locked, without torque: left_elbow"),
}


@pytest.mark.parametrize("case", LIMITS)
def test_a_joint_without_a_limit_is_named_in_one_sentence(tmp_path, case, capfd) -> None:
    """And nothing is said by an engine."""
    name, limit, said = LIMITS[case]
    path = str(biped.write(tmp_path, joint(name, limit)))
    try:
        told = "\n".join(explain(path).notes)
    except RobotError as error:
        told = str(error)
        assert "\n" not in told
    assert said in told
    assert capfd.readouterr() == ("", "")


def test_a_limit_that_the_robot_file_gives_is_enough(tmp_path) -> None:
    path = biped.write(tmp_path, joint("left_knee", '<limit lower="0" upper="2"/>'))
    path.write_text(f"{biped.FILE}torque_limit: {{left_knee: 70}}\nvelocity_limit: {{left_knee: 9}}\n")
    robot = describe(str(path), RobotOptions())
    place = robot.joint_names.index("left_knee")
    assert (robot.torque_limit[place], robot.velocity_limit[place]) == (70.0, 9.0)


def test_a_joint_that_turns_without_end_needs_no_limit(tmp_path, capfd) -> None:
    for limit in ("", '<limit effort="9" velocity="9"/>'):
        found = explain(str(biped.write(tmp_path, joint("left_elbow", limit, "continuous"))))
        assert "joint 'left_elbow' turns without end in the model and one turn either way here" in found.notes
        assert ("left_elbow" in found.description.joint_names) == bool(limit)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("old", "said"),
    [
        ('<mass value="2.0"/>', "inertial of link 'left_thigh' lacks mass; give mass"),
        (r"<inertia [^>]*/>", "inertial of link 'base' lacks inertia; give inertia"),
        (r' ixy="0"', "inertia of link 'base' lacks ixy; give ixy"),
    ],
)
def test_a_link_that_urdfdom_does_not_take_is_named(tmp_path, old, said, capfd) -> None:
    assert said in refused(biped.write(tmp_path, re.sub(old, "", SOUND, count=1)))
    assert capfd.readouterr() == ("", "")


def test_a_file_of_nothing_is_called_empty(tmp_path) -> None:
    """A failed command leaves such a file behind `>`."""
    path = tmp_path / "robot.yaml"
    for text in ("", "\n\n", "# nothing but this\n"):
        path.write_text(text)
        assert f"{path}: is empty; write one with: surefoot robot new MODEL --out FILE" in refused(path)


def test_numbers_in_messages_are_short(tmp_path) -> None:
    path = biped.write(tmp_path, None, biped.FILE + "posture: {left_knee: 2.1000000000000001}\n")
    assert "'left_knee' at 2.1 rad" in refused(path)
    path.write_text(biped.FILE + "scale: 0.0012345678901234567\n")
    assert "scale is 0.00123456789; " in refused(path)
