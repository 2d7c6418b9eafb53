"""Writes what a robot and a controller without a plan exchange in one run into the log's channels."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from surefoot.planner.types import Foot, PhaseInfo
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.layout import RowLayout, Table
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.body import RobotRows
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.walk import RunRecorder
from surefoot.sim.measurement import Measurement
from surefoot.wbc.body.model import RobotTerms

Array = NDArray[np.float64]

_OWN = "What the controller tells, by names of its own, whenever it decides."


class SeatRecorder(RunRecorder):
    """The channels of a robot whose controller has no plan: one row per control tick, and what the controller tells.

    Args:
        writer: of the log.
        sizes: of the channels.
        torque_limit: of the joints, shape (nj,) [N·m].
    """

    def __init__(self, writer: LogWriter, sizes: Sizes, torque_limit: Array) -> None:
        measurement, truth = writer.channel(channels.measurement(sizes)), writer.channel(channels.truth(sizes))
        contact, torque = writer.channel(channels.felt_contact(sizes)), writer.channel(channels.torque(sizes))
        gait = writer.channel(channels.gait(sizes))
        joints = ("joint_position", "joint_velocity", "joint_torque")
        vectors = (
            (measurement, (*joints, "gyro", "accelerometer", "wrench_left", "wrench_right", "external_force")),
            (truth, ("q", "v", "com", "com_velocity", "angular_momentum", "left_sole", "right_sole")),
            (torque, ("command",)),
        )
        numbers = (
            (truth, ("nonfoot_contact", "self_contact")),
            (contact, ("felt",)),
            (gait, ("phase", "stance", "step", "phase_time")),
        )
        derived = (
            (truth, ("torso_tilt",)),
            (torque, ("limit_ratio_max",)),
            (contact, ("zmp", "normal_force", "cop_left", "cop_right")),
        )

        inverse_limit = 1.0 / torque_limit

        def derive(table: Table) -> RobotRows:
            return RobotRows(table, inverse_limit)

        self._row = writer.rows(RowLayout(vectors, numbers, derived, derive, {"sole_rotation": 18}, ("upright",)))
        super().__init__(writer, sizes)
        self._names: tuple[str, ...] | None = None

    def tick(
        self,
        time_ns: int,
        measurement: Measurement,
        truth: RobotTerms,
        torque: Array,
        contact: tuple[bool, bool],
        phase: PhaseInfo,
    ) -> None:
        """A control tick: sensors and true state, contacts and gait as felt, and what the joints are given.

        Args:
            time_ns: simulated time [ns].
            measurement: what the sensors say.
            truth: terms of the true robot in its true state.
            torque: commanded at this instant, shape (nj,) [N·m].
            contact: feet that carry load, (left, right).
            phase: of the gait.
        """
        m = measurement
        stance = -1 if phase.stance is None else int(phase.stance)
        numbers = (
            m.nonfoot_contact, m.self_contact, *contact, phase.kind, stance, phase.step, phase.elapsed,
            truth.torso_rotation.item(8),
        )  # fmt: skip
        self._row.append(
            time_ns, numbers, m.joint_position, m.joint_velocity, m.joint_torque, m.gyro, m.accelerometer, m.wrench,
            m.external_force, m.q, m.v, truth.com, truth.com_velocity, truth.angular_momentum, truth.sole_pose, torque,
            truth.sole_rotation,
        )  # fmt: skip

    def landed(self, time_ns: int, foot: Foot, step: int, truth: RobotTerms) -> None:
        """A footstep taken, of which nothing was planned."""
        rotation = truth.sole_rotation[foot]
        yaw = math.atan2(rotation.item(3), rotation.item(0))
        place = np.append(truth.sole_position[foot], yaw)
        self._footstep.put(time_ns, index=step, foot=int(foot), planned=np.full(4, np.nan), actual=place)

    def reported(self, time_ns: int, reported: Mapping[str, Array]) -> None:
        """Log the values that the controller reports beside; those of the first call fix which they are."""
        if self._names is None:
            self._names = tuple(reported)
            fields = tuple([FieldSpec(name, np.shape(value), "", "", "") for name, value in reported.items()])
            self._more = self._writer.channel(ChannelSpec("/controller", "Controller", fields, _OWN))
        self._more.append(time_ns, *[reported[name] for name in self._names])
