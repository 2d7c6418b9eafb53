"""One tour: the harness around a controller, and what is written down of it."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import PartError
from surefoot.joints import JointCommand, Servo
from surefoot.planner.geometry.plane import wrap_angle
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.run.planning import RunFault
from surefoot.studies.tour.draws import DRAWS, Steps
from surefoot.studies.tour.robot import ARM_JOINTS, TourRobot, arms_of, tour_robot
from surefoot.studies.tour.rules import DURATION, LOWEST, SLOT, ArmWalk, Punch, Tour
from surefoot.studies.tour.walker import Entrant, Goal
from surefoot.studies.tour.world import RATE, TourWorld

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PunchTaken:
    """The state at the beginning of a punch, and its result.

    Attributes:
        time: of its beginning [s].
        joint: name of the joint whose link it hit.
        impulse: over the robot's mass [N·s/kg].
        level: its level part alone [N·s/kg].
        direction: in the frame of the pelvis' heading: forward, left, up, of length 1.
        phase: double or single.
        stance: left or right in single support, else none.
        fraction: elapsed share of the phase [-].
        survived: whether the robot had not fallen when the next one came, or the tour was over.
    """

    time: float
    joint: str
    impulse: float
    level: float
    direction: tuple[float, float, float]
    phase: str
    stance: str
    fraction: float
    survived: bool


@dataclass(frozen=True, slots=True)
class TourResult:
    """The result of a tour.

    Attributes:
        row: whose it was.
        seed: of the tour.
        survival: until the fall, or of the whole tour [s].
        completed: whether there was none.
        position_errors: distance from each place when its time was over [m].
        heading_errors: difference from the heading of each place when its time was over [rad].
        energy: magnitude of the joints' power over the slots that were brought to their end, each [J].
        punches: in order; the one that came last before a fall was not survived.
        fault: what ended the controller's work, in words; else empty.
        unsolved: control ticks before the fall whose QP had no solution [-].
        warned: how long before the fall the planner was sure of it; None where it never was [s].
        left_over: distance from the place [m] and from its heading [rad] at the fall; None where there was none.
    """

    row: str
    seed: int
    survival: float
    completed: bool
    position_errors: tuple[float, ...]
    heading_errors: tuple[float, ...]
    energy: tuple[float, ...]
    punches: tuple[PunchTaken, ...]
    fault: str
    unsolved: int
    warned: float | None
    left_over: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Setting:
    """Beginning of a tour, and the origin of its random numbers.

    Attributes:
        start: on the ``feet``, or on the ``crane`` of the benchmark, which lets go.
        draws: of Surefoot's ``own`` streams, or of those of the ``benchmark``.
        punched: whether there are punches.
    """

    start: str = "feet"
    draws: str = "own"
    punched: bool = True


OWN = Setting()
STARTS = ("feet", "crane")

HUNG = 3.0
"""Time for which the crane holds the robot [s]."""


class Ride:
    """A tour that goes on control tick by control tick.

    Args:
        entrant: that takes part.
        seed: of the tour.
        setting: how it begins, and what draws it.
        tour: places and punches in place of those of the seed.

    Attributes:
        tour: places and punches.
        world: that is simulated.
        walker: in its seat.
    """

    def __init__(self, entrant: Entrant, seed: int, setting: Setting = OWN, tour: Tour | None = None) -> None:
        self.entrant, robot = entrant, tour_robot()
        self.walker, draws = entrant.walker(), DRAWS[setting.draws]
        description = self.walker.robot
        self._names, self._mass = description.joint_names, float(description.mass)
        self.world, self.tour = TourWorld(description, robot), tour or draws.tour(seed, len(self._names))
        if not setting.punched:
            self.tour = replace(self.tour, punches=())
        steps = draws.arm_steps(seed)
        self._arms = Arms(robot, self.world, self._names, steps) if entrant.drives_arms else None
        {"feet": self._stand, "crane": self._hang}[setting.start]()
        self._anchor = (*self.world.pelvis[:2].tolist(), self.world.heading)
        self._punches: list[PunchTaken] = []
        self._errors: list[tuple[float, float]] = []
        self._energy: list[float] = []
        self._fault, self._unsolved, self._warned = "", 0, math.nan
        self._tick = 0

    def _stand(self) -> None:
        """Begin on the feet, in the posture of the walker."""
        q = self.walker.posture.copy()
        if self._arms is not None:
            q[7:][self._arms.joints] = self._arms.start
        self.world.reset(q)
        self.walker.reset(q)

    def _hang(self) -> None:
        """Hang on the crane, and be let go; the walker begins where its feet will be on the ground."""
        robot, world = tour_robot(), self.world
        q = np.zeros(7 + len(self._names))
        q[2], q[6] = robot.crane_height, 1.0
        for number, name in enumerate(self._names):
            ends = [angle for end, angle in robot.leg_stance.items() if name.endswith(end)]
            q[7 + number] = ends[0] if ends else 0.0
        arms = self._arms or Arms(robot, world, self._names, lambda joints: np.zeros((1, joints)))
        q[7:][arms.joints] = arms.start
        gains = np.array([robot.drive_gains(float(armature)) for armature in world.model.dof_armature[6:]])
        still = np.zeros(len(self._names))
        hung = world.hang(q, JointCommand(still, Servo(q[7:].copy(), still, *gains.T)), HUNG)
        hung[2] -= world.lowest()
        self.walker.reset(hung)

    def run(self, duration: float = DURATION) -> TourResult:
        """Go on until the robot falls, or so long [s]."""
        rate = self.entrant.rate
        ticks = round(duration * rate)
        while self._tick < ticks and self.world.pelvis[2] >= LOWEST:
            self.step()
        time, fell = self._tick / rate, bool(self.world.pelvis[2] < LOWEST)
        if not fell:
            self._close_slots(time)
        if fell and self._punches:
            self._punches[-1] = replace(self._punches[-1], survived=False)
        return TourResult(
            row=self.entrant.name,
            seed=self.tour.seed,
            survival=time,
            completed=not fell,
            position_errors=tuple(position for position, _ in self._errors),
            heading_errors=tuple(heading for _, heading in self._errors),
            energy=tuple(self._energy),
            punches=tuple(self._punches),
            fault=self._fault,
            unsolved=self._unsolved,
            warned=time - self._warned if fell and math.isfinite(self._warned) else None,
            left_over=self._error(time) if fell else None,
        )

    def step(self) -> None:
        """Go through one tick of the walker's clock."""
        rate = self.entrant.rate
        time = self._tick / rate
        self._close_slots(time)
        arms = None if self._arms is None else self._arms.command(time)
        command = self._controlled(time, arms)
        for k in range(RATE // rate):
            punch = self.tour.punch(time + k / RATE)
            if punch is not None and len(self._punches) <= self.tour.slot(time):
                self._punches.append(self._described(punch))
            self.world.advance(command, 1.0 / RATE, punch)
        self._tick += 1

    def _controlled(self, time: float, arms: JointCommand | None) -> JointCommand:
        """Command of the joints; nothing but damping once the walker has given up."""
        if self._fault:
            return JointCommand(-self.world.data.qvel[6:].copy())
        walker = self.walker
        try:
            command = walker.step(self.world, Goal(self.tour.slot(time), *self._way(time)), arms)
        except (RunFault, PartError) as fault:
            self._fault = str(fault)
            return JointCommand(np.zeros(len(self._names)))
        self._unsolved += walker.unsolved
        if not walker.falling:
            self._warned = math.nan
        elif math.isnan(self._warned):
            self._warned = time
        return command if arms is None or self._arms is None else command.with_joints(self._arms.joints, arms)

    def _place(self, time: float) -> tuple[float, float, float]:
        """Place to go to at an instant, in the world [m, m, rad]."""
        x, y, yaw = self.tour.places[self.tour.slot(time)].tolist()
        x0, y0, yaw0 = self._anchor
        cos, sin = math.cos(yaw0), math.sin(yaw0)
        return x0 + cos * x - sin * y, y0 + sin * x + cos * y, yaw0 + yaw

    def _way(self, time: float) -> tuple[tuple[float, float], float]:
        """Way to that place, in the frame of the pelvis' heading [m], and to its heading [rad]."""
        x, y, yaw = self._place(time)
        dx, dy = (np.array([x, y]) - self.world.pelvis[:2]).tolist()
        heading = self.world.heading
        cos, sin = math.cos(heading), math.sin(heading)
        return (cos * dx + sin * dy, cos * dy - sin * dx), float(wrap_angle(yaw - heading))

    def _close_slots(self, time: float) -> None:
        """Write down how far from its place the robot is when a slot is over."""
        ended = int((time + 1e-6) / SLOT)
        if ended > len(self._errors):
            self._errors.append(self._error((len(self._errors) + 0.5) * SLOT))
            self._energy.append(float(self.world.energy.sum()) - sum(self._energy))

    def _error(self, time: float) -> tuple[float, float]:
        """Distance from the place of an instant [m], and from its heading [rad]."""
        (x, y), turn = self._way(time)
        return math.hypot(x, y), abs(turn)

    def _described(self, punch: Punch) -> PunchTaken:
        """The state as a punch begins, which counts as survived until the robot falls."""
        heading, phase = self.world.heading, self.walker.gait
        cos, sin = math.cos(heading), math.sin(heading)
        x, y, z = self.world.direction(punch).tolist()
        impulse, single = punch.impulse / self._mass, phase.kind is PhaseKind.SINGLE
        fraction = phase.elapsed / phase.duration if math.isfinite(phase.duration) else 0.0
        return PunchTaken(
            time=punch.time,
            joint=self._names[punch.joint],
            impulse=impulse,
            level=impulse * math.hypot(x, y),
            direction=(cos * x + sin * y, cos * y - sin * x, z),
            phase="single" if single else "double",
            stance=phase.stance.name.lower() if single and phase.stance is not None else "none",
            fraction=min(max(fraction, 0.0), 1.0),
            survived=True,
        )


class Arms:
    """Drives the arms as the harness does."""

    def __init__(self, robot: TourRobot, world: TourWorld, names: tuple[str, ...], steps: Steps) -> None:
        arm = arms_of(names)
        left, right = (np.flatnonzero(arm & [name.startswith(side) for name in names]) for side in ("left", "right"))
        assert len(left) == len(right) == ARM_JOINTS
        self.joints, self._left, self._right = arm, left, right
        self._mirror = np.array(robot.arm_mirror)
        model = world.model
        gains = np.array([robot.drive_gains(float(armature)) for armature in model.dof_armature[6:]])
        self._stiffness, self._damping = np.where(arm, gains[:, 0], 0.0), np.where(arm, gains[:, 1], 0.0)
        stance = np.array(robot.arm_stance)
        self._target = np.zeros(len(names))
        lower, upper = model.jnt_range[1:][left].T
        self._walk = ArmWalk(steps, stance, lower, upper, world.hands_allowed(robot, left, right))
        self.start = self._both(stance)[arm]

    def _both(self, left: Array) -> Array:
        self._target[self._left], self._target[self._right] = left, self._mirror * left
        return self._target.copy()

    def command(self, time: float) -> JointCommand:
        """Command of the arms at an instant [s]."""
        target = self._both(self._walk.angles(time))
        still = np.zeros_like(target)
        return JointCommand(still, Servo(target, still, self._stiffness, self._damping))


def run_tour(entrant: Entrant, seed: int, duration: float = DURATION, setting: Setting = OWN) -> TourResult:
    """A tour from its beginning.

    Args:
        entrant: that takes part.
        seed: of the tour.
        duration: after which it is over, shorter than a whole one in tests [s].
        setting: how it begins, and what draws it.
    """
    return Ride(entrant, seed, setting).run(duration)
