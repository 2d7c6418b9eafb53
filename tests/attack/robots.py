"""Robot files hurt at random: a URDF, an MJCF in parts, or a known robot, with an SRDF and a mesh beside it.

As a program it describes the robots of some seeds, each a line of JSON: `python robots.py FIRST COUNT FOLDER`.
"""

import copy
import json
import os
import random
import re
import resource
import shutil
import struct
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

MEMORY = 3 << 30
"""Bytes of data that the program may have, so that a trial without bounds ends it and not the machine."""

NUMBERS = (
    "0", "1", "-1", "1e300", "-1e300", "1e-300", "nan", "inf", "-inf", "20,5", "0x1p3", "1e999", "1e16", "1_0", "",
    "1 2", "1 2 3", "0 0 0", "1e9 1e9 1e9", "twenty", "1 0 0 0", "99999999", "-0.5 nan 0", "1e5", "4 000", "\u0663",
)  # fmt: skip
WORDS = (
    "",
    "base",
    "world",
    "universe",
    "root_joint",
    "left_foot",
    "no_such",
    "a" * 5000,
    "\u202e",
    "a&#10;b",
    "imu",
    "left_sole",
)
INSERTED = (
    '<replicate count="1000" euler="0 0 1"><replicate count="1000"><geom size="1"/></replicate></replicate>',
    '<include file="model.xml"/>', '<include file="legs.xml"/>', '<include file="/dev/zero"/>', '<include file="."/>',
    '<hfield name="h" nrow="9" ncol="9" size="1 1 1 1"/>', '<geom type="hfield" hfield="h"/>',
    '<composite type="cable" count="100000 1 1"/>',
    '<flexcomp name="f" type="grid" count="900 900 900" spacing="1 1 1"/>',
    '<size memory="900G" nuser_body="900000000"/>', '<mesh name="cap" file="/dev/zero"/>',
    '<mesh file="nothing.stl"/>', '<geom type="mesh" mesh="cap"/>',
    '<texture type="2d" builtin="flat" width="90000" height="90000"/>',
    '<mesh name="s" builtin="supersphere" params="90000 1 1"/>', '<model name="m" file="model.xml"/>',
    '<attach model="m" body="base" prefix="x"/>', "<b>" * 300 + "</b>" * 300, "<b/>" * 30_000, '<link name="base"/>',
    '<link name="alone"/>', '<link/>', '<joint name="left_yaw"/>', "<robot/>", "<inertial/>",
    '<joint name="loop" type="fixed"><parent link="left_foot"/><child link="base"/></joint>',
    '<visual><geometry><mesh filename="/dev/zero"/></geometry></visual>',
    '<collision><geometry><mesh filename="cap.stl" scale="1e300 1 1"/></geometry></collision>',
    '<visual><geometry><box size="1 1"/></geometry></visual>', '<visual><geometry><mesh/></geometry></visual>',
    '<visual><geometry><mesh filename="package://../../x.stl"/></geometry></visual>',
    '<collision><geometry><cylinder radius="0.1"/></geometry></collision>', '<mimic joint="left_knee"/>',
    '<equality><joint joint1="left_knee" joint2="right_knee"/></equality>',
    '<compiler meshdir="/dev" angle="radian"/>', '<plugin plugin="mujoco.pid" name="p"/>', '<freejoint/>',
    '<joint type="ball"/>', '<body name="b"/>', "<frame/>", '<muscle joint="left_knee"/>', '<option timestep="nan"/>',
    '<default><geom size="nan"/></default>',
)  # fmt: skip
BYTES = (b"\0", b"\xff\xfe", b"<", b"&", b'"', b"]]>", b"<!--", b"-->", b"&x;", b"\r", b"<?xml version='1.1'?>")
HEAD = b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;&b;">]>'
LINES = (
    "scale: 1e300", "scale: 1.0e+300", "scale: .nan", "inertia: repair", "forward: -y", "torso: left_foot",
    "lock: ['*']", "lock: {'*_yaw': 1.0e+300}", "posture: {'*': .inf}", "posture: half", "posture: {left_knee: 0.3}",
    "srdf: robot.srdf", "srdf: /dev/zero", "srdf: .", "sole: {length: 1, width: 1}",
    "sole: {length: 0.1, width: 0.05, centre: [0, 0, 1.0e+200]}",
    "sole: {length: 0.2, width: 0.1, centre: [0, 0, -0.06]}", "com_height: 1.0e-300", "com_height: 900",
    "name: 'a\\nb'", "torque_limit: {'*': 1.0e+8}", "velocity_limit: {'[': 1}", "armature: {'*': 1.0e-300}",
    "keep_apart: [[base, base]]", "keep_apart: [[left_shank, right_shank]]", "model: humanoid100", "model: '\\0'",
    "model: /dev/zero", "model: .", "model: package://../../model.urdf", "model: package:///",
    f"model: {'a' * 3000}/b.urdf", "<<: *a", "&a [*a]: 1", f"lock: {'[' * 400}", f"licence: {'x' * 90_000}",
    f"licence: {'x' * 200_000}", "source: 2001-99-99", "? {a: b}\n: c", "feet: {left: left_foot, right: left_foot}",
    "feet: {left: base, right: world}", "feet: [1]", "feet: !!binary YQ==",
)  # fmt: skip


