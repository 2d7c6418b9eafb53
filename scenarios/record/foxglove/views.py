"""The drawings of a run for MCAP viewers: bodies, forces, points and outlines, and its events in words."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.message import DecodeError
from google.protobuf.message import Message as ProtobufMessage
from google.protobuf.timestamp_pb2 import Timestamp
from numpy.typing import ArrayLike, NDArray

from surefoot.models.types import RobotDescription
from surefoot.planner.model.dcm import dcm
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import PlanSample
from surefoot.planner.types import SolverStatus
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Log as LogFile
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.template import Template
from surefoot.scenarios.record.foxglove import drawing as templates
from surefoot.scenarios.record.foxglove.drawing import NOWHERE, Outlines, force_arrow, published, scene_data
from surefoot.sim.measurement import Measurement
from surefoot.sim.world import World
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.contact.zmp import centre_of_pressure, measured_zmp
from surefoot.wbc.types import SolveStatus, WbcReport

Array = NDArray[np.float64]
Triple = tuple[float, float, float]

RATE = 20
"""Pictures per simulated second [Hz]."""

_HELD = SolverStatus.HELD


class Drawn:
    """A channel whose messages come from one template."""

    def __init__(
        self, writer: LogWriter, topic: str, schema: type[ProtobufMessage], template: Template, doc: str
    ) -> None:
        self._channel = writer.message_channel(topic, published(schema), doc, sampled=True)
        self._template = template

    def append(self, time_ns: int, values: ArrayLike) -> None:
        """Write a message with the template's values."""
        self._channel.append(time_ns, self._template.encode(time_ns, values))


class WalkView:
    """The channels that every fidelity can fill: points and outlines."""

    def __init__(self, writer: LogWriter, half_length: float, half_width: float) -> None:
        """Open them; half size of the soles [m]."""
        self._points = Drawn(
            writer, "/scene/points", SceneUpdate, templates.points(), "CoM, ZMP, DCM, true and planned"
        )
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
        centre, in_the_plane = com.tolist(), dcm(com[:2], com_velocity[:2], s.omega)
        in_flight = zmp[0] != zmp[0]
        ground = self._shape.ground if in_flight else zmp[2]
        planned = (*s.zmp.tolist(), ground, *in_the_plane.tolist(), ground, *s.dcm.tolist(), ground)
        self._points.append(time_ns, (*centre, *s.com.tolist(), *(NOWHERE if in_flight else zmp), *planned))
        self._outlines.append(time_ns, self._shape.values)


