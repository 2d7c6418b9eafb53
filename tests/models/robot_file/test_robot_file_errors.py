"""Faults of a robot file or its model are named in one sentence, with the place and what would be right."""

import re

import biped
import pytest

from surefoot.models import RobotError, RobotOptions, describe

pytestmark = pytest.mark.unit

INERTIA = '<inertia ixx="0.00208'
LEFT_THIGH = '<link name="left_thigh"><inertial>'
EFFORT = 'effort="80"'
CAP = '<link name="cap"><{0}><geometry><mesh filename="{1}"/></geometry></{0}></link>'
FIXED = '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'
PARENT = '<parent link="{}"/><child link="right_yaw_link"/>'
SWAPPED = "name: biped\nmodel: biped.urdf\nfeet: {left: right_foot, right: left_foot}\n"
SHORT = "name: biped\nmodel: biped.urdf\nfeet: {left: left_shank, right: right_shank}\n"


def unphysical(urdf: str) -> str:
    """The left thigh's largest moment made three times as large."""
    found = re.search(r'(<link name="left_thigh">.*?ixx=")([^"]*)', urdf)
    return urdf.replace(found[0], f"{found[1]}{3 * float(found[2])}", 1)


def massless(urdf: str) -> str:
    return re.sub(r'(<link name="left_shank">)<inertial>.*?</inertial>', r"\1", urdf)


FILES = {
    "unknown key": ("nmae: x\n" + biped.FILE, r"biped.yaml:1: unknown key 'nmae'; did you mean 'name'\?"),
    "key of a group": (biped.FILE.replace("left:", "lef:"), r"biped.yaml:3: .*did you mean 'left'\?|lacks feet.left"),
    "no feet": ("name: biped\nmodel: biped.urdf\n", r"lacks feet; give feet: \{left: LINK, right: LINK\}"),
    "no name": ("model: biped.urdf\n", "lacks name; give name: my-robot"),
    "wrong type": (biped.FILE + "com_height: tall\n", r"biped.yaml:4: com_height is 'tall'; input should be"),
    "no YAML": ("name: [\n", r"biped.yaml:2: no YAML"),
    "a list": ("- 1\n", "no robot file; give name, model and feet"),
    "no model": (
        biped.FILE.replace("biped.urdf", "bipod.urdf"),
        "bipod.urdf: cannot be read, No such file.*give the path",
    ),
    "no package": (
        biped.FILE.replace("biped.urdf", "package://no_such_thing/biped.urdf"),
        "package 'no_such_thing' is not installed; install it",
    ),
    "no such foot": (
        biped.FILE.replace("left_foot", "left_feet"),
        r"feet.left of biped names 'left_feet'.*mean 'left_foot'",
    ),
    "swapped feet": (SWAPPED, r"look swapped.*write feet: \{left: left_foot, right: right_foot\}"),
    "short legs": (SHORT, "left leg of biped, to link 'left_shank', has 4 joints; legs need 5 to 7"),
    "wrong forward": (biped.FILE + "forward: -x\n", "forward of biped is -x.*leave it out"),
    "pattern": (biped.FILE + "armature: {'*_elbo': 0.1}\n", r"'\*_elbo', which matches no joint; did you mean"),
    "lock pattern": (
        biped.FILE + "lock: [wrist_*]\n",
        r"lock of biped has the pattern 'wrist_\*', which matches no joint",
    ),
    "no posture": (biped.FILE + "posture: half_sitting\n", "posture of biped is 'half_sitting', which is no state"),
    "posture out of range": (biped.FILE + "posture: {left_knee: -1}\n", "'left_knee' at -1 rad; it must lie within"),
    "no torso": (biped.FILE + "torso: chest\n", "torso of biped names 'chest', which is no link"),
    "torso in a leg": (biped.FILE + "torso: left_thigh\n", "which is part of a leg; name a link above"),
    "apart": (biped.FILE + "keep_apart: [[left_shank, left_foot]]\n", "names 'left_foot', which has no contact shape"),
    "no srdf": (biped.FILE + "srdf: biped.srdf\n", "srdf biped.srdf of biped is not there; put it at"),
    "negative": (biped.FILE + "scale: -1\n", "biped.yaml:4: scale is -1; input should be .* equal to 0.01"),
    "base robot": ("name: half\nmodel: humanoid1000\nscale: 0.5\n", "did you mean 'humanoid100'"),
    "base robot's feet": (
        "name: half\nmodel: humanoid100\ncom_height: 0.5\n",
        "com_height beside the model 'humanoid100'",
    ),
}

