"""The errors against commanded velocities: the law of the mean, and which commands are judged."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge.following import base_pose, mean_velocity, velocity_error, yaw_rate_error
from surefoot.similarity import Similarity

pytestmark = pytest.mark.unit

RATE = 500


def ridden(twists, seconds, sway=0.0, start=0.0):
    """Place and heading of a base that follows each of some velocities for a while, and sways aside."""
    time = np.arange(round(RATE * seconds)) / RATE
    poses, (x, y, yaw) = [], (0.3, -0.2, 3.0)
    for v_x, v_y, rate in twists:
        heading = yaw + rate * time
        c, s = np.cos(heading), np.sin(heading)
        step = np.column_stack((c * v_x - s * v_y, s * v_x + c * v_y, np.full_like(c, rate))) / RATE
        path = np.array([x, y, yaw]) + np.cumsum(step, axis=0) - step[0]
        (x, y, yaw) = path[-1] + step[-1]
        poses.append(path)
    found = np.concatenate(poses)
    aside = sway * np.sin(2.0 * np.pi * (np.arange(len(found)) / RATE / 0.66 + start))
    found[:, :2] += aside[:, None] * np.column_stack((-np.sin(found[:, 2]), np.cos(found[:, 2])))
    return found


@pytest.mark.parametrize("twist", [(0.5, 0.0, 0.0), (0.0, -0.2, 0.0), (0.3, 0.1, 0.7), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("start", [0.0, 0.13, 0.5])
def test_the_mean_of_a_steady_walk_is_its_velocity_whatever_its_sway(twist, start):
    np.testing.assert_allclose(mean_velocity(ridden([twist], 2.5), RATE), twist, atol=1e-3)
    np.testing.assert_allclose(mean_velocity(ridden([twist], 2.5, 0.03, start), RATE), twist, atol=0.02)
    plain = np.diff(ridden([(0.5, 0.0, 0.0)], 2.5, 0.03, 0.13)[[0, -1], 1])  # which the ends alone would not give
    assert abs(plain.item() / 2.5 - 0.5 * np.sin(3.0)) > 0.01


def run_of(twists, asked, seconds=4.0, lasts=None, size=1.0):
    """A run that was commanded some velocities, each after so many seconds, and did others."""
    poses = ridden(twists, seconds)
    begins = seconds * np.arange(len(asked)) if lasts is None else np.asarray(lasts)
    asked = np.asarray(asked, dtype=float)
    fields = {"velocity": asked[:, :2], "yaw_rate": asked[:, 2]}
    command = SimpleNamespace(time=begins, field=fields.__getitem__)
    return SimpleNamespace(
        constants=SimpleNamespace(similarity=Similarity(size), control_rate=RATE),
        ticks=len(poses),
        time=np.arange(len(poses)) / RATE,
        log={"/command": command},
        reduced={base_pose: poses}.__getitem__,
    )


def errors(fell=None, **keys):
    run = run_of(**keys)
    run.once = lambda function: fell if function.__name__ == "_fall_time" else function(run)
    return velocity_error(run), yaw_rate_error(run)


def test_the_worst_command_counts_in_each_direction():
    did = [(0.5, 0.0, 0.0), (0.2, 0.1, 0.3), (0.0, 0.0, 0.0)]
    off = [(0.52, 0.0, 0.0), (0.23, 0.14, 0.2), (0.0, 0.0, 0.0)]
    velocity, rate = errors(twists=off, asked=did)
    assert velocity == pytest.approx(0.05, abs=2e-3)
    assert rate == pytest.approx(0.1, abs=2e-3)


def test_a_robot_that_stands_under_a_command_is_as_far_off_as_that():
    velocity, rate = errors(twists=[(0.0, 0.0, 0.0)], asked=[(0.3, 0.0, -0.4)])
    assert (velocity, rate) == (pytest.approx(0.3), pytest.approx(0.4))


def test_a_command_counts_once_it_is_settled_and_if_it_lasts():
    late = [(0.0, 0.0, 0.0), (0.4, 0.0, 0.0)]  # it takes a second to come to it
    velocity, _ = errors(twists=late, asked=[(0.4, 0.0, 0.0)], seconds=1.2)
    assert velocity is None  # 0.9 s are left once it is settled
    velocity, _ = errors(twists=[late[0], *[late[1]] * 3], asked=[(0.4, 0.0, 0.0)], seconds=1.2)
    assert velocity == pytest.approx(0.0, abs=2e-3)


def test_commands_alike_are_one_and_places_are_none():
    asked = [(0.4, 0.0, 0.0)] * 4
    velocity, _ = errors(twists=[(0.3, 0.0, 0.0)], asked=asked, lasts=[0.0, 1.0, 2.0, 3.0])
    assert velocity == pytest.approx(0.1, abs=2e-3)
    assert errors(twists=[(0.3, 0.0, 0.0)], asked=[(np.nan,) * 3]) == (None, None)


def test_what_comes_after_a_fall_is_not_judged():
    twists = [(0.4, 0.0, 0.0), (0.0, 0.0, 0.0)]
    asked = [(0.4, 0.0, 0.0)] * 2
    assert errors(twists=twists, asked=asked)[0] > 0.1
    assert errors(twists=twists, asked=asked, fell=4.0)[0] == pytest.approx(0.0, abs=2e-3)
    assert errors(twists=twists, asked=asked, fell=2.0) == (None, None)


def test_a_small_robot_has_less_time():
    short = {"twists": [(0.4, 0.0, 0.0)], "asked": [(0.4, 0.0, 0.0)], "seconds": 2.2}
    assert errors(**short) == (None, None)
    assert errors(**short, size=0.5)[0] == pytest.approx(0.0, abs=2e-3)
