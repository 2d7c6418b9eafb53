"""Whatever holds a model in its world, the base of the robot is free, and the robot is the same to the digit."""

import itertools
import re

import biped
import mjcf_biped as mjcf
import numpy as np
import pinocchio as pin
import pytest

from surefoot.apps.robots.draft import draft
from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.consistency import EnginePair

pytestmark = pytest.mark.unit

LIMIT = '<limit lower="-3" upper="3" effort="{}" velocity="9"/>'
TURN, SLIDE = "revolute", "prismatic"
SIX = [(kind, axis) for kind in (SLIDE, TURN) for axis in ("1 0 0", "0 1 0", "0 0 1")]
MJ_SIX = [("slide", axis) for _, axis in SIX[:3]] + [("hinge", axis) for _, axis in SIX[:3]]


def held(*joints: tuple[str, str], at: str = "0 0 0.9", mass: float = 0.0, effort: float = 0.0, name: str = "v") -> str:
    """A URDF whose base hangs on the world by a chain of joints, each given by its type and its axis."""
    moment = 1e-3 * mass
    inertia = f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/>'
    inertial = f'<inertial><mass value="{mass}"/>{inertia}</inertial>' if mass else ""
    links = ["world", *(f"{name}{number}" for number in range(1, len(joints))), "base"]
    parts = [f'<link name="{link}">{inertial if link != "world" else ""}</link>' for link in links[:-1]]
    for number, (kind, axis) in enumerate(joints):
        ends = f'<parent link="{links[number]}"/><child link="{links[number + 1]}"/>'
        origin = f'<origin xyz="{at if number == 0 else "0 0 0"}"/>'
        joint = f'<joint name="{name}{number}" type="{kind}">{ends}{origin}<axis xyz="{axis}"/>{LIMIT.format(effort)}'
        parts.append(f"{joint}</joint>")
    return biped.Biped(extra="".join(parts)).urdf()


TABLE = '<link name="table"><inertial><mass value="30"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
TABLE += '</inertial></link><joint name="stand" type="fixed"><parent link="world"/><child link="table"/></joint>'
HELD = {
    "floating": held(("floating", "1 0 0")),
    "planar": held(("planar", "0 0 1")),
    "one slide": held((SLIDE, "0 0 1")),
    "one hinge": held((TURN, "0 1 0")),
    "fixed above the ground": held(("fixed", "0 0 1")),
    "fixed twice": held(("fixed", "0 0 1"), ("fixed", "0 0 1")),
    "six": held(*SIX),
    "six with motors": held(*SIX, effort=100.0),
    "six with dummies of a gram": held(*SIX, mass=1e-3),
    "hinges first": held(*SIX[3:], *SIX[:3]),
    "by turns": held(*itertools.chain(*zip(SIX[:3], SIX[3:], strict=True))),
    "planar, then fixed": held(("planar", "0 0 1"), ("fixed", "0 0 1")),
    "fixed, then floating": held(("fixed", "0 0 1"), ("floating", "0 0 1")),
    "floating beside a table": held(("floating", "1 0 0")).replace("</robot>", f"{TABLE}</robot>"),
    "names of the engines": held(*SIX, name="universe"),
    "names of legs": held(*SIX, name="left_hip_"),
}


NUMBER = re.compile(r"-?[0-9.]+(?:e-?[0-9]+)?")


def same(one, other) -> None:
    """Both descriptions say the same, but for a rounding of their numbers."""
    assert NUMBER.sub("", one.mjcf) == NUMBER.sub("", other.mjcf)
    numbers = [np.array(NUMBER.findall(robot.mjcf), dtype=float) for robot in (one, other)]
    np.testing.assert_allclose(*numbers, rtol=0.0, atol=1e-12)
    for name in ("joint_names", "bodies", "pelvis_body", "torso_body", "roles"):
        assert getattr(one, name) == getattr(other, name), name
    assert (one.mass, one.com_height) == pytest.approx((other.mass, other.com_height), abs=1e-12)


@pytest.mark.parametrize("case", HELD)
def test_a_urdf_that_hangs_in_a_world_is_the_robot_without_it(tmp_path, case) -> None:
    plain = describe(str(biped.write(tmp_path, biped.Biped())), RobotOptions())
    found = explain(str(biped.write(tmp_path, HELD[case])))
    same(found.description, plain)
    told = [note for note in found.notes if "the base is free" in note]
    assert bool(told) == (not case.startswith("fixed ")), found.notes
    assert EnginePair(found.description).difference(*_state(found.description)).largest < 1e-9


def _state(robot):
    return EnginePair(robot).random_state(np.random.default_rng(2))


@pytest.mark.parametrize("case", ["floating", "six", "six with dummies of a gram"])
def test_feet_are_found_below_such_a_base(tmp_path, case) -> None:
    (tmp_path / "biped.urdf").write_text(HELD[case])
    made = draft("biped.urdf", tmp_path)
    assert made.refusal == ""
    assert "left: left_foot, right: right_foot" in made.text


