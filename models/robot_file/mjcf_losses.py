"""Attributes of a compiled MJCF that change how its robot moves, and that a description has not."""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.models.robot_file.mjcf_schema import ELEMENTS, WORLD, LeftOut
from surefoot.models.types import Array

_PLAIN = """<mujoco><worldbody><body><joint name="of"/><geom size="1"/></body></worldbody>
<actuator><motor joint="of"/></actuator></mujoco>"""


def losses(mj: mujoco.MjModel, root: int) -> Iterator[str]:
    """A line for each reason to leave attributes out that differ from plain ones, of the robot with a root body."""
    found: dict[tuple[str, str], tuple[list[str], set[int]]] = {}
    own = {kind: _own(mj, root, kind) for kind in ("joint", "dof", "geom", "body", "actuator")}
    for one in {one.fields: one for group in ELEMENTS for one in group.left_out}.values():
        differ = [at for at in own[one.of] if _differs(mj, one, at)]
        if differ:
            names, things = found.setdefault((one.why, _THING.get(one.of, one.of)), ([], set()))
            names.append(one.name)
            things |= {int(mj.dof_jntid[at]) if one.of == "dof" else at for at in differ}
    for (why, kind), (names, things) in found.items():
        yield f"left out: {', '.join(names)} of {_things(mj, kind, sorted(things))}: {why}"
    grounds = int((mj.geom_bodyid == 0).sum())
    if grounds:
        yield f"left out: {grounds} geom{'s' if grounds > 1 else ''} of its world: {WORLD}"


_THING = {"dof": "joint"}


def _own(mj: mujoco.MjModel, root: int, kind: str) -> list[int]:
    """Numbers of the things of a kind that are of the robot; of geoms those that touch."""
    if kind == "actuator":
        return list(range(len(mj.actuator_trntype)))
    own = mj.body_rootid == root
    if kind == "body":
        return [int(body) for body in np.flatnonzero(own)]
    bodies = {"joint": mj.jnt_bodyid, "dof": mj.dof_bodyid, "geom": mj.geom_bodyid}[kind]
    touches = (mj.geom_contype != 0) | (mj.geom_conaffinity != 0) if kind == "geom" else True
    return [int(at) for at in np.flatnonzero(own[bodies] & touches)]


def _differs(mj: mujoco.MjModel, one: LeftOut, at: int) -> bool:
    """Return true if a thing has another value than a plain one."""
    plain = _plain()
    return any(bool(np.any(_of(mj, field, at) != _of(plain, field, 0))) for field in one.fields)


def _of(mj: mujoco.MjModel, field: str, at: int) -> Array:
    values: Array = np.asarray(getattr(mj, field))[at]
    return values


@lru_cache(maxsize=1)
def _plain() -> mujoco.MjModel:
    """A model of one thing of each kind, as MuJoCo has it by default."""
    return mujoco.MjModel.from_xml_string(_PLAIN)


def _things(mj: mujoco.MjModel, kind: str, numbers: list[int]) -> str:
    name = getattr(mj, kind)(numbers[0]).name
    first = f" '{name}'" if name else ""
    if len(numbers) == 1:
        return f"{kind}{first}"
    plural = {"body": "bodies"}.get(kind, f"{kind}s")
    return f"{len(numbers)} {plural}{f',{first} first' if first else ''}"
