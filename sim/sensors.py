"""Reading the sensors out of MuJoCo's state, without a look at the forces of single contacts."""

from collections.abc import Callable

import numpy as np

from surefoot.engine import mujoco
from surefoot.models.convert import Coordinates, mujoco_to_pinocchio
from surefoot.models.types import RobotDescription
from surefoot.native.library import Library, library
from surefoot.sim.contacts import ContactSense
from surefoot.sim.errors import WorldError
from surefoot.sim.measurement import Array, Measurement
from surefoot.sim.pushes import PushSchedule
from surefoot.values import maker

_a_measurement = maker(Measurement)

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
        self.model, self._data, self._pushes, self._coordinates = model, data, pushes, Coordinates(model)
        base = model.body(description.pelvis_body).id
        _check_imu(model, description, base)
        soles = [model.site(name).id for name in description.sole_sites]
        feet = [int(model.site_bodyid[sole]) for sole in soles]
        self._qpos, self._qvel, self._qacc_base = data.qpos, data.qvel, data.qacc[:3]
        self._joint_force, self._couples = data.qfrc_actuator[6:], self._coordinates.G is not None
        if self._couples:
            size = len(description.joint_names)
            self._qpos, self._qvel, self._joint_force = np.zeros(7 + size), np.zeros(6 + size), np.zeros(size)
        self._base_rotation = data.xmat[base].reshape(3, 3)
        self._gravity = model.opt.gravity.copy()
        self._com, self._body_com = data.subtree_com[base], data.xipos
        self._soles = [
            (foot, data.site_xpos[sole], data.site_xmat[sole]) for foot, sole in zip(feet, soles, strict=True)
        ]
        self._external = data.cfrc_ext
        self._contact: Array = np.zeros((model.nbody, 6))
        self._touch = ContactSense(model, data, feet)
        self._allocate(len(self._qpos), len(self._qvel))
        kernels = library()
        self._read_compiled = self._compiled(kernels, data) if kernels else None

    def _allocate(self, nq: int, nv: int) -> None:
        self._q, self._v, self._torque = np.zeros(nq), np.zeros(nv), np.zeros(nv - 6)
        self._specific_force, self._accelerometer = np.zeros(3), np.zeros(3)
        self._wrench, self._push = np.zeros((2, 6)), np.zeros(3)
        q, v = _read_only(self._q), _read_only(self._v)
        torque, felt, wrench = _read_only(self._torque), _read_only(self._accelerometer), _read_only(self._wrench)
        self._views = q[7:], v[6:], torque, v[3:6], felt, wrench, q, v, _read_only(self._push)
        """Of a measurement, from the joints' positions to the push."""

    def read(self, time: float) -> Measurement:
        """Everything at `time` [s], where a step of the world ended."""
        mujoco.mj_rnePostConstraint(self.model, self._data)
        pushed = bool(self._pushes.active)
        if pushed:
            self._without_pushes()
        if self._couples:
            self._gather()
        if self._read_compiled is None:
            self._read(self._contact if pushed else self._external)
        else:
            self._read_compiled(pushed)
        nonfoot_contact, self_contact = self._touch.read()
        return _a_measurement(time, *self._views, nonfoot_contact, self_contact)

    def _read(self, contact: Array) -> None:
        """Fill the buffers; the terrain's forces on the bodies as MuJoCo has them, shape (nbody, 6) [N m, N]."""
        self._push[:] = self._pushes.mean
        mujoco_to_pinocchio(self._qpos, self._qvel, self._q, self._v)
        self._torque[:] = self._joint_force
        np.subtract(self._qacc_base, self._gravity, out=self._specific_force)
        np.dot(self._specific_force, self._base_rotation, out=self._accelerometer)
        com = self._com.tolist()
        for wrench, (foot, position, rotation) in zip(self._wrench, self._soles, strict=True):
            wrench[:] = _at_sole(contact[foot].tolist(), com, position.tolist(), rotation.tolist())

    def _gather(self) -> None:
        """Put what is of the independent joints side by side, and what follows them away."""
        data, own = self._data, self._coordinates
        self._qpos[:7], self._qvel[:6] = data.qpos[:7], data.qvel[:6]
        self._qpos[7:], self._qvel[6:] = data.qpos[own.positions], data.qvel[own.velocities]
        self._joint_force[:] = data.qfrc_actuator[own.velocities]

    def _compiled(self, kernels: Library, data: mujoco.MjData) -> Callable[[int], None]:
        """The kernel that does what `_read` does."""
        (left, *at_left), (right, *at_right) = self._soles
        return kernels.bind(
            "sensors_read",
            nq=len(self._q),
            nv=len(self._v),
            qpos=self._qpos,
            qvel=self._qvel,
            base_acceleration=self._qacc_base,
            joint_force=self._joint_force,
            base_rotation=self._base_rotation,
            gravity=self._gravity,
            com=self._com,
            push=self._pushes.mean,
            left_external=self._external[left],
            right_external=self._external[right],
            left_contact=self._contact[left],
            right_contact=self._contact[right],
            left_position=at_left[0],
            right_position=at_right[0],
            left_rotation=at_left[1],
            right_rotation=at_right[1],
            q=self._q,
            v=self._v,
            torque=self._torque,
            accelerometer=self._accelerometer,
            wrench=self._wrench,
            pushed=self._push,
        )

    def _without_pushes(self) -> None:
        """External forces of the bodies minus the pushes: what the terrain does."""
        self._contact[:] = self._external
        for body, force in self._pushes.active:
            row = self._contact[body]
            row[:3] -= np.cross(self._body_com[body] - self._com, force)
            row[3:] -= force
            if np.abs(row).max() < ROUND_OFF * np.abs(force).max():
                row[:] = 0.0


def _at_sole(
    external: list[float], com: list[float], position: list[float], rotation: list[float]
) -> tuple[float, ...]:
    """Spatial force about the CoM in world axes (torque first) as a wrench at the sole in sole axes (force first).

    Plain floats: at this size they are faster than arrays.
    """
    tx, ty, tz, fx, fy, fz = external
    x, y, z = com[0] - position[0], com[1] - position[1], com[2] - position[2]
    tx, ty, tz = tx + y * fz - z * fy, ty + z * fx - x * fz, tz + x * fy - y * fx
    a, b, c, d, e, f, g, h, i = rotation
    return (
        a * fx + d * fy + g * fz,
        b * fx + e * fy + h * fz,
        c * fx + f * fy + i * fz,
        a * tx + d * ty + g * tz,
        b * tx + e * ty + h * tz,
        c * tx + f * ty + i * tz,
    )


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
