"""The signs of a run: each is what it says, on motion of which it is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.check.signs import SIGNS, Stage, Trace, stages
from surefoot.scenarios.log import Log
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

RATE = 500
STAND = Stage("stand", 1, 400)
SWING = Stage("step 1", 100, 400, foot=0, landed=300)


def sign(column):
    (found,) = [one for one in SIGNS if column in one.columns]
    return found.measure


def run_of(soles=None, **fields):
    """A run with fields by topic and name, such as wbc__wrench_left."""
    constants = SimpleNamespace(
        control_rate=RATE, mass=100.0, joint_names=("left_hip", "left_knee", "right_hip"), roles={}
    )
    values = {("/" + key.partition("__")[0], key.partition("__")[2]): value for key, value in fields.items()}
    return SimpleNamespace(
        field=lambda topic, name: values[topic, name], constants=constants, sole=lambda foot: soles[foot]
    )


def wrenches(normal):
    whole = np.zeros((len(normal), 6))
    whole[:, 2] = normal
    return whole


def forces(planned, felt):
    return run_of(
        wbc__wrench_left=wrenches(planned),
        wbc__wrench_right=wrenches(1000.0 - planned),
        measurement__wrench_left=wrenches(felt),
        measurement__wrench_right=wrenches(1000.0 - felt),
    )


@pytest.mark.parametrize("ticks", [1, 3, 7])
def test_a_lag_is_the_time_by_which_the_forces_follow_whatever_they_are_off_by(ticks):
    planned = 500.0 + 200.0 * np.sin(np.linspace(0.0, 9.0, 420) ** 2)
    felt = np.concatenate((np.full(ticks, 500.0), planned[:-ticks])) + 30.0
    assert sign("lag")(forces(planned, felt), [STAND]) == [[pytest.approx(ticks / RATE)]]


def test_no_lag_is_told_in_a_step_of_forces_that_stay_or_of_forces_that_do_not_follow():
    planned = 500.0 + 200.0 * np.sin(np.linspace(0.0, 9.0, 420) ** 2)
    still, other = np.full(420, 500.0), np.random.default_rng(0).normal(500.0, 100.0, 420)
    for run, stage in (
        (forces(planned, planned), SWING),
        (forces(still, still), STAND),
        (forces(planned, other), STAND),
    ):
        assert np.isnan(sign("lag")(run, [stage])).all()


def test_friction_is_the_largest_share_that_is_planned_for_a_loaded_foot():
    wrench = wrenches(np.full(420, 500.0))
    wrench[150, :2] = 300.0, 400.0
    wrench[200] = 40.0, 0.0, 10.0, 0.0, 0.0, 0.0  # hardly loaded
    assert sign("friction_left")(run_of(wbc__wrench_left=wrench), [SWING]) == [[pytest.approx(1.0)]]


def test_torque_is_of_the_joints_of_one_leg():
    command = np.tile([3.0, 4.0, 100.0], (420, 1))
    assert sign("torque_left")(run_of(torque__command=command), [SWING]) == [[pytest.approx(np.sqrt(12.5))]]
    assert sign("torque_right")(run_of(torque__command=command), [SWING]) == [[100.0]]


def test_the_swing_error_is_of_the_foot_that_swings_while_it_does():
    soles = [np.zeros((420, 7)), np.ones((420, 7))]
    soles[0][200, 1] = 0.02
    soles[0][350, 1] = 0.5  # it stands again
    run = run_of(soles, reference__swing_position=np.zeros((420, 3)))
    assert sign("swing")(run, [SWING]) == [[pytest.approx(0.02)]]
    assert np.isnan(sign("swing")(run, [STAND])).all()


def test_a_sole_is_where_it_is_when_its_swing_is_over():
    soles = [np.tile(np.arange(420.0)[:, None], 7), np.zeros((420, 7))]
    landings = sign("sole_x")(run_of(soles), [STAND, SWING])
    assert np.isnan(landings[0]).all()
    assert landings[1].tolist() == [300.0, 300.0, 300.0]


def test_stages_go_from_lift_off_to_lift_off_and_cover_the_run():
    stance = np.full(100, -1)
    stance[20:40], stance[60:80] = 1, 0
    single = stance >= 0
    run = SimpleNamespace(ticks=100, single_support=single, field=lambda topic, name: stance)
    assert stages(run) == [
        Stage("first tick", 0, 1),
        Stage("stand", 1, 20),
        Stage("step 1", 20, 60, foot=0, landed=40),
        Stage("step 2", 60, 100, foot=1, landed=80),
    ]
    cut = SimpleNamespace(ticks=30, single_support=single[:30], field=lambda topic, name: stance[:30])
    assert stages(cut)[-1] == Stage("step 1", 20, 30, foot=0, landed=29)
    assert stages(SimpleNamespace(ticks=0)) == []


def test_friction_parts_only_above_what_all_steps_of_the_baseline_use():
    def trace(*friction):
        values = {"time": np.array([0.0, 0.6]), "friction_left": np.array(friction)}
        return Trace(("step 1", "step 2"), ("left", "right"), values)

    assert trace(0.4, 0.6).partings(trace(0.65, 0.1)) == []
    (parting,) = trace(0.4, 0.6).partings(trace(0.75, 0.6))
    assert parting.text.endswith("for the left foot in step 1: 0.75, at most 0.6 in the baseline")
    assert parting.excess == pytest.approx(1.5)


class OnePass(Log):
    """A log that notes topics that are read once more, by themselves."""

    def __init__(self, *given):
        super().__init__(*given)
        self.again = []

    def window(self, topic, start, end):
        self.again.append(topic)
        return super().window(topic, start, end)


def test_a_trace_is_made_in_one_pass_through_the_log(tmp_path, motion, two_steps, robot):
    path = run_scenario(two_steps, tmp_path, simulate=motion(duration=2.2), robot=robot).log
    log = OnePass(path, path.read_bytes())
    assert Trace.of(log).labels
    assert not log.again
