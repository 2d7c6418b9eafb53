"""Random scenario files end as a scenario or as a ScenarioError, never otherwise."""

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.load import read_scenario

pytestmark = pytest.mark.unit

QUICK = settings(max_examples=150, suppress_health_check=list(HealthCheck))

_NAMES = sorted({"step", "0", ""} | set(Scenario.model_fields) | {"max", "min", "equals", "fell", "zmp_error_rms"})
_KEYS = st.sampled_from(
    _NAMES + sorted({key for group in Scenario.model_json_schema()["$defs"].values() for key in group["properties"]})
)
_SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=5),
    st.sampled_from(["flat", "single", "torque_loss", "humanoid100", "torso", 1e-9, 0.02, 1000, 50, -1]),
)
_VALUES = st.recursive(
    _SCALARS, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(_KEYS, inner, max_size=5), max_leaves=20
)
_SYNTAX = st.text(alphabet="abgit: \n\t-[]{}&*!|>'\"%@`#?,.0123456789e_\\~\u00e9\x85\ufeff", max_size=80)


def survive(robots, text, overrides=()):
    try:
        assert isinstance(read_scenario(text, "f.yaml", "f", overrides, robots), Scenario)
    except ScenarioError as error:
        assert error.problems
        assert all(problem.startswith(("f.yaml:", "--set ")) and "; " in problem for problem in error.problems)


@QUICK
@given(text=st.text(max_size=200) | _SYNTAX)
def test_random_text(robots, text):
    survive(robots, text)


@QUICK
@given(value=st.dictionaries(st.sampled_from(sorted(Scenario.model_fields)), _VALUES, max_size=6))
def test_random_structures_near_valid_ones(robots, value):
    survive(robots, yaml.safe_dump(value, allow_unicode=True))


@QUICK
@given(data=st.data())
def test_one_wrong_value_in_a_valid_file(robots, data):
    value = Scenario().model_dump(mode="json", exclude_none=True)
    group = data.draw(st.sampled_from(sorted(value)))
    if isinstance(value[group], dict) and value[group]:
        value[group][data.draw(_KEYS | st.sampled_from(sorted(value[group])))] = data.draw(_VALUES)
    else:
        value[group] = data.draw(_VALUES)
    survive(robots, yaml.safe_dump(value, allow_unicode=True))


@QUICK
@given(key=st.text(max_size=10) | st.lists(_KEYS, max_size=4).map(".".join), text=_SYNTAX)
def test_random_overrides(robots, key, text):
    survive(robots, "gait: {steps: 2}\npushes: [{time: 1}]\n", [f"{key}={text}", text])
