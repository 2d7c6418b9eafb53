"""A model with the joints that walk: others locked, limits and rotors complete, x of the base ahead."""

import fnmatch
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from surefoot.models.inertia import LEAST_MASS, MASSLESS
from surefoot.models.joints import is_revolute
from surefoot.models.robot_file.bindings import check_bindings, locked_note
from surefoot.models.robot_file.couplings import coupling_notes, joined, kept
from surefoot.models.robot_file.files import Originals
from surefoot.models.robot_file.magnitudes import check_angle, check_joints
from surefoot.models.robot_file.mjcf_schema import FOLLOWING
from surefoot.models.robot_file.motors import read_srdf, require_limits, set_armature, set_limits
from surefoot.models.robot_file.schema import RobotFile, matched
from surefoot.models.robot_file.shapes import Shape, placed
from surefoot.models.robot_file.source import RESERVED, SITES, Source
from surefoot.models.robot_file.turning import turn, upward
from surefoot.models.types import Array, Coupling, RobotError, nearest

_BALL = 0.02
"""Radius of gyration that a repaired body gets [m]."""

_GIVEN, _FOLLOWS = "given in the file", "follow others"
_MOTORS = "legs need revolute joints with a motor each; write it into lock if it may be frozen"
_ITS_MOTOR = f"{FOLLOWING}; or write it into lock if it may be frozen"

_TURNS = {"x": 0, "y": 1, "-x": 2, "-y": 3}
"""Quarter turns about z from the base's x to the axis that points ahead."""


@dataclass(frozen=True, slots=True)
class Reduced:
    """The rest of a model, with what is known of its links.

    Attributes:
        model: joint 1 is the floating base, whose x points ahead; all others are revolute.
        bodies: name of the link that each joint moves, the floating base first; by joint index less 1.
        feet: frames of the left and right foot's links.
        visual: what is drawn, by joint, vertices in the joint's frame.
        collision: what touches, by joint, vertices in the joint's frame.
        turned: angle about z by which the base's frame was turned [rad].
        states: postures of the SRDF by name.
        notes: what was derived or altered.
        left_out: see `Source`.
        couplings: joints that follow others, and have no coordinate in the model.
    """

    model: pin.Model
    bodies: tuple[str, ...]
    feet: tuple[int, int]
    visual: tuple[tuple[Shape, ...], ...]
    collision: tuple[tuple[Shape, ...], ...]
    turned: float
    states: dict[str, dict[str, float]]
    notes: list[str]
    left_out: list[str]
    couplings: tuple[Coupling, ...] = ()

    def joint_of(self, link: str, key: str) -> int:
        """The joint that moves a link.

        Raises:
            RobotError: there is no such link.
        """
        if link in self.bodies:
            return self.bodies.index(link) + 1
        return int(self.model.frames[frame_of(self.model, link, key)].parentJoint)


def frame_of(model: pin.Model, link: str, key: str) -> int:
    """Index of a link's frame.

    Raises:
        RobotError: there is no such link.
    """
    links = tuple(frame.name for frame in model.frames if frame.type == pin.FrameType.BODY and frame.name != "universe")
    if link not in links:
        raise RobotError((key,), f"{key} of {model.name} names '{link}', which is no link of it", nearest(link, links))
    return int(model.getFrameId(link, pin.FrameType.BODY))


