"""Metrics of one's own: computed, shown and bounded like ours; a bad or missing one never lets a run pass."""

import json
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from sites import Site

from surefoot.errors import ParameterError
from surefoot.parts.plugins import PluginError
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.judge.inspection import Inspection, inspect
from surefoot.scenarios.judge.metric import RESERVED, Metric, metric, reduction
from surefoot.scenarios.judge.metrics import METRICS, OWN, digest, gathered, register
from surefoot.scenarios.judge.verdict import bound_text, judge, shown_unit, value_text
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import read_scenario

pytestmark = pytest.mark.unit


@reduction("/torque")
def torque_sum(run):
    return run.field("/torque", "command").sum(axis=1)


@metric(unit="m", shown=(1e3, "mm"), size=2, reads={"/truth": ("com",)}, reduces=(torque_sum,))
def grip(run):
    """Grip in two directions [m]."""
    assert len(run.reduced(torque_sum)) == run.ticks
    return np.array([0.001, 0.002])


def made(function, **about):
    function.__name__ = "grip"
    function.__doc__ = function.__doc__ or "Grip."
    return metric(**about)(function)


@pytest.fixture
def brought():
    """Register metrics for a test alone."""
    names = []

    def bring(thing):
        names.append(thing.name)
        return register(thing)

    yield bring
    for name in names:
        METRICS.discard(name)


@pytest.fixture
def packaged(monkeypatch, tmp_path):
    """Have a package with these entry points; a target is a dotted place in this module."""

    def install(**targets):
        site = Site(tmp_path / "site", "my-metrics")
        site.register(METRICS.group, **{name: f"{__name__}:{target}" for name, target in targets.items()})
        monkeypatch.syspath_prepend(str(site.folder))

    METRICS.forget()
    yield install
    METRICS.forget()


@pytest.fixture
def load(robots):
    """Load a scenario of two steps with these criteria beside that of no fall."""

    def make(**criteria):
        lines = "".join(f"  {name}: {bound}\n" for name, bound in criteria.items())
        text = f"name: two-steps\ngait: {{steps: 2}}\ncriteria:\n  fell: false\n{lines}"
        return read_scenario(text, "two-steps.yaml", "two-steps", (), robots)

    return make


@pytest.fixture
def verdict(tmp_path, robot, motion, load):
    stand = motion(duration=0.3)
    return lambda **criteria: run_scenario(load(**criteria), tmp_path, None, stand, robot).verdict


def test_it_is_computed_shown_and_bounded_after_ours(brought, verdict):
    brought(grip)
    found = verdict(grip="{max: [0.0015, 0.0015]}")
    assert list(found.to_json())[-1] == "grip"
    assert list(found.metrics) == [*OWN, "grip"]
    assert found["grip"] == [0.001, 0.002]
    assert found.reasons == ("grip[1] is 0.002 m, bound is at most 0.0015 m",)
    assert value_text("grip", [0.001, 0.002]) == "1  2"
    assert shown_unit("grip") == "mm"
    assert bound_text("grip", found.criteria["grip"]) == "<= 1.5  1.5"


def test_an_entry_point_is_enough(packaged, verdict):
    packaged(grip="grip", fell="grip")
    found = verdict(grip="{max: 0.01}")
    assert found.passed
    assert found["grip"] == [0.001, 0.002]
    assert found["fell"] is False


def test_the_example_of_the_documentation_works(brought, verdict):
    page = (Path(__file__).parents[3] / "docs" / "extending.md").read_text(encoding="utf-8")
    example = {"__name__": "my_package.metrics"}
    exec(re.search(r"(?s)```python\n(.*?)```", page).group(1), example)
    names = re.findall(r'(\w+) = "my_package\.metrics:\1"', page)
    assert names == [name for name, thing in example.items() if isinstance(thing, Metric)]
    for name in names:
        brought(example[name])
    found = verdict(com_sway="{max: 0.05}")
    assert found.notes == ()
    assert found["com_sway"] == 0.0
    assert found["torque_norm_rms"] == pytest.approx(np.sqrt(30.0**2 + 40.0**2 + 5.0**2))


