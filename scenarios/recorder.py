"""Writes what the robot's body and its controller exchange in one run into the log's channels."""

import math

import numpy as np
from numpy.typing import NDArray

from scenarios.log import LogWriter, channels
from scenarios.log.channels import Sizes
from sim.measurement import Measurement
from wbc.model import RobotTerms
from wbc.types import SolveStatus, WbcReference, WbcReport
from wbc.zmp import centre_of_pressure, measured_zmp

Array = NDArray[np.float64]


class Recorder:
    """The channels of the whole body."""

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        """Open its channels; ``torque_limit`` of the joints, shape (nj,) [N·m]."""
        self._torque_limit = torque_limit
        self._measurement = writer.channel(channels.measurement(sizes))
        self._truth = writer.channel(channels.truth(sizes))
        self._estimate = writer.channel(channels.estimate(sizes))
        self._contact = writer.channel(channels.contact(sizes))
        self._wbc = writer.channel(channels.wbc(sizes))
        self._torque = writer.channel(channels.torque(sizes))

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

    def control(self, time_ns: int, report: WbcReport, torque: Array) -> None:
        """The whole-body QP's answer and the torque commanded, shape (nj,) [N·m]."""
        self._wbc.append(
            time_ns, report.status, report.status is SolveStatus.SECOND_SOLVER, report.iterations,
            report.status >= SolveStatus.EQUALITIES_ONLY, report.primal_residual, report.dual_residual,
            report.acceleration, report.wrench[0], report.wrench[1], report.task_error,
        )  # fmt: skip
        self._torque.append(time_ns, torque, np.abs(torque / self._torque_limit).max())
