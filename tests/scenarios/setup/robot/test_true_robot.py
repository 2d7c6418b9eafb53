"""The robot as it is, and the friction as believed: what of a scenario changes which."""

import numpy as np
import pytest

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit

ALIVE = "criteria={fell: false}"
POINT = ("fidelity=pendulum", "duration=0.1", ALIVE)


def walk(*settings):
    return resolve(load("walk-level", [ALIVE, *settings]))


@pytest.mark.parametrize(
    "nothing",
    [
        *("errors.link_mass_noise=0", "errors.torso_com=[0, 0, 0]", "errors.payload={mass: 0, body: pelvis}", "wbc={}"),
        *("errors.torso_mass=1", "motors={}", "motors={delay: 0.002}"),
    ],
)
def test_no_error_leaves_the_robot_that_is_believed_in(nothing):
    found = walk(nothing)
    assert found.true_robot is found.robot
    assert (found.true_mass, found.friction) == (100.0, 0.8)


def test_errors_left_null_are_not_in_the_text_of_a_log():
    text = walk().text
    assert not [name for name in ("link_mass_noise", "torso_com", "payload:", "ground", "impulse") if name in text]


def test_belief_is_the_robot_as_described_whatever_it_is():
    plain = walk()
    found = walk("errors.link_mass_noise=0.2", "errors.torso_com=[0.03, 0, 0]", "errors.payload={mass: 7}")
    assert found.robot.mjcf == plain.robot.mjcf != found.true_robot.mjcf


def test_masses_are_those_of_the_seed():
    one, same, other = (walk("errors.link_mass_noise=0.2", f"seed={seed}") for seed in (1, 1, 2))
    assert one.true_robot.mjcf == same.true_robot.mjcf != other.true_robot.mjcf
    assert 80.0 < one.true_mass < 120.0
    assert one.true_mass != other.true_mass


def test_the_torsos_com_is_believed_farther_by_the_error():
    """Belief minus truth."""
    found = walk("errors.torso_com=[0.03, 0.01, -0.02]")

    def torso(text):
        inertial = text.split('<body name="torso"')[1].split("<inertial")[1]
        return np.array([float(value) for value in inertial.split('pos="')[1].split('"')[0].split()])

    np.testing.assert_allclose(torso(found.robot.mjcf) - torso(found.true_robot.mjcf), [0.03, 0.01, -0.02], atol=1e-15)


def test_a_hidden_load_is_as_heavy_as_it_says_beside_other_errors_and_a_known_one():
    settings = ("robot_options.payload_mass=10", "errors.mass_scale=1.1", "errors.payload={mass: 6, body: pelvis}")
    assert walk(*settings).true_mass == pytest.approx(110.0 / 1.1 + 6.0)
    assert walk("errors.mass_scale=1.1").true_mass == 100.0 / 1.1


@pytest.mark.parametrize(("setting", "mass"), [("errors.payload={mass: 6}", 106.0), ("errors.mass_scale=1.25", 80.0)])
def test_the_pendulum_has_the_true_mass(setting, mass, tmp_path):
    truth = run_scenario(load("walk-level", [setting, *POINT]), tmp_path).log
    assert read(truth)["/contact"].field("normal_force").sum(axis=1)[0] == pytest.approx(9.81 * mass)


def test_what_a_pendulum_does_not_feel_is_told():
    settings = ("sensing={}", "errors.torso_com=[0.01, 0, 0]", "errors.link_mass_noise=0.1", "errors.payload={mass: 6}")
    told = [note for note in notes(Walk(load("walk-level", [*settings, *POINT]))) if "no effect" in note]
    assert told == ["errors.torso_com has no effect on a pendulum"]


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("errors.payload={mass: 5, body: torzo}", "unknown body 'torzo' of humanoid100; did you mean 'torso'"),
        ("errors.link_mass_noise=0.6", "at most 0.5"),
        ("errors.torso_com=[0, 0, 1]", "at most 0.5"),
        ("wbc={friction: 0.01}", "at least 0.05"),
    ],
)
def test_impossible_errors_are_refused_with_their_place(setting, words):
    with pytest.raises(ScenarioError, match=words) as refused:
        walk(setting)
    assert f"--set {setting.split('=')[0]}" in str(refused.value)


def test_a_controller_counts_on_the_friction_that_it_is_given_whatever_the_ground_has():
    for friction in (0.4, 1.2):
        found = walk("wbc.friction=0.7", f"terrain.friction={friction}")
        assert (found.friction, found.ground.true_terrain.friction) == (0.7, friction)
    relative = walk("terrain.friction=0.5", "errors.friction=0.3")
    assert relative.friction == pytest.approx(0.8)
    with pytest.raises(ScenarioError, match=r"a believed friction beside errors\.friction; give one of them"):
        walk("wbc.friction=0.7", "errors.friction=0.1")


def test_the_torso_is_believed_to_be_heavier_by_the_factor():
    """Belief over truth, of its own body alone."""
    plain, found = walk(), walk("errors.torso_mass=1.25")
    torso = float(plain.robot.mjcf.split('<body name="torso"')[1].split('mass="')[1].split('"')[0])
    assert plain.true_mass - found.true_mass == pytest.approx(torso * (1.0 - 1.0 / 1.25))
