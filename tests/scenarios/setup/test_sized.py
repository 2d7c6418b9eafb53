"""A scenario means the same walk for robots of all sizes; what a user sets is meant as it is."""

import math
from dataclasses import dataclass, replace

import pytest

from surefoot.models.facts import CLEAR, HIPS, SHANKS
from surefoot.models.facts import similar_com_height as com_height
from surefoot.models.facts import similar_step_width as step_width
from surefoot.models.facts import similar_tread as tread
from surefoot.models.humanoid100 import HUMANOID100
from surefoot.models.registry import ROBOTS
from surefoot.models.similar import scaled
from surefoot.models.types import Robot, RobotOptions
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import Rates, RobotSettings
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.robot.robots import Robots, nearer_landings
from surefoot.scenarios.setup.sized import clock
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.similarity import Similarity

pytestmark = pytest.mark.unit

QUARTER = Similarity(0.25, 0.25**3)


def _small(options):
    own = RobotOptions(options.foot_length or 0.22, options.foot_width or 0.11, 64.0 * options.payload_mass)
    return replace(scaled(HUMANOID100.build(own), 0.25), name="small")


@pytest.fixture(autouse=True)
def small():
    ROBOTS.add("small", Robot("small", _small))
    yield
    ROBOTS.discard("small")


def read(text, *settings):
    return read_scenario(text, "f.yaml", "f", settings)


def test_a_catalogue_walk_is_the_same_walk_for_a_similar_robot():
    full, walk = load("walk-level"), load("walk-level", {"robot": "small"})
    assert walk.gait.steps == full.gait.steps
    for name in ("step_length", "step_width", "swing_height", "com_height", "apex_single"):
        assert getattr(walk.gait, name) == pytest.approx(0.25 * getattr(full.gait, name), rel=1e-12)
    for name in ("single_support", "double_support", "initial_stand"):
        assert getattr(walk.gait, name) == 0.5 * getattr(full.gait, name)
    assert walk.robot_options == RobotSettings()
    assert walk.criteria["speed_mean"].min == 0.5 * full.criteria["speed_mean"].min
    assert walk.criteria["com_error_rms"].max == tuple(0.25 * most for most in full.criteria["com_error_rms"].max)
    assert walk.criteria["cop_ratio_p99"] == full.criteria["cop_ratio_p99"]
    assert walk.criteria["steps_taken"] == full.criteria["steps_taken"]
    assert walk.rates == Rates(physics=2000, control=1000, planner=100)
    assert walk.planner.sample_time == 0.01
    assert walk.sized_for is None


def test_pushes_grow_with_mass_and_impulses_with_speed():
    text = "sized_for: humanoid100\npushes: [{time: 2 s, force: [64, 0, 0]}, {time: 3, impulse: 0.2, direction: 1.0}]"
    first, second = read(text, "robot=small").pushes
    assert (first.time, first.duration, first.force) == (1.0, 0.05, (1.0, 0.0, 0.0))
    assert (second.time, second.duration, second.impulse, second.direction) == (1.5, 0.05, 0.1, 1.0)


def test_what_is_set_is_literal_and_the_rest_follows():
    settings = ("robot=small", "gait.step_length=0.1", "planner.jerk_limit=70", "criteria.speed_mean={min: 0.1}")
    walk = load("walk-level", (*settings, "pushes=[{time: 2, force: [5, 0, 0]}]", "wbc.schedule.felt_force=3"))
    assert (walk.gait.step_length, walk.planner.jerk_limit, walk.criteria["speed_mean"].min) == (0.1, 70.0, 0.1)
    (push,) = walk.pushes
    assert (push.force, push.duration) == ((5.0, 0.0, 0.0), 0.05)
    resolved = resolve(walk)
    assert resolved.controller.schedule.felt_force == 3.0
    assert resolved.controller.schedule.early_cap == 50.0 / 64.0
    assert resolved.parameters.jerk_limit == 70.0


def test_a_file_that_is_sized_for_no_robot_means_what_it_says():
    walk = read("robot: small\ngait: {step_length: 0.06, single_support: 0.4}")
    assert (walk.gait.step_length, walk.gait.single_support) == (0.06, 0.4)
    assert (walk.gait.double_support, walk.gait.swing_height) == (0.25, 0.0125)
    assert walk.criteria["standing_time_final"].min == 0.5


