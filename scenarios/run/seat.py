"""The closed loop of a controller that has the seat of planner and whole-body controller: a policy, or of a package."""

import json
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Protocol, cast

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand
from surefoot.parts.guard import Guarded, MisfitError, taken_for
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import PhaseInfo
from surefoot.readings import Readings
from surefoot.scenarios.file.registries import CONTROLLERS, DEFAULTS
from surefoot.scenarios.log import AttachedFile, LogWriter
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.coupling import CouplingRecorder
from surefoot.scenarios.record.foxglove.views import SeatView
from surefoot.scenarios.record.provenance import SEAT_RECORD, WORLD_FILE
from surefoot.scenarios.record.readings import ReadingsRecorder
from surefoot.scenarios.record.seat import SeatRecorder
from surefoot.scenarios.run.assembly import Parts
from surefoot.scenarios.run.felt import FeltGait
from surefoot.scenarios.run.full import plant_of, simulated
from surefoot.scenarios.run.moved import Moved, coupling_of, instruments_of, sensors_of
from surefoot.scenarios.run.planning import ROUNDING, RunFault
from surefoot.scenarios.run.plant import Plant, Sensors, completed, push_plant
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.run.tick import Look, Spent
from surefoot.scenarios.setup.parts import fit
from surefoot.scenarios.setup.robot.body import Body, body_of, feet_at
from surefoot.scenarios.setup.seat import STANDING, velocities
from surefoot.scenarios.setup.stances.start import disturbed, pressed
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.sim.measurement import Measurement
from surefoot.sim.readings import SensorSuite
from surefoot.sim.world import World
from surefoot.wbc.contact.zmp import measured_zmp

Array = NDArray[np.float64]


class SeatedController(Protocol):
    """A controller in the seat of planner and whole-body controller: from measured values to a joint command.

    It is made of a `Walk` and of ``controller.options``, and then reset once. It is asked at every control tick, and
    gives the same command until its own next one is due.

    It may have more: ``reads``, whether it is given what sensors say, which else ``sensing.source`` tells; ``told``,
    arrays for the log by name, another mapping whenever it has decided; ``followed``, the velocity that it makes of the
    one commanded, a `surefoot.Twist`.

    Attributes:
        parameters: for the log, by name; JSON.
        posture: angles of the joints at the start, shape (nj,) [rad].
    """

    parameters: Mapping[str, Any]
    posture: Array

    def reset(self, q: Array) -> None:
        """Begin anew.

        Args:
            q: configuration in which it stands, as far as sensors can know it, shape (nq,) [m, -, rad].
        """
        ...

    def step(self, readings: Readings | Measurement, command: Command | None = None) -> JointCommand:
        """Compute the command of the joints from now on.

        Args:
            readings: what sensors say, or the truth.
            command: a velocity to follow from now on, and whether it marches where that is zero; None goes on.
        """
        ...


def seat_loop(walk: Walk, writer: LogWriter, parts: Parts | None = None) -> ClosedLoop:
    """Put the parts of one run together, with the robot standing in the posture of the controller.

    Args:
        walk: what to run.
        writer: gets every boundary crossing.
        parts: what a user replaces.

    Raises:
        ParameterError: a part refuses its parameters.
    """
    parts = parts or Parts()
    body = body_of(walk.robot)
    controller = seated(walk)
    q = pressed(disturbed(standing(walk, body, controller.posture), walk, body), walk.size.length)
    world, senses = simulated(walk), bool(getattr(controller, "reads", walk.sensing.source != DEFAULTS["sensing"]))
    plant = plant_of(walk, world, parts, senses)
    world.reset(q)
    if not isinstance(plant, World):
        plant.reset(q)
        for push in walk.pushes:
            push_plant(plant, push)
    controller.reset(q)
    nj = len(walk.robot.joint_names)
    sizes = Sizes(nj=nj, nq=7 + nj, nv=6 + nj, horizon=1, nf=len(walk.robot.couplings))
    writer.attach(AttachedFile(WORLD_FILE, "application/xml", world.mjcf().encode()))
    parameters = {str(name): json.dumps(value) for name, value in controller.parameters.items()}
    writer.add_metadata(SEAT_RECORD, {"name": name_of(walk), **parameters})
    recorder, view = (
        SeatRecorder(writer, sizes, walk.robot.torque_limit),
        SeatView(writer, world, walk.robot, walk.rates.control),
    )
    sensors = sensors_of(walk, plant, senses)
    read = None if sensors is None else (sensors, ReadingsRecorder(writer, sizes))
    walker = Seated(walk, controller, plant, read, recorder, view, coupling_of(writer, sizes, plant))
    return ClosedLoop.of(walk, walker, recorder, instruments_of(walk, writer, walker))