def test_without_any_the_metrics_are_ours(verdict):
    assert list(verdict().metrics) == list(OWN)


def test_its_fields_and_reductions_are_gathered_while_the_log_is_read(brought, tmp_path, robot, motion, two_steps):
    brought(grip)
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    inspect(log)
    assert not log._loaded
    assert len(digest(log).reduced[torque_sum]) == 2000


@pytest.mark.parametrize(
    ("function", "note"),
    [
        (lambda run: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda run: sys.exit(), "SystemExit"),
        (lambda run: run.field("/truth", "nothing"), "LogError: channel /truth has no field 'nothing'"),
        (lambda run: run.field("/truth", "com").fill(0.0), "ValueError: assignment destination is read-only"),
        (lambda run: [1.0, 2.0], "gave [1.0, 2.0], which is not what it says it gives"),
        (lambda run: [], "gave [], which is not what it says it gives"),
        (lambda run: "much", "gave 'much', which is not what it says it gives"),
        (lambda run: 10**5000, "gave <int that cannot be shown>, which is not what it says it gives"),
        (lambda run: 10**400, "gave 10000"),
    ],
)
@pytest.mark.parametrize("bound", ["{min: 0}", "{equals: true}", "{equals: steps_planned}"])
def test_one_that_fails_is_a_note_and_its_criterion_a_reason(brought, verdict, function, note, bound):
    brought(made(function, reads={"/truth": ("com",)}))
    found = verdict(grip=bound)
    assert not found.passed
    assert found["grip"] is None
    assert len(found.reasons) == 1
    assert found.reasons[0].startswith("grip is not available")
    (said,) = [said for said in found.notes if "grip" in said]
    assert said.startswith(f"metric 'grip' of this program: {note}")
    assert f"{__file__}:" in said or note.startswith("gave")
    assert json.loads(json.dumps(found.to_json()))["grip"] is None


class OddFloat(float):
    """Less than everything, and equal to it."""

    __lt__ = __le__ = __eq__ = lambda self, other: True
    __gt__ = __ge__ = __ne__ = lambda self, other: False
    __hash__ = float.__hash__
    __float__ = lambda self: 0.0  # noqa: E731
    __repr__ = lambda self: "0.0"  # noqa: E731


class OddInt(int):
    """An integer of another class."""

    __lt__ = __le__ = __eq__ = lambda self, other: True
    __gt__ = __ge__ = __ne__ = lambda self, other: False
    __hash__ = int.__hash__
    __repr__ = lambda self: "0"  # noqa: E731


@pytest.mark.parametrize("value", [OddFloat(7.0), OddInt(7), [OddFloat(7.0), 1.0], np.array([7.0, 1.0])])
def test_a_number_of_a_class_of_its_own_is_what_it_holds(brought, verdict, value):
    brought(made(lambda run: value, size=2 if isinstance(value, list | np.ndarray) else 1))
    found = verdict(grip="{max: 1}")
    assert not found.passed
    first = found["grip"][0] if isinstance(found["grip"], list) else found["grip"]
    assert (type(first) in (int, float), repr(first).removesuffix(".0")) == (True, "7")


@pytest.mark.parametrize(
    "result", [lambda run: 1 / 0, lambda run: sys.exit(), lambda run: 3.0, lambda run: np.zeros((2, run.ticks))]
)
def test_a_reduction_that_fails_spares_the_others(brought, verdict, result):
    broken = reduction("/torque")(result)
    brought(made(lambda run: float(run.reduced(broken)), reduces=(broken,)))
    found = verdict()
    assert found.passed
    assert found["torque_ratio_max"] == pytest.approx(0.4)


def test_where_its_channels_are_missing_it_is_none_without_a_note(brought, verdict):
    brought(made(lambda run: 1.0, needs=("/nothing",)))
    found = verdict()
    assert found["grip"] is None
    assert found.notes == ()


def test_a_pendulum_has_no_metric_of_a_body():
    body, any_plant = made(lambda run: 1.0, body=True), made(lambda run: 1.0)
    assert not body.applies("pendulum")
    assert body.applies("full")
    assert any_plant.applies("pendulum")


