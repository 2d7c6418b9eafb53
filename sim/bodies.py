"""Places of a robot's bodies, by MuJoCo's kinematics."""

from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Coordinates
from surefoot.sim.measurement import Array

_WXYZ = (6, 3, 4, 5)


class BodyPoses:
    """Poses of all bodies at a configuration, apart from the simulation.

    After a physics step MuJoCo's own poses belong to the state before it; these belong to the configuration given.

    Attributes:
        names: bodies without the world, length n.
        position: of the bodies' frames in the world, shape (n, 3) [m]; overwritten by `update`.
        quaternion: of the bodies' frames in the world, w x y z, shape (n, 4); overwritten by `update`.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model, self._data = model, mujoco.MjData(model)
        self._qpos, self._coordinates = self._data.qpos, Coordinates(model)
        self.names: tuple[str, ...] = tuple(model.body(body).name for body in range(1, model.nbody))
        self.position: Array = self._data.xpos[1:]
        self.quaternion: Array = self._data.xquat[1:]

    def update(self, q: Array) -> None:
        """Move the bodies to a configuration in Pinocchio's convention, shape (7 + nj,)."""
        self._qpos[:3], self._qpos[3:7] = q[:3], q.take(_WXYZ)
        self._coordinates.bend(q[7:], self._qpos)
        mujoco.mj_kinematics(self._model, self._data)
