"""Writes what the robot's body and its controller exchange in one run into the log's channels."""

import math

import numpy as np
from numpy.typing import NDArray

from scenarios.log import LogWriter, channels
from scenarios.log.channels import Sizes
from sim.measurement import Measurement
from wbc.model import RobotTerms
from wbc.types import RobotState, SolveStatus, WbcReference, WbcReport
from wbc.zmp import centre_of_pressure, measured_zmp

Array = NDArray[np.float64]

_SECOND, _FALLBACK = SolveStatus.SECOND_SOLVER, SolveStatus.EQUALITIES_ONLY


class Recorder:
    """The channels of the whole body, one row per control tick."""

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        """Open its channels; ``torque_limit`` of the joints, shape (nj,) [N·m]."""
        self._inverse_limit = 1.0 / torque_limit
        self._ratio = np.zeros_like(torque_limit)
        measurement = writer.channel(channels.measurement(sizes))
        truth = writer.channel(channels.truth(sizes))
        estimate = writer.channel(channels.estimate(sizes))
        contact = writer.channel(channels.contact(sizes))
        wbc = writer.channel(channels.wbc(sizes))
        torque = writer.channel(channels.torque(sizes))
        vectors = (
            (measurement, ("joint_position", "joint_velocity", "joint_torque", "gyro", "accelerometer")),
            (measurement, ("wrench_left", "wrench_right", "external_force")),
            (truth, ("q", "v", "com", "com_velocity", "angular_momentum", "left_sole", "right_sole")),
            (estimate, ("com", "com_velocity", "base_position", "base_velocity")),
            (wbc, ("acceleration", "wrench_left", "wrench_right", "task_error")),
            (torque, ("command",)),
        )
        numbers = (
            (truth, ("torso_tilt", "nonfoot_contact")),
            (estimate, ("dcm",)),
            (contact, ("zmp", "normal_force", "planned", "active", "felt", "cop_left", "cop_right")),
            (wbc, ("status", "solver", "iterations", "fallback", "primal_residual", "dual_residual")),
            (torque, ("limit_ratio_max",)),
        )
        self._row = writer.rows(vectors + numbers)

    def tick(
        self, time_ns: int, measurement: Measurement, terms: RobotTerms, state: RobotState,
        reference: WbcReference, report: WbcReport, torque: Array,
    ) -> None:  # fmt: skip
        """A control tick: sensors and true state, contacts, what the controller was given and what it answered.

        Args:
            time_ns: simulated time [ns].
            measurement: what the sensors say.
            terms: of the true state.
            state: what the controller was given.
            reference: what it shall do.
            report: what it did.
            torque: the torque commanded, shape (nj,) [N·m].
        """
        m, com, velocity, soles = measurement, terms.com, terms.com_velocity, terms.sole_pose
        self._row.append(
            time_ns,
            m.joint_position, m.joint_velocity, m.joint_torque, m.gyro, m.accelerometer, m.wrench.ravel(),
            m.external_force, m.q, m.v, com, velocity, terms.angular_momentum, soles.ravel(),
            com, velocity, state.q[:3], state.v[:6],
            report.acceleration, report.wrench.ravel(), report.task_error, torque,
            np.array(self._numbers(m, terms, reference, report, torque)),
        )  # fmt: skip

    def _numbers(
        self, m: Measurement, terms: RobotTerms, reference: WbcReference, report: WbcReport, torque: Array
    ) -> tuple[float, ...]:
        """Everything of a tick that is a number or two."""
        x, y, _ = terms.com.tolist()
        vx, vy, _ = terms.com_velocity.tolist()
        omega, status, wrench = reference.omega, report.status, m.wrench
        np.abs(np.multiply(torque, self._inverse_limit, out=self._ratio), out=self._ratio)
        return (
            math.acos(min(1.0, terms.torso_rotation[2, 2])), m.nonfoot_contact, x + vx / omega, y + vy / omega,
            *measured_zmp(wrench, terms.sole_position, terms.sole_rotation), *wrench[:, 2].tolist(),
            *reference.planned_contact, *report.active, *report.felt,
            *centre_of_pressure(wrench[0]), *centre_of_pressure(wrench[1]),
            status, status is _SECOND, report.iterations, status >= _FALLBACK,
            report.primal_residual, report.dual_residual, np.maximum.reduce(self._ratio),
        )  # fmt: skip
