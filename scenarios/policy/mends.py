"""The possible faults of a contract: each with its sign, and the contract with that one thing mended."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from surefoot.models.types import RobotDescription
from surefoot.scenarios.policy.contract import Contract, PerJoint, Term
from surefoot.scenarios.policy.joints import spread

ACTION_FACTORS = (-1.0, 0.5, 2.0, 0.25, 4.0, 0.1, 10.0)
"""Factors of the scale of actions that are tried [-]."""

GAIN_FACTORS = (0.1, 0.2, 0.4, 2.5, 5.0, 10.0)
"""Factors of stiffness and damping that are tried [-]."""

RATES = (25.0, 50.0, 100.0, 200.0)
"""Decisions in a second that are tried [Hz]."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that may be wrong.

    Attributes:
        name: it, in a word or two.
        sign: by which it is known, in words.
        mends: from a contract and its robot to contracts with this mended, each with what was changed.
        suspects: tells from the contract alone that it is wrong, which no other mend can then make right.
    """

    name: str
    sign: str
    mends: Callable[[Contract, RobotDescription], Iterator[tuple[str, Contract]]]
    suspects: Callable[[Contract, RobotDescription], bool] = lambda *_: False


def _changed(contract: Contract, **keys: object) -> Contract:
    return contract.model_copy(update=keys)


def times(value: PerJoint, factor: float) -> PerJoint:
    """Numbers of joints, each so many times as large."""
    if isinstance(value, dict):
        return {name: factor * number for name, number in value.items()}
    if isinstance(value, tuple):
        return tuple(factor * number for number in value)
    return factor * value


def _scales(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for factor in ACTION_FACTORS:
        action = contract.action.model_copy(update={"scale": times(contract.action.scale, factor)})
        yield f"action.scale times {factor:g}", _changed(contract, action=action)


def _gains(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for factor in GAIN_FACTORS:
        stiffness, damping = times(contract.stiffness, factor), times(contract.damping, factor)
        yield f"stiffness and damping times {factor:g}", _changed(contract, stiffness=stiffness, damping=damping)
    for factor in (0.1, 10.0):
        yield f"stiffness times {factor:g}", _changed(contract, stiffness=times(contract.stiffness, factor))
        yield f"damping times {factor:g}", _changed(contract, damping=times(contract.damping, factor))


def _rates(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for rate in RATES:
        if abs(rate - contract.rate) > 0.1 * rate:
            yield f"rate {rate:g} Hz", _changed(contract, rate=rate)


def changed_terms(contract: Contract, change: Callable[[Term], Term]) -> Contract:
    """The contract with its terms changed."""
    inputs = {name: tuple(map(change, terms)) for name, terms in contract.inputs.items()}
    return _changed(contract, observations=tuple(map(change, contract.observations)), inputs=inputs)


def _terms(contract: Contract) -> list[Term]:
    return [*contract.observations, *(term for terms in contract.inputs.values() for term in terms)]


def scaled(name: str, factor: float | tuple[float, ...]) -> Callable[[Term], Term]:
    """A function that changes the scale of a term, by one factor or by one for each number."""

    def change(term: Term) -> Term:
        if term.term != name:
            return term
        scale = term.scale if isinstance(term.scale, tuple) else (term.scale,)
        factors = factor if isinstance(factor, tuple) else (factor,) * len(scale)
        if len(scale) == 1 and len(factors) > 1:
            scale = scale * len(factors)
        return term.model_copy(update={"scale": tuple(a * b for a, b in zip(scale, factors, strict=True))})

    return change


def _optioned(name: str, **options: object) -> Callable[[Term], Term]:
    """Gives a term other options."""
    return lambda term: (
        term.model_copy(update={"options": {**(term.options or {}), **options}}) if term.term == name else term
    )


def _histories(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    history = contract.history
    if max((term.history or history.length for term in _terms(contract)), default=1) < 2:
        return
    order = "newest_first" if history.order == "oldest_first" else "oldest_first"
    turned = history.model_copy(update={"order": order})
    yield f"history.order {order}", _changed(contract, history=turned)
    other = history.model_copy(update={"interleaved": not history.interleaved})
    yield f"history.interleaved {str(not history.interleaved).lower()}", _changed(contract, history=other)
    both = turned.model_copy(update={"interleaved": not history.interleaved})
    yield f"history.order {order}, interleaved {str(both.interleaved).lower()}", _changed(contract, history=both)


def _quaternions(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for term in _terms(contract):
        if term.term == "orientation":
            order = "wxyz" if (term.options or {}).get("order") == "xyzw" else "xyzw"
            yield f"orientation.order {order}", changed_terms(contract, _optioned("orientation", order=order))


def _frames(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for name in ("gravity", "angular_velocity"):
        terms = [term for term in _terms(contract) if term.term == name]
        if not terms:
            continue
        yield f"{name} with the other sign", changed_terms(contract, scaled(name, -1.0))
        body = "torso" if (terms[0].options or {}).get("body", "base") == "base" else "base"
        yield f"{name} of the {body}", changed_terms(contract, _optioned(name, body=body))
        for axis, factors in (("x", (-1.0, 1.0, 1.0)), ("y", (1.0, -1.0, 1.0)), ("z", (1.0, 1.0, -1.0))):
            yield f"{name} with {axis} turned", changed_terms(contract, scaled(name, factors))
    for name in ("angular_velocity", "joint_velocity"):
        if any(term.term == name for term in _terms(contract)):
            for factor in (0.05, 0.2, 0.25, 4.0, 5.0, 20.0):
                yield f"{name} scaled by {factor:g}", changed_terms(contract, scaled(name, factor))


def _commands(contract: Contract, _: RobotDescription) -> Iterator[tuple[str, Contract]]:
    for factor in (0.0174533, 57.2958, 0.5, 2.0, -1.0, 0.1, 10.0):
        yield f"command scaled by {factor:g}", changed_terms(contract, scaled("command", factor))


def _postures(contract: Contract, robot: RobotDescription) -> Iterator[tuple[str, Contract]]:
    rest = dict(zip(robot.joint_names, robot.nominal_joint_positions.tolist(), strict=True))
    legs = robot.roles.legs
    named = tuple(rest[name] if name in legs else 0.0 for name in contract.joints)
    yield "default, of the legs, that of the robot at rest", _changed(contract, default=named)
    half = tuple(0.5 * angle for angle in named)
    yield "default, of the legs, half of it", _changed(contract, default=half)
    if contract.action.offset is not None and not contract.action.joints:
        yield "default that of action.offset", _changed(contract, default=contract.action.offset)
        action = contract.action.model_copy(update={"offset": None})
        yield "action.offset that of default", _changed(contract, action=action)


STRAIGHT = 0.02
"""Knees that are bent by less in the default posture are straight [rad]."""


def _straight(contract: Contract, robot: RobotDescription) -> bool:
    """Return true if the default posture stands on straight knees, as no robot does that is to walk."""
    angles = spread(contract.default, contract.joints, "default")
    knees = [contract.joints.index(name) for name in robot.roles.knees if name in contract.joints]
    return bool(knees) and bool((np.abs(angles[knees]) < STRAIGHT).all())


def _orders(contract: Contract, robot: RobotDescription) -> Iterator[tuple[str, Contract]]:
    names = contract.joints
    kept = tuple(name for name in robot.joint_names if name in names)
    broad = tuple(sorted(kept, key=lambda name: (depths(robot)[name], kept.index(name))))
    sides = tuple(other_side(name) if other_side(name) in names else name for name in names)
    for what, order in (("that of the robot", kept), ("breadth first", broad), ("left and right changed", sides)):
        if order != names:
            yield f"joints in another order, {what}", reordered(contract, order)


def reordered(contract: Contract, names: Sequence[str]) -> Contract:
    """The contract with other names for its joints, in the order of the network, wherever it names them."""
    of = dict(zip(contract.joints, names, strict=True))

    def other(named: tuple[str, ...] | None) -> tuple[str, ...] | None:
        return None if named is None else tuple(of[name] for name in named)

    changed = changed_terms(contract, lambda term: term.model_copy(update={"joints": other(term.joints)}))
    action = contract.action.model_copy(update={"joints": other(contract.action.joints)})
    return _changed(changed, joints=tuple(names), action=action)


def depths(robot: RobotDescription) -> dict[str, int]:
    """Number of joints between each joint and the base, by its name."""
    from surefoot.models.pinocchio import pinocchio_model

    model = pinocchio_model(robot)
    found = {}
    for name in robot.joint_names:
        joint, depth = model.getJointId(name), 0
        while model.parents[joint] > 1:
            joint, depth = model.parents[joint], depth + 1
        found[name] = depth
    return found


def other_side(name: str) -> str:
    """The name of a joint on the other side of the robot; its own in the middle."""
    if re.search("left", name):
        return name.replace("left", "right")
    return name.replace("right", "left")


def swapped(contract: Contract, pairs: Sequence[tuple[int, int]]) -> Iterator[tuple[str, Contract]]:
    """The contract with two joints changed for each other, for each of some pairs."""
    for i, j in pairs:
        names = list(contract.joints)
        names[i], names[j] = names[j], names[i]
        yield f"joints {contract.joints[i]} and {contract.joints[j]} changed", reordered(contract, names)


FAULTS: tuple[Fault, ...] = (
    Fault("history backward", "with histories turned it walks", _histories),
    Fault("quaternion order", "with the other order of the quaternion it walks", _quaternions),
    Fault("frame or sign of a sense", "with a sense in another frame, sign or unit it walks", _frames),
    Fault("joint order", "with joints in another order it walks", _orders),
    Fault("sign or scale of actions", "with actions scaled by a factor it walks", _scales),
    Fault("gains", "with other gains it walks", _gains),
    Fault("rate", "with another rate it walks", _rates),
    Fault("default posture", "with another default posture it walks", _postures, _straight),
    Fault("unit of the command", "with the command scaled by a factor it goes as fast as commanded", _commands),
)
"""Faults that are looked for; of mends that do as well, the first counts."""
