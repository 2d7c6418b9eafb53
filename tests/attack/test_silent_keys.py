"""A key that is set acts, is refused, fails, or is told in a note; none leaves the run as it was without a word."""

import pytest
from experiment import BASES, BODIES, Experiment, keys, trials, values_of

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.registries import INSTRUMENTS
from surefoot.scenarios.file.schema import Scenario, TerrainSettings, own_models
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.load import load, read_scenario

WITHOUT_OCCASION = {
    "seed": "nothing is random in the base",
    "gait.velocity.0.time": "the walk begins when it may, by whichever command is in force then",
    "planner.jerk_limit": "a bound, which the motion may stay within",
    "planner.jerk_rate_limit": "a bound, which the motion may stay within",
    "planner.step_weight": "weighs shifts of footsteps, which there are when the robot is pushed",
    "planner.step_adaptation": "acts when the robot is pushed",
    "planner.profile": "two of them agree on a robot that stands at a constant height",
    "planner.rise": "one of its values is what null means",
    "planner.filter": "one of its values is what null means",
    "sensing.force_estimate": "acts when a force lasts or a weight is not as believed",
    "terrain.friction": "a bound of the contact forces, which they may stay within",
    "wbc.friction": "a bound of the contact forces as it is believed",
    "errors.friction": "a bound of the contact forces, which they may stay within",
    "sensing.gyro_range": "a bound of what is read, which it may stay within",
    "sensing.accelerometer_range": "a bound of what is read, which it may stay within",
    "motors.torque_speed": "a bound of the torques, which they may stay within",
    "planner.without": "leaves out what acts when a push asks for it",
    **dict.fromkeys((key for key in keys() if key.startswith("planner.recovery.")), "acts when a push asks for it"),
    "wbc.second_solver": "acts when the first one fails",
    "control.give_way": "acts when the robot falls",
    "log.keep": "a run that is no longer is held whole",
    "log.rate": "bounds what no metric reads, none of which is in a digest of what is measured",
    "wbc.weights.swing": "acts on a foot that swings",
    "wbc.gains.swing": "acts on a foot that swings",
    "wbc.contact.softening": "acts on a foot that has landed",
    "wbc.contact.sinking": "acts on a foot that has landed",
    "wbc.contact.striking": "acts on a foot that lands on its heel",
    "wbc.contact.striking_damping": "acts on a foot that lands on its heel",
    "requirements": "named in reports of checks",
    **dict.fromkeys((key for key in keys() if key.endswith("_catching")), "acts while a step catches the body"),
    **dict.fromkeys(
        (f"wbc.schedule.{name}" for name in ("felt_force", "felt_ticks", "early_progress", "early_cap")),
        "a threshold, which contacts may stay clear of",
    ),
    **dict.fromkeys(
        (f"wbc.schedule.{name}" for name in ("loading_time", "unloading_time", "share_margin")),
        "acts when feet change their load",
    ),
    **dict.fromkeys(
        (f"wbc.separation.{name}" for name in ("clearance", "attention", "horizon", "slots")),
        "acts when limbs come near each other",
    ),
}
"""Keys that may do nothing without a word, and why: what they ask for is true of the run as it is."""

UNFELT = {
    key: group
    for group, field in Scenario.model_fields.items()
    for key in keys()
    if key.startswith(f"{group}.") and any("pendulum" in getattr(mark, "by", ()) for mark in field.metadata)
}
"""Keys of groups that have no effect on a pendulum, which one note says of all keys of a group."""

FIRST = {next(key for key, of in UNFELT.items() if of == group) for group in UNFELT.values()}
"""One key of each of these groups."""

NOTHING = {
    **dict.fromkeys(("gait.lateral_step", "gait.turn", "start.x", "start.y", "start.yaw"), 1e-300),
    **dict.fromkeys(
        ("errors.link_mass_noise", "errors.ground_noise", "errors.ground_pitch", "errors.ground_roll"), 0.0
    ),
    "errors.torso_mass": 1.0,
    "errors.torso_com": [0, 0, 0],
    "wbc.tasks": [],
    "plant.name": "mujoco",
}
"""Keys of which this value asks for nothing: a place that is where 0 is, no error, no task, the plant there is."""


