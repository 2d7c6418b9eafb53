"""The bindings of a compiled MJCF: equalities, and actuators that act on more than a joint of their own."""

from collections.abc import Iterator, Mapping

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.models.robot_file.bindings import Binding, Follower, element_name

_EQ, _TRN = mujoco.mjtEq, mujoco.mjtTrn
_JOINT = "equality joint"


class MjcfBindings:
    """Reads them.

    Args:
        mj: the compiled model.
        root: body of the robot in the world.
        joints: name of each joint of the robot, by its number.
    """

    def __init__(self, mj: mujoco.MjModel, root: int, joints: Mapping[int, str]) -> None:
        self._mj, self._root, self._joints = mj, root, joints

    def followers(self) -> Iterator[tuple[str, Follower]]:
        """Joints that follow others: of two the one without a motor, or else the first."""
        mj = self._mj
        for equality in self._active(_EQ.mjEQ_JOINT):
            first, second = (int(ids[equality]) for ids in (mj.eq_obj1id, mj.eq_obj2id))
            if first not in self._joints or (second >= 0 and second not in self._joints):
                continue
            name = mj.eq(equality).name
            if second < 0:
                yield self._joints[first], Follower(_JOINT, name, angle=float(mj.eq_data[equality, 0]))
                continue
            swapped = self._driven(first) and not self._driven(second)
            follower, leader = (second, first) if swapped else (first, second)
            constant, ratio, *rest = mj.eq_data[equality, :5].tolist()
            law: tuple[float, float | None] = constant, ratio or None
            if any(rest) or (swapped and not ratio):
                law = 0.0 if swapped else constant, None
            elif swapped:
                law = -constant / ratio, 1.0 / ratio
            yield self._joints[follower], Follower(_JOINT, name, self._joints[leader], *law)

    def again(self, name: str, follower: Follower) -> Binding:
        """The fault of a joint that two equalities bind."""
        joints = {name} if follower.leader is None else {name, follower.leader}
        return Binding(element_name(follower.kind, follower.name), frozenset(joints))

    def bindings(self) -> Iterator[Binding]:
        """All else, as far as the robot's own bodies are bound."""
        mj = self._mj
        for kind, word in ((_EQ.mjEQ_CONNECT, "connect"), (_EQ.mjEQ_WELD, "weld")):
            for equality in self._active(kind):
                bodies = self._bound(equality)
                element = element_name(word, mj.eq(equality).name)
                if all(self._is_own(body) for body in bodies):
                    between = " and ".join(f"'{mj.body(body).name}'" for body in bodies)
                    yield Binding(f"{element} of {between}", self._between(bodies))
        for equality in self._active(_EQ.mjEQ_TENDON):
            tendons = [int(ids[equality]) for ids in (mj.eq_obj1id, mj.eq_obj2id) if ids[equality] >= 0]
            joints = frozenset[str]().union(*(self._along(tendon) for tendon in tendons))
            yield Binding(element_name("equality tendon", mj.eq(equality).name), joints)
        yield from self._motors()

    def outside(self) -> Iterator[str]:
        """A line for each element that binds the robot to what is not of it, or is not active."""
        mj = self._mj
        for equality in range(mj.neq):
            kind = int(mj.eq_type[equality])
            word = _EQ(kind).name.removeprefix("mjEQ_").lower()
            element = element_name(f"equality {word}", mj.eq(equality).name)
            if not mj.eq_active0[equality]:
                yield f"left out: {element}: it is not active"
            elif kind in (int(_EQ.mjEQ_CONNECT), int(_EQ.mjEQ_WELD)):
                if not all(self._is_own(body) for body in self._bound(equality)):
                    yield f"left out: {element}: a robot is bound to nothing beside it"
            elif kind == int(_EQ.mjEQ_JOINT):
                ends = [int(ids[equality]) for ids in (mj.eq_obj1id, mj.eq_obj2id)]
                if any(joint >= 0 and joint not in self._joints for joint in ends):
                    yield f"left out: {element}: a robot is bound to nothing beside it"
        for actuator in range(len(mj.actuator_trntype)):
            kind = int(mj.actuator_trntype[actuator])
            if kind in (int(_TRN.mjTRN_SITE), int(_TRN.mjTRN_SO3), int(_TRN.mjTRN_BODY)):
                element = element_name("actuator", mj.actuator(actuator).name)
                yield f"left out: {element}: it acts on no joint"

    def _motors(self) -> Iterator[Binding]:
        """Actuators of tendons and of slider-cranks."""
        mj = self._mj
        for actuator in range(len(mj.actuator_trntype)):
            kind, (one, other) = int(mj.actuator_trntype[actuator]), mj.actuator_trnid[actuator].tolist()
            element = element_name("actuator", mj.actuator(actuator).name)
            if kind == int(_TRN.mjTRN_TENDON):
                tendon = element_name("tendon", mj.tendon(one).name)
                yield Binding(f"{element} on {tendon}", self._along(one), motor=True)
            elif kind == int(_TRN.mjTRN_SLIDERCRANK):
                bodies = tuple(int(mj.site_bodyid[site]) for site in (one, other))
                yield Binding(f"{element} on a slider-crank", self._between(bodies), motor=True)

    def _active(self, kind: "mujoco.mjtEq") -> Iterator[int]:
        """Numbers of the equalities of a kind that act."""
        mj = self._mj
        yield from (one for one in range(mj.neq) if mj.eq_type[one] == int(kind) and mj.eq_active0[one])

    def _bound(self, equality: int) -> tuple[int, int]:
        """Both bodies of a connect or a weld."""
        mj = self._mj
        ends = int(mj.eq_obj1id[equality]), int(mj.eq_obj2id[equality])
        if mj.eq_objtype[equality] == int(mujoco.mjtObj.mjOBJ_SITE):
            return int(mj.site_bodyid[ends[0]]), int(mj.site_bodyid[ends[1]])
        return ends

    def _is_own(self, body: int) -> bool:
        return body > 0 and int(self._mj.body_rootid[body]) == self._root

    def _driven(self, joint: int) -> bool:
        mj = self._mj
        of_joints = mj.actuator_trntype <= int(_TRN.mjTRN_JOINTINPARENT)
        return bool((of_joints & (mj.actuator_trnid[:, 0] == joint)).any())

    def _above(self, body: int) -> set[int]:
        """A body and all that it hangs on."""
        found = set()
        while body > 0:
            found.add(body)
            body = int(self._mj.body_parentid[body])
        return found

    def _between(self, bodies: tuple[int, ...]) -> frozenset[str]:
        """Joints that move some bodies against each other."""
        above = [self._above(body) for body in bodies]
        shared = {body for body in above[0] if all(body in one for one in above)} if above else set[int]()
        moving = set[int]().union(*above) - shared
        return frozenset(name for joint, name in self._joints.items() if int(self._mj.jnt_bodyid[joint]) in moving)

    def _along(self, tendon: int) -> frozenset[str]:
        """Joints that change the length of a tendon."""
        mj, joints, bodies = self._mj, set[str](), list[int]()
        begin = int(mj.tendon_adr[tendon])
        for wrap in range(begin, begin + int(mj.tendon_num[tendon])):
            kind, of = int(mj.wrap_type[wrap]), int(mj.wrap_objid[wrap])
            if kind == int(mujoco.mjtWrap.mjWRAP_JOINT):
                joints |= {self._joints[of]} if of in self._joints else set()
            elif kind == int(mujoco.mjtWrap.mjWRAP_SITE):
                bodies.append(int(mj.site_bodyid[of]))
            elif kind in (int(mujoco.mjtWrap.mjWRAP_SPHERE), int(mujoco.mjtWrap.mjWRAP_CYLINDER)):
                bodies.append(int(mj.geom_bodyid[of]))
        return frozenset(joints) | self._between(tuple(np.unique(bodies).tolist()))
