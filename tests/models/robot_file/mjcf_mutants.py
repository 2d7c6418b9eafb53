"""Bipeds with elements and attributes of MuJoCo's schema at random, and whether their loss would be seen.

The law is MuJoCo's alone: a robot whose joints accelerate otherwise than those of its source, or that has a torque
which its source has not, has lost something, and has to say so.
"""

import random
from pathlib import Path
from xml.etree import ElementTree

import biped
import mujoco
import numpy as np
from mjcf_biped import LIMITS
from mjcf_elements import EXAMPLES, HAND, SHARED, bound, example, schema, source_text, with_sites

from surefoot.models import RobotDescription, RobotError, explain

VALUES = {
    **dict.fromkeys(("damping", "stiffness", "frictionloss", "armature", "gravcomp", "kp", "kv"), ("0", "0.5", "20")),
    **dict.fromkeys(("springref", "margin", "gap", "solmix", "ref", "springlength", "timeconst"), ("0", "0.1", "1")),
    **dict.fromkeys(("springdamper", "solref", "solreflimit", "solreffriction"), ("0.02 1", "0.1 0.5")),
    **dict.fromkeys(("solimp", "solimplimit", "solimpfriction"), ("0.9 0.95 0.001", "0.5 0.9 0.01")),
    **dict.fromkeys(("ctrlrange", "forcerange", "actuatorfrcrange", "range", "actrange"), ("-1 1", "-9 9", "0 2")),
    **dict.fromkeys(("limited", "actuatorgravcomp", "ctrllimited", "forcelimited", "mocap"), ("true", "false")),
    **dict.fromkeys(("joint", "joint1", "joint2"), ("left_knee", "right_roll", "left_ankle_pitch")),
    **dict.fromkeys(("body", "body1", "body2", "target"), ("left_foot", "base", "right_thigh")),
    **dict.fromkeys(("axis", "pos", "offset"), ("0 1 0", "0.1 0 0", "0 0 0")),
    "gear": ("2", "-3", "0"),
    "type": ("hinge", "slide", "ball", "box", "sphere", "capsule"),
    "mass": ("0", "0.1", "2"),
    "density": ("0", "500", "2000"),
    "friction": ("1 0.1 0.1", "2"),
    "condim": ("1", "3", "6"),
    "contype": ("0", "1"),
    "conaffinity": ("0", "1"),
    "priority": ("0", "2"),
    "size": ("0.02", "0.05 0.05 0.05"),
    "euler": ("0 0 0.3", "0.2 0 0"),
    "quat": ("1 0 0 0", "0.8 0 0.6 0"),
    "polycoef": ("0 1 0 0 0", "0.1 0 0 0 0"),
    "active": ("true", "false"),
    "class": ("none",),
    "delay": ('0.01" nsample="2',),
    "adhesion": ("0", "3"),
    "surfacevel": ("1 0 0 0 0 0",),
    "fluidshape": ("none", "ellipsoid"),
    "inertiafromgeom": ("true", "auto"),
    "angle": ("radian", "degree"),
    "settotalmass": ("30",),
    "gravity": ("0 0 -9.81", "0 0 -1"),
}
"""Values that an attribute may hold; of others one of these."""

ANY = ("0", "1", "0.3", "1 2 3", "true", "left_knee", "0.1 0.2")
STATES = 5


def mutant(seed: int) -> str:
    """The biped with one to three things more or otherwise."""
    rng = random.Random(seed)
    text = rng.choice((_with_example, _with_binding, _with_attribute, _with_attribute))(rng, source_text())
    for _ in range(rng.randrange(3)):
        text = _with_attribute(rng, text)
    return text


def _with_example(rng: random.Random, _text: str) -> str:
    names = sorted({*EXAMPLES, *("/".join(tags) for tags in schema() if "default" not in tags and len(tags) < 4)})
    return example(rng.choice(names))


def _with_binding(rng: random.Random, _text: str) -> str:
    if rng.random() < 0.3:
        return with_sites(source_text(rng.choice(list(SHARED.values()))[0]))
    return bound(rng.choice(("connect", "weld", "joint", "tendon")), rng.choice(("", ' active="false"')))


