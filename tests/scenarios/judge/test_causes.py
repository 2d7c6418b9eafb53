"""Causes of a fall stand first, and what follows from them is an effect; what is as believed is no cause."""

import numpy as np
import pytest

from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.health import findings
from surefoot.scenarios.judge.loss import BEFORE, loss
from surefoot.scenarios.judge.metrics import compute, digest
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import SCENARIO_FILE
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

FALL = 2.0
LOST = FALL - 0.002
"""The last tick in which the body of the fake loop is upright [s]."""


def weight(time, force):
    return np.full(2, 100 * 9.81 / 2)


def still(time, pose):
    return pose * [0, 1, 1, 1, 1, 1, 1]


def pushed(begin, end, newtons):
    """A push along y, which messages tell of a tick later."""
    return {("/measurement", 7): lambda t, f: f + np.array([0.0, newtons * (begin + 1e-9 < t <= end + 1e-9), 0.0])}


def slipping(begin):
    return {("/truth", 5): lambda t, p: np.array([0.03 * (t > begin), 0.1, 0, 0, 0, 0, 1])}


def astray(metres, begin=0.0):
    return {("/estimate", 0): lambda t, c: c + np.array([metres * (t >= begin), 0, 0])}


@pytest.fixture
def fell(tmp_path, motion, robot, two_steps):
    """The digest of a fall after changes as of test_health, which carries a scenario with some keys."""

    def fall(changes=None, keys=None, **how):
        told = {("/contact", 1): weight, ("/truth", 6): still, ("/truth", 5): still, **(changes or {})}
        made = motion(**{"duration": 2.3, "fall_at": FALL, "changes": told, **how})
        found = digest(read(run_scenario(two_steps, tmp_path, simulate=made, robot=robot).log))
        # Keys of masses and motors ask for a model, which the robot of this folder has not.
        scenario = Scenario(**{"name": "two-steps", "gait": {"steps": 2}, **(keys or {})})
        found.attachments = {**found.attachments, SCENARIO_FILE: scenario_yaml(scenario).encode()}
        return found

    return fall


def causes(found):
    return [one.check for one in findings(found) if one.relation == "cause"]


def named(found, check):
    return next(one for one in findings(found) if one.check == check)


def test_balance_is_lost_with_the_margin_or_when_the_body_is_last_upright(fell):
    assert loss(RunView(fell())).time == pytest.approx(LOST)
    outside = {("/plan", 10): lambda t, m: np.array([0.05, 0.1 if t < 1.2 else -0.01])}
    assert loss(RunView(fell(outside))).time == pytest.approx(1.2)
    regained = {("/plan", 10): lambda t, m: np.array([0.05, -0.01 if 0.2 < t < 0.6 else 0.1])}
    assert loss(RunView(fell(regained))).time == pytest.approx(LOST)
    assert loss(RunView(fell(fall_at=np.inf))) is None


def test_a_push_before_the_loss_stands_first_and_the_rest_are_its_effects(fell):
    found = findings(fell({**pushed(1.7, 1.8, 1500.0), **slipping(1.72), **astray(0.02, 1.75)}))
    assert [(one.check, one.relation) for one in found if one.status == "warning" and one.check != "overruns"] == [
        ("push", "cause"),
        ("foot_slip", "effect"),
        ("estimator", "effect"),
    ]
    push = found[0]
    assert push.time == pytest.approx(1.7)
    assert push.value == pytest.approx(1.5)
    assert "1.5 N·s/kg left acts from 1.700 to 1.800 s" in push.cause
    for effect in found[1:3]:
        assert "friction" not in effect.cause
        assert "sensors" not in effect.cause
        assert "follows from the cause push" in effect.cause


@pytest.mark.parametrize(
    ("begin", "end", "newtons", "named"),
    [
        (LOST - BEFORE + 0.05, LOST - BEFORE + 0.15, 1500.0, True),
        (LOST - BEFORE - 0.15, LOST - BEFORE - 0.05, 1500.0, False),
        (LOST + 0.01, LOST + 0.11, 1500.0, False),
        (LOST - 0.3, LOST - 0.2, 40.0, False),
        (0.2, FALL, 60.0, True),
        (0.2, FALL, 5.0, False),
    ],
    ids=["in the half second", "before it", "after the loss", "too weak", "a lasting force", "a breeze"],
)
def test_a_push_is_a_cause_when_it_acts_before_the_loss_with_some_force(fell, begin, end, newtons, named):
    assert causes(fell(pushed(begin, end, newtons))) == (["push"] if named else [])


def test_a_push_that_steps_tried_to_catch_counts_from_when_the_sole_no_longer_held_the_body(fell):
    caught = {("/plan", 10): lambda t, m: np.array([0.05 if t < 1.0 else -0.02, 0.1])}
    assert causes(fell({**pushed(0.8, 0.9, 1500.0), **caught})) == ["push"]
    assert causes(fell(pushed(0.8, 0.9, 1500.0))) == []


SLIPPERY = {"terrain": {"friction": 0.3}, "wbc": {"friction": 0.8}}


def test_friction_is_a_cause_where_it_is_less_than_believed_and_a_foot_slips(fell):
    assert causes(fell(slipping(1.8), SLIPPERY)) == ["friction"]
    assert causes(fell(slipping(1.8), {"terrain": {"friction": 0.3}, "errors": {"friction": 0.5}})) == ["friction"]
    assert causes(fell({}, SLIPPERY)) == []
    for keys in ({"terrain": {"friction": 0.3}}, {"terrain": {"friction": 0.3}, "wbc": {"friction": 0.2}}, {}):
        believed = fell(slipping(1.8), keys)
        assert causes(believed) == []
        assert "the friction is as the controller counts on" in named(believed, "foot_slip").cause


