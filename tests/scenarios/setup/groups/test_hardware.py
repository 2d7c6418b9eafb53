"""Sensors and motors of a scenario: presets, keys that replace their terms, and keys that cannot act."""

import pytest
import yaml

from surefoot.scenarios.catalogue import CONTROLS, OWN
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.sensing import SENSOR_KEYS, MotorSettings, Sensing
from surefoot.scenarios.setup.groups.hardware import Hardware, hardware_problems, sensor_errors
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim.drives import IDEAL, DriveErrors
from surefoot.sim.sensor_errors import CHEAP, GOOD, PERFECT, Delivery, SensorErrors
from surefoot.similarity import REFERENCE_SIZE, Similarity

pytestmark = pytest.mark.unit

ALIVE = "criteria={fell: false}"


def sensing(**keys):
    """Keys of an estimator that reads sensors."""
    checked = Sensing(**keys)
    return checked.model_copy(update={"source": "some estimator"})


def told(keys, motors=None):
    return [str(problem) for problem in hardware_problems(keys, motors, 1000)]


@pytest.mark.parametrize(
    ("preset", "errors"), [(None, PERFECT), ("perfect", PERFECT), ("good", GOOD), ("cheap", CHEAP)]
)
def test_a_preset_sets_every_term(preset, errors):
    assert sensor_errors(sensing(preset=preset), REFERENCE_SIZE) == errors


def test_a_key_replaces_its_term_alone():
    found = sensor_errors(sensing(preset="good", gyro_bias=0.5, encoder_bits=10, encoder_noise=0.0), REFERENCE_SIZE)
    assert (found.gyro_bias, found.encoder_bits, found.encoder_noise) == (0.5, 10, 0.0)
    same = set(SensorErrors.__slots__) - {"gyro_bias", "encoder_bits", "encoder_noise"}
    assert [name for name in same if getattr(found, name) != getattr(GOOD, name)] == []


def test_every_sensor_key_changes_what_sensors_do():
    """The preset is cheap, whose every term is set."""
    others = {"preset": "good", "wrench": "none", "encoder_velocity": True, "encoder_bits": 12}
    for name in SENSOR_KEYS:
        base = {"preset": "cheap"} | ({"encoder_velocity": True} if name == "encoder_velocity_noise" else {})
        changed = base | {name: others.get(name, 0.125)}
        assert sensor_errors(sensing(**changed), REFERENCE_SIZE) != sensor_errors(sensing(**base), REFERENCE_SIZE), name


def test_each_group_comes_as_its_own_keys_say_else_as_those_of_all_else_as_the_preset():
    keys = sensing(preset="cheap", latency=0.01, imu_latency=0.0, wrench_jitter=0.003, jitter=0.001)
    found = sensor_errors(keys, REFERENCE_SIZE)
    assert found.joints == Delivery(0.01, 0.001, CHEAP.joints.dropout)
    assert found.imu == Delivery(0.0, 0.001, CHEAP.imu.dropout)
    assert found.feet == Delivery(0.01, 0.003, CHEAP.feet.dropout)


def test_presets_go_with_the_robot_and_what_is_set_is_meant_as_it_is():
    small = Similarity(length=0.7, mass=0.33)
    found = sensor_errors(sensing(preset="good", wrench_bias=7.0), small)
    assert found.wrench_noise == pytest.approx(GOOD.wrench_noise * small.factor("N"))
    assert (found.wrench_bias, found.gyro_density) == (7.0, GOOD.gyro_density)


def test_no_sensor_key_acts_beside_the_truth():
    for name in (name for name in SENSOR_KEYS if name != "preset"):
        value = {"wrench": "none", "encoder_velocity": False, "encoder_bits": 12}.get(name, 0.01)
        with pytest.raises(ScenarioError) as refused:
            load("paper-push", {f"sensing.{name}": value})
        assert f"sensing.{name} {value} beside sensing.source truth, which reads no sensor" in str(refused.value)


@pytest.mark.parametrize(
    ("keys", "source"),
    [
        ("{}", "truth"),
        ("{preset: good}", "ekf"),
        ("{preset: null}", "truth"),
        ("{preset: cheap, source: truth}", "truth"),
        ("{source: ekf}", "ekf"),
    ],
)
def test_a_preset_is_read_by_the_own_estimator_unless_a_source_is_named(keys, source):
    scenario = read_scenario(f"sensing: {keys}\n{ALIVE.replace('=', ': ')}\n", "f.yaml", "f")
    assert scenario.sensing.source == source
    # As the log has it, it is said in full, and says the same again.
    assert read_scenario(resolve(scenario).text, "log", "f").sensing == scenario.sensing


def test_the_catalogue_walks_from_good_sensors_and_goes_back_to_the_truth_by_one_key():
    from surefoot.scenarios.setup.checks.notes import notes

    sensed = {name: load(name).sensing for name in OWN}
    # Those of the paper have noise and filter of its own.
    assert {name for name, found in sensed.items() if found.source == "truth"} == {"paper-noise", "paper-push"}
    assert {found.preset for found in sensed.values()} == {"good", None}
    assert {name for name in CONTROLS if load(name).sensing.source != "truth"} == {"control-sensors"}
    blind = resolve(load("walk-level", {"sensing.source": "truth"}))
    assert "sensing.preset has no effect beside sensing.source truth, which reads no sensor" in notes(blind)
    assert load("walk-level", {"sensing.preset": None}).sensing.source == "truth"


