"""Each element and attribute of MuJoCo's schema is used, refused by name, or told by name as left out."""

import re

import mjcf_elements
import pytest
from mjcf_elements import BOUND, HAND, SHARED, bound, example, of_fate, read_text, schema, source_text, with_sites

from surefoot.models import RobotError
from surefoot.models.robot_file.mjcf_schema import ELEMENTS, META, Fate, by_path

pytestmark = pytest.mark.unit

LOCKED = "lock: [left_ankle_pitch, left_ankle_roll, left_knee, left_pitch]\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "hand.xml").write_text(f'<mujoco model="hands"><worldbody>{HAND}</worldbody></mujoco>')
    return tmp_path


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Lines on what is left out of the biped without any more."""
    return set(read_text(tmp_path_factory.mktemp("plain"), source_text()).left_out)


def told(folder, text, plain, more=""):
    """Lines on what is left out of a text, and not of the biped alone."""
    return [line for line in read_text(folder, text, more).left_out if line not in plain]


def unlooked(found) -> list[str]:
    """Elements and attributes of a schema that the table lacks."""
    table, missing = by_path(), []
    for tags, attributes in found.items():
        paths = [mjcf_elements.path(tags[:size]) for size in range(1, len(tags) + 1)]
        if any(one in table and table[one].fate is Fate.REFUSED for one in paths[:-1]):
            continue
        group = table.get(paths[-1])
        if group is None:
            missing.append(paths[-1])
        elif group.fate is Fate.KEPT:
            missing += [f"{paths[-1]} {name}" for name in sorted(attributes - group.known)]
    return missing


def test_somebody_has_looked_at_each_element_and_attribute_of_the_schema():
    assert len(schema()) > 150
    assert unlooked(schema()) == []
    later = {**schema(), ("body", "joint"): schema()[("body", "joint")] | {"backlash"}, ("body", "rope"): frozenset()}
    assert unlooked(later) == ["body/joint backlash", "body/rope"]


def test_the_table_has_nothing_that_the_schema_lacks():
    known = {mjcf_elements.path(tags) for tags in schema()}
    assert set(by_path()) - known == {*META, "worldbody", "body/composite"}


@pytest.mark.parametrize("name", of_fate(Fate.KEPT))
def test_an_element_that_is_used_is_not_told_as_left_out(folder, plain, name):
    tag = name.rpartition("/")[2]
    lines = told(folder, example(name), plain)
    assert not any(re.search(rf"^left out: (.*, )?{tag}\b", line) for line in lines), lines


@pytest.mark.parametrize("name", of_fate(Fate.LEFT_OUT))
def test_an_element_that_is_left_out_is_told_by_name(folder, plain, name):
    *around, tag = name.split("/")
    whole = around[-1] if by_path().get("/".join(around), by_path()["asset"]).fate is Fate.LEFT_OUT else tag
    lines = told(folder, example(name), plain)
    assert len([line for line in lines if re.search(rf"\b{whole}\b", line)]) == 1, lines


@pytest.mark.parametrize("name", of_fate(Fate.REFUSED))
def test_an_element_that_is_refused_is_refused_by_name_and_place(folder, name):
    parent, _, tag = name.rpartition("/")
    with pytest.raises(RobotError, match=rf"biped\.xml:\d+: {parent.rpartition('/')[2]} has a {tag}; "):
        read_text(folder, example(name))


@pytest.mark.parametrize("kind", BOUND)
def test_an_equality_is_refused_where_its_joints_move_and_told_where_they_are_locked(folder, plain, kind):
    word = f"equality {kind}" if kind in ("joint", "tendon") else kind
    with pytest.raises(RobotError, match=rf"{word} 'loop'.*; ") as refused:
        read_text(folder, bound(kind))
    assert all(joint in str(refused.value) for joint in BOUND[kind][1])
    (line,) = [line for line in told(folder, bound(kind), plain, LOCKED) if word in line]
    assert "locked" in line
    (idle,) = [line for line in told(folder, bound(kind, ' active="false"'), plain) if "not active" in line]
    assert f"equality {kind} 'loop'" in idle


def test_the_same_robot_without_the_equality_is_read(folder, plain):
    assert told(folder, source_text(), plain) == []


@pytest.mark.parametrize(
    "equality", ['<weld body1="base"/>', '<connect body1="left_foot" anchor="0 0 0"/>'], ids=["weld", "connect"]
)
def test_what_binds_a_robot_to_its_world_is_told(folder, plain, equality):
    (line,) = told(folder, source_text(f"<equality>{equality}</equality>"), plain)
    assert line == f"left out: equality {equality[1:].split()[0]}: a robot is bound to nothing beside it"


GIVEN = "torque_limit: {'*_ankle_*': 40, '*_knee': 60}\nvelocity_limit: {'*': 12}\n"


@pytest.mark.parametrize("kind", SHARED)
def test_a_motor_of_several_joints_needs_torques_that_the_robot_file_gives(folder, plain, kind):
    more, sentence = SHARED[kind]
    text = with_sites(source_text(more))
    with pytest.raises(RobotError, match=rf"{sentence}, .*; give torque_limit"):
        read_text(folder, text)
    lines = [line for line in read_text(folder, text, limits=GIVEN).left_out if "'shared'" in line]
    assert [line.partition(": the robot file gives")[1] != "" for line in lines] == [True]


def test_a_motor_of_no_joint_is_told(folder, plain):
    text = with_sites(source_text('<actuator><motor name="jet" site="foot_site" forcerange="-9 9"/></actuator>'))
    assert told(folder, text, plain) == ["left out: actuator 'jet': it acts on no joint"]


LAWS = ("position", "velocity", "intvelocity", "pid", "damper", "cylinder", "muscle", "dcmotor", "plugin")


@pytest.mark.parametrize(("kind", "told_of"), [*((kind, True) for kind in LAWS), ("motor", False), ("general", False)])
def test_the_law_of_an_actuator_is_told_and_a_plain_motor_has_none(folder, plain, kind, told_of):
    lines = told(folder, example(f"actuator/{kind}"), plain)
    assert any(line.startswith("left out: gain, bias and dynamics of 3 actuators") for line in lines) == told_of


KNEE, FOOT = '<joint name="left_knee"', '<geom type="box" pos="0.03'
BODY, ROLL = '<body name="left_foot"', '<motor joint="left_roll"'
VALUES = {
    ("joint", KNEE): {
        "stiffness": "3",
        "damping": "2",
        "frictionloss": "1",
        "actuatorgravcomp": "true",
        "margin": "0.1",
        "solreflimit": "0.1 1",
        "solimplimit": "0.5 0.9 0.01",
    },
    ("geom", FOOT): {
        "friction": "2 1 1",
        "condim": "6",
        "priority": "1",
        "margin": "0.01",
        "gap": "0.01",
        "solref": "0.1 1",
        "solimp": "0.5 0.9 0.01",
        "solmix": "2",
        "adhesion": "1",
        "surfacevel": "1 0 0 0 0 0",
        "fluidshape": "ellipsoid",
    },
    ("body", BODY): {"gravcomp": "1"},
    ("actuator", ROLL): {"damping": "1", "delay": '0.01" nsample="2'},
}
CASES = [(thing, place, name, value) for (thing, place), values in VALUES.items() for name, value in values.items()]


@pytest.mark.parametrize(("thing", "place", "name", "value"), CASES, ids=lambda part: str(part).split()[0])
def test_an_attribute_that_is_left_out_is_told_by_name(folder, plain, thing, place, name, value):
    text = source_text(change=(place, f'{place[: place.index(" ")]} {name}="{value}"{place[place.index(" ") :]}'))
    (line,) = told(folder, text, plain)
    assert re.match(rf"left out: {name} of {thing}\b", line)
    lines = told(folder, text.replace(f'{name}="{value}"', ""), plain)
    assert lines == []


@pytest.mark.parametrize(("name", "value"), [("damping", "2"), ("frictionloss", "1"), ("stiffness", "3")])
def test_an_attribute_of_a_default_class_is_told_where_a_joint_is_of_it(folder, plain, name, value):
    text = source_text(change=('<joint range="-1 1"', f'<joint {name}="{value}" range="-1 1"'))
    (line,) = told(folder, text, plain)
    assert line.startswith(f"left out: {name} of 12 joints, 'left_yaw' first: ")
    unused = f'<default class="unused"><joint {name}="{value}"/></default></default>'
    assert told(folder, source_text(change=("</default>", unused)), plain) == []


def test_each_attribute_that_the_table_leaves_out_has_a_case_here():
    of = {"dof": "joint"}
    table = {(of.get(one.of, one.of), one.name) for group in ELEMENTS for one in group.left_out}
    cases = {(thing, name) for thing, _, name, _ in CASES}
    assert table - cases == {("body", "mocap"), ("actuator", "gain, bias and dynamics")}
    assert cases <= table


def test_a_base_that_is_driven_by_mocap_is_told(folder, plain):
    text = source_text(change=('<body name="base" pos="0 0 0.7"><freejoint/>', '<body name="base" mocap="true">'))
    (line,) = told(folder, text, plain)
    assert line.startswith("left out: mocap of body 'base'")


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ("<rope/>", "mujoco has a rope, which is no element of an MJCF that is known here"),
        ('<compiler wide="1"/>', "compiler has the attribute 'wide', which is none of it that is known here"),
    ],
)
def test_what_the_table_lacks_is_refused(folder, more, sentence):
    with pytest.raises(RobotError, match=rf"biped\.xml:1: {sentence}"):
        read_text(folder, source_text(more))