def reduced(made_of: Originals, source: Source) -> Reduced:
    """Lock what does not walk, complete limits, and turn the base.

    Raises:
        RobotError: a name or pattern means nothing, or a limit is missing.
    """
    file = made_of.file
    srdf = made_of.srdf
    full = source.model
    notes = source.notes
    names = tuple(full.names)[2:]
    set_limits(full, file, names)
    rotors, states, passive = read_srdf(srdf, names)
    set_armature(full, matched(file.armature, names, "armature", file.name), rotors, srdf, notes)
    feet = file.soles()
    chains = [_chain(full, getattr(feet, side), f"feet.{side}") for side in ("left", "right")]
    left, right = (set(chain) for chain in chains)
    above = _above(full, left, right)
    given = _given(full, file, source, left | right)
    legs = [[joint for joint in chain if joint not in above and full.names[joint] not in given] for chain in chains]
    following = {name: one for name, one in source.followers.items() if name not in given}
    couplings = kept(full, legs, {name: one for name, one in following.items() if one.leader not in given})
    locked = _locked(full, file, source, (left | right) - above, above, given, couplings)
    for why in dict.fromkeys(reason for reason, _ in locked.values()):
        names_of = [str(full.names[joint]) for joint, (reason, _) in locked.items() if reason == why]
        notes.append(f"locked, {why}: {', '.join(names_of)}")
        if why != _GIVEN or set(names_of) & set(source.followers):
            source.left_out.append(locked_note(names_of, why, source.followers))
    q = pin.neutral(full)
    for joint, (_, angle) in locked.items():
        model_joint = full.joints[joint]
        if model_joint.nq == 1:
            q[model_joint.idx_q] = angle
    free = [name for joint, name in enumerate(full.names) if joint > 1 and joint not in locked]
    limited = matched(file.torque_limit, names, "torque_limit", file.name)
    source.left_out += check_bindings(source.bindings, free, limited, made_of.document.path)
    if driven := [name for name in free if name in passive]:
        source.left_out.append(f"left out: passive_joint of the SRDF: {', '.join(driven)}: they have motors here")
    model = _without(full, list(locked), q)
    model.name = file.name
    model = joined(model, couplings)
    notes += coupling_notes(model, couplings)
    require_limits(model, notes)
    notes += check_joints(model)
    frames = tuple(frame_of(model, link, "feet") for link in (feet.left, feet.right))
    turned = _turn(model, frames, file, notes)
    bodies = _bodies(full, tuple(model.names)[1:])
    visual, collision = (_by_joint(model, shapes) for shapes in (source.visual, source.collision))
    shapes = [drawn + touching for drawn, touching in zip(visual, collision, strict=True)]
    notes += _require_inertias(model, bodies, shapes, {full.names[joint] for joint in left | right}, file)
    both = frames[0], frames[1]
    return Reduced(model, bodies, both, visual, collision, turned, states, notes, source.left_out, couplings)


def _above(model: pin.Model, left: set[int], right: set[int]) -> set[int]:
    """Joints from a trunk that is the root down to where two legs part."""
    shared = left & right
    if not shared or left <= right or right <= left:
        return set()
    data = model.createData()
    pin.computeSubtreeMasses(model, data)
    hips = sum(data.mass[min(leg - shared)] for leg in (left, right))
    below = data.mass[min(shared)]
    return shared if below - hips < data.mass[0] - below else set()


def _without(full: pin.Model, locked: list[int], q: Array) -> pin.Model:
    """The model with joints locked; Pinocchio seeks joints among all frames, so others have other names meanwhile.

    Names of a model can be printed: with lines before them, a link's and a fixed joint's are those of nothing else.
    """
    for frame in list(full.frames)[1:]:
        before = {pin.FrameType.JOINT: "", pin.FrameType.BODY: "\n"}.get(frame.type, "\n\n")
        frame.name = f"{before}{frame.name}"
    model = pin.buildReducedModel(full, locked, q)
    for frame in (*full.frames, *model.frames):
        frame.name = frame.name.lstrip("\n")
    return model


def _chain(model: pin.Model, link: str, key: str) -> list[int]:
    """Joints from the floating base to a link."""
    joint = model.frames[frame_of(model, link, key)].parentJoint
    return [index for index in model.supports[joint] if index > 1]


