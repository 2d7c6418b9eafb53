"""Values that cross the planner's boundary. World frame, SI units; arrays are float64."""

import math
from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import ExternalLoad
from surefoot.similarity import GRAVITY as GRAVITY

Array = NDArray[np.float64]


class Foot(IntEnum):
    """A foot, left or right; the value indexes every (2, ...) array of feet."""

    LEFT = 0
    RIGHT = 1

    @property
    def other(self) -> "Foot":
        """The opposite foot."""
        return Foot.RIGHT if self is Foot.LEFT else Foot.LEFT

    @property
    def side(self) -> float:
        """+1 for the left foot, -1 for the right one [-]: which way is outward, to the left counted positive."""
        return 1.0 - 2.0 * self


class Edge(IntEnum):
    """The part of a sole that is in contact: all of it, or a line; the value tells which way ahead of the centre."""

    HEEL = -1
    SOLE = 0
    TOE = 1


class PhaseKind(IntEnum):
    """Support phase."""

    STAND = 0
    DOUBLE = 1
    SINGLE = 2


@dataclass(frozen=True)
class Footstep:
    """A foothold: where a foot stands, stood, or is to land.

    It is given in the world frame. Seen from its stance foot (`planner.geometry.plane.seen_from`) it is in the frame
    of that foothold: x is how far ahead it is, y how far to the left, yaw how far it is turned.

    Attributes:
        foot: the foot that stands here.
        position: sole centre, shape (3,) [m].
        yaw: heading of the sole about the vertical [rad].
        normal: unit normal of the ground that the sole lies flat on, shape (3,) [-].
        step: its number in the walk, from 1, in a plan; else 0.
        touchdown_time: when it lands by the phase clock, in a plan; else NaN [s].
    """

    foot: Foot
    position: Array
    yaw: float
    normal: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    step: int = 0
    touchdown_time: float = math.nan

    @property
    def beside(self) -> float:
        """Distance of a foot seen from its stance foot to its own side, negative where the legs cross [m]."""
        return self.foot.side * float(self.position[1])