ROLLS = {
    "speed": dict.fromkeys(("gait.heel_off", "gait.heel_strike"), "a pendulum's feet roll, however far they pitch")
}
"""Keys that may do nothing in one base, and why."""


@pytest.fixture(scope="module")
def experiments(tmp_path_factory):
    made: dict[str, Experiment] = {}

    def of(name):
        if name not in made:
            made[name] = Experiment({**BASES, **BODIES}[name], tmp_path_factory.mktemp(name))
        return made[name]

    return of


@pytest.mark.unit
@pytest.mark.parametrize(
    ("base", "key", "value", "outcome"),
    [
        ("walk-level", "gait.step_length", 0.21, "felt"),
        ("walk-level", "gait.heel_off", 0.2, "felt"),
        ("walk-level", "gait.heel_strike", 0.2, "felt"),
        ("stairs", "gait.heel_strike", 0.2, "noted"),
        ("walk-level", "gait.pelvis_yaw", 0.05, "noted"),
        ("walk-level", "gait.pelvis_list", 0.03, "noted"),
        ("speed", "gait.pelvis_yaw", 0.05, "noted"),
        ("speed", "gait.pelvis_list", 0.03, "noted"),
        ("speed", "gait.step_length", 0.21, "felt"),
        ("walk-level", "rates.physics", 2000, "noted"),
        ("walk-level", "planner.rise", "single", "noted"),
        ("walk-level", "robot_options.payload_body", "pelvis", "noted"),
        ("walk-level", "errors.payload", {"mass": 0.0}, "noted"),
        ("walk-level", "errors.com_height", 1e-300, "refused"),
        ("walk-level", "pushes", [{"time": 0.5, "force": [1e-300, 0, 0]}], "refused"),
        ("walk-level", "commands", [{"time": 2.4, "swing_height": 0.07}], "failed"),
        ("stand", "gait.swing_height", 0.06, "noted"),
        ("stand", "motors.delay", 0.002, "noted"),
        ("stand", "control.give_way", False, "noted"),
        ("stand", "plant.options", {"refined": 2}, "noted"),
        ("stand", "wbc.weights.swing", 3.0, "noted"),
        ("stand", "instruments", [{"name": "altimeter"}], "noted"),
        ("stand", "errors.payload.mass", 2.0, "felt"),
        ("body-stand", "sensing.options", {"covariance_rate": 20.0}, "refused"),
        ("body-stand", "instruments", [{"name": "altimeter"}], "felt"),
        ("stand", "gait.single_support", 0.5, "noted"),
        ("stand", "gait.ramp", 1, "noted"),
        ("stand", "planner.knee", "straight", "noted"),
        ("paper", "planner.knee", "straight", "noted"),
        ("body-stand", "wbc.knees", {"flexion": 0.3}, "noted"),
        ("body-stand", "wbc.knees.weight", 0.01, "felt"),
        ("stand", "commands", [{"time": 0.3, "single_support": 0.5}], "failed"),
    ],
)
def test_a_key_that_is_set_is_never_silent(experiments, base, key, value, outcome):
    assert experiments(base).outcome(key, value) == outcome


UNTRIED = {
    "name": "of the log",
    **({} if len(INSTRUMENTS) > 1 else {"instruments.0.name": "there is one instrument"}),
    "pushes.0.live": "says of whom a push came",
    "commands.0.live": "says of whom a command came",
    **dict.fromkeys(("criteria.min", "criteria.max", "criteria.equals"), "of a metric, by its name"),
    **dict.fromkeys(
        (key for key in keys() if key.startswith(("seeds", "margins."))), "of other runs in `surefoot check`"
    ),
}
"""Keys that no base can be given anew, and why."""


@pytest.mark.unit
def test_every_key_is_tried_in_some_base():
    """Also one of a group that is null by default, and one that is null itself."""
    scenarios = [read_scenario(text, "f.yaml", "f") for text in {**BASES, **BODIES}.values()]
    tried = {key for scenario in scenarios for key, _ in trials(scenario)}
    named = {scenario.terrain.kind for scenario in scenarios}
    elsewhere = {
        f"terrain.{name}"
        for kind, model in own_models(TerrainSettings)
        if kind not in named
        for name in model.model_fields.keys() - TerrainSettings.model_fields.keys()
    }
    assert set(keys()) - tried == set(UNTRIED) | elsewhere
    in_a_null_group = {key for key, _ in trials(scenarios[0])}
    assert {"motors.delay", "control.output", "errors.payload.mass", "planner.recovery.clear"} <= in_a_null_group


