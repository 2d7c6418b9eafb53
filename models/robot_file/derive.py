"""From a robot file to a description: everything that the file does not say, derived from the model."""

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import names_of
from surefoot.models.inertia import LEAST_MASS
from surefoot.models.robot_file.bindings import rolling, rolling_note
from surefoot.models.robot_file.engine_mesh import compiled, taken
from surefoot.models.robot_file.files import Originals
from surefoot.models.robot_file.imu import find_imu
from surefoot.models.robot_file.joint_inertia import require_inertia
from surefoot.models.robot_file.legs import at, find_legs, rest, solved
from surefoot.models.robot_file.magnitudes import check_figure
from surefoot.models.robot_file.meshes import decimated
from surefoot.models.robot_file.reduced import Reduced, reduced
from surefoot.models.robot_file.schema import RobotFile, matched
from surefoot.models.robot_file.shapes import Shape
from surefoot.models.robot_file.source import SITES, read_source
from surefoot.models.robot_file.text import Parts, robot_text
from surefoot.models.robot_file.touch import Hull, find_hulls, joined, kept_apart, limbs, overlapping, shank_spacing
from surefoot.models.robot_file.upper import find_upper, hanging, swings, with_upright
from surefoot.models.types import Array, JointRoles, RobotDescription, RobotError, fixed, nearest
from surefoot.similarity import LEG_LENGTH

BEND = 0.65
"""Bend of the knees in walking, as that of humanoid100, whose CoM is then 1.00 m above its soles [rad]."""

HANGING, _WIDER, _WIDEST = 0.12, 0.05, 0.8
"""Angle of the arms from the vertical in front view, by what it grows until they are free, and its end [rad]."""

_CLEAR = 0.01
"""Distance that upright shanks keep, of humanoid100; that of others goes with their leg [m]."""

_FREE = 0.04
"""Distance of hanging arms from thighs and trunk, over the leg's length: a push at the trunk swings them [-]."""

_ROUND = 5
"""Decimals of what is only drawn [m]."""

_NEAR = 0.005
"""Distance in the posture, over the leg's length, below which links may overlap for good [-]."""


class Derived(NamedTuple):
    """A description, and how it came to be.

    Attributes:
        description: the robot, at the size of its model.
        derived: what was derived and from what, one line each.
        notes: what was altered, left out or looks wrong, one line each.
    """

    description: RobotDescription
    derived: tuple[str, ...]
    notes: tuple[str, ...]


def derive(made_of: Originals) -> Derived:
    """Describe the robot of a file.

    Raises:
        RobotError: no engine takes the model, or it does not walk on two legs.
    """
    source = read_source(made_of.file, made_of.document)
    return _Deriver(made_of.file, reduced(made_of, source)).derived()


