"""Observation terms by their laws: frames, signs, order and history."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from surefoot.errors import ParameterError
from surefoot.planner.types import Twist
from surefoot.scenarios.policy import terms
from surefoot.scenarios.policy.history import Stack
from surefoot.scenarios.policy.terms import Seen

pytestmark = pytest.mark.unit

STILL = Twist()


def seen(rotation=None, time=0.0, command=STILL, **more):
    upright = np.eye(3) if rotation is None else rotation.as_matrix()
    values = {
        "time": time, "walked": 0.0, "since": 0.0, "rotation": upright,
        "torso_rotation": np.eye(3), "angular_velocity": np.array([1.0, 2.0, 3.0]),
        "torso_angular_velocity": np.array([4.0, 5.0, 6.0]), "linear_velocity": np.zeros(3), "height": 0.7,
        "position": np.array([0.5, 1.0]), "default": np.array([0.1, 0.2]), "velocity": np.array([3.0, 4.0]),
        "action": np.array([7.0]), "command": command, "stands": command.is_zero,
    }  # fmt: skip
    return Seen(**{**values, **more})


@pytest.mark.parametrize(("clock", "share"), [("always", 0.9), ("walking", 0.5), ("anew", 0.1)])
def test_a_clock_runs_always_or_while_it_walks_or_anew(clock, share):
    now = seen(time=0.9, walked=0.5, since=0.1, stands=False)
    told = terms.phase(now, period=1.0, clock=clock)
    np.testing.assert_allclose(told, (np.sin(2.0 * np.pi * share), np.cos(2.0 * np.pi * share)), atol=1e-12)
    begun = terms.phase(now, period=1.0, clock=clock, begin=0.3, waves=["sin"]).item()
    assert begun == pytest.approx(np.sin(2.0 * np.pi * (share + 0.3)))


def test_a_clock_that_is_none_is_refused():
    with pytest.raises(ParameterError, match="no clock 'never'"):
        terms.phase(seen(), clock="never")


def test_gravity_is_down_in_the_frame_of_the_base():
    np.testing.assert_allclose(terms.gravity(seen()), (0.0, 0.0, -1.0))
    ahead = seen(Rotation.from_euler("y", 0.3))  # leans ahead, so that down is ahead of it too
    np.testing.assert_allclose(terms.gravity(ahead), (np.sin(0.3), 0.0, -np.cos(0.3)))
    turned = seen(Rotation.from_euler("z", 1.0))
    np.testing.assert_allclose(terms.gravity(turned), (0.0, 0.0, -1.0), atol=1e-12)
    np.testing.assert_allclose(terms.gravity(ahead, body="torso"), (0.0, 0.0, -1.0))


@pytest.mark.parametrize("order", ["wxyz", "xyzw"])
def test_a_quaternion_is_told_in_its_order(order):
    rotation = Rotation.from_euler("ZYX", [0.4, -0.2, 0.1])
    told = terms.orientation(seen(rotation), order=order)
    np.testing.assert_allclose(told, rotation.as_quat(canonical=True, scalar_first=order == "wxyz"))
    np.testing.assert_allclose(terms.roll_pitch(seen(rotation)), (0.1, -0.2))


def test_joints_are_told_from_the_default_posture():
    np.testing.assert_allclose(terms.joint_position(seen()), (0.4, 0.8))
    np.testing.assert_allclose(terms.joint_position(seen(), relative=False), (0.5, 1.0))
    np.testing.assert_allclose(terms.command(seen(command=Twist(1.0, 2.0, 3.0)), axes=[2, 0]), (3.0, 1.0))
    assert [terms.moving(seen(command=twist)).item() for twist in (Twist(), Twist(0.1))] == [0.0, 1.0]
    assert terms.moving(seen(stands=False)).item() == 1.0  # it marches


def test_a_clock_goes_round_in_its_period_and_rests():
    for time in (0.0, 0.2, 0.55):
        told = terms.phase(seen(time=time), period=0.8, offsets=[0.0, 0.5])
        turn = 2.0 * np.pi * time / 0.8
        np.testing.assert_allclose(told, (np.sin(turn), np.cos(turn), -np.sin(turn), -np.cos(turn)), atol=1e-12)
        again = terms.phase(seen(time=time + 0.8), period=0.8, offsets=[0.0, 0.5])
        np.testing.assert_allclose(told, again, atol=1e-9)
    grouped = terms.phase(seen(time=0.2), period=0.8, offsets=[0.0, 0.5], grouped=True)
    np.testing.assert_allclose(grouped, (1.0, -1.0, 0.0, 0.0), atol=1e-12)
    rests = [terms.phase(seen(time=time), rest=0.25, waves=["sin"]).item() for time in (0.0, 0.3)]
    np.testing.assert_allclose(rests, (1.0, 1.0))
    silent = [terms.phase(seen(stands=stands), offsets=[0.0, 0.5], rest="zeros") for stands in (True, False)]
    assert [told.tolist() for told in silent] == [[0.0] * 4, terms.phase(seen(), offsets=[0.0, 0.5]).tolist()]
    with pytest.raises(ParameterError, match="zeros"):
        terms.phase(seen(), rest="never")
    slower = terms.phase(seen(time=0.3), period=1.0, stance=0.6, waves=["sin"]).item()
    np.testing.assert_allclose(slower, 1.0)  # half of the stance is a quarter turn


def frames(count):
    return [[np.array([float(k), -float(k)]), np.array([10.0 + k])] for k in range(1, count + 1)]


def test_histories_stand_as_they_are_asked_for():
    def last(*given):
        stack = Stack(*given)
        return [stack.add(np.concatenate(frame), [len(one) for one in frame]) for frame in frames(3)]

    assert last([2, 2], False, False, True)[-1].tolist() == [2, -2, 3, -3, 12, 13]
    assert last([2, 2], True, False, True)[-1].tolist() == [3, -3, 2, -2, 13, 12]
    assert last([2, 2], False, True, True)[-1].tolist() == [2, -2, 12, 3, -3, 13]
    assert last([2, 2], True, True, True)[-1].tolist() == [3, -3, 13, 2, -2, 12]
    assert last([1, 3], False, False, True)[-1].tolist() == [3, -3, 11, 12, 13]
    assert last([2, 2], False, False, True)[0].tolist() == [0, 0, 1, -1, 0, 11]
    assert last([2, 2], False, False, False)[0].tolist() == [1, -1, 1, -1, 11, 11]
    with pytest.raises(ValueError, match="frames"):
        Stack([1, 2], False, True, True)
