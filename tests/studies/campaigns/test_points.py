"""Points that are run: every combination once, values drawn apart from each other, searches that find thresholds."""

import shlex

import numpy as np
import pytest

from surefoot.scenarios.many.points import Record, Threshold
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells, draw_value
from surefoot.studies.campaigns.spec import Draw

pytestmark = pytest.mark.unit


@pytest.fixture
def campaign(tmp_path):
    def make(text, name="c.yaml"):
        (tmp_path / name).write_text(text)
        return read_campaign(str(tmp_path / name))

    return make


SHORT = {"fidelity": "pendulum", "gait.steps": 1, "gait.single_support": 0.6, "gait.initial_stand": 0.2,
         "rates.control": 100}  # fmt: skip


def walked(cell, passes=lambda point: True, status="fail"):
    """Points of a cell and what its search finds, when runs end so."""
    search, points = cell.search(), []
    try:
        point = next(search)
        while True:
            points.append(point)
            point = search.send(Record(point.id, "pass" if passes(point) else status))
    except StopIteration as end:
        return points, end.value


def test_every_combination_has_every_seed_once(campaign):
    made = campaign(
        "scenario: walk-level\nset: {gait.turn: 0.1}\ngrid: {gait.steps: [3, 4], errors.friction: [0, 1]}\nseeds: 2"
    )
    points = [point for cell in cells(made) for point in walked(cell)[0]]
    found = [(p.settings["gait.steps"], p.settings["errors.friction"], p.settings["seed"]) for p in points]
    assert found == [(s, f, n) for s in (3, 4) for f in (0, 1) for n in (0, 1)]
    assert len({point.id for point in points}) == len({point.name for point in points}) == 8
    assert all(point.settings["gait.turn"] == 0.1 for point in points)
    assert (
        points[0].command
        == "surefoot run walk-level --set gait.turn=0.1 --set gait.steps=3 --set errors.friction=0 --set seed=0"
    )


MINE = "gait: {steps: 1, single_support: 0.6}\nfidelity: pendulum\nrates: {control: 100}\n"


@pytest.mark.parametrize("name", ["walk-level", "mine.yaml", "mine.yml", "it's mine/mine.yaml", "log.mcap"])
@pytest.mark.parametrize("place", ["c.yaml", "below/c.yaml"])
def test_the_command_makes_the_run_wherever_its_scenario_is(tmp_path, monkeypatch, name, place):
    monkeypatch.chdir(tmp_path)
    spec, scenario = tmp_path / place, (tmp_path / place).parent / name
    scenario.parent.mkdir(parents=True, exist_ok=True)
    if name.endswith(".mcap"):
        run_scenario(load("paper-walk", {**SHORT, "gait.turn": 0.1}), tmp_path / "run").log.rename(scenario)
    elif name != "walk-level":
        scenario.write_text(MINE)
    spec.write_text(f'scenario: "{name}"\nset: {{gait.step_length: 0.11}}\n')
    (cell,) = cells(read_campaign(place))
    (point,), _ = walked(cell)
    program, verb, reference, *settings = shlex.split(point.command)
    assert (program, verb, settings[::2]) == ("surefoot", "run", ["--set"] * 2)
    assert load(reference, settings[1::2]) == read_scenario(*point.base.written, point.settings)


def test_the_same_run_has_the_same_name_and_another_scenario_another(campaign):
    def first(text):
        return walked(next(iter(cells(campaign(text)))))[0][0]

    assert first("scenario: walk-level").id == first("scenario: walk-level\nseeds: 5").id
    assert first("scenario: walk-level").id != first("scenario: diagonal-walk").id
    assert first("scenario: walk-level").id != first("scenario: walk-level\nset: {gait.steps: 3}").id


def test_a_drawn_value_depends_on_key_and_seed_alone(campaign):
    text = "scenario: walk-level\nseed: {}\nseeds: 3\nsample: {{{}terrain.friction: {{uniform: [0.4, 1.2]}}}}"
    draws = [
        [walked(cell)[0][0].settings["terrain.friction"] for cell in cells(campaign(text.format(seed, more)))]
        for seed, more in ((0, ""), (0, "errors.friction: {normal: [0, 1]}, "), (1, ""))
    ]
    assert draws[0] == draws[1] != draws[2]
    assert len(set(draws[0])) == 3


@pytest.mark.parametrize(
    ("draw", "mean", "sd"),
    [
        (Draw(uniform=[0.4, 1.2]), 0.8, 0.8 / np.sqrt(12)),
        (Draw(normal=[2.0, 0.5]), 2.0, 0.5),
        (Draw(choice=[1, 2]), 1.5, 0.5),
    ],
)
def test_distributions_are_those_that_are_stated(draw, mean, sd):
    values = np.array([draw_value(draw, 0, "key", seed) for seed in range(4000)])
    assert abs(values.mean() - mean) < 4 * sd / np.sqrt(4000)
    assert abs(values.std() - sd) < 0.03
    if draw.uniform:
        assert 0.4 <= values.min() < values.max() <= 1.2


