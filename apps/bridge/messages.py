"""The messages of a robot's joints, by the names of their fields in Unitree's LowCmd and LowState, as bytes.

All numbers are little-endian; those of joints are in the order of the robot's description. What a machine has not got,
such as the pose of its base, is in a part of its own.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import Push
from surefoot.joints import JointCommand, Servo
from surefoot.readings import Reading, Readings
from surefoot.scenarios.errors import LinkError
from surefoot.sim.measurement import Array, Measurement, is_rotation


@lru_cache(maxsize=4)
def low_cmd(joints: int) -> np.dtype[Any]:
    """Layout of a command: the tick of the state that it answers, and of each joint q, dq, tau, kp and kd."""
    return np.dtype([("tick", "<i8"), *((name, "<f8", (joints,)) for name in ("q", "dq", "tau", "kp", "kd"))])


@lru_cache(maxsize=4)
def low_state(joints: int) -> np.dtype[Any]:
    """Layout of a state: what sensors say, what became of commands, and what a simulation knows beside."""
    sensed = [
        ("tick", "<i8"),
        *((name, "<f8", (joints,)) for name in ("q", "dq", "tau_est")),
        *((name, "<f8", (3,)) for name in ("gyroscope", "mean_gyroscope", "accelerometer")),
        ("foot_wrench", "<f8", (2, 6)),
        *((f"{group}_age", "<f8") for group in _GROUPS),
        *((f"{group}_fresh", "u1") for group in _GROUPS),
        *((f"has_{name}", "u1") for name in ("dq", "foot_wrench")),
    ]
    answered = [("cmd_tick", "<i8"), ("missed", "<u4"), ("limited", "<u4"), ("damped", "u1")]
    true = [
        ("time", "<f8"),
        *((f"true_{name}", "<f8", (joints,)) for name in ("q", "dq", "tau")),
        *((f"true_{name}", "<f8", (3,)) for name in ("gyroscope", "accelerometer", "external_force")),
        ("true_wrench", "<f8", (2, 6)),
        ("configuration", "<f8", (7 + joints,)),
        ("velocity", "<f8", (6 + joints,)),
        ("nonfoot_contact", "u1"),
        ("self_contact", "u1"),
    ]
    return np.dtype([*sensed, *answered, *true])


_GROUPS = ("joint", "imu", "wrench")

_TRUE = {
    "true_q": "joint_position",
    "true_dq": "joint_velocity",
    "true_tau": "joint_torque",
    "true_gyroscope": "gyro",
    "true_accelerometer": "accelerometer",
    "true_external_force": "external_force",
    "true_wrench": "wrench",
    "configuration": "q",
    "velocity": "v",
    "nonfoot_contact": "nonfoot_contact",
    "self_contact": "self_contact",
    "time": "time",
}
"""Fields of a measurement by those of a state that hold them."""


_KNOWN = ("time", "true_q", "true_dq", "true_gyroscope", "configuration", "velocity")
_PERHAPS_KNOWN = ("true_tau", "true_accelerometer", "true_external_force", "true_wrench")
_SENSED = (
    *("q", "dq", "tau_est", "gyroscope", "mean_gyroscope", "accelerometer", "foot_wrench"),
    *(f"{group}_age" for group in _GROUPS),
)
"""Fields of a state that are numbers in each, that are NaN where a plant does not know them, and of sensors."""


@lru_cache(maxsize=4)
def _reset(joints: int) -> np.dtype[Any]:
    return np.dtype(
        [("senses", "u1"), ("q", "<f8", (7 + joints,)), ("v", "<f8", (6 + joints,)), ("torque", "<f8", (joints,))]
    )


@dataclass(frozen=True, slots=True)
class Answered:
    """The fate of the commands at a plant.

    Attributes:
        tick: of the state that the command in force answers; -1 before the first one.
        missed: ticks so far to which no new command had come.
        limited: ticks so far at which a command was bent to the limits.
        damped: whether the plant is damped, whatever it is commanded.
    """

    tick: int = -1
    missed: int = 0
    limited: int = 0
    damped: bool = False


@dataclass(frozen=True, slots=True)
class State:
    """The state that a plant sends at a tick.

    Attributes:
        tick: number of the control tick.
        measurement: the truth.
        readings: of the sensors; None where none are read.
        answered: what has become of the commands.
    """

    tick: int
    measurement: Measurement
    readings: Readings | None
    answered: Answered


def command_bytes(tick: int, command: JointCommand) -> bytes:
    """A command that answers the state of a tick."""
    joints, servo = len(command.torque), command.servo
    message = np.zeros((), low_cmd(joints))
    message["tick"], message["tau"] = tick, command.torque
    if servo is not None:
        message["q"] = servo.position
        message["dq"] = servo.velocity
        message["kp"] = servo.stiffness
        message["kd"] = servo.damping
    return message.tobytes()


def command_of(payload: bytes, joints: int) -> tuple[int, JointCommand]:
    """Tick and command of a message; without gains it is one of torques alone.

    Raises:
        LinkError: it is of another robot, or not of numbers for joints.
    """
    message = _read(payload, low_cmd(joints), "command")
    q, dq, tau, kp, kd = numbers = [message[name] for name in ("q", "dq", "tau", "kp", "kd")]
    _refuse_unsound(numbers, "command")
    if kp.min() < 0.0 or kd.min() < 0.0:
        raise LinkError("a command with a negative gain")
    servo = Servo(q, dq, kp, kd) if kp.any() or kd.any() else None
    return int(message["tick"]), JointCommand(tau, servo)


GREATEST = 1e9
"""Size of a number beyond which none is of a robot, in SI units."""


def _refuse_unsound(numbers: Iterable[Array], what: str, known: bool = True) -> None:
    """Refuse numbers that are greater than any of a robot, and those that are none where all must be ``known``.

    Raises:
        LinkError: there is one.
    """
    sizes = np.abs(np.concatenate([part.ravel() for part in numbers]))
    if known and not np.isfinite(sizes).all():
        raise LinkError(f"a {what} whose numbers are not finite")
    if (sizes > GREATEST).any():
        raise LinkError(f"a {what} with a number of the size {np.nanmax(sizes):.3g}; none may be over {GREATEST:g}")


def _refuse_unturned(quaternion: Array, what: str) -> None:
    """Refuse numbers that turn nothing; LinkError if they do."""
    if not is_rotation(quaternion):
        raise LinkError(f"a {what} whose base has no attitude")


def _read(payload: bytes, layout: np.dtype[Any], what: str) -> NDArray[np.void]:
    if len(payload) != layout.itemsize:
        raise LinkError(
            f"a {what} of {len(payload)} bytes where {layout.itemsize} are due; it is of a robot with other joints"
        )
    return np.frombuffer(payload, layout)[0]  # type: ignore[no-any-return]


def state_bytes(state: State) -> bytes:
    """A state as a message."""
    seen, said, answered = state.measurement, state.readings, state.answered
    message = np.zeros((), low_state(len(seen.joint_position)))
    message["tick"] = state.tick
    if said is None:
        sensed: Mapping[str, Any] = {
            "q": seen.joint_position, "dq": seen.joint_velocity, "tau_est": seen.joint_torque, "gyroscope": seen.gyro,
            "accelerometer": seen.accelerometer, "foot_wrench": seen.wrench,
        }  # fmt: skip
    else:
        sensed = _sensed(said)
    for name, value in sensed.items():
        message[name] = value
    for name, field in _TRUE.items():
        message[name] = getattr(seen, field)
    message["cmd_tick"] = answered.tick
    message["missed"] = answered.missed
    message["limited"] = answered.limited
    message["damped"] = answered.damped
    return message.tobytes()


def _sensed(said: Readings) -> dict[str, Any]:
    """Fields of what sensors say; those of one group come together."""
    sensed: dict[str, Any] = {
        "q": said.joint_position.values, "tau_est": said.joint_torque.values,
        "gyroscope": said.angular_velocity.values, "mean_gyroscope": said.mean_angular_velocity.values,
        "accelerometer": said.specific_force.values,
    }  # fmt: skip
    if said.joint_velocity is not None:
        sensed |= {"has_dq": 1, "dq": said.joint_velocity.values}
    if said.wrench is not None:
        sensed |= {"has_foot_wrench": 1, "foot_wrench": said.wrench.values}
    for group, reading in zip(_GROUPS, (said.joint_position, said.specific_force, said.wrench), strict=True):
        if reading is not None:
            sensed |= {f"{group}_age": reading.age, f"{group}_fresh": reading.fresh}
    return sensed


def state_of(payload: bytes, joints: int, rate: int, senses: bool) -> State:
    """A state of a message.

    Args:
        payload: of the message.
        joints: of the robot.
        rate: of its control ticks [Hz].
        senses: whether what sensors say is wanted.

    Raises:
        LinkError: it is of another robot, or not of numbers that a robot has.
    """
    message = _read(payload, low_state(joints), "state")
    _refuse_unsound([message[name] for name in _KNOWN], "state")
    _refuse_unsound([message[name] for name in _PERHAPS_KNOWN], "state", known=False)
    if senses:
        _refuse_unsound([message[name] for name in _SENSED], "state")
    _refuse_unturned(message["configuration"][3:7], "state")
    flags = {"nonfoot_contact", "self_contact"}
    true: dict[str, Any] = {
        field: bool(message[name]) if name in flags else float(message[name]) if name == "time" else message[name]
        for name, field in _TRUE.items()
    }
    tick = int(message["tick"])
    answered = Answered(
        int(message["cmd_tick"]), int(message["missed"]), int(message["limited"]), bool(message["damped"])
    )
    if not -1 <= answered.tick <= tick + 1:
        raise LinkError(f"a state of tick {tick} with a command in force that answers tick {answered.tick}")
    return State(tick, Measurement(**true), _readings(message, tick / rate) if senses else None, answered)


def _readings(message: NDArray[np.void], time: float) -> Readings:
    def reading(name: str, group: str) -> Reading:
        return Reading(message[name], float(message[f"{group}_age"]), bool(message[f"{group}_fresh"]))

    return Readings(
        time=time,
        joint_position=reading("q", "joint"),
        joint_velocity=reading("dq", "joint") if message["has_dq"] else None,
        joint_torque=reading("tau_est", "joint"),
        angular_velocity=reading("gyroscope", "imu"),
        mean_angular_velocity=reading("mean_gyroscope", "imu"),
        specific_force=reading("accelerometer", "imu"),
        wrench=reading("foot_wrench", "wrench") if message["has_foot_wrench"] else None,
    )


@dataclass(frozen=True, slots=True)
class Start:
    """The start of a plant.

    Attributes:
        q: configuration, shape (7 + nj,).
        v: velocity, shape (6 + nj,).
        torque: that holds it, shape (nj,) [N·m].
        senses: whether its sensors are to be read.
    """

    q: Array
    v: Array
    torque: Array
    senses: bool


def start_bytes(start: Start) -> bytes:
    """A start as a message."""
    message = np.zeros((), _reset(len(start.torque)))
    for name, value in asdict(start).items():
        message[name] = value
    return message.tobytes()


def start_of(payload: bytes, joints: int) -> Start:
    """The start of a message.

    Raises:
        LinkError: it is of another robot, or not of finite numbers.
    """
    message = _read(payload, _reset(joints), "start")
    q, v, torque = message["q"], message["v"], message["torque"]
    _refuse_unsound((q, v, torque), "start")
    _refuse_unturned(q[3:7], "start")
    return Start(q, v, torque, bool(message["senses"]))


def push_bytes(push: Push) -> bytes:
    """A push as a message."""
    return json_bytes({"time": push.time, "duration": push.duration, "force": push.force.tolist(), "body": push.body})


def push_of(payload: bytes) -> Push:
    """The push of a message.

    Raises:
        LinkError: it is none, or not of finite numbers.
    """
    keys = json_of(payload, "push")
    try:
        force = np.array([float(part) for part in keys["force"]])
        push = Push(float(keys["time"]), float(keys["duration"]), force, str(keys["body"]))
    except (KeyError, TypeError, ValueError, OverflowError):
        raise LinkError("a push without time, duration, force and body") from None
    _refuse_unsound((force, np.array([push.time, push.duration])), "push")
    return push


def json_bytes(keys: Mapping[str, Any]) -> bytes:
    """An object of JSON as a message."""
    return json.dumps(keys).encode()


def json_of(payload: bytes, what: str) -> dict[str, Any]:
    """The object of JSON of a message.

    Raises:
        LinkError: it is none.
    """
    try:
        keys = json.loads(payload)
    except (ValueError, RecursionError):
        keys = None
    if not isinstance(keys, dict):
        raise LinkError(f"a {what} that is no object of JSON")
    return keys


def end_bytes(why: str) -> bytes:
    """Reason of an end, as a message."""
    return json_bytes({"why": why})


def why_of(payload: bytes) -> str:
    """Reason of an end or a refusal, by a message of the other side; whatever it sends becomes one line."""
    why = str(json_of(payload, "reason").get("why", ""))
    return "".join(sign for sign in why if sign.isprintable())[:LONGEST_SAID]


LONGEST_SAID = 300
"""Characters of what another process says that are shown."""
