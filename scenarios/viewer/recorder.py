"""Writes what viewers draw: a picture every few hundredths of a second, an event when it happens, the scene now and then."""

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.message import Message as ProtobufMessage
from numpy.typing import NDArray

from models.types import RobotDescription
from planner.plan import WalkPlan
from planner.sampling import PlanSample
from planner.types import SolverStatus
from scenarios.log import LogWriter
from scenarios.log.template import Template
from scenarios.viewer import templates
from scenarios.viewer.drawing import NOWHERE, Outlines, force_arrow
from scenarios.viewer.events import EventLog
from scenarios.viewer.scene import world_scene
from scenarios.viewer.schemas import published
from sim.bodies import BodyPoses
from sim.measurement import Measurement
from sim.world import World
from wbc.model import RobotTerms
from wbc.types import SolveStatus, WbcReport
from wbc.zmp import centre_of_pressure, measured_zmp

Array = NDArray[np.float64]
Triple = tuple[float, float, float]

RATE = 25
"""Pictures per simulated second [Hz]."""

SCENE_PERIOD = 10
"""The unchanging scene is repeated, for viewers that join late or see a part of the log [s]."""


_FALLBACK, _HELD = SolveStatus.EQUALITIES_ONLY, SolverStatus.HELD


class Drawn:
    """A channel whose messages come from one template."""

    def __init__(
        self, writer: LogWriter, topic: str, schema: type[ProtobufMessage], template: Template, doc: str
    ) -> None:
        self._channel = writer.message_channel(topic, published(schema), doc)
        self._template = template

    def append(self, time_ns: int, values: Sequence[float]) -> None:
        """Write a message with the template's values."""
        self._channel.append(time_ns, self._template.encode(time_ns, values))


class WalkView:
    """The channels that every fidelity can fill: points and outlines."""

    def __init__(self, writer: LogWriter, half_length: float, half_width: float) -> None:
        """Open them; half size of the soles [m]."""
        self._points = Drawn(writer, "/scene/points", SceneUpdate, templates.points(), "CoM, ZMP, DCM, true and planned")
        support = "support polygon and the next footsteps as planned"
        self._outlines = Drawn(writer, "/scene/support", SceneUpdate, templates.outlines(), support)
        self._shape = Outlines(half_length, half_width)
        self._plan: WalkPlan | None = None

    def update(self, time_ns: int, com: Array, com_velocity: Array, zmp: Triple, plan: WalkPlan, s: PlanSample) -> None:
        """Draw an instant.

        Args:
            time_ns: simulated time [ns].
            com: true CoM, shape (3,) [m].
            com_velocity: shape (3,) [m/s].
            zmp: true ZMP, x y z [m]; NaN in flight.
            plan: the plan that is followed.
            s: its references now.
        """
        if plan is not self._plan:
            self._shape.update(plan)
            self._plan = plan
        x, y, _ = centre = com.tolist()
        vx, vy, _ = com_velocity.tolist()
        in_flight = zmp[0] != zmp[0]
        ground = self._shape.ground if in_flight else zmp[2]
        true_dcm = (x + vx / s.omega, y + vy / s.omega, ground)
        planned = (*s.zmp.tolist(), ground, *true_dcm, *s.dcm.tolist(), ground)
        self._points.append(time_ns, (*centre, *s.com.tolist(), *(NOWHERE if in_flight else zmp), *planned))
        self._outlines.append(time_ns, self._shape.values)


class BodyView:
    """Everything that is drawn of a run in full physics.

    Attributes:
        every: control ticks from picture to picture.
    """

    def __init__(self, writer: LogWriter, world: World, robot: RobotDescription, control_rate: int) -> None:
        self.every = max(control_rate // RATE, 1)
        self._scene_every = control_rate * SCENE_PERIOD
        self._poses = BodyPoses(world.model)
        self._torso = self._poses.names.index(robot.torso_body)
        poses, joints = templates.transforms(self._poses.names), templates.joint_states(robot.joint_names)
        self._tf = Drawn(writer, "/tf", FrameTransforms, poses, "all bodies in the world")
        self._joints = Drawn(writer, "/joint_states", JointStates, joints, "positions, velocities and torques")
        forces = "contact forces at the centres of pressure, and pushes"
        self._forces = Drawn(writer, "/scene/forces", SceneUpdate, templates.forces(), forces)
        self._scene = writer.message_channel("/scene/world", published(SceneUpdate), "robot and terrain, each body in its frame")
        self._scene_data = world_scene(world.mjcf()).SerializeToString(deterministic=True)
        self._walk = WalkView(writer, 0.5 * robot.sole_length, 0.5 * robot.sole_width)
        self._events = EventLog(writer)
        self._levers = np.zeros((2, 3, 2))

    def events(
        self, time_ns: int, measurement: Measurement, report: WbcReport, plan: WalkPlan, fallen: bool
    ) -> None:
        """Say what has changed since the last control tick."""
        force = measurement.external_force
        fallback = report.status >= _FALLBACK or plan.status.solver is _HELD
        self._events.update(time_ns, report.active, bool(np.dot(force, force)), fallback, fallen)

    def picture(
        self, tick: int, time_ns: int, measurement: Measurement, terms: RobotTerms, plan: WalkPlan, sample: PlanSample
    ) -> None:
        """Draw a control tick, if it is one that is drawn; ``terms`` are those of the true state."""
        if tick % self.every:
            return
        if tick % self._scene_every == 0:
            self._scene.append(time_ns, self._scene_data)
        m, poses = measurement, self._poses
        poses.update(m.q)
        self._tf.append(time_ns, poses.position.ravel().tolist() + poses.quaternion.ravel().tolist())
        self._joints.append(time_ns, np.concatenate((m.joint_position, m.joint_velocity, m.joint_torque)).tolist())
        self._forces.append(time_ns, self._arrows(m, terms))
        zmp = measured_zmp(m.wrench, terms.sole_position, terms.sole_rotation)
        self._walk.update(time_ns, terms.com, terms.com_velocity, zmp, plan, sample)

    def _arrows(self, m: Measurement, terms: RobotTerms) -> tuple[float, ...]:
        """Contact forces and push as arrows."""
        levers = self._levers
        levers[:, :, 0] = m.wrench[:, :3]
        for foot in (0, 1):
            x, y = centre_of_pressure(m.wrench[foot])
            levers[foot, :2, 1] = (0.0, 0.0) if x != x else (x, y)
        left, right = np.matmul(terms.sole_rotation, levers).transpose(0, 2, 1)
        origins = terms.sole_position
        push = force_arrow(self._poses.position[self._torso], m.external_force)
        return (*force_arrow(origins[0] + left[1], left[0]), *force_arrow(origins[1] + right[1], right[0]), *push)
