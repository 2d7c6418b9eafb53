"""Points and outlines of a walk, whatever its fidelity: a picture every few hundredths of a second."""

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.message import Message as ProtobufMessage
from numpy.typing import NDArray

from planner.plan import WalkPlan
from planner.sampling import PlanSample
from planner.types import SolverStatus
from scenarios.log import LogWriter
from scenarios.log.template import Template
from scenarios.viewer import templates
from scenarios.viewer.drawing import NOWHERE, Outlines
from scenarios.viewer.events import EventLog
from scenarios.viewer.schemas import published

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
        self._channel = writer.message_channel(topic, published(schema), doc)
        self._template = template

    def append(self, time_ns: int, values: Sequence[float]) -> None:
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
        x, y, _ = centre = com.tolist()
        vx, vy, _ = com_velocity.tolist()
        in_flight = zmp[0] != zmp[0]
        ground = self._shape.ground if in_flight else zmp[2]
        true_dcm = (x + vx / s.omega, y + vy / s.omega, ground)
        planned = (*s.zmp.tolist(), ground, *true_dcm, *s.dcm.tolist(), ground)
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
        """Say what has changed since the last control tick; ``force`` is the push, shape (2,) [N]."""
        self._events.update(time_ns, contact, bool(np.dot(force, force)), plan.status.solver is _HELD, lost)

    def picture(
        self, tick: int, time_ns: int, com: Array, com_velocity: Array, zmp: Array, plan: WalkPlan, sample: PlanSample
    ) -> None:
        """Draw a control tick, if it is one that is drawn; arguments as of `WalkView`, the ZMP as x y."""
        if tick % self._every == 0:
            ground = min(float(foot.position[2]) for foot in plan.footholds)
            x, y = zmp.tolist()
            self._walk.update(time_ns, com, com_velocity, (x, y, ground), plan, sample)
