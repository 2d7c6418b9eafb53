"""Writes what the robot's body and its controller exchange in one run into the log's channels."""

from collections.abc import Callable
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from surefoot.native.library import Library
from surefoot.planner.plan import PlanSample
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.rows import RowLayout, Rows
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.sim.measurement import Measurement
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.types import SolveStatus, WbcReport
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
_SENSED = ("joint_position", "joint_velocity", "joint_torque", "gyro", "accelerometer")
_STATE = ("q", "v")
_TRUE = ("com", "com_velocity", "angular_momentum")
_SOLVED = ("status", "iterations", "primal_residual", "dual_residual")
_sensed, _state, _true, _solved = (attrgetter(*names) for names in (_SENSED, _STATE, _TRUE, _SOLVED))
"""Fields that have the names that sensors, robot and report give them."""

_MORE_VECTORS = {"sole_rotation": 18}
_MORE_NUMBERS = ("omega", "upright")
"""What is not logged as it is, but needed for what is: the soles' orientations for the ZMP, the pendulum's natural
frequency for the DCM, the vertical part of the torso's upward axis for its tilt."""


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
            (measurement, (*_SENSED, "wrench_left", "wrench_right", "external_force")),
            (truth, (*_STATE, *_TRUE, "left_sole", "right_sole")),
            (estimate, ("com", "com_velocity", "base_position", "base_velocity", "external_force", "external_moment")),
            (wbc, ("acceleration", "wrench_left", "wrench_right", "task_error")),
            (torque, ("command",)),
        )
        numbers = (
            (truth, ("nonfoot_contact", "self_contact")),
            (estimate, ("mass",)),
            (contact, ("planned", "active", "felt")),
            (wbc, _SOLVED),
        )
        derived = (
            (wbc, ("solver", "fallback")),
            (truth, ("torso_tilt",)),
            (estimate, ("dcm",)),
            (torque, ("limit_ratio_max",)),
            (contact, ("zmp", "normal_force", "cop_left", "cop_right")),
        )
        more = _MORE_VECTORS, _MORE_NUMBERS
        layout = RowLayout(vectors, numbers, derived, self._derived, *more, self._compiled, standing=True)
        self._row = writer.rows(layout)
        self._last: tuple[Measurement, RobotTerms, RobotTerms, Array, Array, WbcReport, Array] | None = None

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
        m, r = measurement, report
        numbers = (
            m.nonfoot_contact, m.self_contact, r.load.mass_scale * terms.model_mass,
            *planned.contacts, *r.active, *r.felt, *_solved(r), planned.omega, truth.torso_rotation.item(8),
        )  # fmt: skip
        if self._stands(m, truth, terms, r, torque):
            self._row.again(time_ns, numbers)
            return
        self._last = m, truth, terms, terms.q, terms.v, r, torque
        self._row.append(
            time_ns, numbers, *_sensed(m), m.wrench, m.external_force, *_state(m), *_true(truth), truth.sole_pose,
            terms.com, terms.com_velocity, terms.q[:3], terms.v[:6], r.load.force, r.load.moment,
            r.acceleration, r.wrench, r.task_error, torque, truth.sole_rotation,
        )  # fmt: skip

    def _stands(self, m: Measurement, truth: RobotTerms, terms: RobotTerms, r: WbcReport, torque: Array) -> bool:
        """Whether all arrays of a row are those of the row before, whose memory holds other values now."""
        if self._last is None:
            return False
        n, true, own, q, v, s, command = self._last
        # One by one: tuples of them take four times as long.
        return (
            m.joint_position is n.joint_position
            and m.joint_velocity is n.joint_velocity
            and m.joint_torque is n.joint_torque
            and m.gyro is n.gyro
            and m.accelerometer is n.accelerometer
            and m.wrench is n.wrench
            and m.external_force is n.external_force
            and m.q is n.q
            and m.v is n.v
            and truth is true
            and terms is own
            and terms.q is q
            and terms.v is v
            and r.load is s.load
            and r.acceleration is s.acceleration
            and r.wrench is s.wrench
            and r.task_error is s.task_error
            and torque is command
        )

    def _derived(self, rows: Rows) -> dict[tuple[str, str], Array]:
        """What follows from the rest: solver, fallback, tilt, DCM, largest torque ratio, ZMP and contact points."""
        status, upright = rows["/wbc", "status"], rows["upright"]
        n = len(status)
        wrench = rows.span(("/measurement", "wrench_left"), ("/measurement", "wrench_right")).reshape(n, 2, 6)
        soles = rows.span(("/truth", "left_sole"), ("/truth", "right_sole")).reshape(n, 2, 7)
        zmp, cop = contact_points(wrench, soles[:, :, :3], rows["sole_rotation"].reshape(n, 2, 3, 3))
        com, velocity = rows["/estimate", "com"], rows["/estimate", "com_velocity"]
        return {
            ("/wbc", "solver"): status == _SECOND,
            ("/wbc", "fallback"): status >= _FALLBACK,
            ("/truth", "torso_tilt"): np.arccos(np.minimum(upright, 1.0)),
            ("/estimate", "dcm"): com[:, :2] + velocity[:, :2] / rows["omega"],
            ("/torque", "limit_ratio_max"): np.abs(rows["/torque", "command"] * self._inverse_limit).max(axis=1),
            ("/contact", "zmp"): zmp,
            ("/contact", "normal_force"): wrench[:, :, 2],
            ("/contact", "cop_left"): cop[:, 0],
            ("/contact", "cop_right"): cop[:, 1],
        }

    def _compiled(self, kernels: Library, part: Callable[..., Array]) -> Callable[[], None]:
        """The kernel that does what `_derived` does."""

        def of(topic: str, first: str, last: str = "") -> Array:
            return part((topic, first), (topic, last or first))

        return kernels.bind(
            "body_row_derive",
            joints=len(self._inverse_limit),
            unloaded=UNLOADED,
            second=_SECOND,
            without=_FALLBACK,
            wrench=of("/measurement", "wrench_left", "wrench_right"),
            soles=of("/truth", "left_sole", "right_sole"),
            sole_rotation=part("sole_rotation", "sole_rotation"),
            status=of("/wbc", "status"),
            upright=part("upright", "upright"),
            com=of("/estimate", "com"),
            com_velocity=of("/estimate", "com_velocity"),
            omega=part("omega", "omega"),
            command=of("/torque", "command"),
            inverse_limit=self._inverse_limit,
            solver=of("/wbc", "solver"),
            fallback=of("/wbc", "fallback"),
            tilt=of("/truth", "torso_tilt"),
            dcm=of("/estimate", "dcm"),
            limit_ratio=of("/torque", "limit_ratio_max"),
            zmp=of("/contact", "zmp"),
            normal_force=of("/contact", "normal_force"),
            cop_left=of("/contact", "cop_left"),
            cop_right=of("/contact", "cop_right"),
        )
