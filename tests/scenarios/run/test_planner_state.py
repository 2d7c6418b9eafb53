"""Noise and filter of what the planner measures, and plants that are not what it believes, on the pendulum."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.planner.model.jerk import jerk_model
from surefoot.planner.types import CentroidalState
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.sensing import PlannerSensing, filter_noise
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=2", "gait.single_support=0.8", "gait.initial_stand=0.2", "rates.control=100")
NOISE = ("sensing.zmp_noise=0.01", "sensing.com_noise=0.002")


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    def run(*overrides):
        return run_scenario(load_scenario("diagonal-walk", (*SHORT, *overrides)), tmp_path_factory.mktemp("runs"))

    return run


@pytest.fixture(scope="module")
def noisy(walk):
    return walk(*NOISE)


def measured(scenario, count=4000):
    """Noise alone: deviations of a standing mass, shape (count, 3, 2) for ZMP, CoM and velocity."""
    sensing = PlannerSensing(resolve(scenario))
    still = CentroidalState(0.0, np.array([0.0, 0.0, 1.0]), np.zeros(3))
    states = [sensing.sense(still, np.zeros(2), None) for _ in range(count)]
    return np.array([(s.measured_zmp, s.measured.com[:2], s.measured.com_velocity[:2]) for s in states])


def scenario(seed=0, **sensing):
    return Scenario(seed=seed, sensing=sensing, planner={"filter": "none"})


def test_noise_has_its_deviation_is_clipped_and_unbiased():
    noise = measured(scenario(zmp_noise=0.01, com_noise=0.002))
    deviation = np.array([0.01, 0.002, 0.01])[:, None]
    clipped = np.sqrt(1.0 - 0.0795)  # of a Gaussian clipped at two standard deviations
    np.testing.assert_allclose(noise.std(axis=0) / deviation, clipped, rtol=0.03)
    assert (np.abs(noise).max(axis=0) == 2.0 * deviation).all()
    assert np.abs(noise.mean(axis=0) / deviation).max() < 0.05


def test_noise_follows_the_seed_and_each_sensor_has_its_own():
    both, zmp_only = scenario(zmp_noise=0.01, com_noise=0.002), scenario(zmp_noise=0.01)
    np.testing.assert_array_equal(measured(both, 5), measured(both, 5))
    np.testing.assert_array_equal(measured(both, 5)[:, 0], measured(zmp_only, 5)[:, 0])
    assert not measured(zmp_only, 5)[:, 1:].any()
    assert (measured(both, 5) != measured(scenario(1, zmp_noise=0.01, com_noise=0.002), 5)).all()


def test_noise_is_what_is_measured_less_what_is_true():
    """The first row of the stream of random numbers is the ZMP's, then come CoM and velocity."""
    state = CentroidalState(0.0, np.array([0.3, -0.2, 1.0]), np.array([0.1, 0.4, -0.1]))
    told = PlannerSensing(resolve(scenario(3, zmp_noise=0.01, com_noise=0.002))).sense(
        state, np.array([0.2, -0.1]), None
    )
    stream = np.random.default_rng(np.random.SeedSequence(3, spawn_key=(1,)))
    zmp, com, velocity = np.clip(stream.standard_normal((3, 2)), -2.0, 2.0)
    np.testing.assert_allclose(told.measured_zmp, np.array([0.2, -0.1]) + 0.01 * zmp)
    np.testing.assert_allclose(told.measured.com, state.com + 0.002 * np.append(com, 0.0))
    np.testing.assert_allclose(told.measured.com_velocity, state.com_velocity + 0.01 * np.append(velocity, 0.0))


