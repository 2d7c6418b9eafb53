"""Imports of commands, in counts, which no busy machine changes; the numbers are those of `benchmarks/limits.json`."""

import json
import sys
from pathlib import Path

import pytest
from needs import COMPILED

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from benchmarks.startup import COMMANDS, imported  # noqa: E402  found by the line above

pytestmark = pytest.mark.unit

LIMITS = json.loads((ROOT / "benchmarks" / "limits.json").read_text())

ENGINES = {"mujoco", "pinocchio", "coal", "proxsuite", "daqp", "qpsolvers", "scipy", "matplotlib"}
LOGS = {"mcap", "google", "lz4", "zstandard"}
NEVER = {
    "--help": {*ENGINES, *LOGS, "numpy", "pydantic", "yaml"},
    "list": {*ENGINES, *LOGS, "numpy", "pydantic"},
    "list --json": {*ENGINES, *LOGS, "numpy", "pydantic"},
    "show walk": {*ENGINES, *LOGS, "numpy", "pydantic", "importlib.metadata"},
    "schema": {*ENGINES, *LOGS, "numpy", "pydantic", "yaml"},
    "run diagonal-walk": {
        *("qpsolvers", "matplotlib", "viser", "asyncio", "multiprocessing.pool", "scipy.spatial"),
        *("glfw.library", "numpy.ma"),
    },
}


@pytest.fixture(scope="module", params=COMMANDS)
def command(request):
    """A command by name, and the modules that it has imported; a run on plain Python has others."""
    if request.param.startswith("run"):
        COMPILED.or_skip()
    return request.param, imported(COMMANDS[request.param])


def test_a_command_imports_no_more_than_it_uses(command):
    name, modules = command
    assert NEVER[name].isdisjoint(modules)


def test_a_check_imports_what_draws_only_where_runs_part():
    found = imported(("check", "stand", "--set", "duration=0.02", "--jobs", "1"))
    assert "surefoot.scenarios.check.history" in found
    assert {"matplotlib", "scipy.special", "scipy.spatial", "surefoot.scenarios.show.replay.extract"}.isdisjoint(found)


def test_a_command_imports_no_more_modules_than_before(command):
    name, modules = command
    own = [module for module in modules if module.partition(".")[0] == "surefoot"]
    most, most_of_ours = (LIMITS[f"{which} modules that a command imports"][name] for which in ("all", "surefoot's"))
    assert 0.85 * most_of_ours < len(own) <= most_of_ours
    assert 0.7 * most < len(modules) <= most


VALUES = {"surefoot.wbc.estimation", "surefoot.wbc.estimation.estimate"}
"""The types of an estimate, which the truth has too."""

UNUSED = {
    "sensing.source=truth": (
        *("surefoot.wbc.estimation.", "surefoot.scenarios.run.ekf", "surefoot.scenarios.record.estimation"),
        *("surefoot.sim.readings", "surefoot.sim.imu_motion"),
    ),
    "sensing={source: ekf, preset: good}": (),
}
"""Modules that a walk with a setting does not use, beside what none uses."""

OF_NO_WALK = ("surefoot.studies", "surefoot.apps", "surefoot.models.robot_file", "surefoot.scenarios.run.processes")


@pytest.mark.parametrize("setting", UNUSED)
def test_a_walk_imports_what_it_uses(setting):
    words = (*COMMANDS["run diagonal-walk"], "--set", setting)
    modules = [name for name in imported(words) if name not in VALUES]
    assert "surefoot.scenarios.run.skeleton" in modules
    assert [name for name in modules if name.startswith((*OF_NO_WALK, *UNUSED[setting]))] == []
    assert ("surefoot.wbc.estimation.estimator" in modules) == ("ekf" in setting)