def impulse(point):
    return point.settings["errors.friction"]


LADDER = "scenario: walk-level\nbisect: {key: errors.friction, low: 0.1, high: 1.0, ratio: 1.1}\nseeds: 3"


def test_a_ladder_stops_at_its_first_hole(campaign):
    """All smaller rungs must hold: what passes above a failure does not count."""
    (cell,) = cells(campaign(LADDER))
    points, found = walked(cell, lambda p: impulse(p) < 0.2 or impulse(p) > 0.3)
    assert found.side == "inside"
    assert found.value == pytest.approx(0.1 * 1.1**7)
    assert [p.settings["seed"] for p in points] == [0, 1, 2] * 8 + [0]


def test_one_seed_that_falls_decides(campaign):
    (cell,) = cells(campaign(LADDER))
    points, found = walked(cell, lambda p: impulse(p) < 0.15 or p.settings["seed"] != 2)
    assert found.value == pytest.approx(0.1 * 1.1**4)
    assert points[-1].settings["seed"] == 2


@pytest.mark.parametrize(("limit", "found"), [(0.05, Threshold(None, "below")), (9.0, "above")])
def test_a_threshold_outside_the_ladder_is_said_to_be(campaign, limit, found):
    (cell,) = cells(campaign(LADDER))
    _, threshold = walked(cell, lambda p: impulse(p) < limit)
    assert threshold.side == getattr(found, "side", found)
    assert threshold.value is None or 1.0 / 1.1 < threshold.value <= 1.0 + 1e-9


HALVES = "scenario: walk-level\nbisect: {key: errors.friction, low: 0.0, high: 1.0, tolerance: 0.01}\nseeds: 2"


@pytest.mark.parametrize("limit", [0.003, 0.377, 0.999])
@pytest.mark.parametrize("sense", [1, -1])
def test_halving_finds_where_passing_ends(campaign, limit, sense):
    (cell,) = cells(campaign(HALVES))
    points, found = walked(cell, lambda p: sense * impulse(p) <= sense * limit)
    assert found.side == "inside"
    assert abs(found.value - limit) <= 0.01
    assert sense * found.value <= sense * limit  # the end that was seen to pass
    assert len(points) < 25


def test_halving_says_on_which_side_of_the_range_it_is(campaign):
    (cell,) = cells(campaign(HALVES))
    assert walked(cell, lambda p: True)[1] == Threshold(None, "above")
    assert walked(cell, lambda p: False)[1] == Threshold(None, "below")


def test_the_first_value_that_is_not_refused(campaign):
    made = campaign("scenario: walk-level\nfirst: {gait.com_height: [1.0, 0.9, 0.8]}")
    (cell,) = cells(made)
    points, _ = walked(cell, lambda p: p.settings["gait.com_height"] < 0.95, "refused")
    assert [p.settings["gait.com_height"] for p in points] == [1.0, 0.9]
    points, _ = walked(cell, lambda p: False, "refused")
    assert len(points) == 3
    points, _ = walked(cell, lambda p: False, "fail")  # a fall is an answer
    assert len(points) == 1


def test_folders_have_names_that_file_systems_take(campaign):
    made = campaign(
        "scenario: walk-level\ngrid: {a: {'x/../: y': {gait.steps: 3}, " + "z" * 300 + ": {gait.steps: 4}}}"
    )
    names = [walked(cell)[0][0].name for cell in cells(made)]
    assert all(len(name) <= 120 and "/" not in name and ":" not in name for name in names)


@pytest.mark.parametrize(
    "grid",
    [
        pytest.param("errors.friction: [0.1, 0.1000000001]", id="last digits"),
        pytest.param("a: {x y: {gait.steps: 3}, x_y: {gait.steps: 4}, x/y: {gait.steps: 5}}", id="replaced"),
        pytest.param("a: {ä: {gait.steps: 3}, ö: {gait.steps: 4}, 高: {gait.steps: 5}}", id="letters"),
        pytest.param(
            "a: {'1,b=2': {gait.steps: 3}, '1': {gait.steps: 4}}, b: {'3': {gait.turn: 0}, '2,b=3': {gait.turn: 0.1}}",
            id="separators",
        ),
    ],
)
def test_no_two_runs_have_the_same_folder(campaign, grid):
    made = campaign(f"scenario: walk-level\ngrid: {{{grid}}}")
    points = [walked(cell)[0][0] for cell in cells(made)]
    assert len({point.name for point in points}) == len({point.id for point in points}) == len(points)
    assert all(point.name.isascii() for point in points)
