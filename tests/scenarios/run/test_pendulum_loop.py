"""Fidelity pendulum: the same planner, log, metrics and verdict without a body."""

import numpy as np
import pytest

from surefoot.forces import Push
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.log import read
from surefoot.scenarios.run.pendulum import mean_force
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.show.differences import WALL_CLOCK

pytestmark = pytest.mark.unit

SHORT = (
    "sensing={}",
    "fidelity=pendulum",
    "gait.steps=2",
    "gait.single_support=0.8",
    "gait.initial_stand=0.2",
    "rates.control=100",
)


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """Run a short diagonal walk on the pendulum with further overrides."""

    def run(*overrides):
        scenario = load_scenario("diagonal-walk", (*SHORT, *overrides))
        return run_scenario(scenario, tmp_path_factory.mktemp("runs"))

    return run


@pytest.fixture(scope="module")
def plain(walk):
    return walk()


def test_passes_the_criteria_that_a_pendulum_has(plain):
    assert plain.verdict.passed
    assert "criterion torque_ratio_max is not asked: a pendulum has no such metric" in plain.verdict.notes
    assert plain.verdict.metrics["steps_taken"] == 2
    assert plain.verdict.metrics["zmp_inside_fraction"] == 1.0


def test_metrics_without_a_meaning_are_null_and_the_others_are_not(plain):
    null = {name for name, value in plain.verdict.metrics.items() if value is None}
    assert {"torque_ratio_max", "foot_slip_max", "knee_angle_mean", "wbc_time", "qp_failures"} <= null
    assert not null & {"fell", "cop_ratio_p99", "zmp_error_rms", "com_error_rms", "dcm_error_rms", "speed_mean"}


def test_a_criterion_of_the_body_alone_is_noted_not_missed(walk):
    verdict = walk("criteria={fell: false, knee_angle_mean: {max: 0.1}, wbc_time.p99: {max: 1}}").verdict
    assert verdict.passed
    assert [note.split()[1] for note in verdict.notes] == ["knee_angle_mean", "wbc_time.p99"]


def test_durations_off_the_planners_grid_are_walked_as_they_are(walk):
    odd = walk("gait.single_support=0.803", "gait.initial_stand=0.195")
    assert odd.verdict.passed
    assert not [note for note in odd.verdict.notes if "gait" in note]
    log = read(odd.log)
    phase, time = log["/reference"].field("phase"), log["/reference"].time
    lift_off = time[np.flatnonzero((phase[1:] == PhaseKind.SINGLE) & (phase[:-1] != PhaseKind.SINGLE)) + 1]
    period = load_scenario("diagonal-walk", SHORT).gait.double_support + 0.803
    assert np.diff(lift_off) == pytest.approx([period], abs=0.0201)


def test_the_mass_obeys_the_pendulum_and_its_zmp_the_soles(plain):
    """x'' = λ (x - p) between ticks, with λ = (g + z'') / z at the tick; and p never leaves the planned soles."""
    log = read(plain.log)
    com, zmp = log["/truth"].field("com"), log["/contact"].field("zmp")
    stiffness = (9.81 + log["/reference"].field("com_acceleration")[:, 2]) / com[:, 2]
    measured = np.diff(log["/truth"].field("com_velocity")[:, :2], axis=0) * 100
    expected = stiffness[:-1, None] * (com[:-1, :2] - zmp[1:, :2])
    np.testing.assert_allclose(measured, expected, atol=0.02)
    assert plain.verdict.metrics["cop_ratio_max"] <= 1.0


def test_a_strong_push_fells_it_when_it_comes_and_a_weak_one_does_not(walk):
    push = "pushes=[{{time: 1.3, duration: 0.1, force: [0, {}, 0]}}]"
    assert not walk(push.format(20)).verdict.metrics["fell"]
    felled = walk(push.format(2000)).verdict
    assert not felled.passed
    assert 1.3 < felled.metrics["fall_time"] < 2.5
    assert felled.reasons[0] == f"fell is true at {felled.metrics['fall_time']:.3f} s, must be false"


def test_a_frozen_plan_fells_it(walk):
    verdict = walk("faults=[{kind: planner_freeze, time: 0.6}]", "duration=6").verdict
    assert verdict.metrics["fell"]
    assert verdict.metrics["fall_time"] > 0.6


def test_not_a_number_ends_the_run_with_its_reason(walk):
    verdict = walk("faults=[{kind: state_nan, time: 1}]").verdict
    assert verdict.reasons[0] == "the run ended at 1.000000 s: the measured state is not finite at 1.000 s"


def test_the_same_run_gives_the_same_content(walk):
    first, second = (read(walk("start.position_noise=0.001", "seed=3").log) for _ in range(2))
    same = (topic for topic in first.topics if topic not in WALL_CLOCK)
    assert all(list(first.messages(topic)) == list(second.messages(topic)) for topic in same)
    other = read(walk("start.position_noise=0.001", "seed=4").log)
    assert first["/truth"].content() != other["/truth"].content()


def test_keys_without_effect_are_noted(walk):
    notes = walk("terrain.friction=0.02", "duration=1").verdict.notes
    assert "terrain.friction has no effect on a pendulum" in notes
    assert "duration 1 s ends before the gait does, which takes 3.8 s" in notes


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("faults=[{kind: torque_loss}]", "fault 'torque_loss' needs joints, which fidelity pendulum has not got; use"),
        ("pushes=[{time: 1, force: [0, 0, 9]}]", "a vertical push on a pendulum, whose height is prescribed; use"),
        ("pushes=[{time: 1, impulse: 0.1, elevation: 0.2}]", "an elevation of a push on a pendulum, whose height is"),
    ],
)
def test_what_would_test_nothing_is_refused(override, message):
    with pytest.raises(ScenarioError, match="^--set .*" + message.split(";")[0]):
        load_scenario("diagonal-walk", (*SHORT, override))


def test_impulses_are_exact_whatever_the_rate():
    push = (Push(0.0131, 0.0077, np.array([10.0, -4.0, 0.0])),)
    for rate in (50, 333, 500, 1000):
        impulse = sum(mean_force(push, tick / rate, 1 / rate) / rate for tick in range(rate))
        np.testing.assert_allclose(impulse, 0.0077 * push[0].force[:2], atol=1e-12)


def test_the_logged_swing_of_ideal_feet_is_where_they_are_though_they_cannot_roll(walk):
    log = read(walk("gait.heel_off=0.5").log)
    stance, swing = log["/reference"].field("stance"), log["/reference"].field("swing_position")
    for foot, name in enumerate(("left_sole", "right_sole")):
        error = (swing - log["/truth"].field(name)[:, :3])[stance == 1 - foot]
        assert np.abs(error).max() < 1e-3
    assert not log["/reference"].field("roll").any()
