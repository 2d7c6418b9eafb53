"""Writes what every walk has, whatever its fidelity, and what the pendulum has in place of a body."""

import math
import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import Push
from surefoot.planner.geometry.orientation import roll_sole
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import POINT, PlanSample, in_point
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import GRAVITY, CentroidalState, FeetState, Foot, Footstep, SolverStatus
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.layout import Place, RowLayout
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import SUPPORT_VERTICES, Sizes
from surefoot.scenarios.record.provenance import BEGUN_RECORD, AskedPush

Array = NDArray[np.float64]


_POSITION, _VELOCITY = (slice(in_point(name).start, in_point(name).start + 3) for name in ("swing", "swing_velocity"))
_LEVEL, _RATES = in_point("swing"), in_point("swing_velocity")
_REFERENCE = {
    **{name: in_point(name) for name in ("com", "com_velocity", "com_acceleration", "zmp", "dcm", "zmp_reference")},
    "swing_position": _POSITION,
    "swing_velocity": _VELOCITY,
    "support": slice(POINT, POINT + 2 * SUPPORT_VERTICES),
}
"""Fields that the reference of a tick has of a sample of the plan, and their place in a point, before the support."""

_STATE = {
    "measured_com": "measured.com",
    "measured_com_velocity": "measured.com_velocity",
    "measured_zmp": "measured_zmp",
    "com": "given.com",
    "com_velocity": "given.com_velocity",
    "com_acceleration": "acceleration",
    "innovation": "innovation",
}
_PLAN = {
    **{name: name for name in ("com", "com_velocity", "zmp", "zmp_reference", "jerk", "omega")},
    "status": "status.solver",
    "infeasible": "status.infeasible",
    "falling": "status.falling",
    "step_shift": "balance.shift",
    "step_delay": "balance.delay",
}
"""Places of the fields of these channels in a planner's state and in a plan."""

_FOOTSTEPS = ("current_left", "current_right", "next", "next_foot", "touchdown_time")

_NO_FOOTSTEP = (math.nan,) * 4


TickTiming = tuple[float, float, float, float, float, float, float, float]
"""Wall-clock time of the parts of one control tick, and the controller's processor time, as the log has them [s]."""


@dataclass(frozen=True)
class PlannerState:
    """The CoM that the planner measured, and the one that it was given; world frame.

    Attributes:
        measured: CoM as measured.
        measured_zmp: ZMP as measured, shape (2,) [m].
        given: CoM as estimated, which the planner gets.
        acceleration: its estimated acceleration, which the planner does not get, since it keeps the one that it has
            planned; NaN without a filter, shape (2,) [m/s^2].
        innovation: normalised innovation squared of the filter, by axis; NaN without a filter, shape (2,) [-].
    """

    measured: CentroidalState
    measured_zmp: Array
    given: CentroidalState
    acceleration: Array
    innovation: Array


class RunRecorder:
    """The channels of every run: its clock, its commands, and footsteps taken.

    Args:
        writer: of the log.
        sizes: of the channels.
    """

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        self._footstep = writer.channel(channels.footstep(sizes))
        self._command = writer.channel(channels.command(sizes))
        timing = writer.channel(channels.timing(sizes))
        self._timing = writer.rows(RowLayout((), ((timing, [field.name for field in timing.spec.fields]),)))
        self._process = writer.channel(channels.process(sizes))
        self._writer, self._begun = writer, 0
        self._looked = -1

    def touchdown(self, time_ns: int, planned: Footstep, feet: FeetState) -> None:
        """A footstep taken: as last planned, and where the sole is."""
        foot = planned.foot
        actual = np.append(feet.position[foot], feet.yaw[foot])
        self._footstep.put(time_ns, index=planned.step, foot=int(foot), planned=_pose(planned), actual=actual)

    def begun(self, push: Push, live: bool) -> None:
        """A push that has waited for its point of the gait; ``live`` if it was once given by hand."""
        self._begun += 1
        self._writer.add_metadata(f"{BEGUN_RECORD}{self._begun}", AskedPush.of(push, live).to_metadata())

    def command(self, time_ns: int, orders: Command) -> None:
        """Log the commands to the walk from now on."""
        place = orders.places[-1] if orders.places else None
        numbers = ((math.nan,) * 3 if twist is None else twist[:3] for twist in (place, orders.twist, orders.followed))
        (*place_xy, heading), (*velocity, yaw_rate), (*followed, followed_rate) = numbers
        self._command.put(
            time_ns, orders, velocity=velocity, yaw_rate=yaw_rate, followed_velocity=followed,
            followed_yaw_rate=followed_rate, place=place_xy, heading=heading,
        )  # fmt: skip

    def timing(self, time_ns: int, timing: TickTiming) -> None:
        """Wall-clock times of the tick, and once a simulated second the state of the process."""
        state, build, solve, plan, physics, log, tick, busy = timing
        self._timing.append(
            time_ns,
            (1e6 * state, 1e6 * build, 1e6 * solve, 1e6 * plan, 1e6 * physics, 1e6 * log, 1e6 * tick, 1e6 * busy),
        )
        second = time_ns // 1_000_000_000
        if second != self._looked:
            self._looked = second
            self._process.append(time_ns, resident_memory())


