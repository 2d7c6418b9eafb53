"""Numbers in another unit are refused with the link, the number and the unit; robots of every size are not."""

import re

import biped
import mjcf_biped as mjcf
import numpy as np
import pytest

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.robot_file import magnitudes
from surefoot.models.robot_file.magnitudes import Law

pytestmark = pytest.mark.unit

LAWS = {name: law for name, law in vars(magnitudes).items() if isinstance(law, Law)}
MOMENTS = "ixx iyy izz ixy ixz iyz"


def scaled(text: str, attributes: str, factor: float, within: str = "") -> str:
    """A URDF with attributes times a factor: in one link or joint, in one part of it, or everywhere.

    Args:
        text: of the URDF.
        attributes: their names.
        factor: of each of their numbers.
        within: "link left_thigh", "link left_thigh inertial", "joint left_knee"; all if empty.
    """

    def times(block: str) -> str:
        for name in attributes.split():
            block = re.sub(
                rf'( {name}=")([^"]*)"',
                lambda m: m[1] + " ".join(f"{float(v) * factor:.12g}" for v in m[2].split()) + '"',
                block,
            )
        return block

    if not within:
        return times(text)
    tag, name, *parts = within.split()
    pattern = rf'<{tag} name="{name}".*?</{tag}>'
    whole = re.search(pattern, text, re.DOTALL)[0]
    part = re.search(rf"<{parts[0]}>.*?</{parts[0]}>", whole, re.DOTALL)[0] if parts else whole
    assert times(part) != part
    return text.replace(whole, whole.replace(part, times(part)))


SOUND = biped.Biped().urdf()
NO_AXES = re.sub(r'<axis xyz="[^"]*"/>', lambda m: m[0].replace("xyz", "XYZ"), SOUND)


def lengths(factor: float) -> str:
    """Every length of the robot times a factor."""
    return scaled(NO_AXES, "xyz size", factor).replace("XYZ", "xyz")


def origin(joint: str, factor: float) -> str:
    return scaled(NO_AXES, "xyz", factor, f"joint {joint}").replace("XYZ", "xyz")


ASIDE = SOUND.replace("0 0 -0.15", "0.016 0 -0.15")
URDFS = {
    "a CoM in mm": (scaled(ASIDE, "xyz", 1000, "link left_thigh inertial"), "link 'left_thigh' is 151 m .*millimetres"),
    "a pelvis CoM in mm": (
        scaled(SOUND, "xyz", 1000, "link base inertial"),
        "link 'base' is .* m outside .*millimetres",
    ),
    "a CoM in cm": (scaled(SOUND, "xyz", 100, "link left_thigh inertial"), "'left_thigh' is 14.7 m .*in centimetres"),
    "a CoM in inches": (scaled(SOUND, "xyz", 39.37, "link left_thigh inertial"), "'left_thigh' is 5.61 m .*in inches"),
    "a mass in g": (scaled(SOUND, "value", 1000, "link left_shank"), "mass of link 'left_shank' is 1500 kg.*in grams"),
    "masses in g": (scaled(SOUND, "value", 1000), "mass of link 'base' is 8000 kg, .*of a cube of water"),
    "masses in t": (scaled(SOUND, f"value {MOMENTS}", 1e-3), "joints are 0.936 m .*its masses in tonnes"),
    "moments in kg cm^2": (scaled(SOUND, MOMENTS, 1e4, "link left_thigh"), "gyration of link 'left_thigh' .*kg cm.2"),
    "moments in kg mm^2": (scaled(SOUND, MOMENTS, 1e6, "link left_thigh"), "gyration of link 'left_thigh' .*kg mm.2"),
    "moments in g mm^2": (scaled(SOUND, MOMENTS, 1e9, "link left_thigh"), "gyration of link 'left_thigh' .*in g mm.2"),
    "a shape in mm": (
        scaled(SOUND, "size", 1000, "link left_thigh collision"),
        "link 'left_thigh' reaches 100 m .*milli",
    ),
    "shapes of a thousandth": (scaled(SOUND, "size", 1e-3), "mass of link 'base' is 8 kg, .*cube of water"),
    "a joint in mm": (origin("left_knee", 1000), "joint 'left_knee' is 300 m from the joint before .*millimetres"),
    "a joint in cm": (origin("left_knee", 100), "joint 'left_knee' is 30 m from the joint before .*centimetres"),
    "all in mm": (lengths(1000), "joint '.*' is 340 m from .*in millimetres"),
    "all in cm": (lengths(100), "joint '.*' is 34 m from .*in centimetres"),
    "all in inches": (lengths(39.37), "joint '.*' is 13.4 m from .*in inches"),
    "degrees": (scaled(SOUND, "lower upper", 57.3), "joint 'left_shoulder' of biped turns up to 143 rad.*in degrees"),
    "degrees of a knee": (scaled(SOUND, "lower upper", 57.3, "joint left_knee"), "'left_knee' .*115 rad.*in degrees"),
    "degrees of a frame": (SOUND.replace('rpy="0 0 0"', 'rpy="0 0 90"', 1), "'left_yaw' is '0 0 90'; .*not degrees"),
}