def test_gains_and_rates_that_a_file_gives_are_translated_too():
    controller, rates = "{arm_swing: 0.5, gains: {orientation: [100, 20]}}", "{control: 1000, physics: 2000}"
    text = f"sized_for: humanoid100\nwbc: {controller}\nrates: {rates}"
    walk = read(text, "robot=small")
    assert (walk.wbc.arm_swing, walk.wbc.gains.orientation) == (2.0, (400.0, 40.0))
    assert walk.rates == Rates(physics=4000, control=2000, planner=100)
    assert walk.planner.sample_time == 0.01


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("sized_for: [1]", "unknown robot '[1]' in sized_for"),
        ("sized_for: humanoid100\nrobot: [small]", "robot is ['small']; give a word"),
        ("sized_for: humanoid100\ngait: 3", "gait is 3; give a group of keys"),
        (
            "sized_for: humanoid100\ngait: {step_length: [1, {}]}",
            "give a number ([1, {}] in the file, for humanoid100)",
        ),
        (
            "sized_for: humanoid100\nrates: {planner: x}\nplanner: {sample_time: 1}",
            "rates.planner is 'x'; give a rate",
        ),
        ("sized_for: humanoid100\ncriteria: {speed_mean: {min: [x]}}", "criteria.speed_mean"),
        (
            "sized_for: humanoid100\nwbc: {gains: {swing: [1, 2, 3]}, arm_swing: x}",
            "wbc.arm_swing is 'x'; give a number",
        ),
        ("sized_for: humanoid100\nwbc: {friction: {a: 1}}", "wbc.friction"),
        ("sized_for: humanoid100\nwbc: {weights: {swing: {a: {}}}}", "wbc.weights.swing"),
        ("sized_for: humanoid100\ngait: {step_width: [0.2]}", "([0.2] in the file, for humanoid100)"),
        ("sized_for: humanoid100\ngait: {com_height: [1.0]}", "([1.0] in the file, for humanoid100)"),
    ],
)
def test_what_makes_no_sense_is_told_as_for_any_robot(text, told):
    with pytest.raises(ScenarioError) as error:
        read(text, "robot=small") if "robot" not in text else read(text)
    assert told in str(error.value), str(error.value)


@pytest.mark.parametrize("name", ["walk-level", "stairs-up", "paper-push", "waypoints", "commanded"])
def test_for_its_own_robot_nothing_changes(name, monkeypatch):
    monkeypatch.setattr("surefoot.scenarios.setup.load.say_for", lambda *given: None)
    plain = load(name)
    monkeypatch.undo()
    ROBOTS.add("small", Robot("small", _small))
    assert load(name) == plain


def test_a_log_of_another_robot_runs_again(tmp_path):
    short = (
        "sensing={}",
        "robot=small",
        "fidelity=pendulum",
        "gait.steps=1",
        "gait.initial_stand=0.05",
        "duration=0.3",
    )
    original = load("diagonal-walk", short)
    log = run_scenario(original, tmp_path).log
    assert load(str(log)) == original
    walk = Walk(original, QUARTER)
    assert not any("no effect" in note for note in notes(walk))


def test_a_fault_is_told_with_the_value_as_it_is_written():
    text = "sized_for: humanoid100\ngait:\n  step_length: 1.2"
    with pytest.raises(
        ScenarioError, match=r"f.yaml:3:16: .*0.3 m is out of reach.*\(1.2 in the file, for humanoid100\)"
    ):
        read(text, "robot=small")


def test_a_robot_that_nobody_knows_is_refused():
    with pytest.raises(ScenarioError, match=r"f\.yaml:1:12: unknown robot 'humanoid10' in sized_for; did you mean"):
        read("sized_for: humanoid10", "robot=small")
    with pytest.raises(ScenarioError, match="unknown robot 'smal'; did you mean 'small'"):
        load("walk-level", {"robot": "smal"})


def test_a_file_for_a_robot_that_cannot_be_read_is_refused(tmp_path):
    with pytest.raises(ScenarioError, match=r"sized_for '.*none.yaml' is a robot that cannot be read"):
        read(f"sized_for: {tmp_path}/none.yaml")


def test_legs_are_bent_as_much_and_feet_no_nearer():
    robots = Robots()
    full, other = robots.facts("humanoid100", RobotSettings()), robots.facts("small", RobotSettings())
    wide = replace(other, com_above_hip=0.05, hip_width=0.08, shank_spacing=0.04, foot_width=0.02)
    height = com_height(0.99, full, wide)
    assert (height - 0.05) / wide.leg_length == pytest.approx((0.99 - full.com_above_hip) / full.leg_length)
    width = step_width(0.2, full, wide)
    assert width == pytest.approx(0.05 + 0.04 - 0.25 * full.shank_spacing)
    assert width - wide.shank_spacing == pytest.approx(0.25 * (0.2 - full.shank_spacing))
    assert width - wide.foot_width >= 0.25 * (0.2 - full.foot_width)
    assert step_width(0.2, full, replace(wide, hip_width=0.3, shank_spacing=0.01, foot_width=0.01)) == 0.05