def name_of(walk: Walk) -> str:
    """Name of the controller in the seat of a walk."""
    return (walk.seat.name if walk.seat is not None else None) or DEFAULTS["controller"]


def seated(walk: Walk) -> SeatedController:
    """The controller in the seat of a walk, behind its guard.

    Raises:
        ParameterError: it refuses the walk.
        PartError: it is of others and cannot be made.
    """
    seat, name = walk.seat, name_of(walk)
    assert seat is not None
    options = {**(seat.options or {}), **({} if seat.policy is None else {"file": seat.policy, "digest": seat.digest})}
    maker, guard = CONTROLLERS[name], CONTROLLERS.guard(name)
    joints = len(walk.robot.joint_names)
    with guard.making:
        made = maker(walk, **options)
        fit(made.posture, (joints,), "posture")
        if not isinstance(made.parameters, Mapping):
            raise MisfitError("has parameters that are no mapping")
        json.dumps(dict(made.parameters))
        for verb in ("reset", "step"):
            if not callable(getattr(made, verb, None)):
                raise MisfitError(f"has no method {verb}")
    return cast("SeatedController", Guarded(made, guard, {"step": _commanded(joints)}) if guard.who else made)


def _commanded(joints: int) -> Callable[..., JointCommand]:
    """A check of commands of so many joints."""

    def take(answer: JointCommand, *_: Any) -> JointCommand:
        taken_for(JointCommand)(answer)
        fit(answer.torque, (joints,), "torque")
        if answer.servo is not None:
            for name in ("position", "velocity", "stiffness", "damping"):
                fit(getattr(answer.servo, name), (joints,), f"servo.{name}")
        return answer

    return take


def standing(walk: Walk, body: Body, posture: Array) -> Array:
    """The configuration, shape (nq,), in which joints of a posture, shape (nj,), stand on the lower sole.

    The pelvis is as upright as makes the soles level, the middle of the feet where the walk starts.
    """
    start, ground = walk.start, walk.ground.start_height
    q = pin.neutral(body.model)
    q[7:] = posture
    data = body.scratch.data
    pin.framesForwardKinematics(body.model, data, q)
    soles = [data.oMf[body.model.getFrameId(name)] for name in body.frames.soles]
    normal = np.mean([sole.rotation[:, 2] for sole in soles], axis=0)
    upright = pin.Quaternion.FromTwoVectors(normal / np.linalg.norm(normal), np.array([0.0, 0.0, 1.0]))
    turned = pin.SE3(pin.utils.rotate("z", start.yaw) @ upright.matrix(), np.zeros(3))
    q[:7] = pin.SE3ToXYZQUAT(turned)
    feet = feet_at(body, q).position
    q[:2] += np.array([start.x, start.y]) - feet[:, :2].mean(axis=0)
    q[2] += ground - feet[:, 2].min()
    found: Array = q
    return found


def placed(walk: Walk, q: Array) -> Walk:
    """The walk as one that begins with the feet where a configuration, shape (nq,), has them."""
    feet = feet_at(body_of(walk.robot), q).position
    width = float(np.linalg.norm(feet[0, :2] - feet[1, :2]))
    gait = walk.keys.gait.model_copy(update={"step_width": width})
    return resolve(walk.keys.model_copy(update={"gait": gait}), walk.described)