@pytest.mark.parametrize("case", URDFS)
def test_a_urdf_in_another_unit_is_refused_by_link_number_and_unit(tmp_path, case) -> None:
    text, said = URDFS[case]
    with pytest.raises(RobotError, match=said) as refused:
        describe(str(biped.write(tmp_path, text)), RobotOptions())
    assert len(str(refused.value)) < 400


FILES = {
    "a sole in mm": ("sole: {length: 180, width: 80, centre: [0.03, 0, -0.06]}", "is 180 m long.*in millimetres"),
    "a sole's centre in mm": (
        "sole: {length: 0.18, width: 0.08, centre: [30, 0, -60]}",
        "is 67.1 m from its ankle.*milli",
    ),
    "a sole of a fly": (
        "sole: {length: 0.007, width: 0.01, centre: [0.03, 0, -0.06]}",
        "is 0.007 m long.*at least 0.0256",
    ),
    "a narrow sole": (
        "sole: {length: 0.18, width: 0.005, centre: [0.03, 0, -0.06]}",
        "0.005 m wide.*at least 0.0128 m",
    ),
    "com_height in mm": ("com_height: 700", "CoM of biped is 700 m high.*in millimetres"),
    "com_height in cm": ("com_height: 70", "CoM of biped is 70 m high.*in centimetres"),
    "lock in degrees": ("lock: {left_elbow: 90}", "'left_elbow' turns up to 90 rad.*in degrees"),
    "armature": ("armature: {'*_knee': 100}", "armature of joint 'left_knee' of biped is 100 kg m"),
}


@pytest.mark.parametrize("case", FILES)
def test_a_robot_file_in_another_unit_is_refused(tmp_path, case) -> None:
    line, said = FILES[case]
    with pytest.raises(RobotError, match=said):
        describe(str(biped.write(tmp_path, None, f"{biped.FILE}{line}\n")), RobotOptions())


SHANK = '<body name="left_shank" pos="0 0 -0.25" quat="0.8 0 0.6 0">'
YAW = '<inertial pos="0 0 0" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/>'
MJCFS = {
    "a CoM in mm": (
        YAW,
        YAW.replace('pos="0 0 0"', 'pos="40 0 -30"'),
        "'left_yaw_link' is 50 m outside .*in millimetres",
    ),
    "a mass in g": (YAW, YAW.replace("0.5", "500"), "mass of link 'left_yaw_link' is 500 kg.*in grams"),
    "moments in kg mm^2": (YAW, YAW.replace("1e-3", "1e3"), "gyration of link 'left_yaw_link' .*kg mm.2"),
    "a body in mm": (SHANK, SHANK.replace("-0.25", "-250"), "joint 'left_knee' is 250 m from .*in millimetres"),
    "a geom in mm": ('size="0.09 0.04 0.01"', 'size="90 40 10"', "mass of link 'left_foot'|'left_foot' reaches"),
    "degrees read as radians": ('range="-1 1"', 'range="-60 60"', "turns up to 60 rad.*in degrees"),
    "radians read as degrees": ('angle="radian"', 'angle="degree"', "turns the farthest, up to 0.0349 rad.*in radians"),
    "Euler's degrees": (
        'quat="0.8 0 -0.6 0"',
        'euler="0 90 0"',
        "euler of body 'left_pad' is '0 90 0' in a file of rad",
    ),
}


