"""The simulated world: one robot on one terrain, under pushes, on an integer physics clock."""

import copy
import logging
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.forces import Push
from surefoot.joints import JointCommand
from surefoot.models.convert import Coordinates
from surefoot.models.types import RobotDescription, nearest
from surefoot.planner.ground.terrain import Terrain
from surefoot.sim.bodies import BodyPoses
from surefoot.sim.checkpoint import Checkpoint, is_finite
from surefoot.sim.drives import Drives
from surefoot.sim.errors import SimulationDiverged, WorldError
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.pushes import PushSchedule, physics_window
from surefoot.sim.scene import world_mjcf
from surefoot.sim.sensors import SensorReader
from surefoot.similarity import REFERENCE_SIZE, Similarity

_LOG = logging.getLogger(__name__)


class World:
    """A robot in MuJoCo.

    Args:
        description: the robot.
        terrain: the ground.
        physics_rate: physics steps per second [Hz].
        pushes: forces on bodies of the robot.
        size: of the robot, with which the ground's compliance goes.
        drives: its motors; None for ones that give each torque at once.

    Raises:
        WorldError: a push names an unknown body or has a negative time, no duration or a force that is not finite.

    Attributes:
        description: the robot.
        physics_rate: physics steps per second [Hz].
        tick: physics steps since the reset.
        data: MuJoCo's state; for renderers and tests to look at.
    """

    def __init__(
        self,
        description: RobotDescription,
        terrain: Terrain,
        physics_rate: int,
        pushes: Sequence[Push] = (),
        size: Similarity = REFERENCE_SIZE,
        drives: Drives | None = None,
    ) -> None:
        for index, push in enumerate(pushes):
            _check_push(push, description, ("pushes", index))
        self.description = description
        self.physics_rate = physics_rate
        self.tick = 0
        _log_warnings()
        self._mjcf = world_mjcf(description, terrain, 1.0 / physics_rate, size)
        self._model, self._is_shared = _compiled(self._mjcf), True
        self.data = mujoco.MjData(self._model)
        self._drives, self._coordinates = drives, Coordinates(self._model)
        self._pushes = PushSchedule(pushes, [self._model.body(push.body).id for push in pushes], physics_rate)
        self._sensors = SensorReader(self._model, self.data, description, self._pushes)
        self._ctrl, self._qpos, self._qvel = self.data.ctrl, self.data.qpos, self.data.qvel
        self._xfrc, self._sound = self.data.xfrc_applied, Checkpoint(self.data)
        self._torque = self._ctrl if drives is None else np.zeros(self._model.nu)

    @property
    def model(self) -> mujoco.MjModel:
        """MuJoCo's model, without the geoms that are only drawn, for whoever wants to look at it or to change it.

        Worlds of equal text have the same one until they are asked for it: a copy takes as long as all else of a world.
        """
        if self._is_shared:
            self._model, self._is_shared = copy.copy(self._model), False
            self._sensors.model = self._model
        return self._model

    @property
    def time(self) -> float:
        """Simulated time since the reset [s]."""
        return self.tick / self.physics_rate

    @property
    def angles(self) -> Array:
        """Angles of the joints now, shape (nj,) [rad]."""
        found: Array = self._qpos[self._coordinates.positions]
        return found

    @property
    def apart(self) -> Array:
        """Distance of each joint that follows another one from where it belongs now, shape (nf,) [rad]."""
        return self._coordinates.apart(self._qpos)

    def mjcf(self) -> str:
        """The whole world as one MJCF text, exactly what is simulated."""
        return self._mjcf

    def poses(self) -> BodyPoses:
        """Poses of its bodies as it was made, whatever its model has become."""
        return BodyPoses(_compiled(self._mjcf))

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None, tick: int = 0) -> None:
        """Start from a state in Pinocchio's convention, without the pushes that were added since.

        Args:
            q: configuration, shape (7 + nj,) [m, -, rad].
            v: velocity, shape (6 + nj,) [m/s, rad/s]; rest if None.
            torque: joint torques that the first measured contact forces belong to, shape (nj,) [N m]; none if None.
            tick: physics step at which it starts; the world's own pushes begin with the first.
        """
        mujoco.mj_resetData(self._model, self.data)
        self._coordinates.to_mujoco(q, np.zeros(len(q) - 1) if v is None else v, self._qpos, self._qvel)
        self._pushes.rewind(self._xfrc)
        self.tick = tick
        if torque is not None:
            self._ctrl[:] = torque
        if self._drives is not None:
            self._drives.rewind(self._ctrl)
        mujoco.mj_forward(self._model, self.data)

    def measure(self) -> Measurement:
        """Measure the true state now."""
        return self._sensors.read(self.tick / self.physics_rate)

    def push(self, push: Push) -> None:
        """Add a push while the world runs; it acts beside the others, with its whole impulse, until the next reset.

        Args:
            push: starts at `time` or later.

        Raises:
            WorldError: it starts in the past, or could not have been given to the constructor.
        """
        _check_push(push, self.description, ("push",))
        if physics_window(push.time, push.duration, self.physics_rate)[0] < self.tick:
            what = f"push on '{push.body}' at {push.time} s, which is in the past"
            raise WorldError(("push", "time"), what, f"it must start at {self.time} s or later")
        self._pushes.add(push, self._model.body(push.body).id, self.tick)

    def advance(self, torque: Array, steps: int) -> None:
        """Simulate with constant commanded torques.

        Args:
            torque: commanded joint torques, shape (nj,) [N m]; the motors clip them to their limits.
            steps: physics steps.

        Raises:
            SimulationDiverged: the torque or the state is not finite.
        """
        self._torque[:] = torque
        if not is_finite(self._torque):
            raise SimulationDiverged(self.time, "the commanded torque is not finite")
        self._sound.keep()
        if self._drives is not None:
            self._drives.tell(self.tick, torque)
        pushes, tick, end = self._pushes, self.tick, self.tick + steps
        pushes.mean[:] = 0.0
        while tick < end:
            if tick >= pushes.next_change:
                pushes.step_over(self._xfrc)
            stop = min(end, pushes.next_change)
            if self._drives is not None:
                self._ctrl[:], stop = self._drives.torque(tick, self._qvel[self._coordinates.velocities]), tick + 1
            mujoco.mj_step(self._model, self.data, stop - tick)
            if pushes.active:
                pushes.mean += (stop - tick) / steps * pushes.total
            tick = stop
        if self._sound.diverged():
            self._diverge()
        self.tick = end

    def act(self, command: JointCommand, period: float) -> None:
        """Simulate what is commanded for so long, a whole number of physics steps [s].

        Drives with gains are faster than a step of the physics. Within it they count with the speed that they make, as
        in an implicit step of their joint's own inertia. So no damping is too much for a light limb.

        Raises:
            SimulationDiverged: the torque or the state is not finite.
        """
        steps = round(period * self.physics_rate)
        if command.servo is None:
            self.advance(command.torque, steps)
            return
        pushed, h = np.zeros(3), 1.0 / self.physics_rate
        s, own = command.servo, self._coordinates
        share = 1.0 / (1.0 + h * (s.damping + h * s.stiffness) / own.inertia(self._model))
        for _ in range(steps):
            q, v = self._qpos[own.positions], self._qvel[own.velocities]
            pull = s.stiffness * (s.position - q - h * v) + s.damping * (s.velocity - v)
            self.advance(command.torque + share * pull, 1)
            pushed += self._pushes.mean
        self._pushes.mean[:] = pushed / steps

    def _diverge(self) -> None:
        self._sound.restore()
        self.data.qacc_warmstart[:] = 0.0
        mujoco.mj_forward(self._model, self.data)
        raise SimulationDiverged(self.time, "the acceleration is not finite")