class PointView:
    """Everything that is drawn of a run of the pendulum."""

    def __init__(self, writer: LogWriter, sole: tuple[float, float], control_rate: int) -> None:
        """Open the channels; ``sole`` is length and width [m]."""
        self._every = max(control_rate // RATE, 1)
        self._walk = WalkView(writer, 0.5 * sole[0], 0.5 * sole[1])
        self._events = EventLog(writer)

    def events(self, time_ns: int, contact: tuple[bool, bool], force: Array, plan: WalkPlan, lost: bool) -> None:
        """Log what has changed since the last control tick; ``force`` is the push, shape (2,) [N]."""
        status = plan.status
        self._events.update(time_ns, contact, force, status.solver is _HELD, status.falling, lost, status.acted)

    def picture(
        self, tick: int, time_ns: int, com: Array, com_velocity: Array, zmp: Array, plan: WalkPlan, sample: PlanSample
    ) -> None:
        """Draw a control tick, if it is one that is drawn.

        Args:
            tick: number of the control tick.
            time_ns: simulated time [ns].
            com: true CoM, shape (3,) [m].
            com_velocity: shape (3,) [m/s].
            zmp: true ZMP, shape (2,) [m]; NaN in flight.
            plan: the plan that is followed.
            sample: its references now.
        """
        if tick % self._every == 0:
            ground = min(float(foot.position[2]) for foot in plan.footholds)
            x, y = zmp.tolist()
            self._walk.update(time_ns, com, com_velocity, (x, y, ground), plan, sample)


TOPIC = "/events"
_FEET = ("left", "right")


_Now = tuple[tuple[bool, bool], bool, bool, bool, bool, tuple[str, ...]]


class EventLog:
    """The log messages of a run, in Foxglove's ``foxglove.Log``."""

    def __init__(self, writer: LogWriter) -> None:
        self._channel = writer.message_channel(TOPIC, published(Log), "what happens, in words")
        self._last: _Now = ((True, True), False, False, False, False, ())

    def update(
        self,
        time_ns: int,
        contact: tuple[bool, bool],
        force: Array,
        fallback: bool,
        falling: bool,
        fallen: bool,
        acted: tuple[str, ...] = (),
    ) -> None:
        """Log what has changed since the last call; before the first one the robot stood in peace.

        Args:
            time_ns: simulated time [ns].
            contact: feet that stand, (left, right).
            force: sum of pushes, shape (2,) or (3,) [N]; NaN, of a plant that does not tell, is none.
            fallback: whether the controller or the planner goes on without a solution.
            falling: whether the planner knows that a fall is coming.
            fallen: whether the robot has fallen.
            acted: rules of recovery that acted in the plan.
        """
        pushed = bool(force.dot(force) > 0.0)
        now = (contact, pushed, fallback, falling, fallen, acted)
        if now == self._last:
            return
        (last_contact, was_pushed, fell_back, was_falling, had_fallen, had_acted), self._last = self._last, now
        for foot, before, after in zip(_FEET, last_contact, contact, strict=True):
            if after != before:
                kind = "touchdown" if after else "lift-off"
                self._say(time_ns, Log.INFO, kind, f"{kind} of the {foot} foot")
        if pushed != was_pushed:
            self._say(time_ns, Log.WARNING, "push", "a push begins" if pushed else "the push ends")
        if fallback != fell_back:
            words = "no solution, the fallback acts" if fallback else "solved again, the fallback ends"
            self._say(time_ns, Log.WARNING, "fallback", words)
        for rule in acted:
            if rule not in had_acted:
                self._say(time_ns, Log.INFO, "rule", f"the rule {rule} acts")
        if falling and not was_falling:
            self._say(time_ns, Log.ERROR, "falling", "no step will save the robot, a fall is coming")
        if was_falling and not falling:
            self._say(time_ns, Log.WARNING, "falling", "steps can save the robot again, no fall is coming")
        if fallen and not had_fallen:
            self._say(time_ns, Log.ERROR, "fall", "the robot falls")

    def _say(self, time_ns: int, level: "Log.Level.ValueType", kind: str, text: str) -> None:
        seconds, nanos = divmod(time_ns, 10**9)
        message = Log(timestamp=Timestamp(seconds=seconds, nanos=nanos), level=level, message=text, name=kind)
        self._channel.append(time_ns, message.SerializeToString(deterministic=True))


class Event(NamedTuple):
    """An event of a run: when [s], what kind it is, and in words."""

    time: float
    kind: str
    text: str


def events(log: LogFile, start: float = -math.inf, end: float = math.inf) -> Iterator[Event]:
    """The events of a log between two times [s], in order.

    Raises:
        LogError: the log has none, or one cannot be read.
    """
    for time_ns, data in log.messages(TOPIC):
        time = time_ns / 1e9
        if start <= time <= end:
            try:
                said = Log.FromString(data)
            except DecodeError:
                right = "`surefoot recover` keeps what is whole"
                raise LogError(f"{log.path}: an event at {time:.3f} s cannot be read; {right}") from None
            yield Event(time, said.name, said.message)


SCENE_PERIOD = 10
"""The unchanging scene is repeated, for viewers that join late or see a part of the log [s]."""

SCENE_RATE = 20_000
"""One with the meshes of a robot so much more seldom that it takes no more than this of the log [B/s]."""


_FALLBACK, _HELD = SolveStatus.EQUALITIES_ONLY, SolverStatus.HELD


class RobotView:
    """The drawings of every robot: its bodies, its joints, and the forces on it.

    Attributes:
        every: control ticks from picture to picture.
    """

    def __init__(self, writer: LogWriter, world: World, robot: RobotDescription, control_rate: int) -> None:
        self.every = max(control_rate // RATE, 1)
        self._poses = world.poses()
        self._torso = self._poses.names.index(robot.torso_body)
        poses, joints = templates.transforms(self._poses.names), templates.joint_states(robot.joint_names)
        self._tf = Drawn(writer, "/tf", FrameTransforms, poses, "all bodies in the world")
        self._joints = Drawn(writer, "/joint_states", JointStates, joints, "positions, velocities and torques")
        forces = "contact forces at the centres of pressure, and pushes"
        self._forces = Drawn(writer, "/scene/forces", SceneUpdate, templates.forces(), forces)
        self._scene = writer.message_channel(
            "/scene/world", published(SceneUpdate), "robot and terrain, each body in its frame"
        )
        self._scene_data = scene_data(world.mjcf())
        period = max(SCENE_PERIOD, round(len(self._scene_data) / SCENE_RATE))
        # A flight recorder has it in all that it keeps.
        self._scene_every = round(control_rate * (period if writer.keep is None else min(period, writer.keep)))
        self._levers = np.zeros((2, 3, 2))

    def picture(
        self,
        tick: int,
        time_ns: int,
        measurement: Measurement,
        terms: RobotTerms,
        plan: WalkPlan | None = None,
        sample: PlanSample | None = None,
    ) -> None:
        """Draw a control tick, if it is one that is drawn; ``terms`` are those of the true state.

        The first is the one after that of the first plan, so that hardly a tick makes both a plan and a picture.
        """
        if tick % self._scene_every == 0:
            self._scene.append(time_ns, self._scene_data)
        if (tick - 1) % self.every:
            return
        m, poses = measurement, self._poses
        poses.update(m.q)
        self._tf.append(time_ns, np.concatenate((poses.position.ravel(), poses.quaternion.ravel())))
        self._joints.append(time_ns, np.concatenate((m.joint_position, m.joint_velocity, m.joint_torque)))
        self._forces.append(time_ns, self._arrows(m, terms))
        if plan is not None and sample is not None:
            self._planned(time_ns, measurement, terms, plan, sample)

    def _planned(
        self, time_ns: int, measurement: Measurement, terms: RobotTerms, plan: WalkPlan, sample: PlanSample
    ) -> None:
        """Draw what is planned, where something is."""

    def _arrows(self, m: Measurement, terms: RobotTerms) -> tuple[float, ...]:
        """Contact forces and push as arrows."""
        levers = self._levers
        levers[:, :, 0] = m.wrench[:, :3]
        for lever, wrench in zip(levers, m.wrench, strict=True):
            x, y = centre_of_pressure(wrench)
            lever[:2, 1] = (0.0, 0.0) if x != x else (x, y)
        turned = np.matmul(terms.sole_rotation, levers)
        left, right = turned[:, :, 1] + terms.sole_position
        push = force_arrow(self._poses.position[self._torso], m.external_force)
        return (*force_arrow(left, turned[0, :, 0]), *force_arrow(right, turned[1, :, 0]), *push)


class SeatView(RobotView):
    """Everything that is drawn of a robot whose controller has no plan."""

    def __init__(self, writer: LogWriter, world: World, robot: RobotDescription, control_rate: int) -> None:
        super().__init__(writer, world, robot, control_rate)
        self._events = EventLog(writer)

    def events(self, time_ns: int, measurement: Measurement, contact: tuple[bool, bool], fallen: bool) -> None:
        """Log what has changed since the last control tick; feet that stand are (left, right)."""
        force = measurement.external_force
        self._events.update(time_ns, contact, force, fallback=False, falling=False, fallen=fallen)


class BodyView(RobotView):
    """Everything that is drawn of a run in full physics."""

    def __init__(self, writer: LogWriter, world: World, robot: RobotDescription, control_rate: int) -> None:
        super().__init__(writer, world, robot, control_rate)
        self._walk = WalkView(writer, 0.5 * robot.sole_length, 0.5 * robot.sole_width)
        self._events = EventLog(writer)

    def events(self, time_ns: int, measurement: Measurement, report: WbcReport, plan: WalkPlan, fallen: bool) -> None:
        """Log what has changed since the last control tick."""
        force, status = measurement.external_force, plan.status
        fallback = report.status >= _FALLBACK or status.solver is _HELD
        self._events.update(time_ns, report.active, force, fallback, status.falling, fallen, status.acted)

    def _planned(
        self, time_ns: int, measurement: Measurement, terms: RobotTerms, plan: WalkPlan, sample: PlanSample
    ) -> None:
        zmp = measured_zmp(measurement.wrench, terms.sole_position, terms.sole_rotation)
        self._walk.update(time_ns, terms.com, terms.com_velocity, zmp, plan, sample)
