"""Sizes that no robot has, by the robot itself: each number of a part against the size or the mass of the whole.

A number in another unit is off by a factor of ten and more, while what robots are made of is alike at every size. So
each law is a ratio, and its bound lies between the farthest of some 130 public models and the nearest unit that is none
of ours. The farthest of them stand in the table of docs/robot-files.md.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import repeat

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import names_of
from surefoot.models.robot_file.shapes import Shape, placed
from surefoot.models.types import Array, RobotError

Units = tuple[tuple[float, str], ...]
"""Units in which a number may be instead, each with the factor that it makes of the ratio."""

LENGTHS: Units = ((39.37, "inches"), (100.0, "centimetres"), (1000.0, "millimetres"))
MASSES: Units = ((1000.0, "grams"), (1e-3, "tonnes"))
ANGLES: Units = ((180.0 / math.pi, "degrees"),)
RADIANS: Units = ((math.pi / 180.0, "radians, while the file's compiler reads degrees"),)
TORQUES: Units = ((1000.0, "N mm"),)
SPEEDS: Units = ((180.0 / math.pi, "deg/s"), (30.0 / math.pi, "turns a minute"))
INERTIAS: Units = ((1e2, "kg cm^2"), (1e3, "kg mm^2"), (3.2e3, "g cm^2"), (3.2e4, "g mm^2"))
"""Units of a radius of gyration, which grows with the root of the moment."""


@dataclass(frozen=True, slots=True)
class Law:
    """The bounds of a ratio.

    Attributes:
        said: a sentence about ``{what}`` whose number is ``{value}``, up to what it is measured by.
        unit: of the number.
        over: what it is measured by, with its size as ``{}``.
        most: largest ratio of a robot.
        usual: ratio of most robots, by which the unit is guessed.
        units: in which the number may be instead; none where nobody can say.
        least: smallest ratio.
        instead: what else may be wrong.
        then: what becomes of a model that breaks it.
    """

    said: str
    unit: str
    over: str
    most: float
    usual: float
    units: Units = ()
    least: float = 0.0
    instead: str = ""
    then: str = "refused"

    def holds(self, value: float, size: float) -> bool:
        """Return true if a number is of a robot of that size."""
        return self.least * size <= value <= self.most * size

    def refusal(self, what: str, value: float, size: float) -> tuple[str, str]:
        """A number that is of no robot, and what would be right."""
        ratio = value / size if size > 0.0 else math.inf
        said = self.said.format(what=what, value=f"{_shown(value)} {self.unit}")
        bound = f"least {_shown(self.least * size)}" if ratio < self.least else f"most {_shown(self.most * size)}"
        right = f"give at {bound} {self.unit}{self._likely(ratio)}"
        return f"{said}, {_shown(ratio)} times {self.over.format(_shown(size))}", right

    def _likely(self, ratio: float) -> str:
        """The unit whose factor is the nearest to what the number is off by."""
        off = math.log(ratio / self.usual) if 0.0 < ratio < math.inf else 0.0
        near = [one for one in self.units if abs(math.log(one[0]) - off) < 0.6 * abs(math.log(one[0]))]
        best = min(near, key=lambda one: abs(math.log(one[0]) - off), default=None)
        return self.instead if best is None else f"; it is likely in {best[1]}"


def _shown(value: float) -> str:
    """A number in three digits, or a whole one."""
    return f"{value:.0f}" if 100.0 <= value < 1e7 else f"{value:.3g}"


_SPAN = "the {} m from end to end of its joints"
LONG = Law(
    "{what} are {value} from end to end",
    "m",
    "the {} m of a robot of its mass",
    5.0,
    1.0,
    ((10.0, "metres and its masses in tonnes"), *LENGTHS),
)
FAR = Law("{what} is {value} from the joint before it", "m", "the {} m of a robot of its mass", 4.0, 0.3, LENGTHS)
APART = Law("{what} is {value} from the joint before it", "m", _SPAN, 0.75, 0.2)
HEAVY = Law("the mass of {what} is {value}", "kg", "the {} kg of a robot of its size", 30.0, 1.0, MASSES)
SHARE = Law("the mass of {what} is {value}", "kg", "the {} kg of all other links", 8.0, 0.05, MASSES)
DENSE = Law(
    "the mass of {what} is {value}",
    "kg",
    "the {} kg of a cube of water as wide as its shapes",
    30.0,
    0.2,
    instead=", or larger shapes: one of both is in another unit",
)
EXTENT = Law("a shape of {what} reaches {value} from its frame", "m", _SPAN, 4.0, 0.2, LENGTHS)
SPECK = Law("a shape of {what} is {value} across", "m", _SPAN, math.inf, 0.2, least=4e-4, then="remarked")
LEVER = Law("the centre of mass of {what} is {value} outside its shapes and joints", "m", _SPAN, 0.4, 0.1, LENGTHS)
ASIDE = Law(
    "the centre of mass of {what} is {value} outside its shapes and joints",
    "m",
    _SPAN,
    0.1,
    0.05,
    LENGTHS,
    then="remarked",
)
GYRATION = Law("the radius of gyration of {what} is {value}", "m", _SPAN, 1.5, 0.05, INERTIAS)
SPREAD = Law(
    "the radius of gyration of {what} is {value}",
    "m",
    "the {} m across its shapes",
    1.5,
    0.3,
    INERTIAS,
    then="remarked",
)
TURN = Law("{what} turns up to {value}", "rad", "a turn of {} rad", 1.01, 0.3, ANGLES)
WIDEST = Law("{what} turns the farthest, up to {value}", "rad", "a turn of {} rad", 1.01, 0.3, RADIANS, 0.03)
ROTOR = Law("the armature of {what} is {value}", "kg m^2", "the {} kg m^2 of its mass at its size", 0.3, 1e-3)
TORQUE = Law(
    "the torque limit of {what} is {value}",
    "N m",
    "the {} N m of its weight at its size",
    30.0,
    0.3,
    TORQUES,
    then="remarked",
)
SPEED = Law(
    "the velocity limit of {what} is {value}", "rad/s", "the {} rad/s of fast joints", 1.0, 0.1, SPEEDS, then="remarked"
)
CENTRE = Law(
    "the centre of the sole of {what} is {value} from its ankle", "m", "the {} m from hip to ankle", 0.6, 0.1, LENGTHS
)
LENGTH = Law("the sole of {what} is {value} long", "m", "the {} m of its legs", 1.0, 0.25, LENGTHS, 0.04)
WIDTH = Law("the sole of {what} is {value} wide", "m", "the {} m of its legs", 1.0, 0.12, LENGTHS, 0.02)
COM = Law("the CoM of {what} is {value} high in walking", "m", "the {} m of its legs", 2.0, 1.0, LENGTHS, 0.4)

FEWEST = 8
"""Joints that two legs have; what has fewer is refused for that."""

_CUBIC = 20.0
"""Mass of a humanoid over the cube of the distance from end to end of its joints: 7 to 70 in most [kg/m^3]."""

_WATER = 1000.0
"""Density [kg/m^3]."""

_WEIGHTY, _MASSIVE, _TURNING = 1e-3, 5e-3, 1e-3
"""Share of the mass from which on a CoM counts, a density counts, and of mass and size squared an inertia [-]."""

_ENDLESS = 1e3
"""Angle as large stands for no stop in models that other programs wrote, as 1e9 does [rad]."""

_FAST = 200.0
"""Speed of fast joints [rad/s]."""

_GRAVITY = 9.81
"""[m/s^2]"""


@dataclass(frozen=True, slots=True)
class Part:
    """A link as its file has it.

    Attributes:
        link: its name.
        mass: of it [kg].
        com: in its frame, shape (3,) [m].
        moment: largest moment of inertia about its CoM [kg m^2].
    """

    link: str
    mass: float
    com: Array
    moment: float


@dataclass(frozen=True, slots=True)
class Held:
    """The results of a model that was held against itself.

    Attributes:
        drawn: shapes of a size that they can have.
        left_out: others, one line each link.
        notes: what is remarked.
    """

    drawn: tuple[Shape, ...]
    left_out: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def check_parts(
    model: pin.Model, parts: Sequence[Part], drawn: Sequence[Shape], touching: Sequence[Shape], place: str
) -> Held:
    """Hold the parts of a model against the whole.

    Args:
        model: joint 1 is the floating base.
        parts: its links.
        drawn: what is drawn of it.
        touching: what touches.
        place: its file, for messages.

    Raises:
        RobotError: a number is of no robot.
    """
    whole = _Whole(model, parts)
    if model.njoints - 2 < FEWEST or not whole.mass > 0.0:
        return Held(tuple(drawn))
    _refuse(whole.apart(touching), place)
    faults = [_unseen(shape, whole.span) for shape in drawn]
    seen = tuple(shape for shape, fault in zip(drawn, faults, strict=True) if not fault)
    _refuse(whole.astray((*seen, *touching)), place)
    left_out = dict.fromkeys(f"left out: what is drawn, since {fault}" for fault in faults if fault)
    specks = [(shape.link, _across(shape), whole.span) for shape in touching if _across(shape) > 0.0]
    notes = _remark(SPECK, "link", [speck for speck in specks if not SPECK.holds(*speck[1:])])
    return Held(seen, tuple(left_out), (*notes, *whole.remarked((*seen, *touching))))


def _unseen(shape: Shape, span: float) -> str:
    """Reason why a shape cannot be drawn; empty where it can."""
    what = f"link '{shape.link}'"
    if not len(shape.faces):
        return f"a shape of {what} has no surface"
    for law, size in ((EXTENT, _extent(shape)), (SPECK, _across(shape))):
        if not law.holds(size, span):
            return "; ".join(law.refusal(what, size, span))
    return ""


def _refuse(faults: Iterator[tuple[str, str]], place: str) -> None:
    """Refuse the first of some faults, each with what would be right."""
    for what, right in faults:
        raise RobotError(("model",), f"{place}: {what}", right)


def check_joints(model: pin.Model) -> list[str]:
    """Hold limits and rotors of the driven joints against the robot; ranges that stand for none become a turn.

    Args:
        model: altered in place; joint 1 is the floating base, all others are driven.

    Returns:
        what is remarked.

    Raises:
        RobotError: a number is of no robot.
    """
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    span = float(np.linalg.norm(np.ptp([data.oMi[joint].translation for joint in range(1, model.njoints)], axis=0)))
    mass = sum(inertia.mass for inertia in model.inertias)
    notes = _bounded(model)
    names = names_of(model)
    ends = np.maximum(np.abs(model.lowerPositionLimit[7:]), np.abs(model.upperPositionLimit[7:]))
    for law, key, values, size in (
        (TURN, "model", ends, math.tau),
        (WIDEST, "model", ends, math.tau),
        (ROTOR, "armature", model.armature[6:], mass * span**2),
    ):
        worst = int(np.argmax(values))
        if not law.holds(float(values[worst]), size):
            what, right = law.refusal(f"joint '{names[worst]}' of {model.name}", float(values[worst]), size)
            raise RobotError((key,), what, right)
    for law, values, size in (
        (TORQUE, model.upperEffortLimit[6:], mass * _GRAVITY * span),
        (SPEED, model.upperVelocityLimit[6:], _FAST),
    ):
        notes += _remark(law, "joint", [one for one in zip(names, values, repeat(size)) if not law.holds(*one[1:])])
    return notes


def _remark(law: Law, kind: str, wrong: Sequence[tuple[str, float, float]]) -> list[str]:
    """Remark on names, each with its number and its size, in one line; none where none is wrong."""
    if not wrong:
        return []
    name, value, size = wrong[0]
    others = f" and {len(wrong) - 1} more" if len(wrong) > 1 else ""
    return ["; ".join(law.refusal(f"{kind} '{name}'{others}", float(value), size))]


def check_angle(what: str, angle: float, key: tuple[str, ...]) -> None:
    """Refuse an angle beyond a turn [rad].

    Raises:
        RobotError: it is.
    """
    if not TURN.holds(abs(angle), math.tau):
        raise RobotError(key, *TURN.refusal(what, abs(angle), math.tau))


def _bounded(model: pin.Model) -> list[str]:
    """One turn either way for joints whose ends are as large as those that stand for none; tells which."""
    lower, upper = np.array(model.lowerPositionLimit), np.array(model.upperPositionLimit)
    endless = (lower < -_ENDLESS) | (upper > _ENDLESS)
    endless[:7] = False
    own = names_of(model)
    names = [own[int(at) - 7] for at in np.flatnonzero(endless)]
    lower[endless], upper[endless] = np.maximum(lower[endless], -math.tau), np.minimum(upper[endless], math.tau)
    model.lowerPositionLimit, model.upperPositionLimit = lower, upper
    return [f"joints turn without end in the model and one turn either way here: {', '.join(names)}"] if names else []


def check_figure(
    robot: str, leg_length: float, to_ankle: float, centre: float, sole: tuple[float, float], com_height: float
) -> None:
    """Hold soles and CoM, given or derived, against the legs.

    Args:
        robot: its name, for messages.
        leg_length: hip centre to sole [m].
        to_ankle: hip centre to the last joint of the leg, which is straight [m].
        centre: from that joint to the centre of the sole [m].
        sole: length and width [m].
        com_height: of the CoM above the soles in walking [m].

    Raises:
        RobotError: a number is of no robot.
    """
    for law, key, value, size in (
        (CENTRE, "sole", centre, to_ankle),
        (LENGTH, "sole", sole[0], leg_length),
        (WIDTH, "sole", sole[1], leg_length),
        (COM, "com_height", com_height, leg_length),
    ):
        if not law.holds(value, size):
            raise RobotError((key,), *law.refusal(robot, value, size))


class _Whole:
    """A model with its size and its mass."""

    def __init__(self, model: pin.Model, parts: Sequence[Part]) -> None:
        self._model, self._parts = model, parts
        self._links = {f.name: f for f in model.frames if f.type == pin.FrameType.BODY}
        data = model.createData()
        pin.forwardKinematics(model, data, pin.neutral(model))
        places = np.array([data.oMi[joint].translation for joint in range(1, model.njoints)])
        self.span = float(np.linalg.norm(np.ptp(places, axis=0)))
        self.mass = sum(part.mass for part in parts)

    def apart(self, touching: Sequence[Shape]) -> Iterator[tuple[str, str]]:
        """Joints too far apart, masses that are none, and shapes that are too large to touch."""
        joints = range(2, self._model.njoints)
        apart = {joint: float(np.linalg.norm(self._model.jointPlacements[joint].translation)) for joint in joints}
        far = max(apart, key=lambda joint: apart[joint])
        usual, joint = math.cbrt(self.mass / _CUBIC), f"joint '{self._model.names[far]}'"
        if not FAR.holds(apart[far], usual):
            yield FAR.refusal(joint, apart[far], usual)
        if not LONG.holds(self.span, usual):
            yield LONG.refusal("the joints", self.span, usual)
        if not APART.holds(apart[far], self.span):
            yield APART.refusal(joint, apart[far], self.span)
        heaviest = max(self._parts, key=lambda part: part.mass)
        if not SHARE.holds(heaviest.mass, self.mass - heaviest.mass):
            yield SHARE.refusal(f"link '{heaviest.link}'", heaviest.mass, self.mass - heaviest.mass)
        for shape in touching:
            if not EXTENT.holds(_extent(shape), self.span):
                yield EXTENT.refusal(f"link '{shape.link}'", _extent(shape), self.span)

    def astray(self, shapes: Sequence[Shape]) -> Iterator[tuple[str, str]]:
        """Links that are too dense, and whose mass is where they are not, or spread over more than there is of them."""
        boxes = self._boxes(shapes)
        for part in self._parts:
            joint, what = self._joint(part), f"link '{part.link}'"
            box = boxes.get(joint)
            cube = 0.0 if box is None else _WATER * float(np.linalg.norm(np.ptp(box, axis=0))) ** 3
            if cube and part.mass > _MASSIVE * self.mass and not DENSE.holds(part.mass, cube):
                yield DENSE.refusal(what, part.mass, cube)
            outside = self._outside(part, box)
            if part.mass > _WEIGHTY * self.mass and not LEVER.holds(outside, self.span):
                yield LEVER.refusal(what, outside, self.span)
            radius = math.sqrt(part.moment / part.mass) if part.mass else 0.0
            counts = part.moment > _TURNING * self.mass * self.span**2
            if counts and not GYRATION.holds(radius, self.span):
                yield GYRATION.refusal(what, radius, self.span)
        usual, heaviest = _CUBIC * self.span**3, max(self._parts, key=lambda part: part.mass)
        if not HEAVY.holds(self.mass, usual):
            what = f"the robot, with {heaviest.mass:.3g} kg of link '{heaviest.link}',"
            yield HEAVY.refusal(what, self.mass, usual)

    def remarked(self, shapes: Sequence[Shape]) -> Iterator[str]:
        """Links whose mass is beside their shapes, or spread over more than these; the first of each kind."""
        boxes = self._boxes(shapes)
        found: dict[Law, list[tuple[str, float, float]]] = {ASIDE: [], SPREAD: []}
        for part in self._parts:
            box = boxes.get(self._joint(part))
            if part.mass <= _MASSIVE * self.mass:
                continue
            found[ASIDE].append((part.link, self._outside(part, box), self.span))
            if box is not None:
                across = float(np.linalg.norm(np.ptp(box, axis=0)))
                found[SPREAD].append((part.link, math.sqrt(part.moment / part.mass), across))
        for law, numbers in found.items():
            yield from _remark(law, "link", [number for number in numbers if not law.holds(*number[1:])])

    def _joint(self, part: Part) -> int:
        return int(self._links[part.link].parentJoint)

    def _boxes(self, shapes: Sequence[Shape]) -> dict[int, Array]:
        """Corners of the box around the shapes of each joint, in its frame, shape (2, 3) [m]."""
        found: dict[int, list[Array]] = {}
        for shape in shapes:
            if len(shape.vertices):
                frame = self._links[shape.link]
                found.setdefault(frame.parentJoint, []).append(placed(shape.vertices, frame.placement))
        return {joint: _box(np.concatenate(points)) for joint, points in found.items()}

    def _outside(self, part: Part, box: Array | None) -> float:
        """Distance of a CoM from the box around a link's shapes, its joint and the joints that it carries [m]."""
        joint, model = self._joint(part), self._model
        ends = [model.jointPlacements[child].translation for child in model.children[joint]]
        low, high = _box(np.vstack((np.zeros((1, 3)), *ends, *(() if box is None else box))))
        com = self._links[part.link].placement.act(part.com)
        return float(np.linalg.norm(np.maximum(0.0, np.maximum(low - com, com - high))))


def _box(points: Array) -> Array:
    return np.array((points.min(axis=0), points.max(axis=0)))


def _across(shape: Shape) -> float:
    """Diagonal of the box around a shape [m]."""
    return float(np.linalg.norm(np.ptp(shape.vertices, axis=0)))


def _extent(shape: Shape) -> float:
    """Extent of a shape from the frame of its link, so that one that is far away counts as well [m]."""
    if not np.isfinite(shape.vertices).all():
        return math.inf
    return float(np.abs(shape.vertices).max(initial=0.0))