@pytest.mark.unit
def test_what_is_excused_is_a_key():
    assert {*WITHOUT_OCCASION, *NOTHING, *ROLLS["speed"]} <= set(keys())
    assert all(value in values_of(key, None) for key, value in NOTHING.items())


@pytest.mark.unit
@pytest.mark.parametrize("base", [*BASES, *BODIES])
def test_each_base_is_accepted(base):
    with Simulation(read_scenario({**BASES, **BODIES}[base], "f.yaml", base)) as sim:
        assert not sim.done


@pytest.mark.long
@pytest.mark.parametrize("base", [*BASES, *BODIES])
def test_no_key_of_the_schema_is_silent(experiments, base):
    experiment, point = experiments(base), base in BASES
    silent, seen = [], 0
    for key, value in experiment.trials():
        elsewhere = point and key in UNFELT and key not in FIRST
        if key in {**WITHOUT_OCCASION, **ROLLS.get(base, {})} or NOTHING.get(key) == value or elsewhere:
            continue
        seen += 1
        if experiment.outcome(key, value) == "silent":
            silent.append((key, value))
    assert seen > 20
    assert silent == []


@pytest.mark.physics
def test_numbers_of_catching_are_felt_where_a_step_catches_the_body(experiments):
    experiment = experiments("body-caught")
    trials = [(key, value) for key, value in experiment.trials() if key.endswith("_catching")]
    assert len(trials) >= 5
    assert {experiment.outcome(key, value) for key, value in trials} == {"felt"}


PUSH = "pushes=[{time: 2.9, force: [10, 0, 0], duration: %s}]"


@pytest.mark.unit
@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (
            [PUSH % 0.2],
            "pushes.0 would last until 3.1 s, and the end of the run at 3 s cuts it off; give it at most 0.1 s",
        ),
        (["faults=[{kind: planner_freeze, time: 1, duration: 9}]"], "faults.0 would last until 10 s"),
        (["pushes=[{time: 1, impulse: 1.0e-12}]"], "makes an impulse of 1e-12 N·s/kg"),
        (["commands=[{time: 2.99, swing_height: 0.06}]"], "no plan comes before the end at 3 s"),
        (
            ["commands=[{time: 1.001, v_x: 0.1}, {time: 1.01, v_x: 0.2}]"],
            "commands.0.v_x never acts: commands.1 supersedes it before the plan at 1.02 s",
        ),
        (["gait.waypoints=[{x: 0.001, y: 0}]"], "gait.waypoints.0 is where the robot starts"),
        (["gait.waypoints=[{x: 1, y: 0}, {x: 1, y: 0}]"], "gait.waypoints.1 is where gait.waypoints.0 is"),
        (
            ["terrain.kind=slope", "terrain.angle=0.05", "terrain.start=9.05", "gait.com_height=0.9"],
            "none of 20 footsteps comes to the slope",
        ),
        (["errors.ground=[{x: 1, length: 1, height: 1.0e-12}]"], "errors.ground.0.height 1e-12 is too small"),
    ],
)
def test_what_would_never_act_is_refused(settings, words):
    with pytest.raises(ScenarioError) as refused:
        load("walk-level", ["fidelity=pendulum", "criteria={fell: false}", "duration=3", *settings])
    assert words in "\n".join(refused.value.problems)


@pytest.mark.unit
def test_what_was_given_by_hand_need_not_act():
    given = [
        "pushes=[{time: 2.9, force: [10, 0, 0], duration: 0.2, live: true}]",
        "commands=[{time: 1.001, v_x: 0.1, live: true}, {time: 1.01, v_x: 0.2, live: true},"
        " {time: 2.99, v_x: 0, live: true}]",
    ]
    load("walk-level", ["fidelity=pendulum", "criteria={fell: false}", "duration=3", *given])