def _with_attribute(rng: random.Random, text: str) -> str:
    """An attribute that the schema has of some element of the text; those that draw are rarer."""
    root = ElementTree.fromstring(text)
    sections = {"body": ("joint", "geom", "inertial", "freejoint"), "actuator": ("motor", "position", "general")}
    chosen = rng.choice([e for e in root.iter() if e.tag in {"body", "compiler", *sum(sections.values(), ())}])
    around = next((name for name, tags in sections.items() if chosen.tag in tags), None)
    names = sorted(schema()[(around, chosen.tag) if around else (chosen.tag,)] - {"name", "file", "childclass"})
    told = [name for name in names if name in VALUES]
    name = rng.choice(told if told and rng.random() < 0.8 else names)
    value, _, more = rng.choice(VALUES.get(name, ANY)).partition('" ')
    chosen.set(name, value)
    if more:
        chosen.set(*more.split('="'))
    return ElementTree.tostring(root, encoding="unicode")


def outcome(folder: Path, text: str) -> tuple[str, tuple[str, ...], RobotDescription | None]:
    """Outcome of a text: a refusal, or lines on what is left out and the robot."""
    (folder / "hand.xml").write_text(f'<mujoco model="hands"><worldbody>{HAND}</worldbody></mujoco>')
    file = biped.write(folder, text, biped.FILE.replace("biped.urdf", "biped.xml") + LIMITS, "biped.xml")
    try:
        found = explain(str(file))
    except RobotError as refusal:
        return str(refusal), (), None
    return "", found.description.left_out, found.description


def lost(robot: RobotDescription, text: str) -> list[str]:
    """Motions of a robot that differ from its source by MuJoCo's own account, contacts, gravity and motors aside."""
    try:
        source = mujoco.MjModel.from_xml_string(text)
    except ValueError:  # of what is not read, or needs files
        return []
    ours = mujoco.MjModel.from_xml_string(robot.mjcf)
    found = [f"torque of {name}" for name in robot.joint_names if _stronger(robot, source, name)]
    for model in (source, ours):
        model.opt.gravity[:] = 0.0, 0.0, -9.81
        model.opt.density = model.opt.viscosity = 0.0
        model.opt.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    rng = np.random.default_rng(0)
    for _ in range(STATES):
        one, other = (_accelerations(model, robot, rng.bit_generator.state) for model in (source, ours))
        rng.random(99)
        if one.shape != other.shape or not np.allclose(one, other, rtol=1e-6, atol=1e-6):
            return [*found, "accelerations"]
    return found


def _accelerations(model: mujoco.MjModel, robot: RobotDescription, state: object) -> np.ndarray:
    """Accelerations of the joints in a state that is the same for both models [rad/s^2]."""
    rng = np.random.default_rng(0)
    rng.bit_generator.state = state
    data = mujoco.MjData(model)
    joints = [model.joint(name) for name in robot.joint_names]
    low, high = robot.position_lower, robot.position_upper
    for joint, share, speed in zip(
        joints, rng.uniform(0.2, 0.8, len(joints)), rng.normal(size=len(joints)), strict=True
    ):
        at = robot.joint_names.index(joint.name)
        place = joint.qposadr[0]
        data.qpos[place] = model.qpos0[place] + low[at] + share * (high[at] - low[at])
        data.qvel[joint.dofadr[0]] = speed
    mujoco.mj_forward(model, data)
    return np.array([data.qacc[joint.dofadr[0]] for joint in joints])


def _stronger(robot: RobotDescription, source: mujoco.MjModel, name: str) -> bool:
    """Return true if a joint has more torque than its source gives it at the ends of what its motors may do."""
    given = {"left_ankle_roll": 40.0, "right_ankle_roll": 40.0}  # by the robot file
    data, dof = mujoco.MjData(source), source.joint(name).dofadr[0]
    best = []
    for sign in (1.0, -1.0):
        data.qfrc_actuator[:] = 0.0
        for control in (1e6, -1e6):
            data.ctrl[:] = sign * control
            data.act[:] = sign * control
            mujoco.mj_forward(source, data)
            best.append(float(data.qfrc_actuator[dof]))
    limit = robot.torque_limit[robot.joint_names.index(name)]
    return name not in given and limit > max(abs(min(best)), abs(max(best))) + 1e-6
