"""The contract of a policy: what its network observes, in which order and unit, and what its outputs mean."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, ValidationError, model_validator

from surefoot.errors import ParameterError
from surefoot.scenarios.file.group import WHOLE, Group, Many, as_tuple, key
from surefoot.scenarios.file.units import RADIAN, Unit

KEY = ("controller", "policy")
"""Key of a scenario that names a policy."""

Value = Annotated[float, Field(ge=-1e6, le=1e6)]
PerJoint = Annotated[float | tuple[float, ...] | dict[str, float], BeforeValidator(as_tuple)]
"""One number for all joints, one for each in the order of `joints`, or by regular expressions of their names."""
Positive = Annotated[float, Field(gt=0, le=1e6)]
Pair = Annotated[tuple[float, float], BeforeValidator(as_tuple)]


class Term(Group):
    """Numbers of an observation, side by side with those of the terms before and after."""

    term: str = Field(description="name of the term, see the page of policies")
    scale: Annotated[float | tuple[float, ...], BeforeValidator(as_tuple)] = key(
        1.0, "factor of its numbers, one for all or one for each; after the clip"
    )
    clip: Pair | None = key(None, "bounds of its numbers before they are scaled, null: none")
    history: Annotated[int, Field(ge=1, le=1000), WHOLE] | None = key(
        None, "how many of its last values are observed, null: history.length"
    )
    joints: Many[str] | None = key(None, "joints that it tells, in this order, null: all of the contract")
    options: dict[str, Any] | None = key(None, "given to the term by name, null: none")


class History(Group):
    """The order in which the last values of terms stand side by side."""

    length: Annotated[int, Field(ge=1, le=1000), WHOLE] = key(1, "how many values of each term are observed")
    order: Literal["oldest_first", "newest_first"] = key("oldest_first", "which of them comes first")
    interleaved: bool = key(False, "frame by frame, each with all terms; false: term by term, each with all frames")
    begin: Literal["first", "zero"] = key("first", "values before the first observation: that one, or zeros")


class Action(Group):
    """The meaning of the network's output."""

    output: str | None = key(None, "name of the output, null: the only one that is no state")
    kind: Literal["position", "torque"] = key("position", "targets of joints, or torques")
    joints: Many[str] | None = key(None, "joints that it moves, in this order, null: all of the contract")
    scale: PerJoint = key(1.0, "radians, or newton metres, of an output of one")
    offset: PerJoint | None = key(None, "added to the scaled output, null: the default posture; of torques 0")
    clip: Pair | None = key(None, "bounds of the output before it is scaled, null: none")
    limits: Annotated[tuple[Pair, ...], BeforeValidator(as_tuple)] | None = key(
        None, "bounds of the target of each joint, null: none"
    )


class Others(Group):
    """Joints that the contract does not name: they are held."""

    position: dict[str, Annotated[float, RADIAN]] = key(
        {}, "where, by regular expressions of their names; others where the robot has them at rest"
    )
    stiffness: PerJoint | None = key(None, "null: torque limit over 1 rad [N·m/rad]")
    damping: PerJoint | None = key(None, "null: 0.02 s times the stiffness [N·m·s/rad]")


class CommandRange(Group):
    """The velocities that the policy was trained for; faster ones are cut to these."""

    v_x: Pair | None = key(None, "forward [m/s], null: any")
    v_y: Pair | None = key(None, "to the left [m/s], null: any")
    yaw_rate: Pair | None = key(None, "of the heading, left positive [rad/s], null: any")