def test_a_pendulum_has_no_sensors_and_one_note_tells_it():
    from surefoot.scenarios.setup.checks.notes import notes

    told = [note for note in notes(resolve(load("walk-level", {"fidelity": "pendulum"}))) if "sensing" in note]
    assert told == ["sensing.preset has no effect on a pendulum"]
    alone = resolve(load("paper-walk", {"fidelity": "pendulum", "sensing": {"source": "ekf"}}))
    assert "sensing.source has no effect on a pendulum" in notes(alone)


def test_zeros_of_earlier_logs_are_taken():
    """Their scenarios have every key that was not null with its default."""
    kept = ("encoder_noise", "gyro_noise", "accelerometer_noise", "wrench_noise", "latency")
    scenario = load("walk-level", {"sensing": dict.fromkeys(kept, 0.0)})
    assert resolve(scenario).hardware == Hardware(PERFECT, IDEAL)
    with pytest.raises(ScenarioError):
        load("walk-level", {"sensing": {"gyro_bias": 0.0}})


def test_scenarios_without_these_keys_say_nothing_of_them():
    written = yaml.safe_load(resolve(load("walk-level", {"sensing": {}})).text)
    assert set(written["sensing"]) == {"source", "zmp_noise", "com_noise", "force_estimate"}
    assert "motors" not in written
    assert not {"torso_mass", "ground_pitch", "ground_roll"} & set(written["errors"])


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"wrench": "none", "wrench_noise": 1.0}, "sensing.wrench_noise of feet that have no force sensors"),
        ({"wrench": "none", "moment_bias": 1.0}, "sensing.moment_bias of feet that have no force sensors"),
        ({"wrench": "none", "wrench_latency": 0.01}, "sensing.wrench_latency of feet that have no force sensors"),
        ({"preset": "good", "encoder_velocity_noise": 1.0}, "of encoders that say no velocity"),
        ({"encoder_velocity": False, "encoder_velocity_noise": 1.0}, "of encoders that say no velocity"),
    ],
)
def test_keys_of_sensors_that_are_not_there_are_refused(keys, words):
    (problem,) = told(sensing(**keys))
    assert words in problem


def test_sound_keys_are_taken():
    assert told(sensing(preset="cheap", wrench="none", encoder_velocity=True, encoder_velocity_noise=0.1)) == []


@pytest.mark.parametrize(
    "wrong",
    [
        *("sensing: {preset: best}", "sensing: {encoder_bits: 12.5}", "sensing: {dropout: 1}"),
        *("sensing: {gyro_range: 0}", "sensing: {wrench: hands}", "motors: {damping: -1}"),
        *("motors: {torque_speed: 1}", "motors: {delay: 3 m}", "errors: {ground_pitch: 10 deg}"),
        "errors: {torso_mass: 3}",
    ],
)
def test_impossible_values_are_refused(wrong):
    with pytest.raises(ScenarioError):
        read_scenario(f"{wrong}\n", "f.yaml", "f")


def test_motors_act_with_the_truth_and_nobody_believes_in_them():
    keys = {"motors.damping": 2.0, "motors.friction_loss": 1.5, "motors.delay": "4 ms", "motors.noise": 0.5}
    walk = resolve(load("walk-level", {**keys, "motors.torque_speed": 0.4}))
    assert walk.hardware.drives == DriveErrors(delay=0.004, noise=0.5, torque_speed=0.4)
    assert 'damping="2.0" frictionloss="1.5"' in walk.true_robot.mjcf
    assert "frictionloss" not in walk.robot.mjcf


def test_motors_that_only_wait_leave_the_robot_as_it_is():
    walk = resolve(load("walk-level", {"motors.delay": 0.002}))
    assert walk.true_robot is walk.robot


def test_a_delay_of_less_than_half_a_step_of_the_physics_is_refused():
    (problem,) = told(Sensing(), MotorSettings(delay=4e-4))
    assert "motors.delay 0.0004 s is less than half a step of the physics" in problem
    assert told(Sensing(), MotorSettings(delay=6e-4)) == []


@pytest.mark.parametrize("key", ["motors.noise", "errors.ground_pitch"])
def test_sizes_that_change_nothing_are_refused(key):
    with pytest.raises(ScenarioError, match=f"{key} 1e-300 is too small to change anything"):
        load("walk-level", {key: 1e-300})


def test_motors_of_a_pendulum_are_told_to_have_no_effect():
    from surefoot.scenarios.setup.checks.notes import notes

    walk = resolve(load("walk-level", {"fidelity": "pendulum", "criteria": {"fell": False}, "motors.damping": 1.0}))
    assert "motors has no effect on a pendulum" in notes(walk)


def test_numbers_of_motors_of_a_file_are_for_the_robot_that_it_is_sized_for():
    text = "name: f\nsized_for: humanoid100\nmotors: {damping: 2, friction_loss: 1}\ncriteria: {fell: false}\n"
    motors = read_scenario(text, "f.yaml", "f", {"robot": "g1"}).motors
    assert motors.friction_loss == pytest.approx(0.33 * 0.72, rel=0.15)
    assert 0.1 < motors.damping < 0.6