class _Deriver:
    """Holds what is found while a robot is described."""

    def __init__(self, file: RobotFile, reduced: Reduced) -> None:
        self.file, self.model = file, reduced.model
        self.lines: list[str] = []
        self.legs = find_legs(reduced, file)
        pairs = (rolling(reduced.model, leg.joints) for leg in self.legs)
        reduced.left_out.extend(rolling_note(pair) for pair in pairs if pair is not None)
        self.upper = find_upper(reduced, file, self.legs)
        self.reduced = reduced = with_upright(reduced, self.upper.torso)
        self.hulls = find_hulls(reduced, self.legs, self.upper)
        self.sole = tuple(min(getattr(leg.sole, side) for leg in self.legs) for side in ("length", "width"))
        self.leg_length = self._leg_length()
        self.imu, self.imu_line = find_imu(reduced, file, self.upper.torso)

    def derived(self) -> Derived:
        """The whole description."""
        straight, posture = self._postures()
        require_inertia(self.model, (posture, straight), self.reduced.notes)
        excluded = self._excluded([straight, posture])
        mjcf = robot_text(self._parts(excluded, looks=True))
        compiled(mjcf)
        com_height = self._com_height(posture)
        self._check_figure(com_height)
        description = self._description(mjcf, straight, posture, com_height, excluded)
        self._say(description, excluded)
        return Derived(description, tuple(self.lines), (*self.reduced.notes, *description.left_out))

    def _leg_length(self) -> float:
        """Hip centre to sole, the longer one of both straight legs [m]."""
        lengths = []
        for leg in self.legs:
            data = at(self.model, solved(self.model, leg, rest(self.model), 0.0))
            lengths.append(float(leg.hip[2] - (data.oMi[leg.chain[-1]] * leg.sole.placement).translation[2]))
        if min(lengths) <= 0.0:
            what = f"the soles of {self.file.name} are not below its hips with straight legs"
            raise RobotError(("model",), what, "z of the floating base must point up")
        return max(lengths)

    def _postures(self) -> tuple[Array, Array]:
        """Joint angles with straight legs, and in a mild crouch; the upper body alike in both [rad]."""
        base = self._upper_posture()
        straight, crouch = base.copy(), base.copy()
        for leg in self.legs:
            for angles, bend in ((straight, 0.0), (crouch, BEND)):
                angles[:] = solved(self.model, leg, angles, bend)
        names = names_of(self.model)
        for name, angle in self._given_posture().items():
            place = names.index(name)
            crouch[place] = angle
            if self.model.getJointId(name) not in {joint for leg in self.legs for joint in leg.joints}:
                straight[place] = angle
        return straight, crouch

    def _given_posture(self) -> dict[str, float]:
        """Angles that the file gives, by a state of the SRDF or by patterns."""
        posture, names = self.file.posture, names_of(self.model)
        if isinstance(posture, str):
            states = self.reduced.states
            if posture not in states:
                what = f"posture of {self.file.name} is '{posture}', which is no state of its SRDF"
                raise RobotError(("posture",), what, nearest(posture, tuple(states) or ("angles by pattern",)))
            return {name: angle for name, angle in states[posture].items() if name in names}
        given = matched(posture or {}, names, "posture", self.file.name)
        for name, angle in given.items():
            joint = names.index(name) + 7
            lower, upper = float(self.model.lowerPositionLimit[joint]), float(self.model.upperPositionLimit[joint])
            if not lower <= angle <= upper:
                what = f"posture of {self.file.name} has joint '{name}' at {angle:.6g} rad"
                raise RobotError(("posture", name), what, f"it must lie within {lower:.3f} and {upper:.3f} rad")
        return given

    def _upper_posture(self) -> Array:
        """Arms that hang, wide enough to be free of thighs and trunk."""
        posture, aside = rest(self.model), HANGING
        if not self.upper.arms:
            return posture
        near = _FREE * self.leg_length
        others = {1, self.upper.torso, *(leg.thigh for leg in self.legs)}
        arms = {joint for arm in self.upper.arms for joint in arm[2:]}
        hulls = {joint: hull for joint, hull in self.hulls.items() if joint in others | arms}
        text = robot_text(self._parts((), looks=False, hulls=hulls))
        bodies = {joint: self.reduced.bodies[joint - 1] for joint in hulls}
        parents = list(self.model.parents)
        fixed = {self.reduced.bodies[joint - 1] for joint in others}
        while True:
            found = hanging(self.model, self.upper, posture, aside)
            pairs = overlapping(text, [found], bodies, parents, near)
            if aside > _WIDEST or all((one in fixed) == (other in fixed) for one, other in pairs):
                return found
            aside += _WIDER

    def _parts(
        self, excluded: list[tuple[str, str]] | tuple[()], looks: bool, hulls: dict[int, Hull] | None = None
    ) -> Parts:
        nothing: tuple[tuple[()], ...] = ((),) * self.model.njoints
        return Parts(
            name=self.file.name,
            model=self.model,
            bodies=self.reduced.bodies,
            legs=self.legs,
            leg_length=self.leg_length,
            sole=(self.sole[0], self.sole[1]),
            height=self.leg_length - float(self.legs[0].hip[2]),
            hulls=self.hulls if hulls is None else hulls,
            looks=self._looks() if looks else nothing,
            excluded=excluded,
            couplings=self.reduced.couplings,
        )

    def _looks(self) -> list[list[Shape]]:
        """Shapes to draw, with as many triangles as a viewer needs; a shape that no engine draws is noted."""
        shapes = [(joint, shape) for joint, group in enumerate(self.reduced.visual) for shape in group]
        few = decimated([(shape.vertices, shape.faces) for _, shape in shapes])
        small = [(np.round(vertices, _ROUND) + 0.0, faces) for vertices, faces in few]
        looks: list[list[Shape]] = [[] for _ in range(self.model.njoints)]
        unmade = set[str]()
        for (joint, shape), part, sound in zip(shapes, small, taken(small, drawn=True), strict=True):
            if sound:
                looks[joint].append(Shape(shape.link, *part, shape.rgba))
            elif len(part[1]):
                unmade.add(shape.link)
        drawn = {shape.link for group in looks for shape in group}
        lost = unmade | ({shape.link for _, shape in shapes if len(shape.faces)} - drawn)
        if lost:
            what = ", ".join(sorted(lost))
            self.reduced.left_out.append(f"left out: what is drawn of {what}, which comes to too few triangles")
        return looks

    def _excluded(self, postures: list[Array]) -> list[tuple[str, str]]:
        bodies = {joint: self.reduced.bodies[joint - 1] for joint in self.hulls}
        text, parents = robot_text(self._parts((), looks=False)), list(self.model.parents)
        found = overlapping(text, postures, bodies, parents, _NEAR * self.leg_length)
        return list(dict.fromkeys((*found, *joined(bodies, parents))))

    def _com_height(self, posture: Array) -> float:
        """Height of the CoM over the soles in the posture [m]."""
        if self.file.com_height is not None:
            return self.file.com_height
        data, q = self.model.createData(), pin.neutral(self.model)
        q[7:] = posture
        com = pin.centerOfMass(self.model, data, q)
        leg = self.legs[0]
        return float(com[2] - (data.oMi[leg.chain[-1]] * leg.sole.placement).translation[2])

    def _check_figure(self, com_height: float) -> None:
        data, leg = at(self.model, rest(self.model)), self.legs[0]
        centre = max(float(np.linalg.norm(leg.sole.placement.translation)) for leg in self.legs)
        to_ankle = float(np.linalg.norm(leg.hip - data.oMi[leg.chain[-1]].translation))
        check_figure(self.file.name, self.leg_length, to_ankle, centre, (self.sole[0], self.sole[1]), com_height)

    def _meeting(self, excluded: list[tuple[str, str]]) -> list[tuple[int, int]]:
        """Limbs that can meet, but for those that overlap for good."""
        apart, bodies = {frozenset(pair) for pair in excluded}, self.reduced.bodies
        pairs = limbs(self.legs, self.upper, self.hulls)
        return [pair for pair in pairs if frozenset(bodies[joint - 1] for joint in pair) not in apart]

    def _roles(self, posture: Array) -> JointRoles:
        names = self.model.names
        swing = swings(self.model, self.upper, posture)
        left, right = self.legs
        return JointRoles(
            left_leg=tuple(names[joint] for joint in left.joints),
            right_leg=tuple(names[joint] for joint in right.joints),
            knees=(names[left.joints[left.knee]], names[right.joints[right.knee]]),
            waist=tuple(names[joint] for joint in self.upper.waist),
            arm_swing=None if swing is None else (names[swing[0][0]], names[swing[0][1]]),
            knee_bend=(left.bend, right.bend),
            arm_back=(1.0, 1.0) if swing is None else swing[1],
        )

    def _description(
        self, mjcf: str, straight: Array, posture: Array, com_height: float, excluded: list[tuple[str, str]]
    ) -> RobotDescription:
        model = self.model
        left, right = self.legs
        room = _CLEAR * self.leg_length / LEG_LENGTH
        return RobotDescription(
            name=self.file.name,
            mjcf=mjcf,
            mass=float(sum(inertia.mass for inertia in model.inertias)),
            joint_names=names_of(model),
            roles=self._roles(posture),
            torque_limit=fixed(model.upperEffortLimit[6:]),
            velocity_limit=fixed(model.upperVelocityLimit[6:]),
            position_lower=fixed(model.lowerPositionLimit[7:]),
            position_upper=fixed(model.upperPositionLimit[7:]),
            sole_sites=(SITES[1], SITES[2]),
            sole_length=self.sole[0],
            sole_width=self.sole[1],
            pelvis_body=self.reduced.bodies[0],
            torso_body=self.reduced.bodies[self.upper.torso - 1],
            imu_site=SITES[0],
            hip_width=float(np.linalg.norm(left.hip - right.hip)),
            leg_length=self.leg_length,
            shank_spacing=shank_spacing(at(model, straight), self.legs, self.hulls, room),
            nominal_joint_positions=fixed(posture),
            straight_joint_positions=fixed(straight),
            com_height=com_height,
            bodies=self._weighty(),
            kept_apart=kept_apart(self.reduced, self.file, self.hulls, self._meeting(excluded), self.legs),
            imu=self.imu,
            left_out=tuple(self.reduced.left_out),
            couplings=self.reduced.couplings,
        )

    def _weighty(self) -> tuple[str, ...]:
        """Names of the bodies with mass, base and torso among them: what stands between joints alone is no body."""
        named = {self.reduced.bodies[0], self.reduced.bodies[self.upper.torso - 1], self.imu.body}
        pairs = zip(self.reduced.bodies, list(self.model.inertias)[1:], strict=True)
        return tuple(name for name, inertia in pairs if name in named or inertia.mass > LEAST_MASS)

    def _say(self, robot: RobotDescription, excluded: list[tuple[str, str]]) -> None:
        """Note what was derived."""
        given = self.file.model_fields_set
        lines = self.lines
        left, right = self.legs
        lines.append(f"legs: {', '.join(robot.roles.left_leg)}; {', '.join(robot.roles.right_leg)}")
        lines.append(
            f"knees: {' and '.join(robot.roles.knees)}, straight at {left.straight:.3f} and {right.straight:.3f} rad, "
            f"bent by {'positive' if left.bend > 0 else 'negative'} angles on the left"
        )
        by = "as given" if "torso" in given else "which carries the arms" if self.upper.arms else "the heaviest body"
        lines.append(f"torso: {robot.torso_body}, {by}; waist: {', '.join(robot.roles.waist) or 'none'}")
        if self.upper.arms:
            swing = ", ".join(robot.roles.arm_swing or ()) or "none, no joint turns a whole arm about the lateral axis"
            lines.append(f"arm swing: {swing}")
        if robot.sole_width > robot.sole_length:
            self.reduced.notes.append(
                f"soles are wider ({robot.sole_width:.3f} m) than long ({robot.sole_length:.3f} m); check feet and "
                "forward, or give sole"
            )
        by = "as given" if "sole" in given else "the largest rectangle in the lowest face of the foot"
        lines.append(f"soles: {robot.sole_length:.3f} x {robot.sole_width:.3f} m, {by}")
        if robot.roles.feet_lean:
            lines.append("feet: no joint rolls them, so they lean with the shanks and stand on a side edge")
        lines.append(
            f"leg length: {robot.leg_length:.3f} m from hip centre to sole; hips {robot.hip_width:.3f} m apart"
        )
        by = "as given" if "com_height" in given else f"with knees bent by {BEND} rad"
        lines.append(f"com_height: {robot.com_height:.3f} m, {by}")
        lines.append(f"shank_spacing: {robot.shank_spacing:.3f} m, from the contact shapes of the shanks")
        lines.append(self.imu_line)
        if excluded:
            listed = ", ".join(f"{one} and {other}" for one, other in excluded)
            lines.append(f"may overlap, joined or since they do in the posture: {listed}")
