"""The closed loop in full physics: a simulated robot under its controller, and the log around it."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.parts.guard import Guard
from surefoot.parts.plugins import Registry
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.plan.sample import PlanSample
from surefoot.readings import Readings
from surefoot.scenarios.file.control import PlantSettings
from surefoot.scenarios.file.registries import DEFAULTS, PLANT_NAMES
from surefoot.scenarios.log import AttachedFile, LogWriter
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.foxglove.views import BodyView
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.record.walk import WalkRecorder
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.controller import Controller
from surefoot.scenarios.run.driven import Somebody
from surefoot.scenarios.run.moved import Moved, coupling_of, instruments_of, sensors_of
from surefoot.scenarios.run.planning import Planned, Planning
from surefoot.scenarios.run.plant import Plant, PlantMaker, Sensors, completed, made, push_plant
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.run.tick import Look, Spent
from surefoot.scenarios.setup.stances.start import at_believed_start, disturbed, pressed
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.drives import IDEAL, Drives
from surefoot.sim.world import World
from surefoot.wbc.body.statics import LEVER, standing_torque
from surefoot.wbc.contact.zmp import measured_zmp
from surefoot.wbc.controller import WholeBodyController

if TYPE_CHECKING:
    from surefoot.scenarios.record.coupling import CouplingRecorder
    from surefoot.scenarios.record.estimation import EstimationRecorder
    from surefoot.sim.readings import SensorSuite

Array = NDArray[np.float64]


def full_loop(walk: Walk, writer: LogWriter, parts: Parts | None = None) -> ClosedLoop:
    """Put the parts of one run together, with the robot standing at its start.

    Controller and planner believe in the robot as described; the simulated one differs by the scenario's errors.

    Args:
        walk: what to run.
        writer: gets every boundary crossing.
        parts: what a user replaces.

    Raises:
        ValueError: a part refuses its parameters, e.g. a start posture out of reach.
    """
    controller = Controller(walk.robot, walk, parts=parts)
    body = controller.body
    q = pressed(disturbed(controller.posture, walk, body), walk.size.length)
    world = simulated(walk)
    plant = plant_of(walk, world, parts or Parts(), controller.senses.reads)
    torque = standing_torque(body.model, body.frames, q, LEVER * walk.size.length, data=body.scratch.data)
    world.reset(q, torque=torque)
    if not isinstance(plant, World):
        plant.reset(q, torque=torque)
        for push in walk.pushes:
            push_plant(plant, push)
    controller.reset(at_believed_start(q, walk, body) if controller.senses.reads else q)
    sizes = controller.sizes
    writer.attach(AttachedFile(WORLD_FILE, "application/xml", world.mjcf().encode()))
    sensors, sensed = sensors_of(walk, plant, controller.senses.reads), None
    body_recorder, recorder = Recorder(writer, sizes, walk.robot.torque_limit), WalkRecorder(writer, sizes)
    view = BodyView(writer, world, walk.robot, walk.rates.control)
    if sensors is not None:
        from surefoot.scenarios.record.estimation import EstimationRecorder

        sensed = EstimationRecorder(writer, sizes)
    controller.planning.recorder = recorder
    coupled = coupling_of(writer, sizes, plant)
    walker = WholeBody(controller, plant, sensors, body_recorder, view, sensed, coupled)
    return ClosedLoop.of(walk, walker, recorder, instruments_of(walk, writer, walker))


def simulated(walk: Walk) -> World:
    """The simulated world of MuJoCo, with the true robot on the true ground, its motors and the scenario's pushes."""
    return _world(walk, walk.pushes, _drives(walk))


def _drives(walk: Walk) -> Drives | None:
    """The motors of a walk; None for ones that give each torque at once."""
    errors = walk.hardware.drives
    return None if errors == IDEAL else Drives(walk.robot, errors, walk.rates.physics, walk.seed)


def _world(walk: Walk, pushes: tuple[Push, ...], drives: Drives | None) -> World:
    return World(walk.true_robot, walk.ground.true_terrain, walk.rates.physics, pushes, walk.size, drives)


def going_on(walk: Walk, **options: object) -> Plant:
    """The plant that says what a log holds up to a time, and is then the simulated world from its state on."""
    from surefoot.scenarios.run.logged import log_plant

    drives = _drives(walk)
    return log_plant(walk, _world(walk, (), drives), drives, options)


PLANTS: Registry[PlantMaker] = PLANT_NAMES
"""Makers of a plant from a walk and ``plant.options``, by the value of ``plant.name``."""


