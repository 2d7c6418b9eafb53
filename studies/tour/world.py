"""The simulated world of the tour: its robot on flat ground, under punches, with the benchmark's physics."""

from functools import lru_cache
from itertools import product
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.joints import JointCommand
from surefoot.models.convert import mujoco_to_pinocchio, pinocchio_to_mujoco
from surefoot.models.types import RobotDescription
from surefoot.planner.geometry.plane import headings
from surefoot.sim.measurement import Measurement
from surefoot.studies.tour.robot import TourRobot
from surefoot.studies.tour.rules import Punch

Array = NDArray[np.float64]

RATE = 500
"""Steps of the physics in a second [Hz]."""

_FLOOR = {"name": "floor", "type": "plane", "size": "0 0 0.05", "contype": "1", "conaffinity": "0"}


class TourWorld:
    """The robot of the tour in MuJoCo.

    Args:
        description: of the robot.
        robot: what the harness says of it.

    Attributes:
        model: MuJoCo's model.
        data: MuJoCo's state.
        energy: magnitude of the joints' power, integrated since the reset, shape (nj,) [J].
        torque: of the joints in the last step, after their limits, shape (nj,) [N·m].
    """

    def __init__(self, description: RobotDescription, robot: TourRobot) -> None:
        self.model = _compiled(world_text(description, robot))
        self.data = mujoco.MjData(self.model)
        self._limit = np.array(description.torque_limit)
        self._pelvis = self.model.body(description.pelvis_body).id
        self._soles = [self.model.site(name).id for name in description.sole_sites]
        self._feet = [int(self.model.site_bodyid[sole]) for sole in self._soles]
        self._links = self.model.jnt_bodyid[1:].tolist()
        self._parents = self.model.body_parentid[self._links].tolist()
        self._q, self._v = np.zeros(self.model.nq), np.zeros(self.model.nv)
        self.energy, self.torque = np.zeros(len(self._limit)), np.zeros(len(self._limit))

    @property
    def time(self) -> float:
        """Simulated time since the reset [s]."""
        return float(self.data.time)

    @property
    def pelvis(self) -> Array:
        """Position of the pelvis, shape (3,) [m]."""
        return np.array(self.data.qpos[:3])

    @property
    def heading(self) -> float:
        """Heading of the pelvis [rad]."""
        return float(headings(np.roll(self.data.qpos[3:7], -1)))

    def reset(self, q: Array) -> None:
        """Stand still in a configuration in Pinocchio's convention, shape (7 + nj,)."""
        mujoco.mj_resetData(self.model, self.data)
        pinocchio_to_mujoco(q, self._v * 0.0, self.data.qpos, self.data.qvel)
        self.energy[:] = 0.0
        mujoco.mj_forward(self.model, self.data)

    def hang(self, q: Array, command: JointCommand, time: float) -> Array:
        """Hang by the pelvis, which does not move, for so long [s], and be let go; time begins then.

        Args:
            q: configuration in Pinocchio's convention, shape (7 + nj,).
            command: of the joints, which servos follow.
            time: how long [s].

        Returns:
            configuration at the end, in which nothing holds the pelvis any more, shape (7 + nj,).
        """
        self.reset(q)
        held = self.data.qpos[:7].copy()
        for _ in range(round(time * RATE)):
            self.data.qpos[:7], self.data.qvel[:6] = held, 0.0
            self.advance(command, 1.0 / RATE)
        self.data.time, self.energy[:] = 0.0, 0.0
        mujoco_to_pinocchio(self.data.qpos, self.data.qvel, self._q, self._v)
        return self._q.copy()

    def lowest(self) -> float:
        """Height of the lower sole's centre [m]."""
        return float(min(self.data.site_xpos[sole, 2] for sole in self._soles))

    def slipping(self, wrench: Array) -> Array:
        """Level speed of each foot at the centre of its pressure, of one that carries nothing 0, shape (2,) [m/s].

        Args:
            wrench: of the soles at their centres in their frames, shape (2, 6) [N, N·m].
        """
        speed, found = np.zeros(6), np.zeros(2)
        for foot, (site, (_, _, force, roll, pitch, _)) in enumerate(zip(self._soles, wrench.tolist(), strict=True)):
            if force > 0.0:
                mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_SITE, site, speed, 0)
                R = self.data.site_xmat[site].reshape(3, 3)
                arm = R @ (-pitch / force, roll / force, 0.0)
                found[foot] = np.hypot(*(speed[3:] + np.cross(speed[:3], arm))[:2])
        return found

    def measure(self) -> Measurement:
        """State, torques of the joints and wrenches of the soles, all true."""
        mujoco_to_pinocchio(self.data.qpos, self.data.qvel, self._q, self._v)
        return Measurement.of_state(self.time, self._q.copy(), self._v.copy(), self.torque.copy(), self._wrenches())

    def contracted(self) -> Measurement:
        """Measurement that the benchmark hands over: joints, attitude and turning of the pelvis; all else is no number.

        The torques of the joints are those of the drives, whose targets and gains a walker knows.
        """
        mujoco_to_pinocchio(self.data.qpos, self.data.qvel, self._q, self._v)
        q, v = self._q.copy(), self._v.copy()
        q[:3] = v[:3] = np.nan
        return Measurement.of_state(self.time, q, v, self.torque.copy())

    def advance(self, command: JointCommand, period: float, punch: Punch | None = None) -> None:
        """Go on for so long [s] with a command whose servos, if it has any, are followed in each step.

        Args:
            command: of the joints, which clip it to their limits.
            period: a whole number of steps [s].
            punch: that acts all the while.
        """
        data, h = self.data, 1.0 / RATE
        for _ in range(round(period * RATE)):
            speed = data.qvel[6:]
            self.torque = np.clip(command.torque_at(data.qpos[7:], speed), -self._limit, self._limit)
            data.ctrl[:] = self.torque
            if punch is not None:
                self._punch(punch)
            mujoco.mj_step(self.model, data)
            data.xfrc_applied[:] = 0.0
            self.energy += np.abs(self.torque * data.qvel[6:]) * h

    def push(self, body: str, force: Array) -> None:
        """Let a force act on a body's centre of mass in the next step, in the world, shape (3,) [N]."""
        self.data.xfrc_applied[self.model.body(body).id, :3] = force

    def direction(self, punch: Punch) -> Array:
        """Direction of a punch in the world, shape (3,)."""
        frame = (self._parents if punch.of_parent else self._links)[punch.joint]
        return np.array(self.data.xmat[frame]).reshape(3, 3) @ punch.direction

    def hands_allowed(self, robot: TourRobot, left: NDArray[np.intp], right: NDArray[np.intp]) -> "Hands":
        """Limits of the hands, within which the harness lets arms put them.

        Args:
            robot: what the harness says of it.
            left: indices of the left arm's joints.
            right: indices of the right arm's joints.
        """
        return Hands(self.model, robot, (left, right))

    def _punch(self, punch: Punch) -> None:
        """Push a link at the anchor of its joint, in a direction that turns with it."""
        body, data = self._links[punch.joint], self.data
        force = punch.force * self.direction(punch)
        arm = data.xanchor[punch.joint + 1] - data.xipos[body]
        data.xfrc_applied[body] = (*force, *np.cross(arm, force))

    def _wrenches(self) -> Array:
        """Wrenches on the soles, at their centres in their frames, shape (2, 6) [N, N·m]."""
        data = self.data
        mujoco.mj_rnePostConstraint(self.model, data)  # of contacts alone, since no punch is written down any more
        com = data.subtree_com[self._pelvis].tolist()
        wrench = np.zeros((2, 6))
        for row, foot, sole in zip(wrench, self._feet, self._soles, strict=True):
            tx, ty, tz, fx, fy, fz = data.cfrc_ext[foot].tolist()
            x, y, z = (one - other for one, other in zip(com, data.site_xpos[sole].tolist(), strict=True))
            moment = tx + y * fz - z * fy, ty + z * fx - x * fz, tz + x * fy - y * fx
            R = data.site_xmat[sole].reshape(3, 3)
            row[:3], row[3:] = (fx, fy, fz) @ R, moment @ R
        return wrench