class WalkRecorder(RunRecorder):
    """The channels of planner and clock."""

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        reference = writer.channel(channels.reference(sizes))
        at: dict[Place, slice] = {(reference.spec.topic, name): place for name, place in _REFERENCE.items()}
        numbers = ("omega", "roll", "phase", "stance", "step", "phase_time", "phase_duration", "support_count")
        vectors = ((reference, tuple(_REFERENCE)),)
        self._reference = writer.rows(RowLayout(vectors, ((reference, numbers),), at=at))
        self._state = writer.channel(channels.planner_state(sizes)).filler(_STATE)
        self._plan = writer.channel(channels.plan(sizes)).filler(_PLAN, ("slack", "held", "capture_margin"))
        self._footsteps = writer.channel(channels.footsteps(sizes)).filler({}, _FOOTSTEPS)
        super().__init__(writer, sizes)
        self._support = np.zeros(2 * SUPPORT_VERTICES)
        self._polygon = b""
        self._rolls = sizes.nj > 0  # the ideal feet of a point mass stay level

    def planner_state(self, time_ns: int, state: PlannerState) -> None:
        """Log what the planner measured and was given."""
        self._state(time_ns, state)

    def plan(self, time_ns: int, plan: WalkPlan) -> None:
        """A new plan with its horizon and footsteps."""
        status, balance = plan.status, plan.balance
        slack = max(status.zmp_slack.tolist()), max(status.terminal_slack.tolist())
        self._plan(time_ns, plan, slack, status.solver is SolverStatus.HELD, (balance.planned, balance.movable))
        ahead = [*plan.footsteps, *[None] * (3 - len(plan.footsteps))]
        self._footsteps(
            time_ns,
            None,
            _pose(plan.footholds[Foot.LEFT]),
            _pose(plan.footholds[Foot.RIGHT]),
            [_NO_FOOTSTEP if step is None else _pose(step) for step in ahead],
            [-1 if step is None else int(step.foot) for step in ahead],
            [math.nan if step is None else step.touchdown_time for step in ahead],
        )
        vertices = plan.support_polygon
        if (shown := vertices.tobytes()) != self._polygon:
            self._polygon = shown
            support = np.empty((SUPPORT_VERTICES, 2))
            support[: len(vertices)] = vertices
            support[len(vertices) :] = vertices[-1]
            self._support = support.ravel()  # a new one, since rows of the reference have kept the last

    def reference(self, time_ns: int, plan: WalkPlan, sample: PlanSample) -> None:
        """The reference of a control tick and the gait's clock; the swing foot's sole is where its roll takes it."""
        phase, point, pitches = plan.phase, sample.point, [0.0, 0.0]
        for roll in plan.rolls if self._rolls else ():
            pitch, rate, _ = roll.evaluate(sample.time)
            if not pitch:
                continue
            pitches[roll.foot] = pitch
            if roll.foot is sample.swing_foot:
                point = point.copy()
                roll_sole(point[_LEVEL], point[_RATES], roll.pivot, pitch, rate, point[_POSITION], point[_VELOCITY])
        numbers = (
            sample.omega, *pitches, phase.kind, -1 if phase.stance is None else phase.stance, phase.step,
            phase.elapsed + sample.time - plan.time, phase.duration, len(plan.support_polygon),
        )  # fmt: skip
        self._reference.append(time_ns, numbers, point, self._support)


def resident_memory() -> float:
    """Memory that the process holds now; NaN where the system does not tell [B]."""
    try:
        with open("/proc/self/statm", "rb") as file:  # noqa: PTH123  once a second, without a path's cost
            return float(int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
    except (OSError, ValueError, IndexError):
        return math.nan


def _pose(footstep: Footstep) -> tuple[float, ...]:
    return (*footstep.position.tolist(), footstep.yaw)


class PendulumRecorder:
    """The channels of the pendulum."""

    def __init__(self, writer: LogWriter, sizes: Sizes, mass: float) -> None:
        """Open its channels; ``mass`` of the pendulum [kg]."""
        self._mass = mass
        self._truth = writer.channel(channels.point_truth(sizes))
        self._contact = writer.channel(channels.contact(sizes))

    def state(self, time_ns: int, state: CentroidalState, feet: FeetState, force: Array) -> None:
        """True state of a control tick and the push that follows it, shape (2,) [N]."""
        left, right = (_level_pose(position, float(yaw)) for position, yaw in zip(feet.position, feet.yaw, strict=True))
        self._truth.put(time_ns, state, left_sole=left, right_sole=right, external_force=(*force, 0.0))

    def contact(self, time_ns: int, zmp: Array, sample: PlanSample, feet: FeetState) -> None:
        """Contacts and the ZMP, shape (2,) [m]; as centre of pressure only where one foot has all the load."""
        weight = self._mass * (GRAVITY + float(sample.com_acceleration[2]))
        contacts, share = sample.contacts, sample.load_left
        height = share * feet.position[0, 2] + (1.0 - share) * feet.position[1, 2]
        cops = [(math.nan, math.nan), (math.nan, math.nan)]
        if not all(contacts):
            foot = int(contacts[1])
            cops[foot] = tuple((zmp - feet.position[foot, :2]) @ frame_rotation(float(feet.yaw[foot])))
        self._contact.put(
            time_ns, zmp=(*zmp, height), normal_force=(share * weight, (1.0 - share) * weight), planned=contacts,
            active=contacts, edge=(0, 0), felt=contacts, cop_left=cops[0], cop_right=cops[1],
        )  # fmt: skip


def _level_pose(position: Array, yaw: float) -> tuple[float, ...]:
    return (*position.tolist(), 0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw))
