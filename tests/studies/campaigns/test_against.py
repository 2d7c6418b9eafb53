"""Thresholds held against a table of an earlier time: what has moved is told, and what is worse fails."""

import csv

import pytest
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many.points import Outcome, Threshold
from surefoot.studies.campaigns.against import BASELINE, Table, table
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import Cell, cells

pytestmark = pytest.mark.unit

DIRECTIONS = ("forward", "left", "backward")


@pytest.fixture(scope="module")
def searched():
    campaign = read_campaign("march-ladder", ("direction=[forward, left, backward]", "phase=SS 0.5"))
    found = list(cells(campaign))
    assert all(isinstance(cell, Cell) for cell in found)
    return found


def outcomes(searched, *values):
    given = {None: Threshold(None, "below"), "above": Threshold(None, "above")}
    thresholds = [given.get(value) or Threshold(value, "inside") for value in values]
    return [Outcome(cell, (), found) for cell, found in zip(searched, thresholds, strict=True)]


def written(folder, *rows, heading="direction,phase,threshold [N·s/kg],side,runs"):
    path = folder / "thresholds.csv"
    path.write_text("\n".join((heading, *rows)) + "\n", encoding="utf-8")
    return path


def usual(folder):
    return written(folder, "forward,SS 0.5,0.4,inside,6", "left,SS 0.5,0.25,inside,6", "backward,SS 0.5,0.3,inside,6")


def test_what_moved_is_told_and_the_rest_is_not(searched, tmp_path):
    held = Table(usual(tmp_path)).against(outcomes(searched, 0.4, 0.35, 0.3))
    assert held.means == pytest.approx((0.95 / 3.0, 1.05 / 3.0)) and held.worst == (0.25, 0.3)
    assert not held.worse
    told = list(held.lines())
    assert told[1:] == ["  left, SS 0.5: 0.250 -> 0.350"]


@pytest.mark.parametrize(
    ("now", "worse"),
    [
        ((0.4, 0.25, 0.3), False),
        ((0.4, 0.2, 0.35), False),  # by one step of the search, and the mean is the same
        ((0.4, 0.25, 0.2), True),  # the mean
        ((0.5, 0.1, 0.5), True),  # the least
        ((0.4, None, 0.6), True),
        ((0.4, 0.25, "above"), False),
    ],
)
def test_what_is_worse_is_found(searched, tmp_path, now, worse):
    assert Table(usual(tmp_path)).against(outcomes(searched, *now)).worse is worse


def test_ends_of_a_range_are_read_back(searched, tmp_path):
    path = written(tmp_path, "forward,SS 0.5,,below,2", "left,SS 0.5,,above,2", "backward,SS 0.5,0.3,inside,6")
    held = Table(path).against(outcomes(searched, None, "above", 0.3))
    assert list(held.lines()) == ["mean 0.150 -> 0.150, least 0.000 -> 0.000"] and not held.worse


def test_what_was_above_its_range_and_is_within_is_worse(searched, tmp_path):
    path = written(tmp_path, "forward,SS 0.5,,above,2", "left,SS 0.5,0.25,inside,6", "backward,SS 0.5,0.3,inside,6")
    assert Table(path).against(outcomes(searched, 0.4, 0.25, 0.3)).worse
    assert not Table(path).against(outcomes(searched, "above", 0.25, 0.3)).worse


def test_thresholds_that_the_table_lacks_are_counted(searched, tmp_path):
    path = written(tmp_path, "left,SS 0.5,0.25,inside,6")
    held = Table(path).against(outcomes(searched, 0.4, 0.25, 0.3))
    assert len(held.moved) == 1 and held.missing == 2
    assert list(held.lines())[-1] == "2 thresholds are not in the table"


@pytest.mark.parametrize("text", ["", "direction,phase\nforward,SS 0.5\n", "threshold,side\nmuch,inside\n"])
def test_what_is_no_table_is_refused(tmp_path, text):
    path = tmp_path / "thresholds.csv"
    path.write_text(text)
    with pytest.raises(ScenarioError, match="is no table of thresholds"):
        Table(path)


def test_what_has_nothing_in_common_is_refused(searched, tmp_path):
    path = written(tmp_path, "up,SS 0.5,0.25,inside,6")
    with pytest.raises(ScenarioError, match="give the table of the same campaign"):
        Table(path).against(outcomes(searched, 0.4, 0.25, 0.3))


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["march-ladder", "--against", "none.csv"], "none.csv: cannot be read"),
        (["push-map-pendulum", "--against", BASELINE], "'push-map-pendulum' comes with no table of its thresholds"),
        (["soak", "--against", BASELINE], "searches no thresholds to hold against a table"),
    ],
)
def test_what_cannot_be_held_is_refused_before_anything_runs(words, told):
    done = CliRunner().invoke(app, ["sweep", *words])
    assert isinstance(done.exception, ScenarioError)
    assert told in str(done.exception)


@pytest.mark.parametrize("name", ["march-ladder", "walk-ladder"])
def test_the_stored_table_has_every_threshold_of_its_campaign(name):
    campaign = read_campaign(name)
    held = table(campaign, BASELINE)
    every = [Outcome(cell, (), Threshold(0.3, "inside")) for cell in cells(campaign)]
    assert len(every) == 32
    assert held.against(every).missing == 0


@pytest.mark.parametrize("name", ["march-ladder", "walk-ladder"])
def test_the_stored_table_is_of_a_robot_that_survives_something(name):
    from surefoot.studies.campaigns import against

    path = next((against.Path(against.__file__).parent / "baselines").glob(f"{name}.csv"))
    with path.open(encoding="utf-8", newline="") as file:
        highest = {"above": read_campaign(name).spec.bisect.high}
        values = [float(row["threshold [N·s/kg]"] or highest.get(row["side"], 0.0)) for row in csv.DictReader(file)]
    mean = sum(values) / len(values)
    assert 0.2 < mean < 1.25
    page = (against.Path(__file__).parents[3] / "docs" / "campaigns.md").read_text(encoding="utf-8")
    assert f"| `{name}` | {mean:.2f} | {min(values):.2f} |" in page
