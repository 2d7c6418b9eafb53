"""The elements of MJCF and the fate of each: used, left out with a word, or refused.

The reader, its tests and a table of docs/robot-files.md go by this one. An element or an attribute that it lacks is
refused, so that one of a later MuJoCo is never lost without a word.
"""

from dataclasses import dataclass
from enum import Enum
from functools import lru_cache


class Fate(Enum):
    """The treatment of an element."""

    KEPT = "kept"
    LEFT_OUT = "left out"
    BINDING = "refused where it binds joints that move, else left out"
    COUPLING = "kept in a leg; else refused where it binds joints that move, and left out where they are locked"
    REFUSED = "refused"


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Attributes of an element that a robot does without.

    Attributes:
        attributes: names, with spaces between them.
        fields: of a compiled model, where other values than those of a plain element are reported.
        why: for the message.
        of: things whose fields those are: joint, dof, geom, body or actuator.
        called: how a message names them; empty where it names the first of them.
    """

    attributes: str
    fields: tuple[str, ...]
    why: str
    of: str
    called: str = ""

    @property
    def name(self) -> str:
        """Their name in a message."""
        return self.called or self.attributes.split()[0]


@dataclass(frozen=True, slots=True)
class Elements:
    """Elements of one fate.

    Attributes:
        fate: their treatment.
        parent: path of the element around them.
        tags: their names, with spaces between them.
        why: the reason to leave them out, or what would be right in place of refused ones.
        attributes: that are used or move nothing; of elements that are not kept no attribute matters.
        left_out: attributes of kept ones that the robot does without.
        stays: whether others refer to left out ones, so that an engine reads them.
    """

    fate: Fate
    parent: str
    tags: str
    why: str = ""
    attributes: str = ""
    left_out: tuple[LeftOut, ...] = ()
    stays: bool = False

    @property
    def paths(self) -> tuple[str, ...]:
        """Path of each, from the root's children on."""
        return tuple(f"{self.parent}/{tag}" if self.parent else tag for tag in self.tags.split())

    @property
    def known(self) -> frozenset[str]:
        """Names of all attributes of a kept one."""
        return frozenset(" ".join((self.attributes, *(one.attributes for one in self.left_out))).split())


STILL = "they move no body"
WORLD = "each scenario has a world of its own"
TOUCH = "a scenario's terrain has the friction, and MuJoCo's own defaults the rest"
_NO_FLEX = "give a robot of bodies and joints"
_SERIAL = (
    "a robot is a tree of driven joints here: hold these joints by lock, or give a model without it whose joints have "
    "the limits that the linkage leaves them"
)

FOLLOWING = (
    "it may follow the joint next to it in the leg, about a parallel axis and by a constant ratio; else a joint of a "
    "leg needs a motor"
)

_POSE = "pos quat axisangle xyaxes zaxis euler"
_MOTOR = (
    "name class group user joint jointinparent gear ctrlrange ctrllimited forcerange forcelimited lengthrange armature "
    "refsite site slidersite cranksite cranklength tendon"
)
_LATE = LeftOut("delay nsample interp", ("actuator_delay",), "a scenario's motors.delay has one", "actuator")
_LOSSES = LeftOut(
    "damping", ("actuator_damping", "actuator_dampingpoly"), "a scenario's motors.damping has it", "actuator"
)


def _servo(attributes: str) -> LeftOut:
    fields = ("actuator_gaintype", "actuator_biastype", "actuator_dyntype", "actuator_plugin")
    why = "joints are driven by torque here, within the force of the actuator"
    return LeftOut(attributes, fields, why, "actuator", "gain, bias and dynamics")


def _contact(attribute: str) -> LeftOut:
    return LeftOut(attribute, (f"geom_{attribute}",), TOUCH, "geom")


def _actuator(tag: str, law: str, more: str = "") -> Elements:
    return Elements(Fate.KEPT, "actuator", tag, attributes=f"{_MOTOR} {more}", left_out=(_LATE, _LOSSES, _servo(law)))


