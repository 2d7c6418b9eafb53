"""DART in place of MuJoCo: the bodies of the same robot file, in an engine that others wrote.

Contact is rigid there and solved as a linear complementarity problem, where MuJoCo's is compliant and convex. What the
two do otherwise is listed in docs/other-simulator.md.
"""

from dataclasses import dataclass

import dartpy as dart
import mujoco
import numpy as np
from numpy.typing import NDArray

import surefoot
from surefoot.errors import ParameterError
from surefoot.forces import Push
from surefoot.sim import World

Array = NDArray[np.float64]
FAR = 60.0
"""Sides of the box that stands for a plane [m]."""
SHARE = 0.2
"""Share of the newest acceleration in what turns the rotors [-]; all of it rings with the blows of rigid contact."""
SHAPES = {
    mujoco.mjtGeom.mjGEOM_SPHERE: lambda size: dart.dynamics.SphereShape(size[0]),
    mujoco.mjtGeom.mjGEOM_CAPSULE: lambda size: dart.dynamics.CapsuleShape(size[0], 2 * size[1]),
    mujoco.mjtGeom.mjGEOM_BOX: lambda size: dart.dynamics.BoxShape(2 * size),
}
BOXED = (mujoco.mjtGeom.mjGEOM_ELLIPSOID, mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_MESH)
"""Shapes of the robot that the box around them stands for."""


