"""Run after run in one process, as a worker of a campaign makes them: what is kept is kept by value, never stale."""

import importlib
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from surefoot.models.pinocchio import limb_shapes, pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.dumped import dumped_values, parse_dumped, scenario_yaml
from surefoot.scenarios.file.source import apply_overrides, parse
from surefoot.scenarios.run.run import one_thread
from surefoot.scenarios.setup import feasible
from surefoot.scenarios.setup.feasible import made_ready
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.walk import resolve
from surefoot.sim.world import World

pytestmark = pytest.mark.unit


def ready(name="diagonal-walk", **keys):
    walk = resolve(load(name, keys))
    return made_ready(walk, body_of(walk.robot))


@pytest.fixture
def tried(monkeypatch):
    """Number of times that stances were looked at."""
    count = []
    check = feasible.check_stances
    monkeypatch.setattr(feasible, "check_stances", lambda *given: (count.append(given), check(*given)))
    feasible._fitting.cache_clear()
    yield count
    feasible._fitting.cache_clear()


def test_stances_are_looked_at_once_for_walks_that_differ_in_seed_pushes_and_criteria(tried):
    first, legs = ready()
    kept = first.copy()
    first[:] = np.nan
    for seed, criteria in ((1, {}), (2, {"speed_mean": {"min": 0.01}})):
        posture, same = ready(seed=seed, criteria=criteria)
        np.testing.assert_array_equal(posture, kept)
        assert same is legs
    assert len(tried) == 1


@pytest.mark.parametrize(
    "keys",
    [
        {"gait.step_length": 0.1},
        {"gait.com_height": 0.98},
        {"start.yaw": 0.1},
        {"robot_options": {"payload_mass": 5.0}},
        {"terrain.friction": 0.7},
        {"errors.com_height": 0.01},
        {"planner.knee": "bent"},
    ],
    ids=str,
)
def test_they_are_looked_at_again_where_the_walk_is_another(tried, keys):
    ready()
    ready(**keys)
    assert len(tried) == 2


def test_a_robot_file_that_changes_is_another_robot(tried, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "models" / "robot_file"))
    biped = importlib.import_module("biped")
    biped.write(tmp_path, biped.Biped(), biped.FILE)
    file, urdf = tmp_path / "biped.yaml", tmp_path / "biped.urdf"
    before = describe(str(file), RobotOptions())
    urdf.write_text(urdf.read_text().replace('effort="80"', 'effort="81"'))
    after = describe(str(file), RobotOptions())
    assert not np.array_equal(before.torque_limit, after.torque_limit)
    assert feasible.same_robot(before, before) and not feasible.same_robot(before, after)
    assert pinocchio_model(after).upperEffortLimit.max() != pinocchio_model(before).upperEffortLimit.max()


def test_each_run_has_engines_of_its_own():
    robot = describe("humanoid100", RobotOptions())
    world, model, shapes = World(robot, flat(), 1000), pinocchio_model(robot), limb_shapes(robot)
    pairs = len(shapes.collisionPairs)
    world.model.opt.timestep, world.model.body_mass[:] = 1.0, 1.0
    model.gravity.linear, model.inertias[1].mass = np.zeros(3), 1.0
    shapes.removeAllCollisionPairs()
    again, other = World(robot, flat(), 1000), pinocchio_model(robot)
    assert again.model.opt.timestep == pytest.approx(1e-3)
    assert again.model.body_mass.sum() == pytest.approx(100.0)
    assert other.gravity.linear[2] < -9.0
    assert sum(inertia.mass for inertia in other.inertias) == pytest.approx(100.0)
    assert len(limb_shapes(robot).collisionPairs) == pairs


def test_a_text_that_was_read_is_not_what_overrides_have_made_of_it():
    text = "gait: {steps: 4}\n"
    changed = parse(text, "mine.yaml")
    apply_overrides(changed, ["gait.steps=7", "seed=3"])
    assert parse(text, "mine.yaml").value == {"gait": {"steps": 4}}
    assert parse(text, "mine.yaml").overridden == {}


@pytest.mark.parametrize("name", catalogue.names())
def test_a_scenario_is_written_group_by_group_as_in_one_piece_and_read_alike(name):
    for seed in (7, 2**32 - 1, 0):  # of which the others are written around that of the first
        scenario = load(name, {"seed": seed})
        text = scenario_yaml(scenario)
        assert text == yaml.safe_dump(scenario.model_dump(mode="json", exclude_none=True), sort_keys=False)
    for one in (text, catalogue.text(name)[0]):
        assert parse_dumped(one, "x") == parse(one, "x")
        assert dumped_values(one, "x") == parse(one, "x").value


def test_scenarios_whose_json_is_the_same_are_written_as_each_is():
    """JSON has no word for numbers that are not finite."""
    texts = set()
    for value in (math.inf, -math.inf, math.nan):
        scenario = load("walk-level").model_copy(update={"duration": value})
        texts.add(text := scenario_yaml(scenario))
        assert text == yaml.safe_dump(scenario.model_dump(mode="json", exclude_none=True), sort_keys=False)
    assert len(texts) == 3


ODD = [
    "a: {b: 1",
    "a: 'x",
    "a: \t1\n",
    "- !!int 3",
    "{" * 30,
    "a: &x [*x]",
    "a: &x 1\nb: *x",
    "a: 1\na: 2",
    "- 1\na: 2",
    "",
]


@pytest.mark.parametrize("text", ODD)
def test_what_no_program_has_written_is_told_of_alike(text):
    def said(read):
        try:
            return read(text, "x")
        except Exception as error:
            return str(error)

    def sound(*given):
        source = parse(*given)
        if source.problems:  # such as a key twice, which no program has written
            raise ScenarioError([source.describe(problem) for problem in source.problems])
        return source.value

    assert said(parse_dumped) == said(parse)
    assert said(dumped_values) == said(sound)


def test_one_thread_is_taken_back():
    threadpoolctl = importlib.import_module("threadpoolctl")

    def threads():
        return {one["filepath"]: one["num_threads"] for one in threadpoolctl.threadpool_info()}

    before = threads()
    with one_thread():
        assert set(threads().values()) <= {1}
    assert threads() == before


LOOP = """
from threadpoolctl import threadpool_info
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
walk = resolve(load("diagonal-walk", []))
with one_thread():
    closed_loop(walk, NoLog())
    print(sorted({pool["num_threads"] for pool in threadpool_info()}), len(threadpool_info()))
"""


def test_libraries_that_come_with_the_loop_have_one_thread_too():
    """The threads of SciPy may come late; with two threads a loaded machine takes four times."""
    given = {**os.environ, "OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"}
    done = subprocess.run([sys.executable, "-c", LOOP], env=given, capture_output=True, text=True, check=True)
    threads, _, libraries = done.stdout.strip().rpartition(" ")
    assert threads == "[1]" and int(libraries) >= 1
