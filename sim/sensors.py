"""Reading the sensors out of MuJoCo's state, without a look at the forces of single contacts."""

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.maths import algebra
from surefoot.maths.algebra import Vector
from surefoot.models import convert
from surefoot.models.convert import Coordinates
from surefoot.models.types import RobotDescription
from surefoot.sim.contacts import ContactSense
from surefoot.sim.errors import WorldError
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.pushes import PushSchedule

ROUND_OFF = 1e-9
"""Share of a push below which what remains of a body's external force is rounding."""


class SensorReader:
    """Fills one set of buffers; array views are made once, since making them costs more than reading them.

    MuJoCo has already moved the joints to the end of the step while body frames, accelerations and contact forces
    still are those of its beginning. So joint state and gyro are read from the joints, the rest from that one instant.

    The IMU must sit in the frame of the floating base: then the gyro is the base's angular velocity and the
    accelerometer needs no kinematics.

    Attributes:
        model: MuJoCo's model, for which the world may put its own copy.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, description: RobotDescription, pushes: PushSchedule
    ) -> None:
        """Look at a world; `pushes` are those of its latest steps."""
        self.model = model
        self._data = data
        self._pushes = pushes
        self._coordinates = Coordinates(model)
        base = model.body(description.pelvis_body).id
        _check_imu(model, description, base)
        sites = [model.site(name).id for name in description.sole_sites]
        feet = [int(model.site_bodyid[site]) for site in sites]
        self._qpos, self._qvel, self._joint_force = data.qpos, data.qvel, data.qfrc_actuator[6:]
        self._acceleration, self._gravity = data.qacc[:3], model.opt.gravity.copy()
        self._base, self._com = data.xmat[base].reshape(3, 3), data.subtree_com[base]
        self._body_com, self._external = data.xipos, data.cfrc_ext
        self._contact = np.zeros((model.nbody, 6))
        self._mean = pushes.mean
        self._touch = ContactSense(model, data, feet)
        wrench = np.zeros((2, 6))
        self._soles = [
            Sole(foot, data.site_xpos[site], data.site_xmat[site].reshape(3, 3), felt)
            for foot, site, felt in zip(feet, sites, wrench, strict=True)
        ]
        self._couples, size = self._coordinates.G is not None, self._coordinates.size
        self._allocate(size, size - 1, wrench)

    def _allocate(self, nq: int, nv: int, wrench: Array) -> None:
        q = np.zeros(nq)
        v = np.zeros(nv)
        torque = np.zeros(nv - 6)
        felt = np.zeros(3)
        push = np.zeros(3)
        self._q = q
        self._v = v
        self._torque = torque
        self._accelerometer = felt
        self._push = push
        q = _read_only(q)
        v = _read_only(v)
        torque = _read_only(torque)
        felt = _read_only(felt)
        # Of a measurement, from the joints' positions to the push.
        self._views = (q[7:], v[6:], torque, v[3:6], felt, _read_only(wrench), q, v, _read_only(push))

    def read(self, time: float) -> Measurement:
        """Everything at `time` [s], where a step of the world ended."""
        mujoco.mj_rnePostConstraint(self.model, self._data)
        if self._pushes.active:
            self._without_pushes()
            self._read(self._contact)
        else:
            self._read(self._external)
        nonfoot_contact, self_contact = self._touch.read()
        return Measurement(time, *self._views, nonfoot_contact, self_contact)

    def _read(self, external: Array) -> None:
        """Fill the buffers; the terrain's forces on the bodies as MuJoCo has them, shape (nbody, 6) [N m, N]."""
        if self._couples:
            self._gather()
        else:
            convert.mujoco_to_pinocchio(self._qpos, self._qvel, self._q, self._v)
            self._torque[:] = self._joint_force
        self._push[:] = self._mean
        specific_force = algebra.subtract(algebra.vector(self._acceleration), algebra.vector(self._gravity))
        algebra.put(self._accelerometer, algebra.rotate_back(self._base, specific_force))
        com = algebra.vector(self._com)
        for sole in self._soles:
            sole.feel(external, com)

    def _gather(self) -> None:
        """Read the independent joints; what follows them is left away."""
        data, own = self._data, self._coordinates
        own.to_pinocchio(data.qpos, data.qvel, self._q, self._v)
        force = data.qfrc_actuator[own.velocities]
        self._torque[:] = force

    def _without_pushes(self) -> None:
        """External forces of the bodies minus the pushes: what the terrain does."""
        self._contact[:] = self._external
        for body, force in self._pushes.active:
            self._take_off(body, algebra.vector(force))

    def _take_off(self, body: int, force: Vector) -> None:
        lever = algebra.subtract(algebra.row(self._body_com, body), algebra.vector(self._com))
        torque = algebra.subtract(algebra.row(self._contact, body), algebra.cross(lever, force))
        rest = algebra.subtract(algebra.row(self._contact, body, 3), force)
        if _largest(torque, rest) < ROUND_OFF * _largest(force, force):
            torque, rest = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        algebra.put_row(self._contact, body, torque)
        algebra.put_row(self._contact, body, rest, 3)


class Sole:
    """A sole's centre and axes in the world, and the wrench that the ground exerts there.

    Args:
        foot: number of its body.
        position: of its centre, shape (3,) [m].
        rotation: of its axes, shape (3, 3).
        wrench: in its axes, force first, shape (6,) [N, N·m], which is written.
    """

    def __init__(self, foot: int, position: Array, rotation: Array, wrench: Array) -> None:
        self.foot = foot
        self.position = position
        self.rotation = rotation
        self.wrench = wrench

    def feel(self, external: Array, com: Vector) -> None:
        """Take over the spatial force on its body, which MuJoCo has about the CoM in world axes, torque first.

        Args:
            external: forces on all bodies, shape (nbody, 6) [N·m, N].
            com: of the robot in the world [m].
        """
        torque, force = algebra.row(external, self.foot), algebra.row(external, self.foot, 3)
        lever = algebra.subtract(com, algebra.vector(self.position))
        torque = algebra.add(algebra.cross(lever, force), torque)
        algebra.put(self.wrench[:3], algebra.rotate_back(self.rotation, force))
        algebra.put(self.wrench[3:], algebra.rotate_back(self.rotation, torque))


def _largest(a: Vector, b: Vector) -> float:
    """Largest size of the numbers of two vectors."""
    return max(abs(a[0]), abs(a[1]), abs(a[2]), abs(b[0]), abs(b[1]), abs(b[2]))


def _read_only(array: Array) -> Array:
    view: Array = array[:]
    view.setflags(write=False)
    return view


def _check_imu(model: mujoco.MjModel, description: RobotDescription, base: int) -> None:
    site = model.site(description.imu_site).id
    at_base = model.site_bodyid[site] == base and not model.site_pos[site].any()
    if not (at_base and np.array_equal(model.site_quat[site], (1.0, 0.0, 0.0, 0.0))):
        what = f"site {description.imu_site} of {description.name} is not the frame of {description.pelvis_body}"
        raise WorldError(("description", "imu_site"), what, "it must coincide with the floating base")
