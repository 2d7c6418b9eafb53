"""Files of a model are found as the engines find them, so that a description is never of files that changed."""

import os
import re
import struct
from pathlib import Path

import biped
import mjcf_biped as mjcf
import pytest

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.robot_file import build
from surefoot.models.robot_file.files import read_document
from surefoot.models.robot_file.paths import resolve

pytestmark = pytest.mark.unit

CAP = (
    '<link name="cap"><visual><geometry><mesh filename={}/></geometry></visual></link>'
    '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'
)


def stl(size: float) -> bytes:
    """A tetrahedron."""
    corners = ((0.0, 0.0, 0.0), (size, 0.0, 0.0), (0.0, size, 0.0), (0.0, 0.0, size))
    faces = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
    rows = (struct.pack("<12fH", 0, 0, 0, *corners[a], *corners[b], *corners[c], 0) for a, b, c in faces)
    return bytes(80) + struct.pack("<I", 4) + b"".join(rows)


def obj(size: float) -> str:
    return f"mtllib cap.mtl\nv 0 0 0\nv {size} 0 0\nv 0 {size} 0\nv 0 0 {size}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def text_of(path: Path) -> str:
    """As in another process, which remembers nothing."""
    build.unchanged.cache_clear()
    return describe(str(path), RobotOptions()).mjcf


@pytest.mark.parametrize("written", ["'cap.stl'", '"cap&#46;stl"', '"./cap.stl"', '"file://cap.stl"'])
def test_a_mesh_of_a_urdf_is_found_however_it_is_written(tmp_path, written) -> None:
    path = biped.write(tmp_path, biped.Biped(extra=CAP.format(written)))
    seen = set()
    for size in (0.05, 0.06):
        (tmp_path / "cap.stl").write_bytes(stl(size))
        seen.add(text_of(path))
    assert len(seen) == 2


def test_the_colours_beside_a_mesh_are_part_of_it(tmp_path) -> None:
    path = biped.write(tmp_path, biped.Biped(extra=CAP.format('"cap.obj"')))
    (tmp_path / "cap.obj").write_text(obj(0.05))
    for red in (0.25, 0.75):
        (tmp_path / "cap.mtl").write_text(f"newmtl a\nKd {red} 0.5 0.5\n")
        assert f'rgba="{red} 0.5 0.5 1.0"' in text_of(path)


def test_a_mesh_that_changes_while_the_program_runs(tmp_path) -> None:
    path = biped.write(tmp_path, biped.Biped(extra=CAP.format('"cap.stl"')))
    for size in (0.05, 0.06):
        (tmp_path / "cap.stl").write_bytes(stl(size))
        assert f"0.0 0.0 {size}" in describe(str(path), RobotOptions()).mjcf


PARTS = {
    "model.xml": "<mujoco><include file='parts/legs.xml'/><asset><mesh name=\"cap\" file='cap&#46;stl'/></asset>"
    "<default><geom density='500'/><joint range='-1 1' limited='true'/></default>"
    "<worldbody><body name='base' pos='0 0 0.7'><freejoint/><geom type='box' size='0.08 0.1 0.08'/>"
    "<geom type='mesh' mesh='cap'/><include file='left.xml'/><include file='parts/right.xml'/></body></worldbody>"
    f"<actuator>{mjcf.MOTORS}</actuator></mujoco>",
    "parts/legs.xml": "<mujoco><compiler meshdir='looks' angle='radian'/><include file='deep.xml'/></mujoco>",
    "parts/deep.xml": "<mujoco><custom><numeric name='one' data='1'/></custom></mujoco>",
    "left.xml": f"<mujoco>{mjcf.leg('left', 1)}</mujoco>",
    "parts/right.xml": f"<mujoco>{mjcf.leg('right', -1)}</mujoco>",
}


def in_parts(folder: Path) -> Path:
    for name, text in PARTS.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    (folder / "looks").mkdir(exist_ok=True)
    (folder / "looks" / "cap.stl").write_bytes(stl(0.05))
    path = folder / "robot.yaml"
    path.write_text(biped.FILE.replace("biped.urdf", "model.xml") + mjcf.LIMITS)
    return path