def test_events_stand_in_the_order_of_time(fell):
    slip_first = fell({**pushed(1.85, 1.95, 1500.0), **slipping(1.7)}, SLIPPERY)
    push_first = fell({**pushed(1.65, 1.75, 1500.0), **slipping(1.8)}, SLIPPERY)
    assert causes(slip_first) == ["friction", "push"]
    assert causes(push_first) == ["push", "friction"]
    both = fell({**pushed(1.85, 1.95, 1500.0)}, {"errors": {"mass_scale": 1.9}})
    assert causes(both) == ["push", "mass"]


SENSED = {"source": "ekf", "preset": "good"}


def test_sensors_as_they_are_specified_are_no_cause(fell):
    poor = {"sensing": {**SENSED, "encoder_offset": 0.05}}
    assert causes(fell(astray(0.02), {"sensing": SENSED})) == []
    assert causes(fell(astray(0.02), {"sensing": {"source": "ekf", "preset": "cheap"}})) == []
    assert causes(fell(astray(0.02), poor)) == ["sensors"]
    assert causes(fell(astray(0.001), poor)) == []
    assert causes(fell(astray(0.02, LOST + 0.01), poor)) == []
    assert "0.05, where the preset good has 0.0005" in named(fell(astray(0.02), poor), "sensors").cause


LASTING = {
    "mass": ({"errors": {"mass_scale": 1.6}}, {"errors": {"mass_scale": 1.1}}),
    "gains": ({"wbc": {"gains": {"swing": (400.0, 0.1)}}}, {"wbc": {"gains": {"swing": (300.0, 30.0)}}}),
    "late_commands": ({"motors": {"delay": 0.03}}, {"motors": {"delay": 0.004}}),
    "motors": ({"motors": {"friction_loss": 30.0}}, {"motors": {"friction_loss": 1.0}}),
}
"""Keys of a scenario by far more and by less than walks bear, by the name of the cause."""


@pytest.mark.parametrize("kind", LASTING)
def test_what_is_wrong_all_the_time_is_a_cause_beyond_what_walks_bear(fell, kind):
    much, little = LASTING[kind]
    assert causes(fell({}, much)) == [kind]
    assert causes(fell({}, little)) == []
    late = named(fell(slipping(1.8), much), "foot_slip")
    assert late.relation == "effect"


def test_a_task_that_follows_from_the_speed_is_no_cause(fell):
    """Without a speed nothing straightens the knees, and a task that does is none that walks are known to bear."""
    straightening = {"wbc": {"knees": {"weight": 0.008}}}
    assert causes(fell({}, {**straightening, "gait": {"steps": 2, "speed": 0.8}})) == []
    assert causes(fell({}, straightening)) == ["gains"]


def test_a_drive_of_a_joint_is_measured_by_its_own_torque(fell):
    def drives(stiffness):
        return {"control": {"output": "position", "gains": {".*_knee": (stiffness, 1.0)}}}

    assert causes(fell({}, drives(120.0))) == []
    assert causes(fell({}, drives(2000.0))) == ["gains"]


def test_a_fault_that_acts_is_a_cause(fell):
    assert causes(fell({}, {"faults": [{"kind": "torque_loss", "time": 1.6}]})) == ["fault"]
    assert causes(fell({}, {"faults": [{"kind": "torque_loss", "time": 0.5, "duration": 0.1}]})) == []


def test_a_run_that_does_not_fall_has_no_causes_and_no_effects(fell):
    sound = fell({**pushed(1.7, 1.8, 1500.0), **slipping(1.75)}, SLIPPERY, fall_at=np.inf)
    assert {one.relation for one in findings(sound)} == {None}
    assert "friction of 0.3 and the controller counts on 0.8" in named(sound, "foot_slip").cause


def test_without_a_cause_only_what_comes_after_the_loss_is_an_effect(fell):
    found = fell({**slipping(1.0), ("/torque", 0): lambda t, u: u + np.array([0, 0, 95.0 * (t > LOST + 0.05), 0])})
    assert named(found, "foot_slip").relation is None
    assert named(found, "torque_limits").relation == "effect"


def test_a_log_of_a_law_that_tells_no_margin_has_its_causes_all_the_same(fell):
    for margins in ("untold", "absent"):
        assert causes(fell(pushed(1.7, 1.8, 1500.0), margins=margins)) == ["push"]


def test_a_fall_is_told_from_the_last_time_on_that_it_was_not_taken_back(fell):
    def warning(said, **how):
        return compute(fell({("/plan", 13): lambda t, f: float(said(t))}, **how))["fall_warning"]

    assert warning(lambda t: t >= 1.5) == pytest.approx(0.5, abs=0.021)
    assert warning(lambda t: 0.5 <= t < 0.8 or t >= 1.8) == pytest.approx(0.2, abs=0.021)
    assert warning(lambda t: 1.5 <= t < 1.7) is None
    assert warning(lambda t: t >= FALL + 0.1) is None
    assert warning(lambda t: False) is None
    assert warning(lambda t: 0.5 <= t < 0.8, fall_at=np.inf) == pytest.approx(0.5 - 2.3, abs=0.021)


def test_json_has_the_relation_and_one_sentence(fell):
    first, *_ = (one.to_json() for one in findings(fell(pushed(1.7, 1.8, 1500.0))))
    assert set(first) == {"check", "status", "time", "value", "relation", "cause"}
    assert (first["check"], first["relation"]) == ("push", "cause")
    assert first["cause"] == (
        "a push of 1.5 N·s/kg left acts from 1.700 to 1.800 s: balance is lost 0.30 s after it began"
    )