@pytest.mark.parametrize("spacing", [0.01, 0.035, 0.06])
@pytest.mark.parametrize("nearer", [0.0, 0.03, 0.1])
def test_feet_whose_way_is_known_keep_a_part_of_their_room(spacing, nearer):
    robots = Robots()
    full, other = robots.facts("humanoid100", RobotSettings()), robots.facts("small", RobotSettings())
    other = replace(other, shank_spacing=spacing, foot_width=0.01)
    width, room = step_width(0.2, full, other, nearer), 0.2 - full.shank_spacing - nearer
    assert 0.05 <= width <= step_width(0.2, full, other)
    kept = width - 0.25 * nearer - spacing
    assert kept >= 0.25 * min(CLEAR, room) - 1e-12
    assert width == 0.05 or kept == pytest.approx(0.25 * min(CLEAR, room))


@pytest.mark.parametrize(
    ("gait", "told", "nearer"),
    [
        ({}, False, 0.0),
        ({"lateral_step": -0.06}, False, 0.06),
        ({"velocity": [{"time": 0.0, "v_x": 0.3}, {"time": 2.0}]}, False, 0.0),
        ({"velocity": [{"time": 0.0, "v_y": 0.1}]}, False, math.inf),
        ({"velocity": [{"time": 0.0, "v_x": 0.3, "yaw_rate": 0.1}]}, False, math.inf),
        ({"turn": 0.1}, False, math.inf),
        ({"waypoints": [{"x": 1.0}]}, False, math.inf),
        ({"footsteps": [{"foot": "left"}]}, False, math.inf),
        ({}, True, math.inf),
        ({"lateral_step": "wide"}, False, math.inf),
        ({"velocity": 3}, False, 0.0),
    ],
)
def test_feet_may_land_anywhere_where_the_walk_turns_or_is_told(gait, told, nearer):
    assert nearer_landings(gait, told) == nearer


def test_treads_are_as_deep_as_soles_ask_for():
    robots = Robots()
    soles = RobotSettings(foot_length=0.2, foot_width=0.1)
    full, other = robots.facts("humanoid100", soles), robots.facts("small", RobotSettings())
    assert tread(0.3, full, replace(other, foot_length=0.04)) == 0.075
    assert tread(0.3, full, replace(other, foot_length=0.06)) == pytest.approx(0.085)
    stairs = load("stair-climbing", {"robot": "small"})
    assert stairs.gait.step_length == stairs.terrain.tread == pytest.approx(0.05 + 0.25 * (0.22 - 0.075))


def test_the_stance_of_the_reference_robot_is_as_written():
    facts = Robots().facts("humanoid100", RobotSettings())
    assert (facts.hip_width, facts.shank_spacing) == (HIPS, SHANKS)


def test_a_payload_is_no_size():
    options = RobotSettings(payload_mass=7.3)
    assert Robots().facts("humanoid100", options).size == Similarity()
    assert Robots().facts("small", RobotSettings(payload_mass=0.3)).size == QUARTER


@pytest.mark.parametrize("length", [0.1, 0.3, 0.62, 0.95, 1.3, 3.0])
def test_rates_divide_at_every_size(length):
    rates = clock(Rates(), Similarity(length).time)
    assert rates.physics % rates.control == 0 and rates.control % rates.planner == 0
    assert rates.planner * Similarity(length).time == pytest.approx(50.0)


@dataclass(frozen=True)
class Motors(Robots):
    """The robots, of which all but the reference stand on one foot with another share of their motors' torque."""

    share: float

    def one_foot_share(self, name, options):
        return 0.3 if name == "humanoid100" else self.share


@pytest.mark.parametrize(
    ("share", "bound"),
    [(0.3, 0.6), (0.2, 0.6), (0.4, 0.8), (0.6, 0.95), (math.inf, 0.6)],
    ids=["as strong", "stronger", "weaker", "hardly able", "unable"],
)
def test_a_weaker_robot_may_take_so_many_times_what_standing_on_one_foot_takes(share, bound):
    text = "sized_for: humanoid100\nrobot: small\ncriteria: {torque_ratio_max: {max: 0.6}, fell: false}"
    criteria = read_scenario(text, "f.yaml", "f", (), Motors(share)).criteria
    assert criteria["torque_ratio_max"].max == pytest.approx(bound)


def test_no_bound_on_torque_gets_stricter():
    text = "sized_for: humanoid100\nrobot: small\ncriteria: {torque_ratio_max: {max: 0.98}}"
    assert read_scenario(text, "f.yaml", "f", (), Motors(0.6)).criteria["torque_ratio_max"].max == 0.98


@pytest.mark.parametrize("name", ["torque_ratio_max", "foot_slip_max"])
def test_a_bound_in_a_list_of_one_is_that_bound(name):
    plain, listed = (
        read(f"sized_for: humanoid100\ncriteria: {{{name}: {{max: {limit}}}}}", "robot=small").criteria[name].max
        for limit in ("0.5", "[0.5]")
    )
    assert listed == (plain,)


def test_a_similar_robot_stands_with_the_same_share_of_its_torque():
    robots, options = Robots(), RobotSettings()
    share = robots.one_foot_share("humanoid100", options)
    assert robots.one_foot_share("small", options) == pytest.approx(share, rel=1e-3)
    assert 0.3 < share < 0.45