def test_all_parts_of_an_mjcf_are_found_as_mujoco_finds_them(tmp_path) -> None:
    """Includes beside the main file or the one that includes, and meshes in a folder that an included file names."""
    path = in_parts(tmp_path)
    files = {str(file.relative_to(tmp_path)) for file in read_document(tmp_path / "model.xml").files}
    assert files == {*PARTS, "looks/cap.stl"}
    seen = {text_of(path)}
    (tmp_path / "looks" / "cap.stl").write_bytes(stl(0.06))
    seen.add(text_of(path))
    for name in ("left.xml", "parts/right.xml"):
        (tmp_path / name).write_text(PARTS[name].replace('mass="0.5"', 'mass="0.6"'))
        seen.add(text_of(path))
    (tmp_path / "parts" / "legs.xml").write_text(PARTS["parts/legs.xml"].replace("looks", "other"))
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "cap.stl").write_bytes(stl(0.07))
    seen.add(text_of(path))
    assert len(seen) == 5


def test_a_robot_in_parts_is_what_mujoco_reads_of_its_files(tmp_path) -> None:
    import mujoco

    in_parts(tmp_path)
    document = read_document(tmp_path / "model.xml").mjcf
    meshes = {name: file.read_bytes() for name, file in document.meshes.items()}
    ours = mujoco.MjModel.from_xml_string(document.text, meshes)
    own = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    for name in ("body_mass", "body_inertia", "jnt_range", "geom_size", "mesh_vert", "actuator_gear"):
        assert (getattr(ours, name) == getattr(own, name)).all(), name


def test_what_mujoco_refuses_is_said_with_the_line_of_the_file(tmp_path) -> None:
    path = in_parts(tmp_path)
    (tmp_path / "left.xml").write_text(PARTS["left.xml"].replace('type="capsule"', 'type="capsul"'))
    line = next(n for n, text in enumerate(PARTS["left.xml"].splitlines(), 1) if 'type="capsule"' in text)
    with pytest.raises(RobotError, match=rf"invalid keyword: 'capsul'.*left\.xml:{line}; mend it"):
        describe(str(path), RobotOptions())


