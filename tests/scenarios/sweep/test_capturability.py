"""The one-step limit of a push: closed forms along a line, and what a run's log tells of its moment."""

import math
from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.sweep.capturability import Limits, Moment, landing_points, moment_of
from surefoot.scenarios.sweep.points import cells
from surefoot.scenarios.sweep.spec import read_campaign

pytestmark = pytest.mark.unit

OMEGA, LANDING, HALF, REACH = 3.2, 0.4, 0.11, 0.46
AHEAD = 0.05
WIDE = 10.0
"""So wide that nothing sideways binds [m]."""


def strip(low, high):
    return np.array([(x, y) for x in (low, high) for y in (-WIDE, WIDE)])


def line(**changes):
    """A moment in which all that matters lies along x."""
    stance, span = strip(-HALF, HALF), strip(-REACH - HALF, REACH + HALF)
    moment = Moment(np.array([AHEAD, 0.0]), OMEGA, ((stance, (0.0, LANDING)),), span, 1e-6)
    return replace(moment, **changes)


def edge(decay, reach=REACH):
    """Where the DCM may be at most now, so that the landing still catches it [m]."""
    return HALF * (1.0 - decay) + decay * (reach + HALF)


def test_limit_of_a_hit_is_what_lies_between_the_dcm_and_the_edge():
    decay = math.exp(-OMEGA * LANDING)
    assert line().limit(0.0) == pytest.approx(OMEGA * (edge(decay) - AHEAD), rel=1e-5)
    assert line().limit(math.pi) == pytest.approx(OMEGA * (edge(decay) + AHEAD), rel=1e-5)


@pytest.mark.parametrize("duration", [0.1, 0.3, 0.8])
def test_limit_of_a_long_push_is_higher_by_what_diverges_less(duration):
    """Also of one that goes on after the landing."""
    spread = OMEGA * duration
    slower = spread / (1.0 - math.exp(-spread))
    assert line(duration=duration).limit(0.0) == pytest.approx(slower * line().limit(0.0), rel=1e-5)


def test_whoever_stands_has_the_soles_alone():
    standing = line(supports=(), landed=strip(-HALF, HALF))
    assert standing.limit(0.0) == pytest.approx(OMEGA * (HALF - AHEAD), rel=1e-5)


def test_double_support_counts_for_as_long_as_it_lasts():
    lift, back = 0.1, -0.5
    supports = ((strip(back, HALF), (0.0, lift)), (strip(-HALF, HALF), (lift, LANDING)))
    early, decay = math.exp(-OMEGA * lift), math.exp(-OMEGA * LANDING)
    behind = back * (1 - early) - HALF * (early - decay) - decay * (REACH + HALF)
    assert line(supports=supports).limit(math.pi) == pytest.approx(OMEGA * (AHEAD - behind), rel=1e-5)
    assert line(supports=supports).limit(0.0) == pytest.approx(line().limit(0.0), rel=1e-5)


def test_nothing_is_survived_by_what_falls_already():
    assert line(dcm=np.array([2.0, 0.0])).limit(0.0) == 0.0


def test_a_push_aslant_is_bound_by_whichever_side_comes_first():
    narrow = np.array([(x, y) for x in (-HALF, HALF) for y in (-HALF, HALF)])
    square = line(dcm=np.zeros(2), supports=(), landed=narrow)
    assert square.limit(math.pi / 4) == pytest.approx(math.sqrt(2.0) * square.limit(0.0), rel=1e-5)


def test_landing_turns_with_the_stance_foot():
    reach = (np.array([-0.3, 0.1]), np.array([0.3, 0.4]))
    stance = np.array([1.0, 2.0, math.pi / 2])
    points = landing_points(stance, np.array([[1.0, 2.0]]), (0.1, 0.05), reach)
    assert points[:, 0].min() == pytest.approx(1.0 - 0.45)  # the left of whoever faces left is behind
    assert points[:, 1].max() == pytest.approx(2.0 + 0.4)


SPEC = """
scenario: walk
set:
  fidelity: pendulum
  rates.control: 100
  gait.steps: 2
  gait.initial_stand: 0.2
  gait.single_support: 0.5
  pushes: [{step: 1, phase: PHASE, fraction: 0.5, duration: 0.1, impulse: 0.01, direction: 0.5}]
bisect: {key: pushes.0.impulse, low: 0.01, high: 0.02, ratio: 1.5}
"""


def first_log(folder, phase="single"):
    path = folder / "spec.yaml"
    path.write_text(SPEC.replace("PHASE", phase))
    (cell, *_) = cells(read_campaign(str(path)))
    point = cell.point(0, {"pushes.0.impulse": 0.01})
    return run_scenario(read_scenario(*point.base.written, point.settings), folder / "run").log


def test_a_run_tells_the_moment_of_its_push(tmp_path):
    log = first_log(tmp_path)
    moment = moment_of(log, 0)
    assert moment.landing == pytest.approx(0.25)
    assert moment.omega == pytest.approx(math.sqrt(GRAVITY / load(log).gait.com_height))
    assert (moment.duration, moment.direction) == (0.1, 0.5)
    assert len(moment.supports[1][0]) == 4
    assert all(moment.limit(way) > 0.1 for way in (0.0, 1.5, 3.0, -1.5))
    # The left foot swings: a step to that side reaches further than the edge of the sole does on the other.
    assert moment.limit(math.pi / 2) > 1.2 * moment.limit(-math.pi / 2)


def test_the_state_is_the_same_for_every_direction_and_logs_without_one_are_passed_over(tmp_path):
    log = first_log(tmp_path, "double")
    way, other = "pushes.0.direction", "gait.steps"
    logs = [({way: 0.0, other: 2}, tmp_path / "gone.mcap"), ({way: 1.0, other: 2}, log)]
    limits = Limits("pushes.0.impulse", logs, way)
    moment = moment_of(log, 0)
    (_, (begin, lift)), (_, (_, land)) = moment.supports
    assert (begin, land - lift) == (0.0, pytest.approx(0.5))
    assert lift > 0.0
    assert limits.at({way: 0.0, other: 2}, 0.3) == moment.limit(0.3)
    assert limits.at({way: 0.0, other: 2}, None) == moment.limit(0.5)
    assert limits.at({way: 0.0, other: 3}, 0.3) is None
    assert moment_of(log, 1) is None
    assert not Limits("pushes.0.duration", logs, way)