def plant_of(walk: Walk, world: World, parts: Parts, senses: bool) -> Plant:
    """The plant that a program hands over, else that which the scenario names, else the simulated world."""
    keys = walk.keys.plant or PlantSettings()
    name, options = keys.name or DEFAULTS["plant"], keys.options or {}
    if parts.plant is not None:
        return made(parts.plant, walk, options, Guard.of_program("plant", parts.plant), senses)
    if name != DEFAULTS["plant"]:
        return made(PLANTS[name], walk, options, PLANTS.guard(name), senses)
    if options:
        what = f"plant.options of the simulated world, which takes none: {', '.join(options)}"
        raise ParameterError(("plant", "options"), what, "leave them out, or let plant.name name another")
    return world


class WholeBody(Moved, Planned):
    """A robot under its controller; a `Walker`.

    Args:
        mind: its controller, reset to the start.
        plant: what moves it, reset to the start.
        sensors: that the estimator reads; None for one that is given the measurement.
        recorder: of its channels.
        view: of what MCAP viewers show.
        sensed: record what sensors say and what is made of it; None for an estimator that senses nothing.
        coupled: record how joints follow others; None of a robot that has no such joints, and of another plant.

    Attributes:
        mind: its controller.
    """

    def __init__(
        self,
        mind: Controller,
        plant: Plant,
        sensors: "SensorSuite | Sensors | None",
        recorder: Recorder,
        view: BodyView,
        sensed: "EstimationRecorder | None" = None,
        coupled: "CouplingRecorder | None" = None,
    ) -> None:
        walk = mind.walk
        # The controller's terms are those of the true robot in its true state where nothing is believed or estimated.
        super().__init__(walk, plant, sensors, known=mind.senses.is_truth and walk.true_robot is walk.robot)
        self.mind = mind
        self._recorder = recorder
        self._view = view
        self._sensed = sensed
        self._coupled = coupled
        keys, self._somebody = walk.control, None
        if keys.driven_joints and not self.foreign:
            self._somebody = Somebody(keys, walk.robot, mind.posture[7:], walk.seed)
        self._shares_targets = keys.driven_told is not False
        self._no_torque = JointCommand(np.zeros(mind.whole_body.layout.joints))

    @property
    def planning(self) -> Planning:  # type: ignore[override]
        """See `Walker`."""
        return self.mind.planning

    @property
    def controller(self) -> WholeBodyController:
        """See `Walker`."""
        return self.mind.whole_body

    def control(self, tick: int, now: float) -> tuple[PlanSample, Spent]:
        """See `Walker`."""
        mind = self.mind
        somebody = self._somebody
        if somebody is None:
            command = mind.step(self._readings)
        else:
            theirs = somebody.command(now)
            command = mind.step(self._readings, None, theirs if self._shares_targets else None)
            command = command.with_joints(somebody.joints, theirs)
        self._truth = self._own_truth or mind.terms
        lost = self._faults is not None and self._faults.active("torque_loss", tick)
        self._command = self._no_torque if lost else command
        if self.foreign:
            self.measurement = completed(self.measurement, mind.wrench, self._command.torque)
        return mind.sample, mind.spent

    def record(self, now_ns: int, sample: PlanSample) -> None:
        """See `Walker`."""
        mind, truth, terms = self.mind, self._truth, self.mind.terms
        self._recorder.tick(now_ns, self.measurement, truth, terms, sample, mind.report, self._command.torque)
        if self._coupled is not None:
            self._coupled.tick(now_ns)
        if self._sensed is not None and isinstance(self._readings, Readings):
            forces = self.measurement.wrench[:, 2]
            self._sensed.tick(now_ns, self._readings, mind.estimate, mind.wrench, terms, truth, forces)

    def draw(self, tick: int, now_ns: int, plan: WalkPlan, sample: PlanSample, fallen: bool) -> None:
        """See `Walker`."""
        self._view.events(now_ns, self.measurement, self.mind.report, plan, fallen)
        self._view.picture(tick, now_ns, self.measurement, self._truth, plan, sample)

    def look(self) -> Look:
        """See `Walker`."""
        truth = self._truth
        zmp = measured_zmp(self.measurement.wrench, truth.sole_position, truth.sole_rotation)
        com, velocity = truth.com.copy(), truth.com_velocity.copy()
        return Look(com, velocity, np.array(zmp[:2]), self.mind.state, self.mind.report, self.measurement)
