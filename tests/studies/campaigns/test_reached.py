"""Rates of each law or gain of a campaign with intervals, and tests of pairs that had the same pushes."""

import json
from dataclasses import replace

import pytest

from surefoot.maths.chance import mcnemar, wilson
from surefoot.scenarios.many.journal import Journal, MadeOf, outcome_of
from surefoot.scenarios.many.points import Record
from surefoot.scenarios.many.slots import run_cells
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells
from surefoot.studies.campaigns.reached import pair_tests, reached
from surefoot.studies.campaigns.sweep import Swept

pytestmark = pytest.mark.unit

LAWS = """
scenario: walk-level
set: {fidelity: pendulum, pushes: [{time: 1.0, impulse: 0.1}], criteria: {fell: false}}
grid:
  law: {soft: {pendulum.feedback: 2.0}, hard: {pendulum.feedback: 3.0}, other: {pendulum.feedback: 4.0}}
sample: {pushes.0.impulse: {uniform: [0.1, 0.5]}}
seeds: 20
"""

SEARCH = """
scenario: walk-level
set: {fidelity: pendulum, pushes: [{time: 1.0, impulse: 0.1, direction: 0.0}], criteria: {fell: false}}
grid:
  law: {soft: {pendulum.feedback: 2.0}, hard: {pendulum.feedback: 3.0}}
  pushes.0.direction: [0.0, 1.0, 2.0, 3.0, -1.0, -2.0]
bisect: {key: pushes.0.impulse, low: 0.0, high: 1.0, tolerance: 0.01}
"""


class Ruled:
    """A worker whose runs pass by a rule; each measures something else, or all the same."""

    def __init__(self, rule, alike):
        self._rule, self._alike = rule, alike

    def __call__(self, point):
        status = "pass" if self._rule(point) else "fail"
        speed = 1.0 if self._alike else float(int(point.id[:6], 16))
        record = Record(point.id, status, ("fell is true",), {"fell": status == "fail", "speed_mean": speed})
        return replace(record, made_by=MadeOf().of(point))

    def close(self):
        pass


def swept(folder, text, rule, alike=False):
    (folder / "laws.yaml").write_text(text)
    campaign = read_campaign(str(folder / "laws.yaml"))
    every = tuple(cells(campaign))
    with Journal(folder / "out") as journal:
        run_cells(every, journal, [Ruled(rule, alike)])
        return Swept(campaign, folder, tuple(outcome_of(cell, journal) for cell in every))


def by_law(point):
    """Each law bears pushes up to its own, which leaves many pairs of the same end."""
    return point.settings["pushes.0.impulse"] < {2.0: 0.15, 3.0: 0.45, 4.0: 0.46}[point.settings["pendulum.feedback"]]


def test_each_law_has_its_rate_with_its_interval_and_no_rate_stands_over_all(tmp_path):
    found = swept(tmp_path, LAWS, by_law)
    soft, hard, _ = reached(found)
    passed = sum(by_law(point) for point, _ in found.runs if point.labels["law"] == "soft")
    assert (soft.axis, soft.value, soft.passed, soft.judged) == ("law", "soft", passed, 20)
    assert soft.rate == wilson(passed, 20)
    assert soft.rate.high < hard.rate.low
    lines = list(found.lines())
    assert not any("success rate" in line for line in lines)
    (row,) = (line for line in lines if line.startswith("soft  "))
    assert row.split() == ["soft", str(passed), "of", "20", f"{5 * passed:.1f}", *soft.rate.between.split()]


def test_pairs_of_the_same_push_tell_laws_apart_and_hold_for_all_tests_together(tmp_path):
    found = swept(tmp_path, LAWS, by_law)
    tests = {(one.one, one.other): one for one in pair_tests(found)}
    assert len(tests) == 3
    apart = tests["soft", "hard"]
    lost = sum(by_law(one) and not by_law(other) for one, other in pairs(found, "soft", "hard"))
    gained = sum(not by_law(one) and by_law(other) for one, other in pairs(found, "soft", "hard"))
    assert (apart.pairs, apart.only_one, apart.only_other) == (20, lost, gained)
    assert mcnemar(lost, gained) <= apart.chance <= 3 * mcnemar(lost, gained)
    assert apart.differs
    assert not tests["hard", "other"].differs
    assert tests["hard", "other"].chance == 1.0
    assert any(line.startswith("soft and hard differ: 0 of 20 pairs for the one") for line in found.lines())


def pairs(found, one, other):
    points = {(point.labels["law"], point.labels["seed"]): point for point, _ in found.runs}
    return [(points[one, seed], points[other, seed]) for seed in range(20)]


def test_laws_that_do_the_same_are_never_said_to_differ(tmp_path):
    found = swept(tmp_path, LAWS, lambda point: point.settings["pushes.0.impulse"] < 0.3)
    assert all((one.chance, one.differs) == (1.0, False) for one in pair_tests(found))


def test_an_axis_that_is_the_push_itself_has_rates_and_no_test(tmp_path):
    text = LAWS.replace("sample: {pushes.0.impulse: {uniform: [0.1, 0.5]}}", "").replace(
        "grid:", "grid:\n  pushes.0.impulse: [0.1, 0.3, 0.5]"
    )
    found = swept(tmp_path, text.replace("seeds: 20", "seeds: 3"), by_law)
    assert {one.axis for one in reached(found)} == {"pushes.0.impulse", "law"}
    assert {one.axis for one in pair_tests(found)} == {"law"}
    assert {one.pairs for one in pair_tests(found)} == {9}


def test_seeds_that_do_nothing_make_no_pairs(tmp_path):
    text = LAWS.replace("sample: {pushes.0.impulse: {uniform: [0.1, 0.5]}}", "")
    found = swept(tmp_path, text, lambda point: point.settings["pendulum.feedback"] > 2.5, alike=True)
    assert {one.judged for one in reached(found)} == {1}
    assert {one.pairs for one in pair_tests(found)} == {1}


def test_thresholds_of_laws_are_told_by_their_mean_and_by_pairs_of_the_same_direction(tmp_path):
    def bears(point):
        most = 0.3 + 0.05 * abs(point.settings["pushes.0.direction"])
        return point.settings["pushes.0.impulse"] < most + (0.1 if point.settings["pendulum.feedback"] > 2.5 else 0.0)

    found = swept(tmp_path, SEARCH, bears)
    soft, hard = (one for one in reached(found) if one.axis == "law")
    assert (soft.judged, soft.rate) == (6, None)
    assert soft.mean.low < 0.375 < soft.mean.high
    (test,) = pair_tests(found)
    assert (test.axis, test.pairs, test.only_other) == ("law", 6, 6)
    assert test.difference.low < 0.1 < test.difference.high
    assert test.difference.high - test.difference.low < 0.02  # between directions they differ by 0.15
    assert hard.mean.value - soft.mean.value == pytest.approx(0.1, abs=0.01)


def test_the_object_of_a_campaign_has_both(tmp_path):
    told = json.loads(json.dumps(swept(tmp_path, LAWS, by_law).to_json(), allow_nan=False))
    assert [one["value"] for one in told["reached"]] == ["soft", "hard", "other"]
    assert told["reached"][0]["rate"]["low"] < told["reached"][0]["rate"]["rate"]
    (first,) = (one for one in told["tests"] if (one["one"], one["other"]) == ("soft", "hard"))
    assert first["differs"] is True
    assert first["pairs"] == 20