def test_numbers_of_numpy_become_plain_ones(brought, verdict):
    brought(made(lambda run: np.bool_(True)))
    assert verdict(grip="true").to_json()["grip"] is True


def test_a_criterion_on_a_metric_whose_package_is_gone_is_no_pass(tmp_path, brought, verdict):
    brought(grip)
    assert verdict(grip="{max: 1}").passed
    METRICS.discard("grip")
    found = judge(read(tmp_path / "two-steps-0" / "log.mcap"))
    assert not found.passed
    reason = "grip is not known here, so its bound cannot be checked; install the package that has this metric"
    assert found.reasons == (reason,)


def test_a_package_that_cannot_be_loaded_is_said_before_and_after_a_run(packaged, load, verdict):
    packaged(grip="no_such_thing")
    with pytest.raises(ScenarioError, match=r"two-steps.yaml:5:3: metric 'grip' of package .* cannot be loaded"):
        load(grip="{max: 1}")
    found = verdict()
    assert found.passed
    assert "cannot be loaded, AttributeError" in found.notes[0]


def test_an_entry_of_another_name_is_said(packaged, verdict):
    packaged(grasp="grip")
    assert verdict().notes == (
        "metric 'grasp' in surefoot.metrics is named 'grip' where it is made; give both one name",
    )


def test_unknown_names_are_refused_with_the_nearest(brought, load):
    brought(grip)
    with pytest.raises(ScenarioError, match=r"unknown metric 'gripp'; did you mean 'grip'\?"):
        load(gripp="{max: 1}")
    with pytest.raises(ScenarioError, match=r"criteria.grip.max has 3 elements; give one number, or 2 of them"):
        load(grip="{max: [1, 2, 3]}")
    with pytest.raises(ScenarioError, match=r"unknown metric 'planner_time'"):
        load(planner_time="{max: 1}")


def test_ours_cannot_be_replaced(brought):
    ours = made(lambda run: 1.0)
    with pytest.raises(PluginError, match=r"'fell' of surefoot\.metrics is surefoot's own"):
        METRICS.add("fell", ours)
    with pytest.raises(PluginError, match="metric 'grip' is there twice"):
        gathered(SimpleNamespace(a=ours, b=made(lambda run: 2.0)))


@pytest.mark.parametrize(
    ("about", "key"),
    [
        ({"size": 0}, "size"),
        ({"size": 2.0}, "size"),
        ({"size": 2, "parts": ("a", "b")}, "parts"),
        ({"parts": ("a.b",)}, "parts"),
        ({"shown": (0.0, "mm")}, "shown"),
        ({"needs": ("truth",)}, "needs"),
        ({"needs": "/truth"}, "needs"),
        ({"reads": {"truth": ()}}, "reads"),
        ({"reads": {"/truth": "com"}}, "reads"),
        ({"reduces": (len,)}, "reduces"),
    ],
)
def test_what_is_no_metric_is_refused_where_it_is_made(about, key):
    with pytest.raises(ParameterError, match="metric grip") as refused:
        made(lambda run: 1.0, **about)
    assert refused.value.key == (key,)


@pytest.mark.parametrize("name", ["verdict", "log", "<lambda>", "class"])
def test_names_that_are_none_are_refused(name):
    def function(run):
        """Something."""

    function.__name__ = name
    with pytest.raises(ParameterError, match="not a name for a metric"):
        metric()(function)


def test_a_metric_says_what_it_is():
    def silent(run): ...

    with pytest.raises(ParameterError, match="says not what it is"):
        metric()(silent)


def test_reserved_are_the_names_beside_the_metrics(verdict):
    beside = [name for name in verdict().to_json() if name not in OWN]
    assert {*beside, *Inspection.__dataclass_fields__} == set(RESERVED)


def test_a_metric_is_still_its_function():
    assert isinstance(grip, Metric)
    assert grip.meaning == "Grip in two directions [m]."
    assert made(lambda run: run)(5) == 5