@pytest.mark.parametrize("made", [0.0, 2.0])
def test_a_mass_that_does_what_was_planned_leaves_the_filter_no_innovation(made):
    """From a plan made at any time, while it is followed for longer than it looks ahead, and with legs that swing."""
    walk, T, count = resolve(Scenario(planner={"filter": "kalman"})), 0.02, 3
    sensing = PlannerSensing(walk)
    rng, (transition, drive) = np.random.default_rng(2), jerk_model(T)
    plan = SimpleNamespace(
        time=made, sample_time=T, jerk=rng.normal(size=(count, 2)), stiffness=rng.uniform(8.0, 12.0, count + 1),
        zmp_offset=0.05 * rng.normal(size=(count + 1, 2)),
    )  # fmt: skip
    motion = np.zeros((3, 2))
    motion[0] = walk.ground.stance.position[:, :2].mean(axis=0)
    for tick in range(6):
        done = min(tick, count)
        zmp = motion[0] - motion[2] / plan.stiffness[done] + (plan.zmp_offset[done] if tick else 0.0)
        state = CentroidalState(made + T * tick, np.append(motion[0], 1.0), np.append(motion[1], 0.0))
        told = sensing.sense(state, zmp, plan if tick else None)
        np.testing.assert_allclose(told.innovation, 0.0, atol=1e-12)
        np.testing.assert_allclose(told.acceleration, motion[2], atol=1e-9)
        motion = transition @ motion + np.outer(drive, plan.jerk[tick] if tick < count else np.zeros(2))


def test_heights_count_from_the_ground_on_which_the_robot_stands():
    """At the first measurement, which no plan precedes: raised with its ground, a mass is as unstable as before."""
    estimates = []
    for terrain in ({"kind": "flat"}, {"kind": "blocks", "riser": 0.05}):
        walk = resolve(Scenario(planner={"filter": "kalman"}, terrain=terrain))
        state = CentroidalState(0.0, np.array([0.02, 0.01, 0.9 + walk.ground.start_height]), np.zeros(3))
        estimates.append(PlannerSensing(walk).sense(state, np.array([0.01, 0.03]), None).acceleration)
    assert walk.ground.start_height > 0.05
    assert np.abs(estimates[0]).max() > 1e-3
    np.testing.assert_allclose(*estimates, rtol=1e-6)


def test_a_filter_is_used_when_there_is_noise_or_when_asked_for():
    assert resolve(Scenario()).filter == "none"
    assert resolve(Scenario(sensing={"zmp_noise": 0.01})).filter == "kalman"
    assert resolve(Scenario(sensing={"com_noise": 0.01}, planner={"filter": "none"})).filter == "none"
    assert resolve(Scenario(planner={"filter": "zmp_only"})).filter == "zmp_only"
    noise = filter_noise(Scenario(sensing={"com_noise": 0.004}).sensing)
    assert (noise.zmp, noise.com, noise.com_velocity) == (0.01, 0.004, 0.02)


def test_a_noisy_walk_is_walked_and_the_filter_halves_the_error(noisy, walk):
    raw = walk(*NOISE, "planner.filter=none").verdict.metrics
    found = noisy.verdict.metrics
    assert not found["fell"]
    assert found["steps_taken"] == 2
    assert found["zmp_inside_fraction"] == 1.0
    assert max(found["dcm_estimation_error_rms"]) < 0.002 < 0.6 * min(raw["dcm_estimation_error_rms"])
    assert found["estimation_error_rms"] < 0.5 * raw["estimation_error_rms"]
    assert max(found["zmp_error_rms"]) < 0.5 * max(raw["zmp_error_rms"])


def test_what_the_planner_was_given_is_where_its_plan_begins(noisy):
    log = read(noisy.log)
    given = log["/planner_state"].field("com")[:, :2]
    np.testing.assert_allclose(log["/plan"].field("com")[:, 0, :2], given, atol=1e-12)
    error = log["/planner_state"].field("measured_com")[:, 2] - log["/planner_state"].field("com")[:, 2]
    assert not error.any()


def test_without_noise_the_planner_is_given_the_truth(walk):
    found = walk("planner.filter=kalman", "duration=2").verdict.metrics
    assert found["estimation_error_rms"] < 1e-4
    log = read(walk("duration=1").log)
    state, rows = log["/planner_state"], slice(None, None, 2)
    np.testing.assert_array_equal(state.field("com"), log["/truth"].field("com")[rows])
    np.testing.assert_array_equal(state.field("measured_com"), state.field("com"))
    assert np.isnan(state.field("innovation")).all()


