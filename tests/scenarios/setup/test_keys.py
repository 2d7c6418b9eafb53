"""Every parameter of the planner that is called otherwise in a scenario leads to a key that there is."""

import pytest

from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup import keys
from surefoot.scenarios.setup.keys import scenario_key

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("key", set(keys._NAMES.values()))
def test_keys_are_in_the_schema(key):
    model = Scenario
    for part in key:
        assert part in model.model_fields
        model = model.model_fields[part].annotation


def test_the_longest_name_wins_and_the_rest_is_kept():
    assert scenario_key(("parameters", "moves")) == ("planner", "control_horizon")
    assert scenario_key(("parameters", "jerk_limit")) == ("planner", "jerk_limit")
    assert scenario_key(("velocity", 2, "time")) == ("gait", "velocity", 2, "time")
    assert scenario_key(("gait", "single_support")) == ("gait", "single_support")
