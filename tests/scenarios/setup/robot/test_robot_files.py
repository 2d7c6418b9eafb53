"""Scenarios on robots of robot files: by name, by path, and what of the stack takes from the description alone."""

from pathlib import Path

import jsonschema
import numpy as np
import pinocchio as pin
import pytest

import surefoot
from surefoot.models import RobotOptions, describe
from surefoot.models.facts import facts_of
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import RobotSettings
from surefoot.scenarios.run.run import run_constants
from surefoot.scenarios.setup.checks.criteria import published
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.robot.body import body_of, feet_at, leg_inertia
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

HALF = "name: half\nmodel: humanoid100\nscale: 0.5\n"


@pytest.fixture(scope="module", autouse=True)
def no_cache_of_the_user(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield


def files(folder: Path) -> Path:
    """A scenario and a robot file beside it, which it names."""
    (folder / "half.yaml").write_text(HALF)
    scenario = folder / "short.yaml"
    scenario.write_text("robot: ./half.yaml\nfidelity: pendulum\ngait: {steps: 2}\n")
    return scenario


def test_a_path_starts_from_the_scenario_that_names_it(tmp_path, monkeypatch) -> None:
    scenario = files(tmp_path)
    monkeypatch.chdir("/")
    assert load(scenario).robot == str(tmp_path / "half.yaml")
    assert resolve(load(scenario)).robot.leg_length == pytest.approx(0.47)


def test_a_log_needs_no_robot_file_to_be_judged(tmp_path) -> None:
    verdict = surefoot.run(load(files(tmp_path)), out=str(tmp_path / "runs")).verdict
    assert not [reason for reason in verdict.reasons if "known" in reason]


def test_a_path_that_is_set_starts_from_where_one_is(tmp_path, monkeypatch) -> None:
    files(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert load("walk-level", {"robot": "half.yaml"}).robot == str(tmp_path / "half.yaml")


@pytest.mark.parametrize(
    ("robot", "sentence"),
    [
        ("none.yaml", r"none\.yaml: cannot be read, No such file or directory; give a readable robot file"),
        ("broken.yaml", r"broken\.yaml:2: unknown key 'modle'; did you mean 'model'\?"),
        ("taloss", "unknown robot 'taloss'; did you mean 'talos'"),
    ],
)
def test_what_is_wrong_with_the_robot_is_told_at_its_key(tmp_path, monkeypatch, robot, sentence) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "broken.yaml").write_text("name: broken\nmodle: a.urdf\n")
    with pytest.raises(ScenarioError, match=sentence) as refused:
        load("walk-level", {"robot": robot})
    assert [problem.startswith("--set robot: ") for problem in refused.value.problems] == [True]


def test_an_option_is_told_at_its_own_key(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    files(tmp_path)
    with pytest.raises(ScenarioError, match=r"--set robot_options\.payload_body: unknown body 'xyz'"):
        load("walk-level", {"robot": "half.yaml", "robot_options.payload_body": "xyz"})


def test_the_schema_takes_names_and_files() -> None:
    check = jsonschema.Draft202012Validator(published()).is_valid
    assert check({"robot": "talos"}) and check({"robot": "./mine.yaml"})
    assert not check({"robot": "taloss"})


@pytest.fixture(scope="module")
def g1():
    return describe("g1", RobotOptions())


def test_facts_are_of_straight_legs_and_not_of_zero_angles(g1) -> None:
    """CoM over the hips, and how fast a hip can swing the leg that hangs straight."""
    body = body_of(g1)
    q = pin.neutral(body.model)
    q[7:] = g1.straight_joint_positions
    height = pin.centerOfMass(body.model, body.model.createData(), q)[2] - feet_at(body, q).position[0, 2]
    facts = facts_of(g1)
    assert facts.com_above_hip == pytest.approx(height - g1.leg_length, abs=1e-9)
    assert min(facts.swing_acceleration) > 10.0


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_a_robot_starts_on_level_soles_with_its_legs_as_links(name) -> None:
    walk = resolve(load("walk-level", {"robot": name}))
    body = body_of(walk.robot)
    q = start_posture(walk, body)
    chain = leg_inertia(body.model, body.frames, q, body.leg_joints).chain
    legs = chain.thigh.length + chain.shank.length + chain.ankle[2]
    assert legs == pytest.approx(walk.robot.leg_length, rel=0.02)
    assert 2 * chain.hip_half_width == pytest.approx(walk.robot.hip_width, rel=0.05)
    knees = q[7:][list(walk.robot.joint_indices(walk.robot.roles.knees))]
    assert knees == pytest.approx(np.full(2, knees[0]), abs=1e-3)


def test_a_log_says_where_knees_are_straight(g1) -> None:
    """Only where that is not at zero, so that logs of other robots are as they were."""
    constants = run_constants(resolve(load("walk-level", {"robot": "g1"})))
    place = g1.joint_names.index(g1.roles.knees[0])
    assert constants.knee_straight == pytest.approx(np.full(2, g1.straight_joint_positions[place]), abs=1e-6)
    assert "knee_straight" not in run_constants(resolve(load("walk-level"))).to_metadata()


def test_every_name_has_facts_fast_enough_to_be_asked_for_twice() -> None:
    robots = Robots()
    assert robots.facts("talos", RobotSettings()) == robots.facts("talos", RobotSettings())
