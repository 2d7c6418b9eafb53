"""A robot in full physics whatever controls it: it is measured, moved and pushed, and may have fallen."""

import math
from typing import TYPE_CHECKING, cast

from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.models.pinocchio import pinocchio_model
from surefoot.scenarios.judge.body import lies
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.run.planning import FaultSchedule, RunFault
from surefoot.scenarios.run.plant import Plant, Sensors, measured_tick, push_plant
from surefoot.scenarios.setup.groups.hardware import refuse_unread
from surefoot.scenarios.setup.robot.body import frames_of
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.errors import SimulationDiverged
from surefoot.sim.measurement import Measurement
from surefoot.sim.world import World
from surefoot.wbc.body.model import RobotTerms

if TYPE_CHECKING:
    from surefoot.scenarios.record.coupling import CouplingRecorder
    from surefoot.scenarios.run.instruments import Instruments
    from surefoot.sim.readings import SensorSuite


def sensors_of(walk: Walk, plant: Plant, senses: bool) -> "SensorSuite | Sensors | None":
    """The sensors of a plant's measurements, for whoever reads them; None where nobody does.

    A run in which nobody reads them does not import them.

    Args:
        walk: what is run.
        plant: that is measured.
        senses: whether somebody reads it.

    Raises:
        ParameterError: there are keys of sensors that nobody reads.
    """
    if not senses:
        refuse_unread(walk.sensing)
        return None
    if not isinstance(plant, World):
        return cast("Sensors", plant)
    from surefoot.sim.readings import SensorSuite

    return SensorSuite(plant, walk.hardware.sensors, walk.rates.control, walk.seed)


def coupling_of(writer: LogWriter, sizes: Sizes, plant: Plant) -> "CouplingRecorder | None":
    """Records how joints follow others; None of a robot that has no such joints, and of another plant."""
    if not isinstance(plant, World) or not sizes.nf:
        return None
    from surefoot.scenarios.record.coupling import CouplingRecorder

    return CouplingRecorder(writer, sizes, plant)


def instruments_of(walk: Walk, writer: LogWriter, moved: "Moved") -> "Instruments | None":
    """The instruments of a run of a robot; None where it has none, which imports none."""
    if not walk.instruments:
        return None
    from surefoot.scenarios.run.instruments import Instruments

    return Instruments(walk, writer, moved)


class Moved:
    """A robot under what moves and measures it; the part of a `Walker` that no controller bears on.

    Args:
        walk: what is run.
        plant: what moves it, reset to the start.
        sensors: that somebody reads; None where nobody does.
        known: whether a controller's terms are those of the true robot in its true state, which it then sets.

    Attributes:
        plant: what moves it.
        measurement: of this tick; its arrays are overwritten by the next.
        foreign: whether the plant is none of Surefoot's own.
    """

    def __init__(self, walk: Walk, plant: Plant, sensors: "SensorSuite | Sensors | None", known: bool) -> None:
        self.walk, self.plant, self._sensors = walk, plant, sensors
        self.foreign = not isinstance(plant, World)
        self._says_tick = self.foreign and hasattr(plant, "control_tick")
        self._own_truth = None if known else RobotTerms(pinocchio_model(walk.true_robot), frames_of(walk.robot))
        self._faults = FaultSchedule(walk.faults, walk.rates.control) if walk.faults else None
        self._period = 1.0 / walk.rates.control
        self._nominal_height = walk.true_com_height
        self.measurement: Measurement
        self._command: JointCommand
        self._truth: RobotTerms

    def sense(self, tick: int, now: float) -> int:
        """See `surefoot.scenarios.run.skeleton.Walker`; of a plant that says at which tick it measured, that."""
        self.measurement = measurement = self.plant.measure()
        self._readings = measurement if self._sensors is None else self._sensors.read(measurement, tick)
        if self._own_truth is not None:
            self._own_truth.place(measurement.q, measurement.v)
        if not self._says_tick:
            return tick
        return measured_tick(self.plant.control_tick, tick, self.walk.rates.control)  # type: ignore[attr-defined]

    def lost(self, tick: int, kind: str) -> bool:
        """Return true if a fault of a kind acts at a control tick."""
        return self._faults is not None and self._faults.active(kind, tick)

    def fallen(self, sample: object) -> bool:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        terms = self._truth
        soles = terms.sole_position
        height = terms.com.item(2) - min(soles.item(2), soles.item(5))
        tilt = math.acos(min(terms.torso_rotation.item(2, 2), 1.0))
        return bool(lies(height, self._nominal_height, tilt, self.measurement.nonfoot_contact))

    def advance(self, now: float) -> None:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        try:
            self.plant.act(self._command, self._period)
        except SimulationDiverged as fault:
            raise RunFault(str(fault)) from None

    def push(self, push: Push) -> None:
        """See `surefoot.scenarios.run.skeleton.Walker`."""
        push_plant(self.plant, push)