def test_the_paper_s_filter_falls_on_the_true_pendulum_and_walks_on_the_cart_table(walk):
    paper = (*NOISE, "planner.filter=zmp_only")
    assert walk(*paper, "pendulum.feedback=0").verdict.metrics["fell"]
    assert not walk(*NOISE, "pendulum.feedback=0").verdict.metrics["fell"]
    cart = walk(*paper, "pendulum.plant=cart_table").verdict.metrics
    assert not cart["fell"]
    assert cart["zmp_inside_fraction"] > 0.97
    assert max(cart["dcm_estimation_error_rms"]) < 0.015


def test_a_frozen_planner_goes_on_measuring(walk):
    log = read(walk(*NOISE, "faults=[{kind: planner_freeze, time: 0.5, duration: 0.2}]", "duration=1.5").log)
    assert len(log["/plan"]) == len(log["/planner_state"]) - 10
    error = log["/planner_state"].field("com")[:, :2] - log["/truth"].field("com")[::2, :2]
    assert np.abs(error).max() < 0.005


@pytest.mark.parametrize("plant", ["pendulum", "cart_table"])
@pytest.mark.parametrize("error", [-0.2, 0.2])
def test_the_stiffness_is_that_of_the_true_height(walk, plant, error):
    """x'' = λ (x - p) with λ = (g + z'') / z of the true height, which is the believed one less the error."""
    result = walk(f"errors.com_height={error}", f"pendulum.plant={plant}")
    assert not result.verdict.metrics["fell"]
    log = read(result.log)
    com, zmp = log["/truth"].field("com"), log["/contact"].field("zmp")
    np.testing.assert_allclose(com[:, 2], log["/planner_state"].field("com")[:, 2].repeat(2) - error, atol=1e-3)
    stiffness = (9.81 + log["/reference"].field("com_acceleration")[:, 2]) / com[:, 2]
    velocity = log["/truth"].field("com_velocity")[:, :2]
    if plant == "pendulum":  # its ZMP is constant in the tick before, the cart's is that of its end
        found, expected = np.diff(velocity, axis=0) * 100, stiffness[:-1, None] * (com[:-1, :2] - zmp[1:, :2])
    else:
        found, expected = (velocity[2:] - velocity[:-2]) * 50, (stiffness[:, None] * (com[:, :2] - zmp[:, :2]))[1:-1]
    np.testing.assert_allclose(found, expected, atol=0.04)
    wrong = expected * (com[:, 2] / (com[:, 2] + error))[1 : 1 + len(expected), None]
    assert np.abs(found - wrong).max() > 0.1


def test_a_cart_table_cannot_fall_only_leave_the_polygon(walk):
    push = "pushes=[{time: 1.3, duration: 0.1, force: [0, 2000, 0]}]"
    found = walk(push, "pendulum.plant=cart_table").verdict.metrics
    assert not found["fell"]
    assert found["zmp_inside_fraction"] < 0.9
    assert walk(push).verdict.metrics["fell"]


@pytest.mark.parametrize("plant", ["pendulum", "cart_table"])
def test_the_paper_s_push_is_its_impulse_over_the_true_mass(walk, plant):
    """At 500 Hz 75 N for 10 ms, before the loop can answer it: a difference of velocity of 0.75 N s / m."""
    options = ("rates.control=500", "duration=0.7", f"pendulum.plant={plant}", "pendulum.feedback=0")
    push = "pushes=[{time: 0.604, duration: 0.01, force: [75, -75, 0]}]"
    pushed, plain = (read(walk(*options, "errors.mass_scale=1.25", *more).log) for more in ((push,), ()))
    change = pushed["/truth"].field("com_velocity")[307] - plain["/truth"].field("com_velocity")[307]
    np.testing.assert_allclose(change, [0.75 / 80.0, -0.75 / 80.0, 0.0], rtol=1e-3, atol=1e-12)
    np.testing.assert_allclose(
        pushed["/truth"].field("external_force").sum(axis=0) / 500, [0.75, -0.75, 0.0], atol=1e-12
    )


def test_keys_without_effect_are_noted(walk):
    assert "errors.friction has no effect on a pendulum" in walk("errors.friction=0.2", "duration=1").verdict.notes


def test_a_truth_below_half_the_belief_is_refused():
    with pytest.raises(ScenarioError, match=r"errors.com_height 0.4 m leaves 0.3 m of gait.com_height 0.7 m"):
        load_scenario("diagonal-walk", (*SHORT, "gait.com_height=0.7", "errors.com_height=0.4"))
