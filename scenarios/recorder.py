"""Writes what crosses the boundaries of one run into the log's channels, in the order that the channels declare."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.plan import WalkPlan
from planner.sampling import PlanSample
from planner.types import Foot, Footstep, PlannedFootstep, SolverStatus
from scenarios.log import LogWriter, channels
from scenarios.log.channels import SUPPORT_VERTICES, Sizes
from sim.measurement import Measurement
from wbc.model import RobotTerms
from wbc.types import SolveStatus, WbcReference, WbcReport
from wbc.zmp import centre_of_pressure, measured_zmp

Array = NDArray[np.float64]

_NO_FOOTSTEP = np.full(4, np.nan)


@dataclass(frozen=True, slots=True)
class TickTiming:
    """Wall-clock time of the parts of one control tick [s]."""

    state: float
    wbc_build: float
    wbc_solve: float
    planner: float
    physics: float
    log: float
    tick: float


class Recorder:
    """The channels of one run."""

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        """Open all channels; ``torque_limit`` of the joints, shape (nj,) [N·m]."""
        self._torque_limit = torque_limit
        self._measurement = writer.channel(channels.measurement(sizes))
        self._truth = writer.channel(channels.truth(sizes))
        self._estimate = writer.channel(channels.estimate(sizes))
        self._contact = writer.channel(channels.contact(sizes))
        self._reference = writer.channel(channels.reference(sizes))
        self._plan = writer.channel(channels.plan(sizes))
        self._footsteps = writer.channel(channels.footsteps(sizes))
        self._footstep = writer.channel(channels.footstep(sizes))
        self._wbc = writer.channel(channels.wbc(sizes))
        self._torque = writer.channel(channels.torque(sizes))
        self._timing = writer.channel(channels.timing(sizes))
        self._support = np.zeros((SUPPORT_VERTICES, 2))

    def body(self, time_ns: int, measurement: Measurement, terms: RobotTerms) -> None:
        """Sensors and true state of a control tick; ``terms`` are those of the true state."""
        m = measurement
        self._measurement.append(
            time_ns, m.joint_position, m.joint_velocity, m.joint_torque, m.gyro, m.accelerometer,
            m.wrench[0], m.wrench[1], m.external_force,
        )  # fmt: skip
        self._truth.append(
            time_ns, m.q, m.v, terms.com, terms.com_velocity, terms.angular_momentum,
            terms.sole_pose[0], terms.sole_pose[1], math.acos(min(1.0, terms.torso_rotation[2, 2])), m.nonfoot_contact,
        )  # fmt: skip

    def estimate(self, time_ns: int, terms: RobotTerms, q: Array, v: Array, omega: float) -> None:
        """State that planner and controller were given, with the DCM that ω makes of it."""
        dcm = terms.com[:2] + terms.com_velocity[:2] / omega
        self._estimate.append(time_ns, terms.com, terms.com_velocity, dcm, q[:3], v[:6])

    def contact(
        self, time_ns: int, measurement: Measurement, terms: RobotTerms, reference: WbcReference, report: WbcReport
    ) -> None:
        """Contacts planned, held and felt, and where their forces act."""
        wrench = measurement.wrench
        self._contact.append(
            time_ns, measured_zmp(wrench, terms.sole_position, terms.sole_rotation), wrench[:, 2],
            reference.planned_contact, report.active, report.felt,
            centre_of_pressure(wrench[0]), centre_of_pressure(wrench[1]),
        )  # fmt: skip

    def plan(self, time_ns: int, plan: WalkPlan) -> None:
        """A new plan with its horizon and footsteps."""
        status = plan.status
        self._plan.append(
            time_ns, plan.com, plan.com_velocity, plan.zmp, plan.zmp_reference, plan.jerk, plan.omega,
            status.solver, (status.zmp_slack.max(), status.terminal_slack.max()), status.solver is SolverStatus.HELD,
        )  # fmt: skip
        ahead = [*plan.footsteps, *[None] * (3 - len(plan.footsteps))]
        self._footsteps.append(
            time_ns,
            _pose(plan.footholds[Foot.LEFT]),
            _pose(plan.footholds[Foot.RIGHT]),
            [_NO_FOOTSTEP if step is None else _pose(step.footstep) for step in ahead],
            [-1 if step is None else int(step.footstep.foot) for step in ahead],
            [math.nan if step is None else step.touchdown_time for step in ahead],
        )
        vertices = plan.support_polygon
        self._support[: len(vertices)] = vertices
        self._support[len(vertices) :] = vertices[-1]

    def touchdown(self, time_ns: int, planned: PlannedFootstep, terms: RobotTerms) -> None:
        """A footstep taken: as last planned, and where the sole is."""
        foot, rotation = planned.footstep.foot, terms.sole_rotation[planned.footstep.foot]
        actual = np.append(terms.sole_position[foot], math.atan2(rotation[1, 0], rotation[0, 0]))
        self._footstep.append(time_ns, planned.step, int(foot), _pose(planned.footstep), actual)

    def reference(self, time_ns: int, plan: WalkPlan, sample: PlanSample) -> None:
        """The reference of a control tick and the gait's clock."""
        phase = plan.phase
        self._reference.append(
            time_ns, sample.com, sample.com_velocity, sample.com_acceleration, sample.zmp, sample.dcm, sample.omega,
            sample.zmp_reference, sample.swing[:3], sample.swing_velocity[:3],
            int(phase.kind), -1 if phase.stance is None else int(phase.stance), phase.step,
            phase.elapsed + sample.time - plan.time, phase.duration, self._support, len(plan.support_polygon),
        )  # fmt: skip

    def control(self, time_ns: int, report: WbcReport, torque: Array) -> None:
        """The whole-body QP's answer and the torque commanded, shape (nj,) [N·m]."""
        self._wbc.append(
            time_ns, report.status, report.status is SolveStatus.SECOND_SOLVER, report.iterations,
            report.status >= SolveStatus.EQUALITIES_ONLY, report.primal_residual, report.dual_residual,
            report.acceleration, report.wrench[0], report.wrench[1], report.task_error,
        )  # fmt: skip
        self._torque.append(time_ns, torque, np.abs(torque / self._torque_limit).max())

    def timing(self, time_ns: int, timing: TickTiming) -> None:
        """Wall-clock times of the tick."""
        t = timing
        parts = (t.state, t.wbc_build, t.wbc_solve, t.planner, t.physics, t.log, t.tick)
        self._timing.append(time_ns, *(1e6 * part for part in parts))


def _pose(footstep: Footstep) -> Array:
    return np.append(footstep.position, footstep.yaw)