class Twist(NamedTuple):
    """A planar velocity, or a planar way: of a path in a second, in one step, or from the world's origin to a place.

    A velocity is given in the frame of the path's heading. The way of a step, its stride, is given in the frame midway
    between the old and the new heading. The foot lands half a `width` beside the path's new point. So a stride of zeros
    brings it beside the other foot. A place is given in the world frame.

    Attributes:
        x: forward [m/s], of a way [m].
        y: to the left [m/s], of a way [m].
        yaw: of the heading, positive to the left [rad/s], of a way [rad].
        width: of a stride, lateral distance of the two feet from each other about the path [m].
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    width: float = 0.0

    @property
    def is_zero(self) -> bool:
        """Return true if it asks to stand."""
        return self.x == 0.0 and self.y == 0.0 and self.yaw == 0.0

    @property
    def velocity(self) -> dict[str, float]:
        """Its numbers by the names that a velocity has in commands and logs [m/s, rad/s]."""
        return {"v_x": self.x, "v_y": self.y, "yaw_rate": self.yaw}

    def scaled(self, factor: float) -> "Twist":
        """The same direction, so many times [-] as fast or far."""
        return Twist(factor * self.x, factor * self.y, factor * self.yaw, self.width)

    def stride(self, duration: float, width: float) -> "Twist":
        """The stride that follows this velocity exactly for a time [s], along its arc."""
        turn = self.yaw * duration
        chord = duration * float(np.sinc(0.5 * turn / math.pi))
        return Twist(chord * self.x, chord * self.y, turn, width)

    @property
    def advance(self) -> tuple[float, float]:
        """Advance of the path by a stride in the frame of its old heading, forward and to the left [m]."""
        c, s = math.cos(0.5 * self.yaw), math.sin(0.5 * self.yaw)
        return c * self.x - s * self.y, s * self.x + c * self.y

    def landing(self, foot: Foot) -> Footstep:
        """Landing place of a foot that makes this stride, seen from its stance foot on level ground."""
        side, half = foot.side, 0.5 * self.width
        forward, left = self.advance
        ahead = forward - side * half * math.sin(self.yaw)
        beside = side * left + half * (1.0 + math.cos(self.yaw))
        return Footstep(foot, np.array([ahead, side * beside, 0.0]), self.yaw)


@dataclass(frozen=True)
class CentroidalState:
    """The state of the body that the planner is given at one instant.

    Attributes:
        time: instant [s].
        com: CoM position, shape (3,) [m].
        com_velocity: CoM velocity, shape (3,) [m/s].
        lasting: force that goes on acting on it, per mass (`ExternalLoad.per_mass`); None for none.
        deviation: standard deviations of the CoM's horizontal position and velocity, zero for the truth [m, m/s].
    """

    time: float
    com: Array
    com_velocity: Array
    lasting: ExternalLoad | None = None
    deviation: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class FeetState:
    """The state of the feet that the planner is given at one instant.

    Attributes:
        position: sole centres in the world frame, shape (2, 3) [m], left first.
        yaw: sole headings, shape (2,) [rad].
        contact: which feet feel the ground, (left, right).
        height_deviation: standard deviation of the height of one sole over the other, zero for the truth [m].
        arriving: which feet come to the ground in so short a time that they may be taken as landed, (left, right).
    """

    position: Array
    yaw: Array
    contact: tuple[bool, bool]
    height_deviation: float = 0.0
    arriving: tuple[bool, bool] = (False, False)


class SolverStatus(IntEnum):
    """The origin of the jerk of a plan; higher is worse."""

    SOLVED = 0
    """The first solver solved both axes."""
    SECOND_SOLVER = 1
    """The first solver failed on an axis and the second one solved it."""
    HELD = 2
    """Both solvers failed on an axis: its previous jerk sequence was shifted and kept."""


@dataclass(frozen=True)
class PlanStatus:
    """The status of a plan.

    Attributes:
        solver: the worse status of the two axes.
        zmp_slack: violation of the ZMP box that the optimum accepts, shape (2,) for the plan frame's axes [m].
        terminal_slack: violation of the terminal DCM bound, shape (2,) [m].
        infeasible: the profile's hard constraints had no solution; it was softened by the slack given here.
        age: number of ticks since the last plan in which both axes were solved; 0 for a fresh one.
        late_touchdown: ticks for which the phase clock has waited for the touchdown.
        early_touchdown: the swing foot has landed before its time; its foothold is fixed, single support goes on.
        falling: no step will save the body any more, as far as the planner can tell; see
            `planner.recovery.falling.falling`.
        acted: names of the rules of recovery that made something of the steps to come, in their order.
    """

    solver: SolverStatus
    zmp_slack: Array
    terminal_slack: Array
    infeasible: bool
    age: int
    late_touchdown: int
    early_touchdown: bool
    falling: bool = False
    acted: tuple[str, ...] = ()


@dataclass(frozen=True)
class Balance:
    """The margins that are left to the body, and the use that a plan makes of them; NaN from a planner without them.

    Attributes:
        planned: how far the DCM is inside what the CoP alone captures, all steps where and when they are planned, or
            inside the support where none is to come; negative outside, by the worse axis [m].
        movable: the same where the steps to come may be moved as far as legs, and what may be adapted, let them [m].
        shift: by how much the next landing is moved from where it nominally is, world frame, shape (2,) [m].
        delay: how much later than nominally it is made to come [s].
        lost: plans on end, this one among them, whose DCM is farther outside `movable` than that of a robot that can be
            saved.
        catching: place or time of the next landing are being adapted, but on stairs and blocks.
        safe: while a fall is announced: plans on end, this one among them, whose `movable` is not negative.
    """

    planned: float = math.nan
    movable: float = math.nan
    shift: Array = field(default_factory=lambda: np.full(2, math.nan))
    delay: float = math.nan
    lost: int = 0
    catching: bool = False
    safe: int = 0


@dataclass(frozen=True)
class PhaseInfo:
    """The place of a plan in the gait.

    Attributes:
        kind: support phase.
        stance: the supporting foot in single support, otherwise None.
        step: number of the step being swung (single support) or last landed (otherwise); 0 before the first.
        elapsed: time since the phase began, without the time for which the clock waited [s].
        duration: length of the phase, infinite for the final standing [s].
        leads_to: number of the step being swung, or whose foot leaves the ground at its end; 0 for none.
        left: time until it ends, which is not what its duration leaves while the clock hurries or slows down [s].
    """

    kind: PhaseKind
    stance: Foot | None
    step: int
    elapsed: float
    duration: float
    leads_to: int
    left: float

    @property
    def landed(self) -> int:
        """Number of the step that landed last, 0 before the first."""
        return self.step - (self.kind is PhaseKind.SINGLE)
