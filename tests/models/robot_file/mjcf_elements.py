"""MuJoCo's schema as it prints it, and a biped with one element more, for each element that there is."""

import re
from functools import lru_cache
from pathlib import Path

import mujoco
from biped import FILE
from mjcf_biped import LIMITS, TEXT

from surefoot.models.robot_file.files import originals
from surefoot.models.robot_file.mjcf_schema import Fate, by_path, path_of
from surefoot.models.robot_file.reduced import Reduced, reduced
from surefoot.models.robot_file.schema import RobotFile, read
from surefoot.models.robot_file.source import read_source

_ROW = re.compile(r"^(?P<indent>(?:   ){0,8})(?P<tag>\S+) \((?P<kind>.)\) *(?P<attributes>.*)$")


@lru_cache(maxsize=1)
def schema() -> dict[tuple[str, ...], frozenset[str]]:
    """Attributes of each element by the tags that lead to it, the root's left out."""
    found, at = dict[tuple[str, ...], frozenset[str]](), list[str]()
    for line in mujoco.mj_printSchema(False, False).splitlines():
        row = _ROW.match(line)
        if row:
            at = [*at[: len(row["indent"]) // 3], row["tag"]]
        names = (row["attributes"] if row else line).split()
        key = tuple("body" if tag == "(world)body" else tag for tag in at[1:])
        found[key] = found.get(key, frozenset()) | set(names)
    return {key: names for key, names in found.items() if key}


def path(tags: tuple[str, ...]) -> str:
    """Path of an element in the table."""
    found = ""
    for tag in tags:
        found = path_of(found, tag)
    return found


def source_text(more: str = "", at: str = "", change: tuple[str, str] = ("", "")) -> str:
    """The biped with more in a place: the end of the document, or behind a text in it."""
    text = TEXT.replace(*change, 1) if change[0] else TEXT
    assert not change[0] or change[0] in TEXT
    place = at or '<mujoco model="biped">'
    assert place in text, place
    return text.replace(place, place + more, 1)


def read_text(folder: Path, text: str, more: str = "", limits: str = LIMITS) -> Reduced:
    """The robot that a robot file makes of a text, and what the reader leaves out; nothing is drawn or derived."""
    (folder / "biped.xml").write_text(text)
    place = folder / "biped.yaml"
    place.write_text(FILE.replace("biped.urdf", "biped.xml") + limits + more)
    file: RobotFile = read(place)
    made_of = originals(file, folder)
    return reduced(made_of, read_source(file, made_of.document))


HAND = '<body name="hand"><joint name="wrist" axis="1 0 0"/><geom size="0.02"/></body>'
"""A body whose joint has no motor and is locked."""

_ON_KNEE = 'joint="left_knee" forcerange="-5 5"'

_SPATIAL = (
    '<spatial><site site="thigh_site"/><site site="foot_site"/><pulley divisor="2"/><site site="thigh_site"/>'
    '<geom geom="wheel"/><site site="foot_site"/></spatial>'
)
_FIXED = (
    '<fixed name="ankles"><joint joint="left_ankle_pitch" coef="1"/><joint joint="left_ankle_roll" coef="1"/></fixed>'
)

EXAMPLES = {
    "compiler": '<compiler balanceinertia="true"/>',
    "default": '<default><default class="more"/></default>',
    "extension": "<extension/>",
    "extension/plugin": '<extension><plugin plugin="mujoco.pid"/></extension>',
    "extension/plugin/instance": (
        '<extension><plugin plugin="mujoco.pid"><instance name="pid"/></plugin></extension>'
        f'<actuator><plugin instance="pid" {_ON_KNEE}/></actuator>'
    ),
    "extension/plugin/instance/config": (
        '<extension><plugin plugin="mujoco.pid"><instance name="pid"><config key="kp" value="1"/></instance></plugin>'
        f'</extension><actuator><plugin instance="pid" {_ON_KNEE}/></actuator>'
    ),
    "asset": "<asset/>",
    "asset/mesh": '<asset><mesh name="more" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>',
    "asset/material": '<asset><material name="more" rgba="1 0 0 1"/></asset>',
    "asset/model": '<asset><model name="hands" file="hand.xml"/></asset>',
    "worldbody": "<worldbody/>",
    "contact": "<contact/>",
    "tendon": "<tendon/>",
    "equality": "<equality/>",
    "actuator": "<actuator/>",
    "deformable": "<deformable/>",
    "asset/material/layer": '<asset><material name="more"><layer texture="t" role="rgb"/></material></asset>',
    **{
        f"tendon/{name}": f"<tendon>{text}</tendon>"
        for name, text in {
            "spatial": _SPATIAL,
            "spatial/site": _SPATIAL,
            "spatial/geom": _SPATIAL,
            "spatial/pulley": _SPATIAL,
            "fixed": _FIXED,
            "fixed/joint": _FIXED,
        }.items()
    },
    "body": HAND,
    "body/frame": f'<frame pos="0 0 0.1">{HAND}</frame>',
    "body/replicate": f'<replicate count="2" offset="0 0 0.1" sep="-">{HAND}</replicate>',
    "body/inertial": '<body name="more"><inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/></body>',
    "body/joint": HAND,
    "body/freejoint": "",
    "body/geom": '<geom size="0.02"/>',
    "body/attach": '<attach model="hands" body="hand" prefix="left_"/>',
    "body/site": '<site name="imu_site"/>',
    "actuator/plugin": (
        f'<extension><plugin plugin="mujoco.pid"/></extension><actuator><plugin plugin="mujoco.pid" {_ON_KNEE}/>'
        "</actuator>"
    ),
    "actuator/plugin/config": (
        f'<extension><plugin plugin="mujoco.pid"/></extension><actuator><plugin plugin="mujoco.pid" {_ON_KNEE}>'
        '<config key="kp" value="1"/></plugin></actuator>'
    ),
    **{
        f"actuator/{kind}": f"<actuator><{kind} {_ON_KNEE} {more}/></actuator>"
        for kind, more in {
            "general": "",
            "motor": "",
            "position": 'kp="1"',
            "velocity": 'kv="1"',
            "intvelocity": 'kp="1" actrange="-1 1"',
            "pid": 'kp="1"',
            "damper": 'kv="1" ctrlrange="0 1"',
            "cylinder": 'area="1"',
            "muscle": 'lengthrange="-1 1"',
        }.items()
    },
    "actuator/dcmotor": (
        '<actuator><dcmotor joint="left_knee" motorconst="0.1" resistance="1" saturation="5 0 0"/></actuator>'
    ),
}
"""A part of a document for each element that is used; of others their tags are enough, since none is read."""


def with_sites(text: str) -> str:
    """The text with what a spatial tendon of the left leg runs over."""
    thigh, foot = '<body name="left_thigh">', '<body name="left_foot">'
    sites = {
        thigh: '<site name="thigh_site"/><geom name="wheel" size="0.01" mass="0"/>',
        foot: '<site name="foot_site"/>',
    }
    for place, more in sites.items():
        text = text.replace(place, place + more, 1)
    return text


def example(name: str) -> str:
    """The biped with an element of a path."""
    parts = name.split("/")
    if name == "body/attach":
        return source_text(EXAMPLES[name], "<freejoint/>").replace(
            '<mujoco model="biped">', f'<mujoco model="biped">{EXAMPLES["asset/model"]}'
        )
    if name.startswith("tendon/spatial"):
        return with_sites(source_text(EXAMPLES[name]))
    if name in EXAMPLES:
        within = parts[0] == "body"
        return source_text(EXAMPLES[name], "<freejoint/>" if within else "")
    tags = parts[1:] if parts[0] == "body" else parts
    more = "".join(f"<{tag}>" for tag in tags) + "".join(f"</{tag}>" for tag in reversed(tags))
    return source_text(more, "<freejoint/>" if parts[0] == "body" else "")


BOUND = {
    "connect": (
        '<connect name="loop" body1="left_shank" body2="left_foot" anchor="0 0 0"/>',
        ("left_ankle_pitch", "left_ankle_roll"),
    ),
    "weld": ('<weld name="loop" body1="left_ankle" body2="left_foot"/>', ("left_ankle_roll",)),
    "joint": ('<joint name="loop" joint1="left_knee" joint2="left_roll"/>', ("left_knee",)),
    "tendon": ('<tendon name="loop" tendon1="ankles"/>', ("left_ankle_pitch", "left_ankle_roll")),
}
"""An equality of each kind, and joints that it binds."""


SHARED = {
    "tendon": (
        '<tendon><fixed name="ankles"><joint joint="left_ankle_pitch" coef="1"/><joint joint="left_ankle_roll" '
        'coef="-1"/></fixed></tendon><actuator><motor name="shared" tendon="ankles" forcerange="-9 9"/></actuator>',
        "actuator 'shared' on tendon 'ankles' drives joints 'left_ankle_pitch', 'left_ankle_roll'",
    ),
    "crank": (
        '<actuator><motor name="shared" cranksite="thigh_site" slidersite="foot_site" cranklength="0.1" '
        'forcerange="-9 9"/></actuator>',
        "actuator 'shared' on a slider-crank drives joints 'left_ankle_pitch', 'left_ankle_roll', 'left_knee'",
    ),
}
"""Motors of several joints, and the beginning of their refusal."""


def bound(kind: str, inside: str = "") -> str:
    """The biped with an equality of a kind, and more attributes in it."""
    text = BOUND[kind][0].replace("/>", f"{inside}/>")
    return source_text(f"<tendon>{_FIXED}</tendon><equality>{text}</equality>")


def of_fate(*fates: Fate) -> list[str]:
    """Paths of all elements of some fates."""
    return [name for name, group in by_path().items() if group.fate in fates]