def _given(model: pin.Model, file: RobotFile, source: Source, legs: set[int]) -> dict[str, float | None]:
    """Joints that the file freezes, with their angles where it gives them, and those of legs that follow them [rad].

    Raises:
        RobotError: a pattern matches none, or an angle is of no joint.
    """
    found: dict[str, float | None] = {}
    patterns = file.lock if isinstance(file.lock, dict) else dict.fromkeys(file.lock or ())
    names = tuple(model.names)[2:]
    for pattern, angle in patterns.items():
        meant = fnmatch.filter(names, pattern)
        if not meant:
            what = f"lock of {file.name} has the pattern '{pattern}', which matches no joint"
            raise RobotError(("lock", pattern), what, nearest(pattern, names))
        check_angle(f"lock of {file.name} with '{pattern}'", angle or 0.0, ("lock", pattern))
        found |= dict.fromkeys(meant, angle)
    for name, one in source.followers.items():
        if one.leader in found and one.ratio is not None and model.getJointId(name) in legs:
            leads = found[one.leader]
            at = _at_rest(model, model.getJointId(one.leader), 0.0) if leads is None else leads
            found.setdefault(name, one.angle + one.ratio * at)
    return found


def _locked(
    model: pin.Model,
    file: RobotFile,
    source: Source,
    legs: set[int],
    above: set[int],
    given: dict[str, float | None],
    couplings: Sequence[Coupling],
) -> dict[int, tuple[str, float]]:
    """Joints that are frozen, each with the reason and its angle [rad].

    Raises:
        RobotError: a joint of a leg cannot turn.
    """
    coupled = {one.follower for one in couplings} | {one.leader for one in couplings}
    fingers = _fingers(model, legs) if file.lock is None else set()
    data = model.createData()
    pin.computeSubtreeMasses(model, data)
    shown = {
        int(model.frames[frame_of(model, shape.link, "model")].parentJoint)
        for shape in (*source.visual, *source.collision)
    }
    found: dict[int, tuple[str, float]] = {}
    for joint in range(2, model.njoints):
        name, one = model.names[joint], model.joints[joint]
        why = ""
        if name in given:
            why = _GIVEN
        elif not is_revolute(model, joint):
            why = "not revolute"
        elif name in source.followers and name not in coupled:
            why = _FOLLOWS
        elif joint in above:
            why = "above both legs, where the floating base is"
        elif joint in fingers:
            why = "fingers"
        elif joint not in legs and not model.upperEffortLimit[one.idx_v] > 0.0:
            why = "without torque"
        elif joint not in legs and data.mass[joint] <= LEAST_MASS and not shown & set(model.subtrees[joint]):
            why = "move nothing"
        if why and joint in legs and name not in given:
            cause = source.followers[name].cause if why == _FOLLOWS else why
            what = f"joint '{name}' of {file.name} is in a leg and cannot be driven ({cause})"
            right = _ITS_MOTOR if why == _FOLLOWS else _MOTORS
            raise RobotError(("feet",), what, right)
        if why:
            rest, wanted = given.get(name), source.followers[name].angle if why == _FOLLOWS else 0.0
            found[joint] = (why, _at_rest(model, joint, wanted) if rest is None else rest)
    return found


def _at_rest(model: pin.Model, joint: int, wanted: float) -> float:
    one = model.joints[joint]
    if one.nq != 1:
        return 0.0
    return float(np.clip(wanted, model.lowerPositionLimit[one.idx_q], model.upperPositionLimit[one.idx_q]))


def _fingers(model: pin.Model, legs: set[int]) -> set[int]:
    """Joints below a place from which several chains part that are light: what is at the end of an arm."""
    data = model.createData()
    pin.computeSubtreeMasses(model, data)
    total, found = data.mass[0], set()
    for joint in range(2, model.njoints):
        children = [child for child in model.children[joint] if child not in legs]
        if joint in legs or len(children) < 2:
            continue
        if sum(data.mass[child] for child in children) < _LIGHT * total:
            found |= {below for child in children for below in model.subtrees[child]}
    return found


_LIGHT = 0.03
"""Share of the whole mass that all fingers of a hand stay below [-]."""


