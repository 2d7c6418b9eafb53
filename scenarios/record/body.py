"""Writes what the robot's body and its controller exchange in one run into the log's channels."""

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.rows import places
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.sim.measurement import Measurement
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.types import RobotState, SolveStatus, WbcReference, WbcReport
from surefoot.wbc.zmp import UNLOADED

Array = NDArray[np.float64]


def contact_points(wrench: Array, position: Array, rotation: Array) -> tuple[Array, Array]:
    """ZMP and centres of pressure; the definitions are those of `wbc.zmp`.

    Args:
        wrench: sole wrenches in the sole frames, shape (n, 2, 6) [N, N·m].
        position: sole centres in the world frame, shape (n, 2, 3) [m].
        rotation: sole orientations, shape (n, 2, 3, 3).

    Returns:
        the ZMP in the world frame, shape (n, 3), and the centres of pressure in the sole frames, shape (n, 2, 2) [m];
        NaN where there is no load.
    """
    columns = wrench.reshape(-1, 2, 2, 3).swapaxes(2, 3)
    world = rotation @ columns
    force, torque = world[..., 0], world[..., 1]
    fz = force[..., 2]
    total = fz.sum(axis=1)
    load = np.where(total < UNLOADED, np.nan, total)
    height = (fz * position[..., 2]).sum(axis=1) / load
    lever = position[..., 2] - height[:, None]
    moment_x = (torque[..., 0] + position[..., 1] * fz - lever * force[..., 1]).sum(axis=1)
    moment_y = (torque[..., 1] + lever * force[..., 0] - position[..., 0] * fz).sum(axis=1)
    normal = np.where(wrench[..., 2] < UNLOADED, np.nan, wrench[..., 2])
    cop = np.stack((-wrench[..., 4] / normal, wrench[..., 3] / normal), axis=2)
    return np.stack((-moment_y / load, moment_x / load, height), axis=1), cop


_SECOND, _FALLBACK = SolveStatus.SECOND_SOLVER, SolveStatus.EQUALITIES_ONLY
_ROTATIONS = 18
"""Numbers of the sole orientations: they are not logged as they are, but the ZMP needs them."""


class Recorder:
    """The channels of the whole body, one row per control tick."""

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        """Open its channels; ``torque_limit`` of the joints, shape (nj,) [N·m]."""
        self._inverse_limit = 1.0 / torque_limit
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
            (truth, ("nonfoot_contact", "self_contact")),
            (contact, ("planned", "active", "felt")),
            (wbc, ("status", "iterations", "primal_residual", "dual_residual")),
        )
        derived = (
            (wbc, ("solver", "fallback")),
            (truth, ("torso_tilt",)),
            (estimate, ("dcm",)),
            (torque, ("limit_ratio_max",)),
            (contact, ("zmp", "normal_force", "cop_left", "cop_right")),
        )
        self._row = writer.rows(vectors, numbers, derived, self._derived, _ROTATIONS)
        self._at = places(vectors)

    def tick(
        self, time_ns: int, measurement: Measurement, truth: RobotTerms, terms: RobotTerms, state: RobotState,
        reference: WbcReference, report: WbcReport, torque: Array,
    ) -> None:  # fmt: skip
        """A control tick: sensors and true state, contacts, what the controller was given and what it answered.

        Args:
            time_ns: simulated time [ns].
            measurement: what the sensors say.
            truth: terms of the true robot in its true state.
            terms: terms of the controller's robot model in the state that it was given.
            state: that state.
            reference: what it shall do.
            report: what it did.
            torque: the torque commanded, shape (nj,) [N·m].
        """
        m, r = measurement, report
        numbers = (
            m.nonfoot_contact, m.self_contact, *reference.planned_contact, *r.active, *r.felt,
            r.status, r.iterations, r.primal_residual, r.dual_residual, reference.omega, truth.torso_rotation[2, 2],
        )  # fmt: skip
        self._row.append(
            time_ns, numbers,
            m.joint_position, m.joint_velocity, m.joint_torque, m.gyro, m.accelerometer,
            m.wrench.ravel(), m.external_force,
            m.q, m.v, truth.com, truth.com_velocity, truth.angular_momentum, truth.sole_pose.ravel(),
            terms.com, terms.com_velocity, state.q[:3], state.v[:6],
            r.acceleration, r.wrench.ravel(), r.task_error, torque,
            truth.sole_rotation.ravel(),
        )  # fmt: skip

    def _derived(self, vectors: Array, numbers: Array) -> Array:
        """What follows from the rest: solver, fallback, tilt, DCM, largest torque ratio, ZMP and contact points."""
        n, at = len(vectors), self._at
        left, right = at["/measurement", "wrench_left"], at["/measurement", "wrench_right"]
        wrench = vectors[:, left.start : right.stop].reshape(n, 2, 6)
        soles = vectors[:, at["/truth", "left_sole"].start : at["/truth", "right_sole"].stop].reshape(n, 2, 7)
        zmp, cop = contact_points(wrench, soles[:, :, :3], vectors[:, -_ROTATIONS:].reshape(n, 2, 3, 3))
        com, velocity = vectors[:, at["/estimate", "com"]], vectors[:, at["/estimate", "com_velocity"]]
        status, omega, upright = numbers[:, 8], numbers[:, 12:13], numbers[:, 13]
        return np.column_stack((
            status == _SECOND, status >= _FALLBACK, np.arccos(np.minimum(upright, 1.0)),
            com[:, :2] + velocity[:, :2] / omega,
            np.abs(vectors[:, at["/torque", "command"]] * self._inverse_limit).max(axis=1),
            zmp, wrench[:, :, 2], cop.reshape(n, 4),
        ))  # fmt: skip