class DartPlant:
    """A robot in DART, on the ground of a walk, as a `surefoot.Plant`.

    Bodies, joints, limits and shapes are read from the model that MuJoCo makes of the robot file. A reflected inertia,
    which DART has not got, counts as inertia of the joint's child about its axis.

    Args:
        walk: what is run; its robot has at most one hinge a body, its ground is of planes and boxes.

    Raises:
        ParameterError: robot or ground has something else.
    """

    def __init__(self, walk: surefoot.Walk) -> None:
        world = World(walk.true_robot, walk.ground.true_terrain, walk.rates.physics, size=walk.size)
        model, data = world.model, world.data
        mujoco.mj_kinematics(model, data)
        self._step = 1.0 / walk.rates.physics
        self._robot, self._ground = dart.dynamics.Skeleton("robot"), dart.dynamics.Skeleton("ground")
        self._bodies: dict[str, dart.dynamics.BodyNode] = {}
        self._joints: list[dart.dynamics.RevoluteJoint] = []
        self._rotors: list[_Rotor] = []
        for body in range(1, model.nbody):
            self._add_body(model, body)
        _, still = self._ground.createWeldJointAndBodyNodePair()
        for geom in range(model.ngeom):
            if model.geom_contype[geom] or model.geom_conaffinity[geom]:
                self._add_shape(model, data, geom, still)
        soles = [model.site(name).id for name in walk.true_robot.sole_sites]
        self._feet = [self._bodies[model.body(model.site_bodyid[sole]).name] for sole in soles]
        self._sole_of_foot = [_frame(model.site_pos[sole], model.site_quat[sole]) for sole in soles]
        self._root = self._robot.getRootJoint()
        self._limit = walk.true_robot.torque_limit
        self._torque = np.zeros(len(self._joints))
        self._pushes: list[Push] = []
        self._pushed = np.zeros(3)
        self._dofs = np.array([joint.getIndexInSkeleton(0) for joint in self._joints])
        self._tick = 0
        self._world = _world(self._step, model.opt.gravity, self._ground, self._robot)

    def reset(self, q: Array, v: Array | None = None, torque: Array | None = None) -> None:
        """Stand at the start of a walk; see `surefoot.Plant`."""
        x, y, z, w = q[3:7]
        v = np.zeros(len(q) - 1) if v is None else v
        self._world.reset()
        self._tick = 0
        for rotor in self._rotors:
            rotor.turning = rotor.bending = 0.0
        self._root.setTransform(_isometry(_frame(q[:3], np.array([w, x, y, z]))))
        base = self._robot.getRootBodyNode()
        self._root.setSpatialVelocity(np.r_[v[3:6], v[:3]], dart.dynamics.Frame.World(), base)
        for joint, angle, speed in zip(self._joints, q[7:], v[6:], strict=True):
            joint.setPosition(0, angle)
            joint.setVelocity(0, speed)
        self._torque[:] = 0.0 if torque is None else torque

    def measure(self) -> surefoot.Measurement:
        """The state, what the joints give, and what the ground exerts on the soles."""
        base, still = self._robot.getRootBodyNode(), dart.dynamics.Frame.World()
        at = base.getWorldTransform()
        w, x, y, z = _quaternion(at.rotation())
        angles, speeds = self._robot.getPositions()[self._dofs], self._robot.getVelocities()[self._dofs]
        linear, angular = base.getLinearVelocity(still, base), base.getAngularVelocity(still, base)
        wrench, fallen = self._contacts()
        return surefoot.Measurement(
            time=self._tick * self._step,
            joint_position=angles,
            joint_velocity=speeds,
            joint_torque=self._torque.copy(),
            gyro=np.ravel(angular),
            accelerometer=np.full(3, np.nan),
            wrench=wrench,
            q=np.r_[np.ravel(at.translation()), x, y, z, w, angles],
            v=np.r_[np.ravel(linear), np.ravel(angular), speeds],
            external_force=self._pushed.copy(),
            nonfoot_contact=fallen,
            self_contact=False,
        )

    def act(self, command: surefoot.JointCommand, period: float) -> None:
        """Do what is commanded for so long [s]; drives with gains pull anew at each step of the physics."""
        steps, robot, forces = round(period / self._step), self._robot, np.zeros(self._robot.getNumDofs())
        self._pushed[:] = 0.0
        for _ in range(steps):
            angles, speeds = robot.getPositions()[self._dofs], robot.getVelocities()[self._dofs]
            self._torque[:] = np.clip(command.torque_at(angles, speeds), -self._limit, self._limit)
            forces[self._dofs] = self._torque
            self._turn_rotors(forces, robot.getAccelerations())
            robot.setForces(forces)
            self._push_bodies(steps)
            self._world.step()
            self._tick += 1

    def push(self, push: Push) -> None:
        """Push a body later."""
        self._pushes.append(push)

    def _turn_rotors(self, forces: Array, accelerations: Array) -> None:
        """Let what a joint's child has been given for a rotor act on the joint alone, as a reflected inertia does.

        The child resists its own turning; that is taken back, and the turning of the joint is resisted, both by the
        accelerations of the steps before.
        """
        still = dart.dynamics.Frame.World()
        for rotor in self._rotors:
            turning = float(rotor.axis @ np.ravel(rotor.child.getAngularAcceleration(still, rotor.child)))
            rotor.turning += SHARE * (turning - rotor.turning)
            rotor.bending += SHARE * (accelerations[rotor.dof] - rotor.bending)
            rotor.child.addExtTorque(rotor.inertia * rotor.turning * rotor.axis, True)
            forces[rotor.dof] -= rotor.inertia * rotor.bending

    def _push_bodies(self, steps: int) -> None:
        begin = self._tick * self._step
        for push in self._pushes:
            acting = min(begin + self._step, push.time + push.duration) - max(begin, push.time)
            if acting > 0:
                force, body = acting / self._step * np.asarray(push.force), self._bodies[push.body]
                body.addExtForce(force, body.getLocalCOM(), False, True)
                self._pushed += force / steps

    def _contacts(self) -> tuple[Array, bool]:
        """Wrenches of the ground on the soles, in the sole frames, shape (2, 6); whether else touches."""
        wrench, fallen = np.zeros((2, 6)), False
        names = [foot.getName() for foot in self._feet]
        touches: tuple[list[tuple[Array, Array]], ...] = ([], [])
        for contact in self._world.getLastCollisionResult().getContacts():
            one, other = (_body(side) for side in (contact.collisionObject1, contact.collisionObject2))
            robot, sign = (one, 1.0) if other == STILL else (other, -1.0)
            if robot in names:
                touches[names.index(robot)].append((contact.point, sign * contact.force))
            else:
                fallen = True
        for foot, touched in enumerate(touches):
            if touched:
                points, forces = (np.reshape(part, (-1, 3)) for part in zip(*touched, strict=True))
                sole = np.asarray(self._feet[foot].getWorldTransform().matrix()) @ self._sole_of_foot[foot]
                moment = np.cross(points - sole[:3, 3], forces).sum(axis=0)
                wrench[foot] = np.r_[sole[:3, :3].T @ forces.sum(axis=0), sole[:3, :3].T @ moment]
        return wrench, fallen

    def _add_body(self, model: mujoco.MjModel, body: int) -> None:
        parent = self._bodies.get(model.body(model.body_parentid[body]).name)
        name, joints = model.body(body).name, int(model.body_jntnum[body])
        if joints > 1:
            raise ParameterError(("robot",), f"{joints} joints of the body '{name}'", "give each a body of its own")
        place = _frame(model.body_pos[body], model.body_quat[body])
        inertia = _frame(np.zeros(3), model.body_iquat[body])[:3, :3]
        moment = inertia @ np.diag(model.body_inertia[body]) @ inertia.T
        if joints == 0:
            joint, node = self._robot.createWeldJointAndBodyNodePair(parent)
            joint.setTransformFromParentBodyNode(_isometry(place))
        elif parent is None:
            joint, node = self._robot.createFreeJointAndBodyNodePair()
        else:
            joint, node = self._robot.createRevoluteJointAndBodyNodePair(parent)
            first = int(model.body_jntadr[body])
            freedom = int(model.jnt_dofadr[first])
            pivot = _frame(model.jnt_pos[first], np.array([1.0, 0.0, 0.0, 0.0]))
            joint.setTransformFromParentBodyNode(_isometry(place @ pivot))
            joint.setTransformFromChildBodyNode(_isometry(pivot))
            joint.setAxis(model.jnt_axis[first])
            joint.setDampingCoefficient(0, model.dof_damping[freedom])
            joint.setCoulombFriction(0, model.dof_frictionloss[freedom])
            joint.setPositionLowerLimit(0, model.jnt_range[first, 0])
            joint.setPositionUpperLimit(0, model.jnt_range[first, 1])
            joint.setLimitEnforcement(bool(model.jnt_limited[first]))
            if model.dof_armature[freedom]:
                axis = model.jnt_axis[first].copy()
                moment += model.dof_armature[freedom] * np.outer(axis, axis)
                rotor = _Rotor(joint.getIndexInSkeleton(0), node, axis, model.dof_armature[freedom])
                self._rotors.append(rotor)
            self._joints.append(joint)
        node.setName(name)
        node.setInertia(dart.dynamics.Inertia(model.body_mass[body], model.body_ipos[body], moment))
        self._bodies[name] = node

    def _add_shape(self, model: mujoco.MjModel, data: mujoco.MjData, geom: int, still: dart.dynamics.BodyNode) -> None:
        kind, size = mujoco.mjtGeom(model.geom_type[geom]), model.geom_size[geom].copy()
        body = int(model.geom_bodyid[geom])
        place = _frame(model.geom_pos[geom], model.geom_quat[geom])
        if kind == mujoco.mjtGeom.mjGEOM_PLANE:
            kind, size = mujoco.mjtGeom.mjGEOM_BOX, np.array([FAR, FAR, 0.5])
            place = place @ _frame(np.array([0.0, 0.0, -0.5]), np.array([1.0, 0.0, 0.0, 0.0]))
        elif kind in BOXED and body:
            kind, size = mujoco.mjtGeom.mjGEOM_BOX, model.geom_aabb[geom, 3:].copy()
            place = place @ _frame(model.geom_aabb[geom, :3], np.array([1.0, 0.0, 0.0, 0.0]))
        if kind not in SHAPES:
            raise ParameterError(("terrain",), f"a shape of the kind {kind.name}", "take planes and boxes")
        node = self._bodies[model.body(body).name] if body else still
        shape = node.createShapeNode(SHAPES[kind](size))
        shape.setRelativeTransform(_isometry(place))
        shape.createCollisionAspect()
        # The lesser of two shapes' friction counts there, the ground's here.
        shape.createDynamicsAspect().setFrictionCoeff(1e3 if body else model.geom_friction[geom, 0])
        if not body:
            still.setName(STILL)