class Seated(Moved):
    """A robot under a controller without a plan; a `Walker`.

    Args:
        walk: what is run.
        controller: that has the seat, reset to the start.
        plant: what moves the robot, reset to the start.
        sensors: that the controller reads, and what records them; None for one that is given the measurement.
        recorder: of its channels.
        view: of what MCAP viewers show.
        coupled: records how joints follow others; None of a robot that has no such joints, and of another plant.

    Attributes:
        mind: the controller.
    """

    planning = None
    controller = None

    def __init__(
        self,
        walk: Walk,
        controller: SeatedController,
        plant: Plant,
        sensors: "tuple[SensorSuite | Sensors, ReadingsRecorder] | None",
        recorder: SeatRecorder,
        view: SeatView,
        coupled: CouplingRecorder | None,
    ) -> None:
        super().__init__(walk, plant, sensors and sensors[0], known=False)
        self._sensed = sensors and sensors[1]
        self._guard = CONTROLLERS.guard(name_of(walk))
        self.mind, self._recorder, self._view = controller, recorder, view
        self._coupled = coupled
        self._felt = FeltGait(walk.true_mass, walk.size)
        self._waiting, self._rate = deque(velocities(walk)), walk.rates.control
        self._twist, self._heard = STANDING, False
        self._no_torque = JointCommand(np.zeros(len(walk.robot.joint_names)))
        self._reported: Mapping[str, Array] | None = None

    @property
    def gait(self) -> tuple[float, PhaseInfo]:
        """See `Walker`."""
        return self.measurement.time, self._felt.phase

    @property
    def orders(self) -> Command:
        """See `Walker`."""
        followed = getattr(self.mind, "followed", self._twist)
        return Command(self._twist, followed=followed)

    def command(self, command: Command, now: float) -> None:
        """See `Walker`."""
        for name in ("places", "single_support", "double_support", "swing_height"):
            if getattr(command, name) is not None:
                what = f"a command of {name} to a controller that hears velocities alone"
                raise ParameterError(("command", name), what, "give it a velocity")
        self._waiting.appendleft(replace(command, time=now))

    def sees(self, now: float) -> tuple[Readings | Measurement, Command | None]:
        """Readings and last command that the controller will be given at an instant [s] that has been sensed."""
        found = None
        for command in self._waiting:
            if command.time * self._rate <= now * self._rate + ROUNDING:
                found = command
        return self._readings, found

    def control(self, tick: int, now: float) -> tuple[None, Spent]:
        """See `Walker`."""
        begin = time.perf_counter()
        measurement = self.measurement
        if not np.isfinite(measurement.q).all() or self.lost(tick, "state_nan"):
            raise RunFault(f"the measured state is not finite at {now:.3f} s")
        self._felt.update(now, measurement.wrench[:, 2])
        command = self.mind.step(self._readings, self._due(now))
        assert self._own_truth is not None
        self._truth = self._own_truth
        self._command = self._no_torque if self.lost(tick, "torque_loss") else command
        if self.foreign:
            torque = self._torque()
            self.measurement = completed(measurement, np.full((2, 6), np.nan), torque)
        return None, Spent(state=time.perf_counter() - begin)

    def _due(self, now: float) -> Command | None:
        """The last of what is to be heard by now [s]."""
        found = None
        while self._waiting and self._waiting[0].time * self._rate <= now * self._rate + ROUNDING:
            found = self._waiting.popleft()
        if found is None:
            return None
        self._twist, self._heard = found.twist or STANDING, True
        return Command(self._twist, time=now, march=found.march)

    def _torque(self) -> Array:
        """Torques that the joints are given at this instant, shape (nj,) [N·m]."""
        measurement = self.measurement
        return self._command.torque_at(measurement.joint_position, measurement.joint_velocity)

    def record(self, now_ns: int, sample: None) -> None:
        """See `Walker`."""
        recorder, felt, truth = self._recorder, self._felt, self._truth
        recorder.tick(now_ns, self.measurement, truth, self._torque(), felt.contact, felt.phase)
        if felt.landed is not None:
            recorder.landed(now_ns, felt.landed, felt.step, truth)
        if self._heard:
            recorder.command(now_ns, self.orders)
            self._heard = False
        reported = getattr(self.mind, "told", None)
        if reported is not None and reported is not self._reported:
            with self._guard:
                recorder.reported(now_ns, reported)
            self._reported = reported
        if self._coupled is not None:
            self._coupled.tick(now_ns)
        if self._sensed is not None and isinstance(self._readings, Readings):
            self._sensed.tick(now_ns, self._readings)

    def draw(self, tick: int, now_ns: int, plan: WalkPlan | None, sample: None, fallen: bool) -> None:
        """See `Walker`."""
        self._view.events(now_ns, self.measurement, self._felt.contact, fallen)
        self._view.picture(tick, now_ns, self.measurement, self._truth)

    def look(self) -> Look:
        """See `Walker`."""
        truth = self._truth
        zmp = measured_zmp(self.measurement.wrench, truth.sole_position, truth.sole_rotation)
        com, velocity = truth.com.copy(), truth.com_velocity.copy()
        return Look(com, velocity, np.array(zmp[:2]), measurement=self.measurement)