class Hands:
    """A check that angles of the left arm, shape (7,) [rad], keep both hands before the body and below the head.

    Boxes around the hands may reach no farther back, in the frame of the torso, than at the start.

    Args:
        model: of the world.
        robot: what the harness says of it.
        arms: indices of the joints of the left and of the right arm.
    """

    def __init__(
        self, model: mujoco.MjModel, robot: TourRobot, arms: tuple[NDArray[np.intp], NDArray[np.intp]]
    ) -> None:
        self._model, self._data, self._robot = model, mujoco.MjData(model), robot
        self._arms = arms
        self._links = [int(model.jnt_bodyid[1 + arm[-1]]) for arm in arms]
        self._torso = int(model.body_parentid[model.jnt_bodyid[1 + arms[0][0]]])
        low, high = np.array(robot.hand_box)
        corners = np.array(list(product(*zip(low, high, strict=True))))
        self._corners = [corners, corners * (1.0, -1.0, 1.0)]
        self._back = min(low.item(0) for low, _ in self._boxes(np.array(robot.arm_stance)))

    def __call__(self, left: Array) -> bool:
        """Return true if the angles do so."""
        boxes = self._boxes(left)
        back, top = min(low.item(0) for low, _ in boxes), max(high.item(2) for _, high in boxes)
        return back >= self._back and top <= self._robot.head_bottom

    def _boxes(self, left: Array) -> list[tuple[Array, Array]]:
        """Lowest and highest corners of boxes around the hands in the frame of the torso [m]."""
        data, torso = self._data, self._torso
        for arm, angles in zip(self._arms, (left, left * self._robot.arm_mirror), strict=True):
            data.qpos[7 + arm] = angles
        mujoco.mj_kinematics(self._model, data)
        R, origin = data.xmat[torso].reshape(3, 3), data.xpos[torso]
        boxes = []
        for link, corners in zip(self._links, self._corners, strict=True):
            places = (corners @ data.xmat[link].reshape(3, 3).T + data.xpos[link] - origin) @ R
            boxes.append((places.min(axis=0), places.max(axis=0)))
        return boxes