STILL = "the ground"
"""Name of the body that does not move."""


@dataclass
class _Rotor:
    """A body that a motor turns faster than its joint, in DART's place of a reflected inertia.

    Attributes:
        dof: of its joint in the skeleton.
        child: body behind the joint.
        axis: of the joint in that body's frame, shape (3,).
        inertia: reflected to the joint [kg·m^2].
        turning: smoothed angular acceleration of the body about the axis [rad/s^2].
        bending: that of the joint [rad/s^2].
    """

    dof: int
    child: dart.dynamics.BodyNode
    axis: Array
    inertia: float
    turning: float = 0.0
    bending: float = 0.0


def _body(side: dart.collision.CollisionObject) -> str:
    """Name of the body that a side of a contact is of."""
    return str(side.getShapeFrame().asShapeNode().getBodyNodePtr().getName())


def _world(step: float, gravity: Array, *skeletons: dart.dynamics.Skeleton) -> dart.simulation.World:
    """A world whose ground does not move."""
    world = dart.simulation.World()
    world.setTimeStep(step)
    world.setGravity(gravity)
    world.setCollisionDetector(dart.simulation.CollisionDetectorType.ODE)
    skeletons[0].setMobile(False)
    for skeleton in skeletons:
        world.addSkeleton(skeleton)
    return world


def _frame(position: Array, quaternion: Array) -> Array:
    """A pose as a matrix, shape (4, 4), of a quaternion w, x, y, z."""
    pose, rotation = np.eye(4), np.zeros(9)
    mujoco.mju_quat2Mat(rotation, quaternion)
    pose[:3, :3], pose[:3, 3] = rotation.reshape(3, 3), position
    return pose


def _isometry(pose: Array) -> dart.math.Isometry3:
    isometry = dart.math.Isometry3()
    isometry.set_rotation(pose[:3, :3])
    isometry.set_translation(pose[:3, 3])
    return isometry


def _quaternion(rotation: Array) -> Array:
    """The quaternion w, x, y, z of a rotation."""
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ravel(rotation))
    return quaternion