def mesh() -> bytes:
    """A tetrahedron as STL."""
    corners = ((0.0, 0.0, 0.0), (0.05, 0.0, 0.0), (0.0, 0.05, 0.0), (0.0, 0.0, 0.05))
    faces = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
    rows = (struct.pack("<12fH", 0, 0, 0, *corners[a], *corners[b], *corners[c], 0) for a, b, c in faces)
    return bytes(80) + struct.pack("<I", 4) + b"".join(rows)


SRDF = '<robot name="biped"><group_state name="half"><joint name="left_knee" value="0.3"/></group_state><rotor_params>'
SRDF += '<joint name="left_knee" mass="1e-5" gear_ratio="100"/></rotor_params></robot>'
FEET = "feet: {left: left_foot, right: right_foot}\n"
CAP = '<link name="cap"><visual><geometry><mesh filename="cap.stl"/></geometry></visual></link>'
CAP += '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'


def bases() -> list[dict[str, bytes]]:
    """Files of each sound robot by name; robot.yaml is the robot file."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "models" / "robot_file"))
    import biped
    import mjcf_biped as mjcf

    shared = {"cap.stl": mesh(), "robot.srdf": SRDF.encode()}
    urdf = biped.Biped(extra=CAP).urdf()
    one = {"robot.yaml": f"name: biped\nmodel: model.urdf\n{FEET}", "model.urdf": urdf}
    legs = f"<mujoco>{mjcf.leg('left', 1)}{mjcf.leg('right', -1)}</mujoco>"
    main = mjcf.TEXT.replace(mjcf.leg("left", 1) + mjcf.leg("right", -1), '<include file="legs.xml"/>')
    main = main.replace("</default>", '</default><asset><mesh name="cap" file="cap.stl"/></asset>', 1)
    main = main.replace("<freejoint/>", '<freejoint/><geom type="mesh" mesh="cap"/>')
    two = {"robot.yaml": f"name: biped\nmodel: model.xml\n{FEET}{mjcf.LIMITS}", "model.xml": main, "legs.xml": legs}
    found = [{**shared, **{name: text.encode() for name, text in files.items()}} for files in (one, two, one, two)]
    return [*found, *_known()]


def _known() -> list[dict[str, bytes]]:
    """A robot of another package, with its meshes where they are."""
    from surefoot.models.names import SHIPPED
    from surefoot.models.robot_file.paths import resolve
    from surefoot.models.robot_file.schema import read

    file = read(SHIPPED["alexander"])
    yaml = f"name: alexander\nmodel: model.urdf\nfeet: {{left: {file.soles().left}, right: {file.soles().right}}}\n"
    return [{"robot.yaml": yaml.encode(), "model.urdf": resolve(file.model, Path()).read_bytes()}]


def trial(seed: int, folder: Path, sound: list[dict[str, bytes]]) -> Path:
    """Write the files of a sound robot with one to three wounds; returns the robot file."""
    rng = random.Random(seed)
    files = dict(rng.choice(sound))
    wounds: list[Callable[[random.Random, bytes], bytes]] = [_tree] * 8 + [_signs]
    for _ in range(rng.randint(1, 3)):
        name = rng.choice([*files, *(name for name in files if name.startswith(("model", "legs")) for _ in range(3))])
        if name.endswith((".xml", ".urdf", ".srdf")):
            files[name] = rng.choice(wounds)(rng, files[name])
        else:
            files[name] = (_lines if name.endswith(".yaml") else _signs)(rng, files[name])
    for name, data in files.items():
        (folder / name).write_bytes(data)
    if rng.random() < 0.15:
        _replace(rng, folder / rng.choice(list(files)))
    return folder / "robot.yaml"


def _tree(rng: random.Random, data: bytes) -> bytes:
    """An element or attribute lost, doubled, moved or set to something else."""
    try:
        root = ElementTree.fromstring(data)
    except ElementTree.ParseError:
        return _signs(rng, data)
    parents = [node for node in root.iter() if len(node)]
    nodes = [node for node in root.iter() if node.attrib]
    way = rng.choice(
        ("set", "set", "times", "times", "times", "word", "lose", "drop", "double", "move", "insert", "insert")
    )
    node = rng.choice(nodes or [root])
    name = rng.choice(list(node.attrib) or ["name"])
    parent = rng.choice(parents or [root])
    at = rng.randrange(max(len(parent), 1))
    if way in ("set", "times"):
        numeric = [(one, key) for one in nodes for key, value in one.attrib.items() if _NUMERIC.fullmatch(value)]
        one, key = rng.choice(numeric or [(node, name)])
        one.set(key, rng.choice(NUMBERS) if way == "set" else _times(rng, one.get(key, "")))
    elif way == "word":
        node.set(name, rng.choice(WORDS))
    elif way == "lose":
        node.attrib.pop(name, None)
    elif way == "insert":
        mark = ElementTree.Element("MARK")
        rng.choice(parents or [root]).insert(at, mark)
        return ElementTree.tostring(root).replace(b"<MARK />", rng.choice(INSERTED).encode())
    elif len(parent):
        child = parent[at]
        if way != "double":
            parent.remove(child)
        if way != "drop":
            rng.choice(list(root.iter())).insert(at, copy.deepcopy(child))
    return ElementTree.tostring(root, encoding="utf-8")


_NUMERIC = re.compile(r"[-+.eE\d\s]+")


def _times(rng: random.Random, text: str) -> str:
    """Numbers, one or all of them some other way or as much again: a robot as it might be, but is none."""
    tokens, factor = text.split(), rng.choice((0, -1, 0.01, 0.5, 2, 10, 1000, 1e-12))
    only = rng.choice((None, *range(len(tokens))))
    new = [str(factor * float(token)) if only in (None, at) else token for at, token in enumerate(tokens)]
    return " ".join(new)


def _signs(rng: random.Random, data: bytes) -> bytes:
    """Signs lost, put in or changed; an end that is missing; a head that expands."""
    at = rng.randrange(len(data) + 1)
    return rng.choice(
        (
            data[:at],
            data[:at] + rng.choice(BYTES) + data[at:],
            data[:at] + bytes([rng.randrange(256)]) + data[at + 1 :],
            data[:at] + data[at + rng.choice((1, 10, 500)) :],
            HEAD + data.replace(b'name="', b'name="&c;', 1),
            data.decode("latin-1").encode("utf-16"),
        )
    )


def _lines(rng: random.Random, data: bytes) -> bytes:
    """Lines of a robot file lost, put in or given again."""
    lines = data.decode("utf-8", "replace").splitlines()
    if rng.random() < 0.3:
        lines.pop(rng.randrange(len(lines)))
    new = rng.choice(LINES)
    lines = [line for line in lines if line.partition(":")[0] != new.partition(":")[0]]
    return "\n".join((*lines, new, "")).encode()


def _replace(rng: random.Random, file: Path) -> None:
    """Something that is no file, or a very large one, in the place of a file."""
    file.unlink()
    way = rng.choice(("pipe", "zero", "loop", "dangling", "folder", "sparse", "binary", "empty", "nothing"))
    if way == "pipe":
        os.mkfifo(file)
    elif way == "folder":
        file.mkdir()
    elif way == "sparse":
        with file.open("wb") as large:
            large.truncate(1 << 40)
    elif way in ("zero", "loop", "dangling"):
        file.symlink_to({"zero": "/dev/zero", "loop": file.name, "dangling": "no_such_file"}[way])
    elif way != "nothing":
        file.write_bytes(rng.randbytes(5000) if way == "binary" else b"")


def outcome(path: Path) -> dict[str, object]:
    """Outcome of a robot file, and its cost."""
    from surefoot.models import RobotError, RobotOptions, describe

    begin, said, kind = time.process_time(), "", "robot"
    try:
        describe(str(path), RobotOptions())
    except RobotError as error:
        kind, said = "refused", str(error)
    except Exception:
        import traceback

        kind, said = "traceback", traceback.format_exc()
    return {"kind": kind, "said": said, "seconds": time.process_time() - begin, "megabytes": peak_memory()}


def peak_memory() -> int:
    """Most memory that this program held [MB]; nothing of its parent, which `ru_maxrss` counts too."""
    status = Path("/proc/self/status")
    if not status.exists():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
    return int(re.search(r"VmHWM:\s+(\d+) kB", status.read_text())[1]) >> 10


def main() -> None:
    """Describe the robots of some seeds."""
    first, count, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
    assert find_spec("surefoot")
    sound = bases()
    for seed in range(first, first + count):
        place = folder / str(seed)
        place.mkdir(parents=True)
        path = trial(seed, place, sound)
        print(json.dumps({"seed": seed, **outcome(path)}), flush=True)
        shutil.rmtree(place)


if __name__ == "__main__":
    main()
