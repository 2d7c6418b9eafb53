"""A gait of one number: what follows from `gait.speed`, what may stand beside it, and other robots."""

import math

import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.setup.groups.speed import FOLLOWING
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit


def walk(*overrides, speed=0.8, **beside):
    gait = {"speed": speed, "steps": 6, **beside}
    return load("walk-level", {"gait": gait, "criteria": {"fell": False}, **dict(overrides)})


def value(scenario, key):
    for name in key:
        scenario = getattr(scenario, name)
    return scenario


def test_a_speed_is_a_whole_gait():
    keys, plain = walk(), load("walk-level")
    gait = keys.gait
    assert gait.step_length / (gait.single_support + gait.double_support) == pytest.approx(0.8)
    assert gait.heel_off > gait.heel_strike > 0.1
    assert keys.planner.knee == "straight"
    assert keys.wbc.weights is None
    assert resolve(keys).controller.knees.weight > 0.0
    assert resolve(plain).controller.knees.weight == 0.0
    assert plain.wbc is None
    assert plain.planner.knee == "stretched"


WAISTS = [("humanoid100", True, True), ("talos", True, False), ("g1", False, False)]


@pytest.mark.parametrize(("robot", "turns", "lists"), WAISTS)
def test_a_pelvis_sways_by_speed_where_hips_and_waist_have_joints_for_it(robot, turns, lists):
    """People turn it by 5 degrees at 1.2 m/s, and less where they step shorter."""
    for speed in (0.4, 0.6):
        gait = walk(("robot", robot), speed=speed).gait
        assert (0.8 * math.radians(5.0) > gait.pelvis_yaw > 0.5 * math.radians(5.0)) is turns
        assert (0.5 * math.radians(5.0) > gait.pelvis_list > 0.2 * math.radians(5.0)) is lists
    asked = walk(("robot", robot), pelvis_yaw=0.05, pelvis_list=0.03, speed=0.6).gait
    assert (asked.pelvis_yaw, asked.pelvis_list) == (0.05, 0.03)
    plain = load("walk-level", {"robot": robot}).gait
    assert plain.pelvis_yaw == plain.pelvis_list == 0.0


@pytest.mark.parametrize("key", FOLLOWING, ids=".".join)
def test_each_number_may_be_set_beside_it(key):
    usual = value(walk(), key)
    other = "stretched" if usual == "straight" else 2 if key[-1] == "ramp" else 0.9 * usual or 0.001
    keys = walk(**{key[1]: other}) if key[0] == "gait" else walk((".".join(key), other))
    assert value(keys, key) == other
    length, single, double = keys.gait.step_length, keys.gait.single_support, keys.gait.double_support
    assert length / (single + double) == pytest.approx(0.8)


def test_bent_knees_have_the_same_steps_and_no_task_that_straightens_them():
    straight, bent = walk(), walk(("planner.knee", "bent"))
    assert bent.gait == straight.gait
    assert bent.wbc is None
    assert resolve(bent).controller.knees.weight == 0.0


def test_numbers_that_contradict_it_are_refused():
    with pytest.raises(ScenarioError, match=r"--set gait\.speed: speed 0\.8 m/s beside steps of 0\.3 m in 0\.66 s"):
        load("walk-level", {"gait.speed": 0.8})


@pytest.mark.parametrize("speed", [0, -0.5, 7, "fast", float("inf")])
def test_no_speed_at_all_is_refused(speed):
    with pytest.raises(ScenarioError, match=r"gait"):
        walk(speed=speed)


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_it_comes_back_from_its_text_whole(robot):
    keys = walk(("robot", robot))
    assert read_scenario(scenario_yaml(keys), "log", "log") == keys


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_what_followed_from_it_follows_from_another_one_set_over_a_text(robot):
    """A log has every number: those that the speed made are made anew, those that were given stay."""
    text = scenario_yaml(walk(("robot", robot), swing_height=0.04, heel_off=0.3))
    again = read_scenario(text, "log", "log", {"gait.speed": 0.6})
    assert again == walk(("robot", robot), speed=0.6, swing_height=0.04, heel_off=0.3)
    with pytest.raises(ScenarioError, match="beside steps of"):
        read_scenario(scenario_yaml(walk(step_length=0.4, single_support=0.38)), "log", "log", {"gait.speed": 0.6})


def test_a_speed_is_that_of_the_robot_it_is_for():
    """One that is set over a file is not scaled; one in a file that is sized for another robot is."""
    assert walk(("robot", "g1")).gait.speed == 0.8
    text = "name: one\nrobot: humanoid100\nsized_for: humanoid100\ngait: {speed: 0.8, steps: 6}\n"
    keys = read_scenario(text, "one", "one", {"robot": "g1"})
    assert keys.gait.speed == pytest.approx(0.8 * 0.719**0.5, rel=1e-3)
    assert keys.gait.step_length / (keys.gait.single_support + keys.gait.double_support) == pytest.approx(
        keys.gait.speed
    )


def test_a_pendulum_has_the_same_gait_and_no_controller():
    keys = walk(("fidelity", "pendulum"))
    assert keys.gait == walk().gait
    assert keys.wbc is None


def test_feet_that_land_flat_carry_the_body_lower():
    assert walk(heel_strike=0.0).gait.com_height < walk().gait.com_height - 0.015


def test_a_robot_that_is_too_slow_for_it_is_told_a_speed_that_it_can_do():
    from surefoot.scenarios.setup.feasible import made_ready
    from surefoot.scenarios.setup.robot.body import body_of

    keys = walk(("robot", "talos"), speed=1.2)
    way = resolve(keys)
    with pytest.raises(ValueError, match=r"take for example --set gait\.speed=") as refused:
        made_ready(way, body_of(way.robot))
    slower = float(str(refused.value).rpartition("gait.speed=")[2].split()[0].rstrip(".)"))
    calm = resolve(walk(("robot", "talos"), speed=slower))
    made_ready(calm, body_of(calm.robot))
