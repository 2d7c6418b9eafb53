"""The state at a push by a run's log, and its one-step limit by trying out."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.recovery.capturability import swing_box
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.groups.gait import push_time
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.walk import resolve
from surefoot.scenarios.show.logview import LogView
from surefoot.studies.campaigns import capturability
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.capturability import Limits, _moment, moment_of
from surefoot.studies.campaigns.points import cells

pytestmark = pytest.mark.unit

SPEC = """
scenario: walk-level
set:
  fidelity: pendulum
  rates.control: 100
  gait.steps: 2
  gait.initial_stand: 0.2
  gait.single_support: 0.5
  pushes: [{step: 1, phase: PHASE, fraction: FRACTION, duration: 0.1, impulse: 0.01, direction: 0.5}]
bisect: {key: pushes.0.impulse, low: 0.01, high: 0.02, ratio: 1.5}
"""


def first_log(folder, phase="single", fraction=0.5, impulse=0.01):
    path = folder / "spec.yaml"
    path.write_text(SPEC.replace("PHASE", phase).replace("FRACTION", str(fraction)))
    (cell, *_) = cells(read_campaign(str(path)))
    point = cell.point(0, {"pushes.0.impulse": impulse})
    return run_scenario(read_scenario(*point.base.written, point.settings), folder / "run").log


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """The log of a run that is pushed in the middle of its first swing, of the left foot."""
    return first_log(tmp_path_factory.mktemp("single"))


def test_a_run_tells_the_moment_of_its_push(log):
    moment = moment_of(log, 0)
    planned = moment.ways[0]
    assert planned.landing == pytest.approx(0.25)
    assert min(way.landing for way in moment.ways) == pytest.approx(PlannerParameters().recovery.least_single)
    assert moment.omega == pytest.approx(math.sqrt(GRAVITY / load(log).gait.com_height))
    assert (moment.duration, moment.direction) == (0.1, 0.5)
    assert len(planned.supports[1][0]) == 4
    assert all(moment.limit(way) > 0.1 for way in (0.0, 1.5, 3.0, -1.5))
    # The left foot swings: a step to that side reaches further than the edge of the sole does on the other.
    assert moment.limit(math.pi / 2) > 1.2 * moment.limit(-math.pi / 2)


def test_the_state_is_that_before_the_push_which_need_not_begin_with_a_tick(tmp_path, monkeypatch):
    begun = []
    monkeypatch.setattr(capturability, "swing_box", lambda *given: begun.append(given) or swing_box(*given))
    logs = []
    for name, impulse in (("light", 0.01), ("heavy", 0.3)):
        (tmp_path / name).mkdir()
        logs.append(first_log(tmp_path / name, fraction=0.514, impulse=impulse))
    heavy, light = (moment_of(one, 0) for one in reversed(logs))
    assert heavy.dcm == pytest.approx(light.dcm, abs=1e-9)
    assert heavy.limit(0.0) == pytest.approx(light.limit(0.0))
    view, begin = LogView(read(logs[0])), push_time(resolve(load(logs[0])).gait, load(logs[0]).pushes[0])
    com, speed = (view.field("/truth", name, 3)[:, 0] for name in ("com", "com_velocity"))
    truth = np.interp(begin, view.time("/truth"), com + speed / light.omega)
    assert light.dcm[0] == pytest.approx(truth, abs=5e-4)
    left, right = (view.field("/truth", f"{side}_sole", 7)[:, 0] for side in ("left", "right"))
    assert begun[-1][0][0] == pytest.approx(np.interp(begin, view.time("/truth"), left - right), abs=1e-3)
    assert begun[-1][1][0] > 0.5


def adapting(log, adaptation):
    """The moment of a run, had its steps been adapted so."""
    scenario = load(log, {"planner.step_adaptation": adaptation.value})
    walk = resolve(scenario)
    return _moment(scenario, walk, LogView(read(log)), 0)


def test_each_thing_that_may_be_adapted_widens_the_limit(log):
    limits = [[adapting(log, one).limit(way) for way in (0.0, 1.57, 3.14, -1.57)] for one in StepAdaptation]
    assert (np.diff(limits, axis=0) >= 0.0).all()
    none, location, timing, crossing = np.array(limits)
    assert (location[:3] > 1.2 * none[:3]).all()
    assert timing[1] > 1.02 * location[1]
    assert crossing[3] > 1.2 * timing[3]  # to the right, over the foot that stands


def survives(moment, sole, feet, legs, impulses, direction, time):
    """Return true if a simulated pendulum that is pushed comes over its feet by some constant CoP and some landing."""
    (stance, foot, speed), half = feet, np.array(sole) / 2.0
    signs = np.array([(x, y) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    cops = stance + half * np.array([(x, y) for x in np.linspace(-1, 1, 5) for y in np.linspace(-1, 1, 5)])
    jump = impulses[:, None, None] * np.array([math.cos(direction), math.sin(direction)])
    dcm, step = np.broadcast_to(moment.dcm, (len(impulses), len(cops), 2)), 5e-4
    for tick in range(round(time / step)):
        share = moment.duration if tick * step < moment.duration - 1e-9 else math.inf
        dcm = dcm + step * (moment.omega * (dcm - cops) + jump / share / moment.omega)
    end, done = dcm.reshape(-1, 2), np.zeros(dcm.shape[:2], dtype=bool).reshape(-1)
    reach = swing_box(foot, speed, np.array(legs.acceleration), time)
    for box in legs.allowed(1.0, ANYWHERE, True):
        low, high = np.maximum(reach[0] - stance, box[0]), np.minimum(reach[1] - stance, box[1])
        if (low > high).any():
            continue
        for place in (low + (high - low) * np.array([(x, y) for x in (0, 0.5, 1) for y in (0, 0.5, 1)])).tolist():
            hull = ConvexHull(stance + np.vstack([half * signs, place + half * signs])).equations
            done |= (end @ hull[:, :2].T + hull[:, 2] <= 1e-9).all(axis=1)
    return done.reshape(dcm.shape[:2]).any(axis=1)


@pytest.mark.parametrize("direction", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_the_limit_is_what_trying_out_on_a_pendulum_finds(log, direction):
    """No time, place and centre of pressure that was tried survives more than a spacing of times costs."""
    moment, walk, data = moment_of(log, 0), resolve(load(log)), LogView(read(log))
    row = int(np.searchsorted(data.time("/truth"), push_time(walk.gait, load(log).pushes[0]) + 1e-6)) - 1
    right, left = (data.field("/truth", f"{side}_sole", 7)[row, :2] for side in ("right", "left"))
    feet = right, left, data.field("/reference", "swing_velocity", 3)[row, :2]
    limit = moment.limit(direction)
    impulses = limit * np.array([0.5, 0.96, 1.03, 1.1, 1.3])
    times = np.linspace(PlannerParameters().recovery.least_single, 0.44, 52)
    done = np.any([survives(moment, walk.sole, feet, walk.legs, impulses, direction, time) for time in times], axis=0)
    assert done.tolist() == [True, True, False, False, False]


def test_the_state_is_the_same_for_every_direction_and_logs_without_one_are_passed_over(tmp_path):
    log = first_log(tmp_path, "double")
    way, other = "pushes.0.direction", "gait.steps"
    logs = [({way: 0.0, other: 2}, tmp_path / "gone.mcap"), ({way: 1.0, other: 2}, log)]
    limits = Limits("pushes.0.impulse", logs, way)
    moment = moment_of(log, 0)
    (_, (begin, lift)), (_, (_, land)) = moment.ways[0].supports
    assert (begin, land - lift) == (0.0, pytest.approx(0.5))
    assert lift > 0.0
    assert limits.at({way: 0.0, other: 2}, 0.3) == moment.limit(0.3)
    assert limits.at({way: 0.0, other: 2}, None) == moment.limit(0.5)
    assert limits.at({way: 0.0, other: 3}, 0.3) is None
    assert moment_of(log, 1) is None
    assert not Limits("pushes.0.duration", logs, way)
