"""Messages: every number arrives to the bit; what is of another robot, or no number, is refused."""

import dataclasses

import numpy as np
import pytest

from surefoot.apps.bridge import messages
from surefoot.apps.bridge.messages import Answered, Start, State
from surefoot.forces import Push
from surefoot.joints import JointCommand, Servo
from surefoot.readings import Reading, Readings
from surefoot.scenarios.errors import LinkError
from surefoot.sim.measurement import Measurement

pytestmark = pytest.mark.unit

JOINTS, RATE = 5, 500


def numbers(*shape, seed=0):
    return np.random.default_rng((seed, *shape)).standard_normal(shape)


def measurement():
    sized = {"q": 7 + JOINTS, "v": 6 + JOINTS, "gyro": 3, "accelerometer": 3, "external_force": 3}
    arrays = {name: numbers(size, seed=k) for k, (name, size) in enumerate(sized.items())}
    arrays |= {
        f"joint_{name}": numbers(JOINTS, seed=9 + k) for k, name in enumerate(("position", "velocity", "torque"))
    }
    arrays["q"][3:7] /= np.linalg.norm(arrays["q"][3:7])
    return Measurement(
        time=0.1 + 0.2, wrench=np.full((2, 6), np.nan), nonfoot_contact=True, self_contact=False, **arrays
    )


def readings(velocity=True, wrench=True):
    def reading(*shape, age):
        return Reading(numbers(*shape, seed=20), age, age == 0.0)

    return Readings(
        time=17 / RATE,
        joint_position=reading(JOINTS, age=0.004),
        joint_velocity=reading(JOINTS, age=0.004) if velocity else None,
        joint_torque=reading(JOINTS, age=0.004),
        angular_velocity=reading(3, age=0.0),
        mean_angular_velocity=reading(3, age=0.0),
        specific_force=reading(3, age=0.0),
        wrench=reading(2, 6, age=0.002) if wrench else None,
    )


def equal(one, other):
    if dataclasses.is_dataclass(one):
        names = [field.name for field in dataclasses.fields(one)]
        return type(one) is type(other) and all(equal(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other, equal_nan=True)
    return one == other and type(one) is type(other)


@pytest.mark.parametrize("said", [None, readings(), readings(velocity=False), readings(wrench=False)])
def test_a_state_arrives_to_the_bit(said):
    state = State(17, measurement(), said, Answered(16, 3, 2, damped=True))
    assert equal(messages.state_of(messages.state_bytes(state), JOINTS, RATE, said is not None), state)


@pytest.mark.parametrize("servo", [None, Servo(*(abs(numbers(JOINTS, seed=k)) for k in range(4)))])
def test_a_command_arrives_to_the_bit(servo):
    command = JointCommand(numbers(JOINTS), servo)
    tick, arrived = messages.command_of(messages.command_bytes(17, command), JOINTS)
    assert tick == 17
    assert equal(arrived, command)


def test_a_start_and_a_push_arrive_to_the_bit():
    q = np.concatenate((numbers(3), [0.0, 0.0, 0.6, 0.8], numbers(JOINTS)))
    start = Start(q, numbers(6 + JOINTS), numbers(JOINTS), senses=True)
    assert equal(messages.start_of(messages.start_bytes(start), JOINTS), start)
    push = Push(0.1 + 0.2, 1 / 3, numbers(3), "torso")
    assert equal(messages.push_of(messages.push_bytes(push)), push)


def test_a_command_has_the_fields_of_the_robots_own():
    assert messages.low_cmd(JOINTS).names == ("tick", "q", "dq", "tau", "kp", "kd")
    assert {"q", "dq", "tau_est", "gyroscope", "accelerometer", "tick"} <= set(messages.low_state(JOINTS).names)


def broken(**wrong):
    servo = Servo(*(abs(numbers(JOINTS, seed=k)) for k in range(4)))
    message = np.frombuffer(messages.command_bytes(1, JointCommand(numbers(JOINTS), servo)), messages.low_cmd(JOINTS))
    changed = message.copy()
    for name, value in wrong.items():
        changed[name][0, 2] = value
    return changed.tobytes()


@pytest.mark.parametrize(
    ("payload", "said"),
    [
        (broken(tau=np.nan), "not finite"),
        (broken(q=np.inf), "not finite"),
        (broken(tau=1e308), "a command with a number of the size 1e\\+308; none may be over 1e\\+09"),
        (broken(kd=-1.0), "negative gain"),
        (broken()[:-8], "of a robot with other joints"),
        (b"", "a command of 0 bytes"),
    ],
)
def test_a_command_that_nobody_may_obey_is_refused(payload, said):
    assert messages.command_of(broken(), JOINTS)[0] == 1
    with pytest.raises(LinkError, match=said):
        messages.command_of(payload, JOINTS)


def test_a_start_that_is_no_configuration_is_refused():
    start = Start(np.zeros(7 + JOINTS), np.zeros(6 + JOINTS), np.zeros(JOINTS), senses=False)
    with pytest.raises(LinkError, match="a start whose base has no attitude"):
        messages.start_of(messages.start_bytes(start), JOINTS)


@pytest.mark.parametrize("payload", [b"", b"[]", b"{", b"\xff", b"[" * 100_000, b'{"time": 1}', b'{"force": "abc"}'])
def test_what_is_no_push_is_refused(payload):
    with pytest.raises(LinkError):
        messages.push_of(payload)


def test_what_another_process_says_is_one_line():
    assert messages.why_of(messages.end_bytes("a\nb\x1b[2J" + 1000 * "c")).startswith("ab[2Jccc")
    assert len(messages.why_of(messages.end_bytes(1000 * "c"))) == messages.LONGEST_SAID