@lru_cache(maxsize=4)
def _compiled(mjcf: str) -> mujoco.MjModel:
    """The model without its drawn geoms, whose frames would cost 8 % of a physics step; to be copied, not changed.

    It is kept since MuJoCo takes 40 ms to compile it, and the runs of a campaign have few worlds.
    """
    spec = mujoco.MjSpec.from_string(mjcf)
    spec.compiler.discardvisual = True
    return spec.compile()


def _log_warnings() -> None:
    """Send the engine's warnings to `logging`; by default it writes a file into the working directory."""
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(_LOG.warning)


def _check_push(push: Push, description: RobotDescription, key: tuple[str | int, ...]) -> None:
    if push.body not in description.bodies:
        raise WorldError((*key, "body"), f"push on unknown body '{push.body}'", nearest(push.body, description.bodies))
    sound = {
        "time": (0.0 <= push.time < np.inf, "start at 0 s or later"),
        "duration": (0.0 < push.duration < np.inf, "last longer than 0 s"),
        "force": (np.shape(push.force) == (3,) and np.isfinite(push.force).all(), "have a finite force along x, y, z"),
    }
    for name, (right, rule) in sound.items():
        if not right:
            what = f"push on '{push.body}' at {push.time} s for {push.duration} s with {push.force} N"
            raise WorldError((*key, name), what, f"it must {rule}")