@pytest.mark.parametrize("case", MJCFS)
def test_an_mjcf_in_another_unit_is_refused(tmp_path, case) -> None:
    old, new, said = MJCFS[case]
    assert old in mjcf.TEXT
    with pytest.raises(RobotError, match=said):
        mjcf.described(tmp_path, mjcf.TEXT.replace(old, new, 1))


@pytest.mark.parametrize("size", [0.1, 0.3, 1.0, 3.0, 15.0])
def test_the_similar_robot_of_any_size_is_a_robot(tmp_path, size) -> None:
    """Lengths, masses and moments of the same shape and density: nothing is refused or remarked at any size."""
    text = scaled(NO_AXES, "xyz size", size).replace("XYZ", "xyz")
    text = scaled(scaled(text, "value", size**3), MOMENTS, size**5)
    text = scaled(text, "effort", size**4)
    found = explain(str(biped.write(tmp_path, text)))
    assert found.description.leg_length == pytest.approx(0.64 * size)
    assert not [note for note in found.notes if " times " in note]


def test_the_robots_that_come_along_are_within_every_bound() -> None:
    for name in ("talos", "g1", "alexander", "jvrc1", "gr3"):
        found = explain(name)
        assert not [note for note in found.notes if " times " in note], name
        assert not [line for line in found.description.left_out if "drawn" in line or "contact" in line], name


def test_what_is_drawn_in_another_unit_is_left_out(tmp_path) -> None:
    text = scaled(SOUND, "size", 1000, "link left_thigh visual")
    found, plain = (explain(str(biped.write(tmp_path, one))).description for one in (text, SOUND))
    (line,) = found.left_out
    assert re.search("left out: what is drawn, since a shape of link 'left_thigh' reaches .*in millimetres", line)
    assert found.mass == plain.mass
    assert "left_thigh_look" in plain.mjcf
    assert "left_thigh_look" not in found.mjcf


def test_limits_that_no_motor_has_are_remarked(tmp_path) -> None:
    found = explain(str(biped.write(tmp_path, scaled(scaled(SOUND, "effort", 1000), "velocity", 57.3))))
    told = [note for note in found.notes if " times " in note]
    assert re.search("torque limit of joint '.*' and 15 more is 80000 N m, .*in N mm", told[0])
    assert re.search("velocity limit of joint '.*' and 15 more is 860 rad/s, .*in deg/s", told[1])
    endless = explain(str(biped.write(tmp_path, scaled(SOUND, "lower upper", 1e9, "joint left_elbow"))))
    assert "joints turn without end in the model and one turn either way here: left_elbow" in endless.notes
    place = endless.description.joint_names.index("left_elbow")
    assert endless.description.position_upper[place] == pytest.approx(2 * np.pi, abs=2e-3)


@pytest.mark.parametrize("name", LAWS)
def test_a_law_guesses_its_own_units(name) -> None:
    """A usual number in each unit: it is refused, or as small as others are, and its unit is guessed or none is."""
    law = LAWS[name]
    assert law.least < law.usual < law.most
    assert law.holds(law.usual, 1.0)
    for factor, unit in law.units:
        if not law.holds(law.usual * factor, 1.0):
            assert unit in law.refusal("it", law.usual * factor, 1.0)[1]
    assert "likely" not in law.refusal("it", 1.01 * law.usual, 1.0)[1]
