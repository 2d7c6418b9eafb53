"""Writes what the robot's body and its controller exchange in one run into the log's channels."""

import math

import numpy as np
from numpy.typing import NDArray

from surefoot.maths import algebra
from surefoot.planner.model.dcm import dcm
from surefoot.planner.plan.sample import PlanSample
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.layout import RowLayout, Table
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.sim.measurement import Measurement
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.contact import zmp
from surefoot.wbc.types import SolveStatus, WbcReport

Array = NDArray[np.float64]

_SECOND, _FALLBACK = float(SolveStatus.SECOND_SOLVER), float(SolveStatus.EQUALITIES_ONLY)

_MORE_NUMBERS = ("omega", "upright")
"""Inputs that are not logged as they are.

They are the pendulum's natural frequency for the DCM, and the vertical part of the torso's upward axis for its tilt.
"""


class Recorder:
    """The channels of the whole body, one row per control tick.

    Args:
        writer: of the log.
        sizes: of the channels.
        torque_limit: of the joints, shape (nj,) [N·m].
    """

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        measurement = writer.channel(channels.measurement(sizes))
        truth = writer.channel(channels.truth(sizes))
        estimate = writer.channel(channels.estimate(sizes))
        contact = writer.channel(channels.contact(sizes))
        wbc = writer.channel(channels.wbc(sizes))
        torque = writer.channel(channels.torque(sizes))
        joints = ("joint_position", "joint_velocity", "joint_torque")
        vectors = (
            (measurement, (*joints, "gyro", "accelerometer", "wrench_left", "wrench_right", "external_force")),
            (truth, ("q", "v", "com", "com_velocity", "angular_momentum", "left_sole", "right_sole")),
            (estimate, ("com", "com_velocity", "external_force", "external_moment")),
            (wbc, ("acceleration", "wrench_left", "wrench_right", "task_error")),
            (torque, ("command",)),
        )
        numbers = (
            (truth, ("nonfoot_contact", "self_contact")),
            (estimate, ("mass",)),
            (contact, ("planned", "active", "edge", "felt")),
            (wbc, ("status", "iterations", "primal_residual", "dual_residual")),
        )
        derived = (
            (wbc, ("solver", "fallback")),
            (truth, ("torso_tilt",)),
            (estimate, ("dcm", "base_position", "base_velocity")),
            (torque, ("limit_ratio_max",)),
            (contact, ("zmp", "normal_force", "cop_left", "cop_right")),
        )
        # The soles' orientations are needed for the ZMP, and of the state that was given to the controller the base.
        more = {"sole_rotation": 18, "given_q": sizes.nq, "given_v": sizes.nv}
        inverse_limit = 1.0 / torque_limit

        def derive(table: Table) -> BodyRows:
            return BodyRows(table, inverse_limit)

        self._row = writer.rows(RowLayout(vectors, numbers, derived, derive, more, _MORE_NUMBERS))

    def tick(
        self, time_ns: int, measurement: Measurement, truth: RobotTerms, terms: RobotTerms, planned: PlanSample,
        report: WbcReport, torque: Array,
    ) -> None:  # fmt: skip
        """A control tick: sensors and true state, contacts, what the controller was given and what it answered.

        Args:
            time_ns: simulated time [ns].
            measurement: what the sensors say.
            truth: terms of the true robot in its true state.
            terms: terms of the controller's robot model in the state that it was given.
            planned: for this instant.
            report: what it did.
            torque: the torque commanded, shape (nj,) [N·m].
        """
        m, r, load = measurement, report, report.load
        numbers = (
            m.nonfoot_contact, m.self_contact, load.mass_scale * terms.model_mass,
            *planned.contacts, *r.active, *r.edge, *r.felt, r.status, r.iterations, r.primal_residual, r.dual_residual,
            planned.omega, truth.torso_rotation.item(8),
        )  # fmt: skip
        self._row.append(
            time_ns, numbers, m.joint_position, m.joint_velocity, m.joint_torque, m.gyro, m.accelerometer, m.wrench,
            m.external_force, m.q, m.v, truth.com, truth.com_velocity, truth.angular_momentum, truth.sole_pose,
            terms.com, terms.com_velocity, load.force, load.moment, r.acceleration, r.wrench, r.task_error, torque,
            truth.sole_rotation, terms.q, terms.v,
        )  # fmt: skip


