"""The published JSON Schema and the reader of scenario files accept the same."""

import pytest
import yaml
from jsonschema import Draft202012Validator
from mutations import trial
from pydantic import ValidationError

from surefoot.parts.plugins import PluginError
from surefoot.scenarios import catalogue
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.metric import Metric, metric
from surefoot.scenarios.judge.metrics import METRICS, register, unknown_metrics
from surefoot.scenarios.setup.checks.criteria import criteria_problems, published

pytestmark = pytest.mark.unit

UNTOLD = ("exceeds", "checks nothing", "none of these criteria")
"""Faults of criteria that the schema's description names, since it cannot tell them itself."""


@pytest.fixture(scope="module")
def validator():
    schema = published()
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def accepted(data):
    """Return true if the reader accepts the shape of a scenario: what it finds before it looks at robot, gait and
    ground."""
    if not isinstance(data, dict) or unknown_metrics(data.get("criteria")):
        return False
    try:
        scenario = Scenario.model_validate(data)
    except ValidationError:
        return False
    faults = criteria_problems(scenario.criteria, scenario.fidelity)
    return scenario.robot == "humanoid100" and all(any(word in fault.what for word in UNTOLD) for fault in faults)


@pytest.mark.parametrize("name", catalogue.names())
def test_every_scenario_of_the_catalogue_is_valid(validator, name):
    assert [error.message for error in validator.iter_errors(yaml.safe_load(catalogue.text(name)[0]))] == []


@pytest.mark.parametrize("begin", range(0, 200, 100))
def test_schema_and_reader_accept_the_same(validator, begin):
    outcomes = set()
    for seed in range(begin, begin + 100):
        data = trial(seed, alien=False)
        told, read = validator.is_valid(data), accepted(data)
        assert told == read, f"seed {seed}: the schema says {told}, the reader {read}: {data}"
        outcomes.add(read)
    assert outcomes == {True, False}


CASES = {
    "gait: {step_length: 25 cm, single_support: 700 ms, steps: 5.0}": True,
    "gait: {step_length: 25 deg}": False,
    "gait: {step_length: 25cm}": True,
    "gait: {step_length: '0.25'}": False,
    "terrain: {angle: 15 deg}": True,
    "terrain: {angle: 15}": False,
    "rates: {physics: 1 kHz}": True,
    "pushes: [{time: 1, force: [40 N, 0, 1 kN]}]": True,
    "pushes: [{time: 1, force: [40 N, 0]}]": False,
    "criteria: {fell: false, steps_taken: steps_planned, foot_slip_max: {max: 0.01}}": True,
    "criteria: {fell: {max: 1}}": False,
    "criteria: {fell: 0}": False,
    "criteria: {steps_taken: steps_plannd}": False,
    "criteria: {foot_slip_max: foot_slip_max}": False,
    "criteria: {foot_slip_max: footstep_error_max}": False,
    "criteria: {foot_slip_max: {min: null, max: 1}}": False,
    "criteria: {zmp_error_rms: {max: [1, 2]}}": True,
    "criteria: {zmp_error_rms: {max: [1, 2, 3]}}": False,
    "criteria: {zmp_error_rms: 0.1}": False,
    "criteria: {wbc_time.p99: {max: 1}}": True,
    "criteria: {wbc_time: {max: 1}}": False,
    "sensing: {gyro_noise: 0.1}": True,
    "sensing: {preset: best}": False,
    "sensing: {wrench: none, encoder_bits: 12.0}": True,
    "motors: {delay: 4 ms}": True,
    "motors: {damping: 0}": False,
    "planner: {step_adaptation: timing}": True,
    "planner: {step_adaptation: everything}": False,
    "planner: {profile: nobody}": False,
    "robot: nobody": False,
    "wbc: null": True,
    "gait: null": False,
}


@pytest.mark.parametrize("text", CASES)
def test_cases(validator, text):
    data = yaml.safe_load(text)
    assert (validator.is_valid(data), accepted(data)) == (CASES[text], CASES[text])


def test_a_metric_of_another_package_is_a_criterion(validator):
    @metric(unit="m", size=2)
    def sway(run) -> list[float]:
        """Some way [m]."""

    assert isinstance(sway, Metric)
    assert not validator.is_valid({"criteria": {"sway": {"max": 0.1}}})
    register(sway)
    try:
        assert Draft202012Validator(published()).is_valid({"criteria": {"sway": {"max": [0.1, 0.2]}}})
        with pytest.raises(PluginError):
            METRICS.add("fell", sway)
    finally:
        METRICS.discard("sway")


def described(schema, place=""):
    for name, key in schema.get("properties", {}).items():
        yield f"{place}{name}", key
        for option in (key, *key.get("anyOf", ())):
            yield from described(option, f"{place}{name}.")


def has_description(key):
    return bool(key.get("description"))


def test_every_key_has_a_description_and_the_document_its_dialect():
    schema = published()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    found = [place for group in (schema, *schema["$defs"].values()) for place in described(group)]
    assert len(found) > 150
    # A key that kinds of a part have in common has the description of each.
    kinds = {place: key.get("anyOf", ()) if "description" not in key else (key,) for place, key in found}
    assert [place for place, given in kinds.items() if not given or not all(map(has_description, given))] == []
    assert schema["properties"]["criteria"]["properties"]["foot_slip_max"]["unit"] == "m"