def world_text(description: RobotDescription, robot: TourRobot) -> str:
    """The world as MJCF text, with what is only drawn left out.

    Args:
        description: of the robot.
        robot: what the harness says of it.
    """
    root = ElementTree.fromstring(description.mjcf)
    solver = {"timestep": repr(1.0 / RATE), "integrator": "implicitfast"}
    ElementTree.SubElement(root, "option", solver)
    for joint in root.iter("joint"):
        joint.set("damping", repr(robot.damping))
        joint.set("frictionloss", repr(robot.friction_loss))
    for body in root.iter("body"):
        for geom in list(body.findall("geom")):
            if geom.get("class") == "visual" or body.get("name") in robot.feet.values():
                body.remove(geom)
            else:
                geom.attrib.pop("class")
                geom.attrib |= {"contype": "1", "conaffinity": "1"}
        if body.get("name") in robot.feet.values():
            for point in robot.contact_points:
                place = {"pos": " ".join(map(repr, point)), "size": repr(robot.contact_radius)}
                ElementTree.SubElement(body, "geom", place, type="sphere")
    worldbody = root.find("worldbody")
    assert worldbody is not None
    ElementTree.SubElement(worldbody, "geom", _FLOOR)
    return ElementTree.tostring(root, encoding="unicode")


@lru_cache(maxsize=2)
def _compiled(text: str) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(text)
    spec.compiler.discardvisual = True
    return spec.compile()
