"""Numbers of a law of one's own are keys of the group `planner`, as those of the package's laws are."""

import json
import pickle
from dataclasses import dataclass, fields

import pytest

import surefoot
from surefoot.planner import PROFILES, PlannerParameters, Profile
from surefoot.planner.laws.dcm_feedback import DcmFeedback
from surefoot.scenarios.cli import texts
from surefoot.scenarios.file.schema import PlannerSettings, Scenario, own_keys
from surefoot.scenarios.setup.checks.criteria import published
from surefoot.scenarios.setup.walk import resolve
from surefoot.tunable import number, positive

pytestmark = pytest.mark.unit

WALK = {"fidelity": "pendulum", "duration": 1.0, "criteria": {}, "planner.profile": "calm"}


@dataclass(frozen=True, slots=True)
class CalmParameters(PlannerParameters):
    """Parameters of a law with a number of its own, and one that no scenario may change."""

    calm: float = positive(0.5, "m/s^2", "share of the jerk that is applied", most=10.0)
    hidden: float = number(1.0, "-", "unused")


class Calm:
    """DCM feedback with less of the jerk the calmer it is."""

    def __init__(self, parameters, com_height):
        self.law = DcmFeedback(parameters, com_height)
        self.share = 1.0 - 0.01 * parameters.calm

    def plan(self, problem):
        motion = self.law.plan(problem)
        return type(motion)(self.share * motion.jerk, motion.shifts, motion.zmp_slack, motion.terminal_slack)


@pytest.fixture(autouse=True)
def profile():
    """The profile `calm`, registered from Python."""
    yield PROFILES.add("calm", Profile("calm", "calm", CalmParameters(), Calm, False, numbers=("jerk_limit", "calm")))
    PROFILES.discard("calm")


def loaded(**keys):
    return surefoot.load("walk-level", WALK | {f"planner.{name}": value for name, value in keys.items()})


def test_null_is_its_own_and_a_value_changes_that_number_alone():
    usual, changed = resolve(loaded()).parameters, resolve(loaded(calm=2.0)).parameters
    assert {entry.name for entry in fields(usual) if getattr(usual, entry.name) != getattr(changed, entry.name)} == {
        "calm"
    }
    assert (usual.calm, changed.calm) == (0.5, 2.0)


def test_it_moves_the_walk():
    def com(**keys):
        with surefoot.Simulation(loaded(**keys)) as simulation:
            return [simulation.step().com.tolist() for _ in range(200)]

    assert com() == com(calm=0.5) != com(calm=9.0)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"planner.calm": 0.0}, "planner.calm is 0.0; it must be more than 0"),
        ({"planner.calm": 11.0}, "planner.calm is 11.0; it must be at most 10"),
        ({"planner.clam": 1.0}, "unknown key 'clam'; did you mean 'calm'?"),
        ({"planner.hidden": 1.0}, "unknown key 'hidden'"),
        ({"planner.calm": 1.0, "planner.profile": "dcm"}, "unknown key 'calm'; it is a key of profile calm"),
        ({"planner.calm": 1.0, "planner.profile": "default"}, "unknown key 'calm'; it is a key of profile calm"),
        ({"planner.step_weight": 1.0}, "planner.step_weight with profile 'calm', whose law does not read it"),
    ],
)
def test_it_is_checked_as_any_other_and_unknown_elsewhere(keys, sentence):
    with pytest.raises(surefoot.ScenarioError) as refused:
        surefoot.load("walk-level", WALK | keys)
    assert sentence in "\n".join(refused.value.problems)


def test_it_grows_with_the_robot(tmp_path):
    """A file for the reference robot is translated, and so is the law's own value."""
    file = tmp_path / "sized.yaml"
    file.write_text("robot: g1\nsized_for: humanoid100\nplanner: {profile: calm, calm: 0.5}\n")
    usual = resolve(surefoot.load("walk-level", {"robot": "g1", "planner.profile": "calm"})).parameters.calm
    found = resolve(surefoot.load(file)).parameters.calm
    assert found == pytest.approx(usual) != CalmParameters().calm


def test_it_is_described_in_the_schema_and_among_the_keys():
    described = published()["$defs"]["PlannerSettings"]["properties"]["calm"]
    assert described["description"] == "share of the jerk that is applied, null: the profile's own"
    assert dict(own_keys(PlannerSettings))["calm"].description.startswith("calm: share of the jerk")


def test_the_schema_that_is_kept_changes_by_it_and_nowhere_else():
    kept, made = json.loads((texts.FOLDER / "schema.json").read_text(encoding="utf-8")), published()
    assert list(made["$defs"]) == list(kept["$defs"])
    group, other = (one["$defs"]["PlannerSettings"]["properties"] for one in (kept, made))
    assert group.keys() ^ other.keys() == {"calm"}
    assert {name for name in group if group[name] != other[name]} == {"profile"}


def test_a_scenario_with_it_goes_to_another_process_and_comes_back_from_a_log(tmp_path):
    scenario = loaded(calm=2.0)
    again = pickle.loads(pickle.dumps(scenario))
    assert again == scenario
    assert again.planner.model_fields_set == scenario.planner.model_fields_set
    assert surefoot.load(str(surefoot.run(scenario, out=tmp_path).log)).planner.calm == 2.0


def test_profiles_without_numbers_of_their_own_have_the_group_of_all():
    assert type(surefoot.load("walk-level", {"planner.profile": "lti"}).planner) is PlannerSettings
    assert type(Scenario().planner) is PlannerSettings


@pytest.mark.parametrize(
    ("keys", "at"),
    [
        ({"planner.profile": "clam", "planner.calm": 1.0}, "planner.profile"),
        ({"terrain.kind": "dunes", "terrain.sand": 1.0}, "terrain.kind"),
        ({"instruments": [{"name": "altimiter", "noise": 0.1}]}, "instruments"),
    ],
)
def test_keys_of_a_kind_that_nobody_knows_are_left_to_it(keys, at):
    with pytest.raises(surefoot.ScenarioError) as refused:
        surefoot.load("walk-level", keys)
    (problem,) = refused.value.problems
    assert problem.startswith(f"--set {at}")