def test_what_goes_with_the_world_is_told(tmp_path) -> None:
    (note,) = (n for n in explain(str(biped.write(tmp_path, HELD["six with dummies of a gram"]))).notes if "free" in n)
    assert "left out, and links of 0.005 kg with them: v0, v1, v2, v3, v4, v5" in note


def test_a_joint_between_links_with_mass_holds_nothing_in_the_world(tmp_path) -> None:
    """Negative control: a waist below a light trunk stays a joint of the robot, whoever drives it."""
    trunk = 8.0 / 20.0
    waist = held((TURN, "0 0 1"), effort=50.0).replace(
        '<link name="world">', f'<link name="world"><inertial><mass value="{trunk}"/>{_INERTIA}</inertial>'
    )
    with pytest.raises(RobotError, match="both feet of biped hang on joint 'v0'"):
        explain(str(biped.write(tmp_path, waist)))


_INERTIA = '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/>'


def test_a_base_without_mass_is_free_where_legs_and_trunk_part(tmp_path) -> None:
    """Its motion is that of what hangs on it; both engines hold it, and the robot weighs what its file says."""
    base = biped.Biped().urdf()
    start, end = base.index("<inertial>"), base.index("</link>")
    chest = '<joint name="waist" type="revolute"><parent link="base"/><child link="chest"/><axis xyz="0 0 1"/>'
    chest += f'{LIMIT.format(50)}</joint><link name="chest">{base[start:end]}</link>'
    model = (
        (base[:start] + base[end:])
        .replace("</robot>", f"{chest}</robot>")
        .replace('shoulder" type="revolute"><parent link="base"/>', 'shoulder" type="revolute"><parent link="chest"/>')
    )
    robot = explain(str(biped.write(tmp_path, model))).description
    assert robot.pelvis_body == "base"
    assert robot.roles.waist == ("waist",)
    assert robot.mass == pytest.approx(describe(str(biped.write(tmp_path, base)), RobotOptions()).mass, abs=1e-9)
    assert EnginePair(robot).difference(*_state(robot)).largest < 1e-9


def _rooted(joints: str, before: str = "", after: str = "") -> str:
    """The MJCF with other joints in its base, inside of other bodies."""
    text = mjcf.TEXT.replace('<body name="base" pos="0 0 0.7"><freejoint/>', f'{before}<body name="base">{joints}')
    return text.replace("</worldbody>", f"{after}</worldbody>")


def _joints(kinds) -> str:
    return "".join(f'<joint name="r{at}" type="{k}" axis="{a}" limited="false"/>' for at, (k, a) in enumerate(kinds))


DUMMY = '<body name="d{0}"><joint name="r{0}" type="{1}" axis="{2}" limited="false"/>'
DUMMY += '<inertial pos="0 0 0" mass="1e-5" diaginertia="1e-7 1e-7 1e-7"/>'
NESTED = "".join(DUMMY.format(at, kind, axis) for at, (kind, axis) in enumerate(MJ_SIX[:5]))
ROOTS = {
    "slides and hinges": _rooted(_joints(MJ_SIX)),
    "hinges first": _rooted(_joints(MJ_SIX[3:] + MJ_SIX[:3])),
    "a ball and slides": _rooted(_joints([("ball", "0 0 1"), *MJ_SIX[:3]])),
    "three of a plane": _rooted(_joints([MJ_SIX[0], MJ_SIX[2], MJ_SIX[4]])),
    "welded": _rooted(""),
    "bodies of their own": _rooted(_joints([MJ_SIX[5]]).replace("r0", "r5"), NESTED, 5 * "</body>"),
    "a body around it": _rooted(_joints(MJ_SIX), '<body name="mount" pos="0 0 0.4">', "</body>"),
}


@pytest.mark.parametrize("case", ROOTS)
def test_an_mjcf_that_hangs_in_a_world_is_the_robot_without_it(tmp_path, case) -> None:
    same(mjcf.described(tmp_path, ROOTS[case]), mjcf.described(tmp_path))


def test_frames_of_the_base_go_with_its_link(tmp_path) -> None:
    """A link fixed to the base, as an IMU is, stays where it is on the robot."""
    imu = '<link name="imu_link"/><joint name="mount" type="fixed"><parent link="base"/><child link="imu_link"/>'
    imu += '<origin xyz="0.02 0.01 0.05" rpy="0 0 1.5"/></joint>'
    plain = describe(str(biped.write(tmp_path, biped.Biped(extra=imu))), RobotOptions())
    model = HELD["fixed above the ground"].replace("</robot>", f"{imu}</robot>")
    same(describe(str(biped.write(tmp_path, model)), RobotOptions()), plain)
    assert plain.imu.position == pytest.approx((0.02, 0.01, 0.05))
    assert pin.Quaternion(*np.roll(plain.imu.quaternion, -1)).angularDistance(pin.Quaternion(1, 0, 0, 0)) > 0.0