ELEMENTS = (
    Elements(
        Fate.KEPT,
        "",
        "compiler",
        attributes="alignfree angle assetdir autolimits balanceinertia boundinertia boundmass conflict coordinate "
        "discardvisual eulerseq fitaabb fusestatic inertiafromgeom inertiagrouprange meshdir passthrough savecanonical "
        "savecompiled saveinertial settotalmass strippath texturedir usethread",
    ),
    Elements(Fate.LEFT_OUT, "compiler", "lengthrange", STILL),
    Elements(Fate.LEFT_OUT, "", "option", WORLD),
    Elements(Fate.LEFT_OUT, "option", "flag", WORLD),
    Elements(Fate.LEFT_OUT, "", "size statistic visual custom keyframe sensor", STILL),
    Elements(Fate.LEFT_OUT, "visual", "global quality headlight map scale rgba", STILL),
    Elements(Fate.LEFT_OUT, "custom", "numeric text tuple", STILL),
    Elements(Fate.LEFT_OUT, "custom/tuple", "element", STILL),
    Elements(Fate.LEFT_OUT, "keyframe", "key", STILL),
    Elements(
        Fate.LEFT_OUT,
        "sensor",
        "touch accelerometer velocimeter gyro force torque magnetometer camprojection rangefinder jointpos jointvel "
        "tendonpos tendonvel actuatorpos actuatorvel actuatorfrc jointactuatorfrc tendonactuatorfrc ballquat "
        "ballangvel jointlimitpos jointlimitvel jointlimitfrc tendonlimitpos tendonlimitvel tendonlimitfrc framepos "
        "framequat framexaxis frameyaxis framezaxis framelinvel frameangvel framelinacc frameangacc subtreecom "
        "subtreelinvel subtreeangmom insidesite distance normal fromto contact e_potential e_kinetic clock tactile "
        "user plugin",
        STILL,
    ),
    Elements(Fate.LEFT_OUT, "sensor/plugin", "config", STILL),
    Elements(Fate.KEPT, "", "default", attributes="class"),
    Elements(Fate.KEPT, "", "extension asset worldbody contact tendon equality actuator deformable"),
    Elements(Fate.KEPT, "extension", "plugin", attributes="plugin"),
    Elements(Fate.KEPT, "extension/plugin", "instance", attributes="name"),
    Elements(Fate.KEPT, "extension/plugin/instance", "config", attributes="key value"),
    Elements(
        Fate.KEPT,
        "asset",
        "mesh",
        attributes="builtin class content_type face file inertia material maxhullvert name normal params refpos "
        "refquat scale smoothnormal texcoord vertex",
    ),
    Elements(Fate.REFUSED, "asset/mesh", "plugin", "give the mesh as a file"),
    Elements(Fate.LEFT_OUT, "asset", "hfield", WORLD),
    Elements(Fate.LEFT_OUT, "asset", "skin texture", STILL),
    Elements(Fate.LEFT_OUT, "asset/skin", "bone", STILL),
    Elements(
        Fate.KEPT,
        "asset",
        "material",
        attributes="class emission metallic name reflectance rgba roughness shininess specular texrepeat texture "
        "texuniform",
    ),
    Elements(Fate.LEFT_OUT, "asset/material", "layer", STILL),
    Elements(Fate.KEPT, "asset", "model", attributes="content_type file name"),
    Elements(
        Fate.KEPT,
        "",
        "body",
        attributes=f"{_POSE} childclass fuse name simple sleep user",
        left_out=(
            LeftOut("gravcomp", ("body_gravcomp",), "every body weighs what its mass weighs", "body"),
            LeftOut("mocap", ("body_mocapid",), "the base of a robot is free", "body"),
        ),
    ),
    Elements(Fate.KEPT, "body", "frame", attributes=f"{_POSE} childclass name"),
    Elements(Fate.KEPT, "body", "replicate", attributes="count sep offset euler childclass name"),
    Elements(Fate.KEPT, "body", "inertial", attributes=f"{_POSE} diaginertia fullinertia mass"),
    Elements(
        Fate.KEPT,
        "body",
        "joint",
        attributes="actuatorfrclimited actuatorfrcrange armature axis class group limited name pos range ref type user",
        left_out=(
            LeftOut(
                "stiffness springref springdamper springyield",
                ("jnt_stiffness", "jnt_stiffnesspoly"),
                "joints have no springs",
                "joint",
            ),
            LeftOut("damping", ("dof_damping", "dof_dampingpoly"), "a scenario's motors.damping has it", "dof"),
            LeftOut(
                "frictionloss solreffriction solimpfriction",
                ("dof_frictionloss",),
                "a scenario's motors.friction_loss has it",
                "dof",
            ),
            LeftOut("actuatorgravcomp", ("jnt_actgravcomp",), "every body weighs what its mass weighs", "joint"),
            *(
                LeftOut(attribute, (field,), "joints stop as MuJoCo's defaults have it", "joint")
                for attribute, field in (
                    ("margin", "jnt_margin"),
                    ("solreflimit", "jnt_solref"),
                    ("solimplimit", "jnt_solimp"),
                )
            ),
        ),
    ),
    Elements(Fate.KEPT, "body", "freejoint", attributes="align group name"),
    Elements(
        Fate.KEPT,
        "body",
        "geom",
        attributes=f"{_POSE} castshadow class conaffinity contype density fitscale fromto group hfield mass material "
        "mesh name rgba shellinertia size type user",
        left_out=(
            *map(_contact, ("friction", "condim", "priority", "margin", "gap", "solref", "solimp", "solmix")),
            LeftOut("adhesion", ("geom_adhesion",), "soles only press", "geom"),
            LeftOut("surfacevel", ("geom_surfacevel",), "soles have no belts", "geom"),
            LeftOut("fluidshape fluidcoef", ("geom_fluid",), "a robot walks in no fluid", "geom"),
        ),
    ),
    Elements(Fate.REFUSED, "body/geom", "plugin", "give it a shape of MuJoCo's own, or a mesh"),
    Elements(Fate.KEPT, "body", "attach", attributes="body frame model prefix"),
    Elements(
        Fate.KEPT, "body", "site", attributes=f"{_POSE} class fromto group material mesh name rgba size type user"
    ),
    Elements(Fate.LEFT_OUT, "body", "camera light", STILL),
    Elements(Fate.REFUSED, "body", "plugin", "leave it out; nothing but motors and contacts move a robot here"),
    Elements(Fate.REFUSED, "body", "flexcomp composite", _NO_FLEX),
    Elements(Fate.REFUSED, "deformable", "flex", _NO_FLEX),
    Elements(Fate.LEFT_OUT, "deformable", "skin", STILL),
    Elements(Fate.LEFT_OUT, "deformable/skin", "bone", STILL),
    Elements(Fate.LEFT_OUT, "contact", "pair", TOUCH),
    Elements(Fate.LEFT_OUT, "contact", "exclude", "links do not touch that are joined, or that overlap in the posture"),
    Elements(Fate.LEFT_OUT, "tendon", "spatial fixed", "bodies are moved by joints and contacts alone", stays=True),
    Elements(Fate.LEFT_OUT, "tendon/spatial", "site geom pulley", "they are of a tendon", stays=True),
    Elements(Fate.LEFT_OUT, "tendon/fixed", "joint", "they are of a tendon", stays=True),
    Elements(Fate.BINDING, "equality", "connect weld tendon", _SERIAL, stays=True),
    Elements(Fate.COUPLING, "equality", "joint", FOLLOWING, stays=True),
    Elements(Fate.REFUSED, "equality", "flex flexstrain", _NO_FLEX),
    _actuator(
        "general",
        "actdim actearly actlimited actrange biasprm biastype dynprm dyntype ffrange gainprm gaintype velrange",
        "inheritrange input body",
    ),
    _actuator("motor", ""),
    _actuator("position", "dampratio kp kv timeconst", "inheritrange"),
    _actuator("velocity", "kv"),
    _actuator("intvelocity", "actlimited actrange dampratio kp kv", "inheritrange"),
    _actuator("pid", "dampratio ffrange imax ki kp kv posrange slewmax velrange", "inheritrange input"),
    _actuator("damper", "kv"),
    _actuator("cylinder", "area bias diameter timeconst"),
    _actuator("muscle", "force fpmax fvmax lmax lmin range scale tausmooth timeconst vmax"),
    _actuator(
        "dcmotor", "cogging controller inductance lugre motorconst nominal resistance saturation thermal", "input"
    ),
    _actuator("plugin", "actdim actearly actlimited actrange dynprm dyntype", "instance plugin"),
    Elements(Fate.KEPT, "actuator/plugin", "config", attributes="key value"),
    Elements(Fate.LEFT_OUT, "actuator", "adhesion", "soles only press"),
    Elements(Fate.LEFT_OUT, "actuator", "orientation", "joints turn about one axis each"),
)

DEFAULTS = {
    **{tag: f"body/{tag}" for tag in ("joint", "geom", "site", "camera", "light")},
    **{tag: f"asset/{tag}" for tag in ("mesh", "texture", "material")},
    "pair": "contact/pair",
    "tendon": "tendon/spatial",
    "equality": "equality/connect",
}
"""Elements of a default class by those that they are defaults of; others are of the actuator of their name."""

META = ("body/frame", "body/replicate")
"""Elements that MuJoCo's schema lacks; includes are gone before a document is looked at."""


@lru_cache(maxsize=1)
def by_path() -> dict[str, Elements]:
    """Each element by its path."""
    return {path: group for group in ELEMENTS for path in group.paths}


def path_of(parent: str, tag: str) -> str:
    """Path of an element below that of a parent; a body in a body is a body, a default class as what it is of."""
    if parent == "default":
        return tag if tag == "default" else DEFAULTS.get(tag, f"actuator/{tag}")
    within = "body" if parent in ("worldbody", *META) else parent
    if within == "body" and tag == "body":
        return "body"
    return f"{within}/{tag}" if within else tag
