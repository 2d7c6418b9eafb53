"""Public data and errors go between processes as they are."""

import importlib
import inspect
import pickle
import pkgutil
from pathlib import Path

import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES
from surefoot.scenarios.check.check import cases, run_case
from surefoot.scenarios.errors import LONGEST_SENTENCE, Problem
from surefoot.scenarios.judge.inspection import inspect as inspect_log
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.metrics import METRICS
from surefoot.scenarios.run.processes import processes
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

BRIEF = {"fidelity": "pendulum", "duration": 0.2, "criteria": {"fell": False}}


def again(thing):
    return pickle.loads(pickle.dumps(thing))


def errors():
    """Every exception class of the package that leaves its module, in the order of the modules."""
    for found in pkgutil.walk_packages(surefoot.__path__, "surefoot."):
        if found.name.endswith("__main__"):
            continue
        for thing in vars(importlib.import_module(found.name)).values():
            own = inspect.isclass(thing) and issubclass(thing, BaseException) and thing.__module__ == found.name
            if own and not thing.__name__.startswith("_"):
                yield thing


GIVEN = {
    "key, what, right": (("gait", 0), "gait is 0", "use more"),
    "what, right": ("'x' of package y cannot be loaded", "mend it"),
    "problems": (["f.yaml:1:1: \x1b", "x" * 2 * LONGEST_SENTENCE],),
    "problem": (Problem(("gait", "steps"), "gait.steps is 0", lambda: "use more"),),
    "time, cause": (1.5, "the torque"),
    "path, topic": (Path("log.mcap"), "/contact"),
    "args": ("what is wrong; what would be right",),
}
"""Arguments by the names of those that a class takes."""


def raised(kind):
    names = [name for name in inspect.signature(kind.__init__).parameters if name not in ("self", "kwargs")]
    return kind(*GIVEN[", ".join(names)])


def told(error):
    values = {name: str(value) for name, value in vars(error).items()}
    return type(error), str(error), values


def leave_with(kind):
    raise raised(kind)


def test_every_error_is_itself_in_another_process():
    kinds = dict.fromkeys(errors())
    assert {surefoot.ScenarioError, surefoot.SetupError, surefoot.PartError, surefoot.RunFault} <= set(kinds)
    for kind in kinds:
        assert told(again(raised(kind))) == told(raised(kind))
    with processes() as pool:
        for kind in kinds:
            with pytest.raises(kind) as caught:
                pool.submit(leave_with, kind).result(timeout=60)
            assert told(caught.value)[:2] == told(raised(kind))[:2]


def test_what_a_run_leaves_is_itself(tmp_path):
    scenario = surefoot.load("walk-level", BRIEF)
    result = surefoot.run(scenario, out=tmp_path)
    assert again(result).verdict == result.verdict
    log = surefoot.read(result.log)
    assert surefoot.judge(again(log)) == result.verdict
    assert (again(log["/truth"]).field("com") == log["/truth"].field("com")).all()
    assert again(inspect_log(log)).to_json() == inspect_log(log).to_json()
    walk = resolve(scenario)
    assert (again(walk).text, again(walk).formulation.profile) == (walk.text, walk.formulation.profile)
    with surefoot.Simulation(scenario) as sim:
        tick = sim.step()
        assert repr(again(tick)) == repr(tick)
    (tmp_path / "brief.yaml").write_text("fidelity: pendulum\nduration: 0.2\ncriteria: {fell: false}\n")
    checked = run_case(*cases([str(tmp_path / "brief.yaml")]), tmp_path)
    assert (again(checked).status, again(checked).now.metrics) == ("without baseline", checked.now.metrics)


def test_what_is_registered_is_found_again_by_name():
    for registry in (METRICS, PROFILES):
        assert [again(thing) for thing in registry.values()] == list(registry.values())
    assert [again(kind).name for kind in KINDS.values()] == list(KINDS)
    for one in METRICS.values():
        assert again(one) is one
        assert [again(reduction) for reduction in one.reductions] == list(one.reductions)
    assert again(surefoot.Parts()) == surefoot.Parts()


def test_a_metric_that_its_module_has_not_says_so():
    @metric()
    def local(run) -> float:
        """A metric that is a function within a function."""

    with pytest.raises(pickle.PicklingError, match="make it at the top of a module, with the decorator"):
        pickle.dumps(local)