class Places(Group):
    """Law by which it is led to a place, where something does so: the tour of a benchmark."""

    gain: Positive = key(1.5, "velocity over the distance [1/s]")
    turn_gain: Positive = key(1.5, "yaw rate over the angle [1/s]")
    speed: Positive | None = key(None, "most of the level velocity [m/s], null: any")
    keeps_speed: bool = key(False, "a velocity that was cut to its ranges is lengthened to its speed, and cut again")
    v_x: Pair | None = key(None, "forward [m/s], null: that of command")
    v_y: Pair | None = key(None, "to the left [m/s], null: that of command")
    yaw_rate: Pair | None = key(None, "of the heading [rad/s], null: that of command")
    near: Pair = key((0.1, 0.2), "distances at which it stops, and from which on it goes again [m]")
    turned: Pair = key((0.05, 0.12), "angles at which it stops turning, and from which on it turns again [rad]")
    faces: Pair | None = key(None, "distances from which on it begins to look, and fully looks, where it goes [m]")
    waits: Annotated[float, Field(ge=0, le=1000)] = key(0.0, "how long it stands at first [s]")

    @model_validator(mode="after")
    def _in_order(self) -> "Places":
        for name in ("near", "turned", "faces"):
            pair = getattr(self, name)
            if pair is not None and not 0.0 <= pair[0] < pair[1]:
                raise ValueError(f"{name} must be two numbers from 0 on, the lesser first")
        return self


class Recurrent(Group):
    """A state that the network hands to itself, zero at first."""

    input: str = Field(description="name of the input")
    output: str = Field(description="name of the output that is the next input")


class Contract(Group):
    """The contract of a network: its observations and outputs; joints have their names in the robot."""

    network: str = Field(description="file of the network in ONNX, seen from this file")
    robot: str | None = key(None, "robot that it was trained for, null: any with these joints")
    rate: Annotated[float, Field(ge=1, le=10_000), Unit("Hz")] = Field(description="decisions in a second")
    joints: Many[str] = Field(description="names of the joints in the order of the network")
    default: PerJoint = key(0.0, "default posture: where it starts, and from which joint positions are counted [rad]")
    stiffness: PerJoint = Field(description="of the drives [N·m/rad]")
    damping: PerJoint = Field(description="of the drives [N·m·s/rad]")
    action: Action = key(Action.model_construct(), "what the output means")
    others: Others = key(Others.model_construct(), "joints that are not named")
    observations: Many[Term] = key((), "what the only input is made of, in order; or give inputs")
    inputs: dict[str, Many[Term]] = key({}, "what each input is made of, by its name")
    history: History = key(History.model_construct(), "last values of the terms")
    command: CommandRange = key(CommandRange.model_construct(), "velocities that it follows")
    driven: Literal["as_is", "at_rest", "as_commanded"] = key(
        "as_is", "what it is told of joints that somebody else drives: their state, the default posture, or its action"
    )
    places: Places = key(Places.model_construct(), "how it is led to a place")
    recurrent: Many[Recurrent] = key((), "states that it hands to itself")

    @model_validator(mode="after")
    def _observes_once(self) -> "Contract":
        if bool(self.observations) == bool(self.inputs):
            raise ValueError("give either observations or inputs")
        if not self.joints or len(set(self.joints)) != len(self.joints):
            raise ValueError("joints must be names, each once")
        return self


def contract_of(values: Any, place: str) -> Contract:
    """The contract of plain values.

    Args:
        values: as YAML has them.
        place: what to call the file in messages.

    Raises:
        ParameterError: they are none.
    """
    if not isinstance(values, Mapping):
        raise ParameterError(KEY, f"{place}: no contract of a policy, but {type(values).__name__}", "give a mapping")
    try:
        return Contract.model_validate(dict(values))
    except ValidationError as error:
        faults = error.errors(include_url=False)
        listed = "; ".join(f"{'.'.join(map(str, one['loc'])) or 'the file'}: {one['msg']}" for one in faults[:5])
        more = f", and {len(faults) - 5} more" if len(faults) > 5 else ""
        raise ParameterError(KEY, f"{place}: {listed}{more}", "mend the contract") from None


def schema() -> dict[str, Any]:
    """JSON Schema of contracts."""
    from surefoot.scenarios.setup.checks.criteria import DIALECT

    return {"$schema": DIALECT, **Contract.model_json_schema()}