def _require_inertias(
    model: pin.Model, bodies: tuple[str, ...], shapes: Sequence[tuple[Shape, ...]], legs: set[str], file: RobotFile
) -> Iterator[str]:
    """Give links without mass between joints what an engine asks for; refuse what lacks an inertia; yields notes.

    A link without mass that fills no space is no fault: its joint moves what hangs on it. What makes a joint unfit is
    looked for in the inertia of all joints together (`joint_inertia`).

    Raises:
        RobotError: a joint moves no mass at all, or a link has a shape and no mass, or mass and no moment.
    """
    data, balls = model.createData(), []
    pin.computeSubtreeMasses(model, data)
    for joint, body in enumerate(bodies, start=1):
        inertia, name = model.inertias[joint], model.names[joint]
        massless = inertia.mass <= LEAST_MASS
        if massless and not shapes[joint] and data.mass[joint] > LEAST_MASS:
            model.inertias[joint] = inertia + pin.Inertia(MASSLESS, np.zeros(3), MASSLESS * np.eye(3))
            continue
        least = float(np.linalg.eigvalsh(inertia.inertia)[0])
        if not massless and least > LEAST_MASS:
            continue
        if file.inertia == "refuse" or massless:
            what = (
                f"link '{body}' of {file.name} moves with {inertia.mass:g} kg and a least moment of {least:.2g} kg m^2"
            )
            ways = ["give it an inertia in the model"]
            ways += [f"write 'lock: [{name}]'"] if joint > 1 and name not in legs and file.lock is None else []
            ways += ["write 'inertia: repair'"] if not massless else []
            raise RobotError(("inertia",), what, ", or ".join(ways))
        ball = inertia.mass * _BALL**2
        model.inertias[joint] = pin.Inertia(inertia.mass, inertia.lever, inertia.inertia + ball * np.eye(3))
        balls.append(body)
    if balls:
        listed = ", ".join(balls)
        yield f"without a moment of inertia in the model, and with that of a ball of {_BALL} m here: {listed}"


def _turn(model: pin.Model, feet: tuple[int, ...], file: RobotFile, notes: list[str]) -> float:
    """Turn the frame of the base so that z points up and x ahead; returns the angle about z [rad].

    Ahead is what has the left foot on its left.
    """
    axes = upward(model, feet)
    if axes[2, 2] != 1.0:
        turn(model, 1, axes)
        notes.append("the frame of the base is turned, so that its z points from the feet to the hips")
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    left, right = (data.oMf[frame].translation for frame in feet)
    aside = left - right
    quarter = round(np.arctan2(-aside[0], aside[1]) / (np.pi / 2)) % 4
    if file.forward is not None:
        quarter = _TURNS[file.forward]
    else:
        axis = next(name for name, turns in _TURNS.items() if turns == quarter)
        notes.append(f"forward: {axis} of the base, which has the left foot on its left")
    if not quarter:
        return 0.0
    notes.append(f"the frame of the base is turned by {90 * quarter} deg about z, so that its x points forward")
    cosine, sine = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter]
    turn(model, 1, np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]]))
    return float(quarter * np.pi / 2)


def _bodies(model: pin.Model, joints: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the links that joints move; others where a joint or site has them, since frames are found by name."""
    links = [frame for frame in model.frames if frame.type == pin.FrameType.BODY]
    names = {frame.name for frame in links}
    taken = {*tuple(model.names)[1:], *SITES, *RESERVED}
    found = []
    for joint in joints:
        moved = model.getJointId(joint)
        name = str(next(frame.name for frame in links if frame.parentJoint == moved))
        while name in taken:
            name = f"{name}_link" if f"{name}_link" not in names else f"{name}_"
        taken.add(name)
        found.append(name)
    return tuple(found)


def _by_joint(model: pin.Model, shapes: tuple[Shape, ...]) -> tuple[tuple[Shape, ...], ...]:
    """Shapes of each joint, in its frame."""
    found: list[list[Shape]] = [[] for _ in range(model.njoints)]
    for shape in shapes:
        frame = model.frames[model.getFrameId(shape.link, pin.FrameType.BODY)]
        vertices = placed(shape.vertices, frame.placement)
        found[frame.parentJoint].append(Shape(shape.link, vertices, shape.faces, shape.rgba))
    return tuple(tuple(group) for group in found)


def points_of(shapes: tuple[Shape, ...]) -> Array:
    """Vertices of several shapes, shape (n, 3) [m]."""
    return np.concatenate([shape.vertices for shape in shapes]) if shapes else np.zeros((0, 3))
