"""A policy in the tour: by its contract, through the bench, interrupted and gone on with, and refused."""

import csv
import json

import numpy as np
import pytest
import yaml
from needs import POLICY
from typer.testing import CliRunner

from surefoot.planner.steps.commands import Command
from surefoot.planner.types import Twist
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.sim.measurement import Measurement
from surefoot.studies.tour.bench import JOURNAL, PUNCHES, TOURS, Bench, differences
from surefoot.studies.tour.entrants import entrants, setting
from surefoot.studies.tour.results import RowResult, read_tours
from surefoot.studies.tour.ride import Ride, Setting

pytestmark = pytest.mark.physics

CRANE = Setting("crane", "benchmark")


@pytest.fixture
def policies():
    POLICY.or_skip()
    import policies

    return policies


@pytest.fixture
def stander(policies, tmp_path):
    """Folder of a policy that stands."""
    return policies.stander(tmp_path / "stander").parent


def bench(*words):
    return CliRunner().invoke(app, ["bench", "g1-tour", *map(str, words)])


@pytest.mark.parametrize("told", [Setting(), CRANE])
def test_a_tour_of_a_policy_is_the_same_each_time_and_its_arms_are_the_harness(stander, told):
    (entrant,) = entrants((), [stander])
    assert (entrant.name, entrant.rate) == ("stander", 50)
    rides = [Ride(entrant, 1, told) for _ in range(2)]
    results = [ride.run(0.4) for ride in rides]
    assert results[0] == results[1] and results[0].row == "stander" and not results[0].fault
    assert len(results[0].punches) == 1
    arms = rides[0]._arms
    held = rides[0].world.data.qpos[7:][arms.joints]
    assert np.abs(held - arms.start).max() > 0.01


def test_a_bench_of_a_policy_goes_on_where_it_stopped_and_tells_its_tours_as_tables(stander, tmp_path):
    out, words = tmp_path / "out", ("--seconds", 1, "--workers", 1, "--start", "crane", "--draws", "benchmark")
    done = bench("--policy", stander, "--seeds", 1, "--out", out, *words)
    assert done.exit_code == 0, done.output
    first = (out / JOURNAL).read_text()
    assert len(first.splitlines()) == 1
    (out / JOURNAL).write_text(first + first[: len(first) // 2])  # killed while it wrote
    assert bench("--policy", stander, "--seeds", 2, "--out", out, *words).exit_code == 0
    journal = [line for line in (out / JOURNAL).read_text().splitlines() if line.endswith("}")]
    assert len(journal) == 2
    told = json.loads((out / "result.json").read_text())
    assert (told["start"], told["draws"], told["rows"][0]["tours"]) == ("crane", "benchmark", 2)
    with (out / TOURS).open(newline="") as file:
        tours = read_tours(csv.reader(file))
    assert [(tour.row, tour.seed) for tour in tours] == [("stander", 0), ("stander", 1)]
    assert RowResult.of(tours, 1.0).survival.value == pytest.approx(told["rows"][0]["survival"]["value"])
    assert (out / PUNCHES).read_text().startswith("row,kind,of,survived,punches\nstander,level impulse,")
    # Nothing that was there is run again, and another start is another tour.
    bench("--policy", stander, "--seeds", 2, "--out", out, *words)
    assert len([line for line in (out / JOURNAL).read_text().splitlines() if line.endswith("}")]) == len(journal)
    assert len(Bench(entrants((), [stander]), 2, out, 1.0).left()) == 2


def test_a_policy_that_was_changed_is_run_again(stander, tmp_path):
    words = ("--policy", stander, "--seeds", 1, "--seconds", 1, "--workers", 1, "--out", tmp_path / "out")
    bench(*words)
    assert not Bench(entrants((), [stander]), 1, tmp_path / "out", 1.0).left()
    contract = stander / "contract.yaml"
    told = yaml.safe_load(contract.read_text())
    contract.write_text(yaml.safe_dump({**told, "damping": [2.0 * one for one in told["damping"]]}))
    assert len(Bench(entrants((), [stander]), 1, tmp_path / "out", 1.0).left()) == 1


def test_what_is_told_of_driven_arms_follows_the_contract(policies, tmp_path):
    found = {}
    for kind in ("as_is", "at_rest", "as_commanded"):
        (entrant,) = entrants((), [policies.stander(tmp_path / kind, driven=kind).parent])
        ride = Ride(entrant, 2, CRANE)
        ride.step()
        connection = ride.walker.policy.connection
        moved = connection.driven
        state = ride.world.measure()
        position, velocity = connection._joints_seen(state.q[7:], state.v[6:])
        found[kind] = position[moved] - connection.joints.default[moved], velocity[moved]
        own = connection.joints.named[~moved]
        assert np.array_equal(position[~moved], state.q[7:][own])
    assert np.abs(found["as_is"][0]).max() > 0.01 and found["as_is"][1].any()
    assert not found["at_rest"][0].any() and not found["at_rest"][1].any()
    assert not found["as_commanded"][1].any()


def test_what_cannot_take_part_is_refused(policies, stander, tmp_path):
    other = policies.stander(tmp_path / "other", robot="talos").parent
    twin = policies.stander(tmp_path / "again" / "stander").parent
    lost = tmp_path / "lost.yaml"
    for files, told in (
        ([other], "is the contract of robot talos, and this is g1"),
        ([stander, twin], "two walkers are called 'stander'"),
        ([lost], "no such contract"),
    ):
        with pytest.raises(ScenarioError, match=told):
            entrants((), files)
    with pytest.raises(ScenarioError, match="no row 'stander'"):
        entrants(("stander",), [stander])
    for words, told in ((("cran", "own"), "did you mean 'crane'"), (("feet", "theirs"), "no draws 'theirs'")):
        with pytest.raises(ScenarioError, match=told):
            setting(*words)
    done = bench("--policy", lost, "--out", tmp_path / "none")
    assert isinstance(done.exception, ScenarioError) and not (tmp_path / "none").exists()


def test_differences_are_those_of_the_setting():
    own, theirs = differences(Setting()), differences(CRANE)
    assert any("other random numbers" in one for one in own) and not any("random numbers" in one for one in theirs)
    assert any("not on a crane" in one for one in own) and not any("not on a crane" in one for one in theirs)
    assert set(own) & set(theirs)


def test_a_policys_clocks_count_its_decisions(stander):
    (entrant,) = entrants((), [stander])
    policy = entrant.walker().policy
    found = []
    for tick in range(4):
        twist = Twist(0.3) if tick in (0, 1, 3) else Twist()
        policy.step(Measurement.of_state(0.02 * tick, policy_state(policy), np.zeros(35)), Command(twist))
        found.append((round(policy.connection.walked, 6), round(policy.connection.since, 6)))
    assert found == [(0.02, 0.02), (0.04, 0.04), (0.04, 0.0), (0.06, 0.02)]
    policy.reset(None)
    policy.step(Measurement.of_state(0.0, policy_state(policy), np.zeros(35)), Command(Twist()))
    assert (policy.connection.walked, policy.connection.since) == (0.0, 0.0)
    assert policy.connection.driven.any()  # arms stay the harness's


def policy_state(policy):
    """A configuration in its posture."""
    return np.concatenate(([0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0], policy.posture))