class RobotRows:
    """The fields that follow from the rest of a robot's rows: ZMP, centres of pressure, torso's tilt, largest torque.

    Args:
        table: of the rows.
        inverse_limit: of the joints' torques, shape (nj,) [1/(N·m)].
    """

    def __init__(self, table: Table, inverse_limit: Array) -> None:
        count = len(table.values)
        self._inverse_limit = inverse_limit
        left, right = ("/measurement", "wrench_left"), ("/measurement", "wrench_right")
        self._wrench = table.span(left, right).reshape(count, 2, 6)
        self._soles = table.span(("/truth", "left_sole"), ("/truth", "right_sole")).reshape(count, 2, 7)
        self._sole_rotation = table["sole_rotation"].reshape(count, 2, 3, 3)
        self._zmp, self._normal_force = table["/contact", "zmp"], table["/contact", "normal_force"]
        self._cop = table.span(("/contact", "cop_left"), ("/contact", "cop_right")).reshape(count, 2, 2)
        self._upright, self._tilt = table["upright"], table["/truth", "torso_tilt"]
        self._command, self._limit_ratio = table["/torque", "command"], table["/torque", "limit_ratio_max"]

    def derive(self, rows: int) -> None:
        """See `Derived`."""
        for n in range(rows):
            self._feel(n)
            self._follow(n)
            self._tilt[n, 0] = math.acos(algebra.clamp(self._upright[n, 0], -1.0, 1.0))
            self._limit_ratio[n, 0] = self._largest_ratio(n)

    def _feel(self, n: int) -> None:
        """ZMP, normal forces and centres of pressure."""
        wrench = self._wrench[n]
        point = zmp.measured_zmp(wrench, self._soles[n, :, :3], self._sole_rotation[n])
        algebra.put_row(self._zmp, n, point)
        for foot in range(2):
            self._normal_force[n, foot] = wrench[foot, 2]
            self._cop[n, foot, 0], self._cop[n, foot, 1] = zmp.centre_of_pressure(wrench[foot])

    def _follow(self, n: int) -> None:
        """Derive the fields of more than is logged of every robot."""

    def _largest_ratio(self, n: int) -> float:
        """Largest torque over its limit; NaN where one is."""
        most: float = 0.0
        for joint in range(len(self._inverse_limit)):
            ratio = abs(self._command[n, joint] * self._inverse_limit[joint])
            if ratio > most or ratio != ratio:
                most = ratio
            if most != most:
                break
        return most


class BodyRows(RobotRows):
    """The same under a whole-body controller, and what follows of it and of the state that it was given, such as DCM.

    Args:
        table: of the rows.
        inverse_limit: of the joints' torques, shape (nj,) [1/(N·m)].
    """

    def __init__(self, table: Table, inverse_limit: Array) -> None:
        super().__init__(table, inverse_limit)
        self._status, self._solver = table["/wbc", "status"], table["/wbc", "solver"]
        self._fallback = table["/wbc", "fallback"]
        self._com, self._com_velocity = table["/estimate", "com"], table["/estimate", "com_velocity"]
        self._omega, self._dcm = table["omega"], table["/estimate", "dcm"]
        self._q, self._v = table["given_q"], table["given_v"]
        self._base_position = table["/estimate", "base_position"]
        self._base_velocity = table["/estimate", "base_velocity"]

    def derive(self, rows: int) -> None:
        """See `Derived`."""
        RobotRows.derive(self, rows)
        self._dcm[:rows] = dcm(self._com[:rows, :2], self._com_velocity[:rows, :2], self._omega[:rows])

    def _follow(self, n: int) -> None:
        """The base in the state that the controller was given, and what kind of solution it has found."""
        self._solver[n, 0] = 1.0 if self._status[n, 0] == _SECOND else 0.0
        self._fallback[n, 0] = 1.0 if self._status[n, 0] >= _FALLBACK else 0.0
        for k in range(3):
            self._base_position[n, k] = self._q[n, k]
        for k in range(6):
            self._base_velocity[n, k] = self._v[n, k]
