"""The one-step limit of a push: closed forms along a line, and what a run's log tells of its moment."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.gait import push_time
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.walk import resolve
from surefoot.scenarios.show.logview import LogView
from surefoot.scenarios.study.campaigns import capturability
from surefoot.scenarios.study.campaigns.campaign import read_campaign
from surefoot.scenarios.study.campaigns.capturability import (
    Limits,
    Moment,
    Way,
    _moment,
    landing_points,
    moment_of,
    swing_box,
)
from surefoot.scenarios.study.campaigns.points import cells

pytestmark = pytest.mark.unit

OMEGA, LANDING, HALF, REACH = 3.2, 0.4, 0.11, 0.46
AHEAD = 0.05
WIDE = 10.0
"""So wide that nothing sideways binds [m]."""


def strip(low, high):
    return np.array([(x, y) for x in (low, high) for y in (-WIDE, WIDE)])


STANCE = strip(-HALF, HALF)
AS_PLANNED = Way(((STANCE, (0.0, LANDING)),), strip(-REACH - HALF, REACH + HALF))


def line(*ways, **changes):
    """A moment in which all that matters lies along x."""
    return replace(Moment(np.array([AHEAD, 0.0]), OMEGA, ways or (AS_PLANNED,), 1e-6), **changes)


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
    standing = line(Way((), STANCE))
    assert standing.limit(0.0) == pytest.approx(OMEGA * (HALF - AHEAD), rel=1e-5)


def test_double_support_counts_for_as_long_as_it_lasts():
    lift, back = 0.1, -0.5
    supports = ((strip(back, HALF), (0.0, lift)), (strip(-HALF, HALF), (lift, LANDING)))
    early, decay = math.exp(-OMEGA * lift), math.exp(-OMEGA * LANDING)
    behind = back * (1 - early) - HALF * (early - decay) - decay * (REACH + HALF)
    both = line(replace(AS_PLANNED, supports=supports))
    assert both.limit(math.pi) == pytest.approx(OMEGA * (AHEAD - behind), rel=1e-5)
    assert both.limit(0.0) == pytest.approx(line().limit(0.0), rel=1e-5)


def test_nothing_is_survived_by_what_falls_already():
    assert line(dcm=np.array([2.0, 0.0])).limit(0.0) == 0.0


def test_a_push_aslant_is_bound_by_whichever_side_comes_first():
    narrow = np.array([(x, y) for x in (-HALF, HALF) for y in (-HALF, HALF)])
    square = line(Way((), narrow), dcm=np.zeros(2))
    assert square.limit(math.pi / 4) == pytest.approx(math.sqrt(2.0) * square.limit(0.0), rel=1e-5)


def test_the_best_way_to_land_counts_in_each_direction():
    sooner = Way(((STANCE, (0.0, 0.2)),), strip(-0.1, REACH + HALF))
    both = line(AS_PLANNED, sooner)
    assert both.limit(0.0) == line(sooner).limit(0.0) > line().limit(0.0)
    assert both.limit(math.pi) == line().limit(math.pi) > line(sooner).limit(math.pi)


def test_a_foot_is_where_full_acceleration_and_full_braking_bring_it():
    """By trying out when to brake, also with a speed that cannot be lost in time."""
    most, time, ends = 5.0, 0.4, []
    for speed in (0.0, 0.8, -1.5):
        for way in (-1.0, 1.0):
            switch = np.linspace(0.0, time, 4001)
            final = speed + way * most * (2.0 * switch - time)
            top = speed * switch + 0.5 * way * most * switch**2
            rest = time - switch
            place = top + (speed + way * most * switch) * rest - 0.5 * way * most * rest**2
            ends.append(place[np.argmin(np.abs(final))])
        found = swing_box(np.zeros(2), np.full(2, speed), np.full(2, most), time)
        assert (found[0][0], found[1][1]) == pytest.approx(tuple(ends[-2:]), abs=1e-3)
    low, high = swing_box(np.zeros(2), np.full(2, 9.0), np.full(2, most), time)
    assert (low == high).all()


def test_the_limit_is_the_edge_of_the_sum_of_all_polygons():
    """Aslant ones, of some points within them, by the hull of all sums of their corners."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        hulls = [rng.normal(size=(count, 2)) for count in (2, 3, 5)]
        supports = tuple((hull, (0.1 * i, 0.1 * (i + 1))) for i, hull in enumerate(hulls[:2]))
        way = Way(supports, hulls[2])
        sums = [sum(corners) for corners in itertools.product(*way.summands(OMEGA))]
        edges = ConvexHull(sums).equations
        dcm, angle = np.mean(sums, axis=0), rng.uniform(-math.pi, math.pi)
        along = edges[:, :2] @ (math.cos(angle), math.sin(angle))
        room = -(edges[:, :2] @ dcm + edges[:, 2])
        wanted = OMEGA * np.min(room[along > 0.0] / along[along > 0.0])
        assert Moment(dcm, OMEGA, (way,), 1e-6).limit(angle) == pytest.approx(wanted, rel=1e-5)


def test_landing_turns_with_the_stance_foot():
    reach = (np.array([-0.3, 0.1]), np.array([0.3, 0.4]))
    stance = np.array([1.0, 2.0, math.pi / 2])
    points = landing_points(stance, (0.1, 0.05), reach)
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
    """Of a run that is pushed in the middle of its first swing, of the left foot."""
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
    """Whether a simulated pendulum that is pushed comes over its feet by some constant CoP and some landing."""
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
    """Of all times, places and centres of pressure tried none survives more, and some as much."""
    moment, walk, data = moment_of(log, 0), resolve(load(log)), LogView(read(log))
    row = int(np.searchsorted(data.time("/truth"), push_time(walk.gait, load(log).pushes[0]) + 1e-6)) - 1
    right, left = (data.field("/truth", f"{side}_sole", 7)[row, :2] for side in ("right", "left"))
    feet = right, left, data.field("/reference", "swing_velocity", 3)[row, :2]
    limit = moment.limit(direction)
    impulses = limit * np.array([0.5, 0.96, 1.005, 1.1, 1.3])
    times = np.linspace(PlannerParameters().recovery.least_single, 0.44, 15)
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
