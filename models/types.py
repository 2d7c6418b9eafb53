"""A robot for the rest of the stack: one MJCF text and the numbers that were written into it."""

import difflib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surefoot.errors import ParameterError

Array = NDArray[np.float64]


def fixed(values: ArrayLike) -> Array:
    """A read-only copy."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


class RobotError(ParameterError):
    """A robot was asked for in a way that it cannot have, or a description contradicts itself.

    The key is an option's name, or the fields of `RobotDescription` down to the fault. Whatever stood in a file, the
    sentence is one line.
    """

    def __init__(self, key: Iterable[str | int], what: str, right: str) -> None:
        super().__init__(key, _one_line(what), _one_line(right))


class UnknownRobotError(LookupError):
    """No robot has that name."""


LONGEST = 1000
"""Characters of half a sentence."""


def _one_line(text: str) -> str:
    shown = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text[: LONGEST + 1])
    return shown if len(text) <= LONGEST else f"{shown[:LONGEST]}..."


def nearest(name: str, valid: Sequence[str]) -> str:
    """A hint for an unknown name: the nearest valid one, or all of them."""
    close = difflib.get_close_matches(name, valid, n=1)
    return f"did you mean '{close[0]}'?" if close else f"choose from {', '.join(valid)}"


@dataclass(frozen=True, slots=True)
class RobotOptions:
    """Choices that every robot offers.

    Attributes:
        foot_length: sole length [m]; None keeps the robot's own.
        foot_width: sole width [m]; None keeps the robot's own.
        payload_mass: point mass fixed at the CoM of `payload_body` [kg].
        payload_body: body that carries the payload; None is the torso.
    """

    foot_length: float | None = None
    foot_width: float | None = None
    payload_mass: float = 0.0
    payload_body: str | None = None


WITHOUT_ROLL = 5
"""Joints of a leg that can put its foot anywhere, but for how it rolls."""


@dataclass(frozen=True, slots=True)
class JointRoles:
    """The roles of the joints, by name, so that nobody guesses them from how they are called.

    Attributes:
        left_leg: from the hip to the ankle, in the order of the chain.
        right_leg: from the hip to the ankle, in the order of the chain.
        knees: left and right.
        waist: between pelvis and torso, in the order of the chain.
        arm_swing: left and right joint that swings the arm; None without such arms.
        knee_bend: sign of the angles that bend the left and the right knee [-].
        arm_back: sign of the angles that swing the left and the right arm back [-].
    """

    left_leg: tuple[str, ...]
    right_leg: tuple[str, ...]
    knees: tuple[str, str]
    waist: tuple[str, ...] = ()
    arm_swing: tuple[str, str] | None = None
    knee_bend: tuple[float, float] = (1.0, 1.0)
    arm_back: tuple[float, float] = (1.0, 1.0)

    @property
    def feet_lean(self) -> bool:
        """True if no joint rolls the feet, which then lean sideways with the shanks."""
        return len(self.left_leg) == WITHOUT_ROLL

    @property
    def legs(self) -> tuple[str, ...]:
        """Joints of the left leg, then of the right one."""
        return self.left_leg + self.right_leg


@dataclass(frozen=True, slots=True)
class ImuPlace:
    """The place of a robot's IMU; the default is the frame of the floating base itself.

    Attributes:
        body: that carries it, None for the floating base.
        position: of its origin in the frame of that body [m].
        quaternion: of its axes in the frame of that body, w x y z.
    """

    body: str | None = None
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Coupling:
    """A joint without a motor that turns with another one, as the second of a knee whose bones roll on each other.

    Attributes:
        follower: it.
        leader: joint with a motor that moves both.
        ratio: angle of the follower for that of the leader, not 0 [-].
        offset: angle of the follower where that of the leader is 0 [rad].
    """

    follower: str
    leader: str
    ratio: float
    offset: float = 0.0


_OF_JOINTS = (
    "torque_limit",
    "velocity_limit",
    "position_lower",
    "position_upper",
    "nominal_joint_positions",
    "straight_joint_positions",
)


@dataclass(frozen=True, slots=True, eq=False)
class RobotDescription:
    """A robot, complete: `mjcf` is read by MuJoCo and by Pinocchio, the rest repeats facts of that text.

    Joints are revolute, one motor each, in the order of the MJCF, which is the order of both engines. What follows them
    by a coupling has no place in the arrays. Arrays are read-only.

    Raises:
        RobotError: a name or a shape does not fit the others.

    Attributes:
        name: name in the registry.
        mjcf: XML of the robot alone: free joint, explicit inertials, motors, sole and IMU sites, materials.
        mass: total mass with the payload [kg].
        joint_names: actuated joints, length nj.
        roles: what the joints are for.
        torque_limit: peak joint torque, shape (nj,) [N m].
        velocity_limit: no-load joint speed, shape (nj,) [rad/s].
        position_lower: lower joint limits, shape (nj,) [rad].
        position_upper: upper joint limits, shape (nj,) [rad].
        sole_sites: site at the centre of the bottom face of the left and of the right sole; x forward, z up.
        sole_length: sole size along x [m].
        sole_width: sole size along y [m].
        pelvis_body: the floating base.
        torso_body: body whose uprightness is controlled.
        imu_site: site in the frame of the floating base, in which gyro and accelerometer are measured exactly.
        hip_width: distance between the hip centres [m].
        leg_length: hip centre to sole with a straight leg [m].
        shank_spacing: lateral distance of the sole centres at which upright shanks keep a centimetre apart; soles may
            be narrower [m].
        nominal_joint_positions: mild crouch with relaxed arms, the start of an IK, shape (nj,) [rad].
        straight_joint_positions: straight legs on level soles under the hips, arms hanging, shape (nj,) [rad].
        com_height: nominal CoM height above the soles in walking [m].
        bodies: all body names.
        kept_apart: pairs of named contact shapes of different limbs that the controller keeps apart.
        imu: where its own IMU is, whose readings an estimator gets.
        left_out: parts of its model that this description has not, one line each; the verdict of each run tells them.
        couplings: joints of the text that follow others, by an equality there; torque and speed limits, ranges and
            rotors of a leader are those of all that it moves.
    """

    name: str
    mjcf: str
    mass: float
    joint_names: tuple[str, ...]
    roles: JointRoles
    torque_limit: Array
    velocity_limit: Array
    position_lower: Array
    position_upper: Array
    sole_sites: tuple[str, str]
    sole_length: float
    sole_width: float
    pelvis_body: str
    torso_body: str
    imu_site: str
    hip_width: float
    leg_length: float
    shank_spacing: float
    nominal_joint_positions: Array
    straight_joint_positions: Array
    com_height: float
    bodies: tuple[str, ...]
    kept_apart: tuple[tuple[str, str], ...]
    imu: ImuPlace = ImuPlace()
    left_out: tuple[str, ...] = ()
    couplings: tuple[Coupling, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what contradicts itself."""
        self._check_joint_arrays()
        for field in ("pelvis_body", "torso_body"):
            self._check_names((field,), (getattr(self, field),), self.bodies, "body")
        if self.imu.body is not None:
            self._check_names(("imu", "body"), (self.imu.body,), self.bodies, "body")
        self._check_roles()
        self._check_couplings()
        if not 0.0 < self.shank_spacing < np.inf:
            what = f"shank_spacing of {self.name} is {self.shank_spacing:.6g} m"
            raise RobotError(("shank_spacing",), what, "it must be a positive distance")

    def joint_indices(self, names: Iterable[str]) -> tuple[int, ...]:
        """Places of joints in the order of the joints, as those of a role."""
        return tuple(self.joint_names.index(name) for name in names)

    def _check_joint_arrays(self) -> None:
        for name in _OF_JOINTS:
            values = np.asarray(getattr(self, name))
            if values.shape != (len(self.joint_names),):
                what = f"{name} of {self.name} has the shape {values.shape}"
                raise RobotError((name,), what, f"it must have one number for each of {len(self.joint_names)} joints")
            self._refuse(name, ~np.isfinite(values), "must be a finite number")
        for name in ("torque_limit", "velocity_limit"):
            self._refuse(name, getattr(self, name) <= 0.0, "must be positive")
        self._refuse("position_upper", self.position_upper <= self.position_lower, "must exceed position_lower")

    def _refuse(self, name: str, wrong: NDArray[np.bool_], rule: str) -> None:
        """Refuse the value of the first wrong joint of an array."""
        if wrong.any():
            joint = int(np.argmax(wrong))
            what = f"{name} of joint '{self.joint_names[joint]}' of {self.name} is {getattr(self, name)[joint]:.6g}"
            raise RobotError((name, joint), what, f"it {rule}")

    def _check_roles(self) -> None:
        roles = self.roles
        for role in ("left_leg", "right_leg", "knees", "waist", "arm_swing"):
            self._check_names(("roles", role), getattr(roles, role) or (), self.joint_names, "joint")
        if len(set(roles.legs)) != len(roles.legs):
            raise RobotError(("roles",), f"a joint of {self.name} is twice in the legs", "it must be in one place")
        for knee, leg in zip(roles.knees, (roles.left_leg, roles.right_leg), strict=True):
            if knee not in leg[1:-1]:
                what = f"knee '{knee}' of {self.name} is not inside its leg {', '.join(leg)}"
                raise RobotError(("roles", "knees"), what, "it must have joints of the leg above and below it")

    def _check_couplings(self) -> None:
        for number, one in enumerate(self.couplings):
            self._check_names(("couplings", str(number), "leader"), (one.leader,), self.joint_names, "joint")
            if one.follower in self.joint_names or not 0.0 < abs(one.ratio) < np.inf or not np.isfinite(one.offset):
                law = f"{one.ratio:.6g} times '{one.leader}' and {one.offset:.6g}"
                what = f"'{one.follower}' of {self.name} follows by {law}"
                raise RobotError(("couplings", number), what, "it must have no motor, and a finite ratio other than 0")

    def _check_names(self, key: tuple[str, ...], names: tuple[str, ...], valid: tuple[str, ...], kind: str) -> None:
        for name in names:
            if name not in valid:
                what = f"{'.'.join(key)} of {self.name} names '{name}', which is no {kind} of it"
                raise RobotError(key, what, nearest(name, valid))


def same_robot(one: RobotDescription, other: RobotDescription) -> bool:
    """Return true if two descriptions say the same."""
    pairs = ((getattr(one, field.name), getattr(other, field.name)) for field in fields(one))
    return one is other or all(np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b for a, b in pairs)


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot as other packages bring it, by an entry point of its name in the group `surefoot.robots`.

    Attributes:
        name: of the entry point, and of every description.
        build: description with the chosen options; raises `RobotError` for those that it cannot have.
    """

    name: str
    build: Callable[[RobotOptions], RobotDescription]


@dataclass(frozen=True, slots=True)
class Explanation:
    """A robot, and how its description came to be.

    Attributes:
        description: the robot.
        derived: what was derived and from what, one line each.
        notes: what was altered or left out, or is to be known, one line each.
    """

    description: RobotDescription
    derived: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
