"""What viewers draw of a run in full physics: bodies, joints, forces, scene, and everything of `walk_view`."""

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from numpy.typing import NDArray

from models.types import RobotDescription
from planner.plan import WalkPlan
from planner.sampling import PlanSample
from planner.types import SolverStatus
from scenarios.log import LogWriter
from scenarios.viewer import templates
from scenarios.viewer.drawing import force_arrow
from scenarios.viewer.events import EventLog
from scenarios.viewer.scene import world_scene
from scenarios.viewer.schemas import published
from scenarios.viewer.walk_view import RATE, Drawn, WalkView
from sim.bodies import BodyPoses
from sim.measurement import Measurement
from sim.world import World
from wbc.model import RobotTerms
from wbc.types import SolveStatus, WbcReport
from wbc.zmp import centre_of_pressure, measured_zmp

Array = NDArray[np.float64]

SCENE_PERIOD = 10
"""The unchanging scene is repeated, for viewers that join late or see a part of the log [s]."""


_FALLBACK, _HELD = SolveStatus.EQUALITIES_ONLY, SolverStatus.HELD


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
        self._scene = writer.message_channel(
            "/scene/world", published(SceneUpdate), "robot and terrain, each body in its frame"
        )
        self._scene_data = world_scene(world.mjcf()).SerializeToString(deterministic=True)
        self._walk = WalkView(writer, 0.5 * robot.sole_length, 0.5 * robot.sole_width)
        self._events = EventLog(writer)
        self._levers = np.zeros((2, 3, 2))

    def events(self, time_ns: int, measurement: Measurement, report: WbcReport, plan: WalkPlan, fallen: bool) -> None:
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