MODELS = {
    "no shapes": (biped.Biped(feet=False), r"foot 'left_foot' of biped has no shapes; give sole: \{length"),
    "no torque": (
        biped.Biped(changes={EFFORT: 'effort="0"'}),
        r"'left_yaw' and 11 more of biped have no torque limit; give torque_limit",
    ),
    "unphysical": (
        unphysical(biped.Biped().urdf()),
        "link 'left_thigh' has principal moments .* no body has them; .*inertia: repair",
    ),
    "no inertia": (
        massless(biped.Biped().urdf()),
        "link 'left_shank' of biped moves with 0 kg.*; give it an inertia in the model$",
    ),
    "no mesh": (
        biped.Biped(extra=CAP.format("collision", "meshes/cap.stl") + FIXED),
        "link 'cap' of .*: mesh meshes/cap.stl is not there; put it at .*meshes/cap.stl",
    ),
    "mesh of no package": (
        biped.Biped(extra=CAP.format("collision", "package://biped_meshes/cap.stl") + FIXED),
        "link 'cap' of .*: mesh package://biped_meshes/cap.stl: package 'biped_meshes' is not installed",
    ),
    "mesh that is none": (
        biped.Biped(extra=CAP.format("collision", "biped.yaml") + FIXED),
        "link 'cap' of .*: mesh .*biped.yaml: cannot be read",
    ),
    "no XML": ("<robot name='x'><link", "no XML"),
    "no robot": ("<sdf/>", "neither URDF nor MJCF"),
    "prismatic leg": (
        biped.Biped(changes={'<joint name="left_yaw" type="revolute">': '<joint name="left_yaw" type="prismatic">'}),
        "joint 'left_yaw' of biped is in a leg and cannot be driven",
    ),
    "one leg": (
        biped.Biped(
            changes={
                PARENT.format("base"): PARENT.format("left_foot"),
            }
        ),
        "both feet of biped hang on joint 'left_yaw'",
    ),
    "bad link": (
        biped.Biped(changes={'<child link="left_thigh"/>': '<child link="left_tigh"/>'}),
        "biped.urdf:1: child of joint 'left_pitch' is 'left_tigh', which is no link; did you mean 'left_thigh'",
    ),
}


def refused(folder, *args) -> str:
    path = biped.write(folder, *args)
    with pytest.raises(RobotError) as error:
        describe(str(path), RobotOptions())
    return str(error.value)


@pytest.mark.parametrize("case", FILES)
def test_a_wrong_file_says_what_and_where(tmp_path, case) -> None:
    text, sentence = FILES[case]
    said = refused(tmp_path, None, text)
    assert re.search(sentence, said), said
    assert "\n" not in said


@pytest.mark.parametrize("case", MODELS)
def test_a_wrong_model_says_what_and_where(tmp_path, case) -> None:
    model, sentence = MODELS[case]
    said = refused(tmp_path, model)
    assert re.search(sentence, said), said
    assert "\n" not in said


def test_an_unphysical_inertia_is_repaired_on_demand(tmp_path) -> None:
    """To the nearest that a body has, at the same mass; and it is told."""
    from surefoot.models import explain

    found = explain(str(biped.write(tmp_path, unphysical(biped.Biped().urdf()), biped.FILE + "inertia: repair\n")))
    assert any("'left_thigh' is repaired" in note for note in found.notes)
    assert found.description.mass == pytest.approx(describe(str(biped.write(tmp_path)), RobotOptions()).mass)


def test_a_file_that_is_not_there(tmp_path) -> None:
    with pytest.raises(RobotError, match=r"no\.yaml: cannot be read, No such file"):
        describe(str(tmp_path / "no.yaml"), RobotOptions())
