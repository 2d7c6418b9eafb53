"""A policy beside a walk of Surefoot: one campaign, two walkers, and thresholds up to the limit of both."""

import math

import pytest
from matplotlib.projections.polar import PolarAxes
from needs import POLICY
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many.points import Record, Threshold
from surefoot.studies.campaigns.beside import SPEED, WALKER, Beside
from surefoot.studies.campaigns.beside_figure import turned
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import Cell
from surefoot.studies.campaigns.spec import Axis
from surefoot.studies.campaigns.thresholds import Found, compass

pytestmark = pytest.mark.unit


@pytest.fixture
def stander(tmp_path):
    POLICY.or_skip()
    import policies

    return policies.stander(tmp_path / "stander").parent


@pytest.fixture
def laid(stander):
    return read_campaign("march-ladder", beside=Beside(str(stander), "g1"))


def test_both_get_the_same_pushes_and_the_same_velocity(laid):
    combinations = list(laid.combinations())
    assert len(combinations) == 2 * 8 * 4
    by = {name: [keys for labels, keys in combinations if labels[WALKER] == name] for name in ("stander", "g1")}
    for one, other in zip(by["stander"], by["g1"], strict=True):
        assert one.pop("controller.policy").endswith("stander")
        assert one == other
        assert one["commands"] == [{"time": 0.0, "v_x": SPEED}]


def test_without_it_the_campaign_is_as_before(stander):
    alone = read_campaign("march-ladder")
    assert WALKER not in alone.axes and alone.spec.bisect.most is None
    assert alone.spec.set["commands"] == [{"time": 0.0, "march": True}]


def found_by(cell, limit):
    """Threshold of a walker that survives pushes up to a limit, and how many runs it takes."""
    search, runs = cell.search(), 0
    try:
        point = next(search)
        while True:
            runs += 1
            value = point.settings["pushes.0.impulse"]
            point = search.send(Record(point.id, "pass" if value <= limit else "fail"))
    except StopIteration as end:
        return end.value, runs


@pytest.mark.parametrize("limit", [0.4, 1.2, 1.9, 4.0])
def test_the_search_goes_on_to_a_limit_above_its_range(laid, limit):
    labels, keys = next(laid.combinations())
    threshold, runs = found_by(Cell(laid, labels, keys, (0,)), limit)
    assert threshold.side == "inside" and 0.0 <= limit - threshold.value <= 0.075
    assert runs < 12


def test_it_ends_somewhere_and_a_range_that_does_not_go_on_says_so(laid):
    labels, keys = next(laid.combinations())
    assert found_by(Cell(laid, labels, keys, (0,)), 1e6)[0] == Threshold(None, "above")
    alone = read_campaign("march-ladder")
    labels, keys = next(alone.combinations())
    assert found_by(Cell(alone, labels, keys, (0,)), 1.9)[0] == Threshold(None, "above")
    assert found_by(Cell(alone, labels, keys, (0,)), 0.01)[0] == Threshold(None, "below")


def test_the_figure_has_a_curve_for_each_and_a_panel_for_each_phase(laid):
    found, want = [], {"stander": 1.5, "g1": 0.6}
    for labels, _ in laid.combinations():
        found.append(Found(labels, Threshold(want[labels[WALKER]], "inside"), (0.05, 1.25)))
    axes = [Axis(name, tuple(one.label for one in settings)) for name, settings in laid.axes.items()]
    rows, drawn_axes = turned(laid, found, axes)
    assert [axis.name for axis in drawn_axes] == ["phase", "pushes.0.direction", WALKER]
    figure = compass(rows, drawn_axes, "pushes.0.impulse", lambda *_: None)
    roses = [one for one in figure.axes if isinstance(one, PolarAxes)]
    assert len(roses) == 4
    for rose in roses:
        curves = {line.get_label(): line.get_ydata() for line in rose.lines if line.get_label() in want}
        assert {name: set(values) for name, values in curves.items()} == {name: {value} for name, value in want.items()}
        (angles, *_) = (line.get_xdata() for line in rose.lines if line.get_label() == "g1")
        assert {round(math.degrees(angle)) % 360 for angle in angles} == set(range(0, 360, 45))


def test_campaigns_of_one_walker_are_drawn_as_before():
    alone = read_campaign("march-ladder")
    axes = [Axis(name, tuple(one.label for one in settings)) for name, settings in alone.axes.items()]
    assert turned(alone, [], axes) is None


@pytest.mark.parametrize(
    ("campaign", "told"),
    [("random-pushes", "searches no thresholds"), ("march-ladder", "both are called 'g1'")],
)
def test_what_cannot_be_laid_beside_is_refused(campaign, told, tmp_path):
    (tmp_path / "g1").mkdir()
    with pytest.raises(ScenarioError, match=told):
        read_campaign(campaign, beside=Beside(str(tmp_path / "g1"), "g1"))


@pytest.mark.parametrize("words", [["--beside", "g1"], ["--beside", "g1", "--policy", "x", "--against", "baseline"]])
def test_it_is_an_option_beside_a_policy_and_of_no_stored_table(words, tmp_path):
    done = CliRunner().invoke(app, ["sweep", "march-ladder", *words, "--out", str(tmp_path / "out")])
    assert isinstance(done.exception, ScenarioError) and not (tmp_path / "out").exists()


def test_a_policy_that_is_not_there_is_refused_before_a_run(tmp_path):
    words = ["--policy", str(tmp_path / "no.yaml"), "--beside", "g1", "--out", str(tmp_path / "o")]
    done = CliRunner().invoke(app, ["sweep", "march-ladder", *words])
    assert isinstance(done.exception, ScenarioError)
    assert not (tmp_path / "o").exists()