def test_an_entry_of_the_cache_that_was_edited_is_not_believed(tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = biped.write(tmp_path)
    mass = describe(str(path), RobotOptions()).mass
    (entry,) = (tmp_path / "cache" / "surefoot" / "robots").glob("*.json")
    sound = entry.read_bytes()
    edits = [re.sub(rb'"mass": [0-9.]+', b'"mass": 1.0', sound), sound[:-1], sound.replace(b"left_knee", b"left_roll")]
    edits += [b"[" * 100_000, b'{"description": {"roles": []}, "derived": 1, "notes": 2}', b"\n", b"\xff" * 100]
    for edited in edits:
        assert edited != sound
        entry.write_bytes(edited)
        build.unchanged.cache_clear()
        assert describe(str(path), RobotOptions()).mass == mass
        assert entry.read_bytes() == sound
    entry.unlink()
    os.mkfifo(entry)
    build.unchanged.cache_clear()
    assert describe(str(path), RobotOptions()).mass == mass


@pytest.mark.parametrize(
    ("reference", "said"),
    [
        ("package://../../x.urdf", "names no package; write package://NAME/PATH"),
        ("package://here/../../x.urdf", "leads out of its package"),
        ("package://here/a/../../x.urdf", "leads out of its package"),
        ("package:///", "names no package"),
    ],
)
def test_a_reference_stays_in_its_package(tmp_path, reference, said) -> None:
    (tmp_path / "here").mkdir()
    with pytest.raises(RobotError, match=said):
        resolve(reference, tmp_path)
    assert resolve("package://here//etc/hosts", tmp_path) == tmp_path / "here" / "etc" / "hosts"


BODY = '<body name="base" pos="0 0 0.7">'
MASS = '<mass value="8.0"/>'
BOX = '<box size="0.15 0.2 0.1"/>'


def nested(tag: str, times: int) -> str:
    return f"<{tag}>" * times + f"</{tag}>" * times


def fixed(parent: str, child: str) -> str:
    return f'<joint name="{parent}-{child}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'


URDFS = {
    "text": ({MASS: '<mass value="20,5"/>'}, "value of mass in link 'base' is '20,5'; give a decimal number from 0 to"),
    "huge": ({MASS: '<mass value="1e300"/>'}, "value of mass in link 'base' is '1e300'; give a decimal number from 0"),
    "not a number": ({'ixy="0"': 'ixy="nan"'}, "ixy of inertia in link 'base' is 'nan'; give a decimal number"),
    "two": ({BOX: '<box size="0.15 0.2"/>'}, "size of box in link 'base' is '0.15 0.2'; give 3 decimal numbers"),
    "no size": ({BOX: "<box/>"}, "box of link 'base' lacks size; give size"),
    "no radius": ({BOX: '<cylinder length="1"/>'}, "cylinder of link 'base' lacks radius"),
    "axis": ({'<axis xyz="0 0 1"/>': '<axis xyz="0 0 0"/>'}, "axis of joint 'left_yaw' has no direction"),
    "type": ({'"left_yaw" type="revolute"': '"left_yaw" type="free"'}, "joint 'left_yaw' has the type 'free'; choose"),
    "loop": ({"</robot>": fixed("left_foot", "base") + "</robot>"}, "0 links hang on no joint; join all links"),
    "ring": (
        {"</robot>": f"<link name='a'/><link name='b'/>{fixed('a', 'b')}{fixed('b', 'a')}</robot>"},
        "link 'a' hangs on itself; join all links to one tree",
    ),
    "alone": ({"</robot>": "<link name='a'/></robot>"}, "2 links hang on no joint: base, a; join all links"),
    "two above": ({"</robot>": fixed("base", "left_foot") + "</robot>"}, "link 'left_foot' hangs on two joints"),
    "deep": ({"</robot>": nested("a", 300) + "</robot>"}, "nests more than 200 elements; give it flatter"),
    "many": ({"</robot>": "<a/>" * 200_000 + "</robot>"}, "has more than 20000 elements; give the model of one robot"),
    "entity": ({"<robot": '<!DOCTYPE r [<!ENTITY a "b">]><robot'}, "has an entity of its own; write what it stands"),
    "twice": ({"</robot>": '<link name="base"/></robot>'}, "the link 'base' is there twice"),
    "large": ({'<origin xyz="0 0.08 0"': '<origin xyz="0 1e9 0"'}, "xyz of origin in joint 'left_yaw' is '0 1e9 0'"),
}  # fmt: skip


@pytest.mark.parametrize("case", URDFS)
def test_what_no_urdf_may_hold_is_one_sentence(tmp_path, case) -> None:
    changes, said = URDFS[case]
    with pytest.raises(RobotError) as refused:
        describe(str(biped.write(tmp_path, biped.Biped(changes=changes))), RobotOptions())
    assert said in str(refused.value)
    assert f"{tmp_path}/biped.urdf:1" in str(refused.value)


REPEATED = '<replicate count="500" euler="0 0 1"><replicate count="500"><geom size="1"/></replicate></replicate>'
MJCFS = {
    "cycle": (BODY, f'{BODY}<include file="biped.xml"/>', "'biped.xml' is included already; include each file once"),
    "nested": (BODY, f"{BODY}{REPEATED}", "comes to .* elements with .* geoms; give a robot of at most"),
    "count": (BODY, f'{BODY}<replicate count="1e99"/>', "count of replicate in body 'base' is '1e99'; give"),
    "composite": (BODY, f'{BODY}<composite type="cable" count="9 1 1"/>', "has a composite; give a robot of bodies"),
    "mass": ('mass="0.5"', 'mass="1e300"', "mass of inertial in body 'left_yaw_link' is '1e300'; give"),
    "comma": ('mass="0.5"', 'mass="0,5"', "mass of inertial in body 'left_yaw_link' is '0,5'; give"),
    "nan": ('diaginertia="1e-3', 'diaginertia="nan', "diaginertia of inertial in body 'left_yaw_link' is 'nan"),
    "no mesh": (BODY, f"{BODY}<geom type='mesh' mesh='m'/>", "mend it"),
    "zero": (BODY, f"{BODY}<include file='/dev/zero'/>", "include /dev/zero is not there"),
}


@pytest.mark.parametrize("case", MJCFS)
def test_what_no_mjcf_may_hold_is_one_sentence(tmp_path, case) -> None:
    old, new, said = MJCFS[case]
    with pytest.raises(RobotError, match=said):
        mjcf.described(tmp_path, mjcf.TEXT.replace(old, new))


def test_what_is_around_a_robot_costs_nothing(tmp_path) -> None:
    """Height fields, textures, sensors, memory: they are left out before an engine sees them."""
    assets = (
        "<asset><hfield name='h' nrow='90000' ncol='90000' size='1 1 1 1'/><texture name='t' file='no.png'/></asset>"
    )
    around = (
        f"{assets}<size memory='900G'/><keyframe><key qpos='1'/></keyframe><worldbody><geom type='hfield' hfield='h'/>"
    )
    with_all = mjcf.described(tmp_path, mjcf.TEXT.replace("<worldbody>", around, 1))
    assert with_all.mjcf == mjcf.described(tmp_path).mjcf


@pytest.mark.parametrize("way", ["pipe", "zero", "sparse", "folder", "binary"])
@pytest.mark.parametrize("name", ["biped.yaml", "biped.urdf", "cap.stl"])
def test_what_is_no_regular_file_or_too_large_is_not_opened(tmp_path, way, name) -> None:
    path = biped.write(tmp_path, biped.Biped(extra=CAP.format('"cap.stl"')))
    file = tmp_path / name
    file.unlink(missing_ok=True)
    if way == "pipe":
        os.mkfifo(file)
    elif way == "zero":
        file.symlink_to("/dev/zero")
    elif way == "folder":
        file.mkdir()
    else:
        with file.open("wb") as made:
            made.write(b"\xff\0" * 50)
            made.truncate(1 << 40 if way == "sparse" else 100)
    why = "no regular file|bytes, more than|no UTF-8|not there|cannot be read"
    if name == "cap.stl" and way != "sparse":  # what is only drawn may be missing, and is told
        assert any(re.search(why, note) and "is not drawn" in note for note in explain(str(path)).notes)
        return
    with pytest.raises(RobotError, match=why):
        describe(str(path), RobotOptions())


def test_srdfs_beside_the_model_that_nobody_can_read(tmp_path) -> None:
    path = biped.write(tmp_path)
    (tmp_path / "binary.srdf").write_bytes(b"\xff\0\xfe" * 100)
    (tmp_path / "dangling.srdf").symlink_to("nowhere")
    os.mkfifo(tmp_path / "pipe.srdf")
    (tmp_path / "empty.srdf").write_text("")
    assert not any("rotors in" in note for note in explain(str(path)).notes)
    (tmp_path / "other.srdf").write_text(
        "<robot name='biped'><rotor_params><joint name='left_knee' mass='1,5'/></rotor_params></robot>"
    )
    with pytest.raises(RobotError, match="mass of joint 'left_knee' is '1,5'; give a decimal number"):
        describe(str(path), RobotOptions())


@pytest.mark.parametrize("scale", ["1e300", "1.0e+300", "1.0e-300", ".nan"])
def test_a_size_that_no_robot_has(tmp_path, scale) -> None:
    for text in (biped.FILE, "name: half\nmodel: humanoid100\n"):
        with pytest.raises(RobotError, match=r"scale is .*; input should be"):
            describe(str(biped.write(tmp_path, None, f"{text}scale: {scale}\n")), RobotOptions())
