"""The page of a campaign: its numbers are those of the runs, its links lead to logs, and nothing breaks it."""

import csv
import io
import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from html import unescape
from html.parser import HTMLParser
from urllib.parse import unquote

import pytest

from surefoot.maths.chance import wilson
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many.engine import LocalWorker
from surefoot.scenarios.many.journal import Journal, MadeOf, outcome_of
from surefoot.scenarios.many.points import Record
from surefoot.scenarios.many.slots import run_cells
from surefoot.studies.campaigns import report
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells
from surefoot.studies.campaigns.sweep import PAGE, Swept, write

pytestmark = pytest.mark.unit


class Page(HTMLParser):
    """Collects what a page asks for, its links, its anchors and the cells of its tables."""

    def __init__(self, text):
        super().__init__()
        self.asked, self.links, self.rows, self.table, self.within = [], [], {}, "", False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        if tag == "table":
            self.table = found["id"]
        elif tag == "tr":
            self.rows.setdefault(self.table, []).append([])
        elif tag in ("td", "th"):
            self.rows[self.table][-1].append("")
            self.within = True
        elif tag == "a":
            self.links.append(found["href"])
        self.asked += [
            value
            for name, value in attributes
            if name in ("src", "href", "xlink:href", "data") and tag != "a" and not value.startswith("#")
        ]

    def handle_data(self, data):
        if self.within:
            self.rows[self.table][-1][-1] += data

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self.within = False


@dataclass
class Ruled:
    """A worker whose runs end by a rule: from a point to a record."""

    rule: Callable

    def __call__(self, point):
        return replace(self.rule(point), made_by=MadeOf().of(point))

    def close(self):
        pass


def swept(folder, text, rule):
    """A campaign whose runs end by a rule; of which none has a result yet, where that is None."""
    (folder / "spec.yaml").write_text(text)
    campaign = read_campaign(str(folder / "spec.yaml"))
    every = tuple(cells(campaign))
    with Journal(folder / "journal") as journal:
        if rule is not None:
            run_cells(every, journal, [Ruled(rule)])
        return Swept(campaign, folder, tuple(outcome_of(cell, journal) for cell in every))


def passed(point, **metrics):
    return Record(point.id, "pass", metrics={"fell": False, **metrics}, wall_time=1.0)


def failed(point, *reasons, log=""):
    return Record(point.id, "fail", reasons or ("fell is true at 1.000 s, must be false",), {"fell": True}, log, 1.0)


GRID = """
about: Two <b>axes</b> & one drawn.
scenario: walk
set: {fidelity: pendulum, criteria: {fell: false, speed_mean: {max: 0.5}}}
grid:
  gait.step_length: [0.1, 0.2]
  feet: {small: {robot_options.foot_length: 0.075}, human: {}}
sample: {gait.com_height: {uniform: [0.9, 1.0]}, gait.swing_height: {choice: [0.05, 0.06]}}
seeds: 4
"""


def by_length(point):
    if point.settings["gait.step_length"] == 0.1:
        return passed(point, speed_mean=0.1)
    if point.settings["seed"] == 3:
        return Record(point.id, "refused", ("gait.step_length: too long; give less",))
    return failed(point, "speed_mean is 0.6 m/s, bound is at most 0.5")


@pytest.mark.parametrize("trials", [1, 2, 14, 300])
def test_intervals_are_those_of_a_library_of_statistics(trials):
    from scipy.stats import binomtest  # which takes long to be imported

    for successes in {0, 1, trials // 3, trials - 1, trials}:
        rate, wanted = wilson(successes, trials), binomtest(successes, trials).proportion_ci(0.95, "wilson")
        assert (rate.low, rate.high) == pytest.approx((wanted.low, wanted.high), abs=1e-14)
        assert 0.0 <= rate.low <= rate.rate == successes / trials <= rate.high <= 1.0


def test_rates_are_those_of_the_runs_with_their_intervals(tmp_path):
    whole = swept(tmp_path, GRID, by_length)
    rows = {tuple(row[:2]): row[2:] for row in Page(report.page(whole)).rows["success"]}
    rate = wilson(8, 14)
    interval = f"{100 * rate.low:.1f} to {100 * rate.high:.1f}"
    assert rows["all runs", ""] == ["14", "8", f"{100 * rate.rate:.1f}", interval, "2"]
    assert rows["gait.step_length [m]", "0.1"][:3] == ["8", "8", "100.0"]
    assert rows["gait.step_length [m]", "0.2"] == ["6", "0", "0.0", "0.0 to 39.0", "2"]
    assert rows["feet", "small"][:2] == ["7", "4"]
    drawn = [row for key, row in rows.items() if key[0].startswith("gait.com_height")]
    assert sum(int(row[0]) for row in drawn) == 14
    assert sum(int(row[1]) for row in drawn) == 8


def test_what_is_drawn_shows_passes_failures_and_bounds(tmp_path):
    text = report.page(swept(tmp_path, GRID, by_length))
    for word in ("gait.com_height [m]", "speed_mean [m/s]", "missed", "4/4", "0/3", "small"):
        assert word in text
    assert "Two &lt;b&gt;axes&lt;/b&gt; &amp; one drawn." in text


def test_failures_are_grouped_by_the_criterion_and_can_be_run_again(tmp_path):
    whole = swept(tmp_path, GRID, by_length)
    text = report.page(whole)
    rows = Page(text).rows["failures"]
    assert [row for row in rows if re.fullmatch(r"\d+ runs", row[1])] == [
        ["speed_mean", "6 runs"],
        ["refused", "2 runs"],
    ]
    commands = set(map(unescape, re.findall(r'<code class="command">(.*?)</code>', text)))
    points = [point for outcome in whole.outcomes for point, record in outcome.runs if record.status != "pass"]
    assert commands == {point.command for point in points}


def test_only_so_many_failures_are_listed_and_the_rest_is_counted(tmp_path):
    text = report.page(swept(tmp_path, GRID, by_length), most=3)
    assert text.count('class="command"') == 3
    assert "Listed are 3 of 8; the table has all." in text


def test_links_lead_to_logs_that_are_there(tmp_path):
    log = tmp_path / "logs" / "a=1, b#2" / "log.mcap"
    log.parent.mkdir(parents=True)
    log.touch()
    names = iter([str(log.relative_to(tmp_path)), "logs/gone/log.mcap"])
    whole = swept(tmp_path, "scenario: walk\nseeds: 2\n", lambda point: failed(point, log=next(names)))
    links = [link for link in Page(report.page(whole)).links if "log" in link]
    assert [tmp_path / unquote(link) for link in links] == [log]


@pytest.mark.parametrize(
    "rule",
    [
        pytest.param(None, id="empty"),
        pytest.param(passed, id="passed"),
        pytest.param(failed, id="failed"),
        pytest.param(lambda point: Record(point.id, "refused", ("no; yes",)), id="refused"),
        pytest.param(lambda point: Record(point.id, "broken", ("gone",)), id="broken"),
        pytest.param(lambda point: Record(point.id, "fail"), id="bare"),
    ],
)
@pytest.mark.parametrize(
    "more",
    [
        pytest.param("", id="plain"),
        pytest.param("grid: {gait.steps: [3]}", id="one value"),
        pytest.param("grid: {gait.steps: [3, 4]}", id="one axis"),
        pytest.param("grid: {planner.profile: [default, paper]}\nfirst: {gait.com_height: [0.95, 0.9]}", id="first"),
        pytest.param("sample: {gait.steps: {choice: [3, 4]}}", id="sample"),
        pytest.param("bisect: {key: gait.com_height, low: 0.9, high: 0.95, tolerance: 0.05}", id="halving"),
        pytest.param(
            "grid: {start.yaw: [0.0, 1.0, 2.0]}\nbisect: {key: gait.com_height, low: 0.9, high: 0.95, ratio: 1.1}",
            id="compass",
        ),
        pytest.param(
            "grid: {gait.steps: [3, 4], planner.profile: [default, paper]}\n"
            "bisect: {key: gait.com_height, low: 0.9, high: 0.95, ratio: 1.1}",
            id="curves",
        ),
        pytest.param(
            "grid: {pace: {slow: {gait.steps: 3}, fast: {gait.steps: 4}}, planner.profile: [default, paper]}\n"
            "bisect: {key: gait.com_height, low: 0.9, high: 0.95, ratio: 1.1}\n"
            "records: [{name: Somebody, value: 0.93, source: a paper, at: {pace: slow}}]",
            id="bars",
        ),
    ],
)
def test_no_campaign_is_too_poor_for_a_page(tmp_path, rule, more):
    whole = swept(tmp_path, f"scenario: walk\n{more}\n", rule)
    text = report.page(whole)
    found = Page(text)
    assert found.asked == []
    assert "nan" not in re.sub(r"<(?:style|svg).*?</(?:style|svg)>", "", text, flags=re.DOTALL)
    if not whole.ran:
        assert "success rate," not in text


SAME = """
scenario: walk
set: {fidelity: pendulum}
grid: {gait.step_length: [0.1, 0.2]}
seeds: 12
"""


@pytest.mark.parametrize("alike", [True, False])
def test_runs_of_other_seeds_that_are_the_same_count_once(tmp_path, alike):
    def rule(one):
        seed = one.settings["seed"]
        if one.settings["gait.step_length"] == 0.2 and seed > 9:
            return Record(one.id, "refused", ("too long",))
        return passed(one, speed_mean=0.3 if alike else 0.3 + 1e-16 * seed, real_time_factor=1.0 + seed)

    whole = swept(tmp_path, SAME, rule)
    write(whole)
    count = 2 if alike else 22
    rate = wilson(count, count)
    rows = {tuple(row[:2]): row[2:] for row in Page(report.page(whole)).rows["success"]}
    assert rows["all runs", ""] == [str(count)] * 2 + ["100.0", f"{100 * rate.low:.1f} to 100.0", "2"]
    assert rows["gait.step_length [m]", "0.2"][::4] == [str(count // 2 - (not alike)), "2"]
    own_count = 1 if alike else 12
    own = wilson(own_count, own_count)
    (row,) = (line for line in whole.lines() if line.startswith("0.1  "))
    assert row.split()[1:] == [str(own_count), "of", str(own_count), "100.0", *own.between.split()]
    assert (whole.to_json()["pass"], whole.to_json()["repeated"]) == (22, 22 - count)
    said = "20 of 24 runs are those of another seed to the digit, since nothing in them is random; they count once"
    assert (said in [*whole.notes()]) == alike
    assert (said in report.page(whole)) == alike
    table = csv.DictReader(io.StringIO((tmp_path / "table.csv").read_text()))
    assert [row["repeats"] for row in table].count("true") == 22 - count


ALMOST = """
scenario: walk
set: {fidelity: pendulum, criteria: {fell: false, speed_mean: {max: 0.5}, steps_taken: 4}}
sample:
  gait.swing_height: {normal: [0.05, 1.0e-18]}
  gait.com_height: {choice: [0.9, 0.9000000000000001, 0.9000000000000002, 0.9000000000000004, 0.9000000000000005]}
seeds: 12
"""
EXTREMES = {
    "rounding": (0.3, 0.1 + 0.2),
    "rounding of much": (1e17, 1e17 + 32),
    "nothing": (0.0, 5e-324),
    "the same": (0.0, 0.0),
    "all there is": (-1.7e308, 1.7e308),
    "too great for a float": (10**400, 1),
    "too great for a column": (10**30, -(10**30)),
    "little and much": (1e-300, 1e100),
    "truth": (True, 0.5),
    "none": (None, None),
    "words": ("x", 1.0),
    "lists": ([1e308, 0.1], [0.1, 5e-324]),
}


@pytest.mark.parametrize("values", EXTREMES.values(), ids=EXTREMES)
def test_every_campaign_has_its_page_whatever_was_measured(tmp_path, values):
    names = ("speed_mean", "steps_taken", "metric_of_others")
    whole = swept(tmp_path, ALMOST, lambda one: passed(one, **dict.fromkeys(names, values[one.settings["seed"] % 2])))
    write(whole)
    rows = Page((tmp_path / PAGE).read_text()).rows["success"]
    runs = list(csv.DictReader(io.StringIO((tmp_path / "table.csv").read_text())))
    facts = sum(run["repeats"] == "false" for run in runs)  # values that differ by rounding are drawn more than once
    assert len(runs) == 12 and 2 < facts <= 12
    assert rows[1][:4] == ["all runs", "", str(facts), str(facts)]


@pytest.mark.parametrize("seeds", [1, 2])
@pytest.mark.parametrize("status", ["pass", "fail", "refused", "broken"])
def test_every_campaign_has_its_page_however_few_runs_it_has(tmp_path, status, seeds):
    text = ALMOST.replace("seeds: 12", f"seeds: {seeds}") + "grid: {gait.step_length: [0.2, 1.0e-300]}\n"
    write(swept(tmp_path, text, lambda one: Record(one.id, status, ("so it is",), {"speed_mean": 0.3})))
    assert (tmp_path / PAGE).read_text().endswith("</html>\n")


@pytest.mark.parametrize("reached", [-1e100, 5e-324, 1e17, 1e100])
@pytest.mark.parametrize("axis", ["gait.step_length: [0.2, 0.20000000000000004]", "pushes.0.direction: [0.0, 1.0, 2.0]",
                                  "a: {x: {}, y: {}}\n  b: {x: {}, y: {}}"])  # fmt: skip
def test_every_search_has_its_page_wherever_it_ends(tmp_path, axis, reached):
    text = "scenario: walk\nset: {fidelity: pendulum, pushes: [{time: 1, duration: 0.1, impulse: 0.1, direction: 0}]}\n"
    key = "criteria.speed_mean.max"
    text += f"grid:\n  {axis}\nbisect: {{key: {key}, low: -1.0e+100, high: 1.0e+100, tolerance: 1.0e+98}}\n"
    write(swept(tmp_path, text, lambda one: (passed if one.settings[key] <= reached else failed)(one)))
    assert "thresholds-figure" in (tmp_path / PAGE).read_text()


@pytest.mark.parametrize(
    ("key", "of"),
    [
        ("sample", "{criteria.speed_mean.max: {uniform: [-1.7e+308, 1.7e+308]}}"),
        ("bisect", "{key: criteria.speed_mean.max, low: 1.0e-300, high: 1.0e+100, ratio: 1.5}"),
        ("bisect", "{key: criteria.speed_mean.max, low: 0.1, high: 0.2, ratio: 1.000000000001}"),
        ("bisect", "{key: criteria.speed_mean.max, low: 0.1, high: 1.7e+308, tolerance: 1}"),
    ],
)
def test_ranges_that_no_number_spans_are_refused(tmp_path, key, of):
    (tmp_path / "spec.yaml").write_text(f"scenario: walk\n{key}: {of}\n")
    with pytest.raises(ScenarioError, match=rf"spec.yaml:2:.*{key}.*; "):
        read_campaign(str(tmp_path / "spec.yaml"))


PUSHES = """
scenario: walk
set:
  fidelity: pendulum
  rates.control: 100
  duration: 2.0
  gait.steps: 2
  gait.initial_stand: 0.2
  gait.single_support: 0.5
  gait.double_support: 0.12
  pushes: [{step: 1, phase: single, fraction: 0.2, duration: 0.1, impulse: 0.1, direction: 0.0}]
  planner.step_adaptation: location  # The limit is one on the clock.
  criteria: {fell: false}
grid: {pushes.0.direction: [0.0, 2.0, 4.0]}
bisect: {key: pushes.0.impulse, low: 0.2, high: 1.9, ratio: 3}
"""


@pytest.fixture(scope="module")
def push_map(tmp_path_factory):
    """A real campaign, in threads of this process."""
    folder = tmp_path_factory.mktemp("campaign")
    (folder / "spec.yaml").write_text(PUSHES)
    campaign, out = read_campaign(str(folder / "spec.yaml")), folder / "out"
    every = tuple(cells(campaign))
    with Journal(out) as journal:
        worker = LocalWorker(out, keep_all=False, make=lambda: ThreadPoolExecutor(1))
        run_cells(every, journal, [worker])
        whole = Swept(campaign, out, tuple(outcome_of(cell, journal) for cell in every))
        write(whole)
    return whole


def test_thresholds_of_the_page_are_those_of_the_table(push_map):
    text = (push_map.folder / PAGE).read_text()
    table = list(csv.DictReader(io.StringIO((push_map.folder / "thresholds.csv").read_text())))
    wanted = [float(row["threshold [N·s/kg]"]) for row in table]
    assert len(wanted) == 3
    assert [float(value) for value in re.findall(r'data-value="([^"]*)"', text)] == wanted


def test_thresholds_are_printed_with_their_units_as_the_table_has_them(push_map):
    _, head, *rows = [line for line in push_map.lines() if ".csv" not in line and ".html" not in line][:5]
    assert head.split("  ") == ["pushes.0.direction [rad]", "pushes.0.impulse [N·s/kg]"]
    table = list(csv.DictReader(io.StringIO((push_map.folder / "thresholds.csv").read_text())))
    wanted = [[f"{float(row['pushes.0.direction [rad]']):.4g}", row["threshold [N·s/kg]"]] for row in table]
    assert [row.split() for row in rows] == [[angle, f"{float(value):.4g}"] for angle, value in wanted]


@pytest.mark.parametrize(("side", "told"), [("below", "below 0.9"), ("above", "above 0.95")])
def test_a_threshold_beyond_its_range_is_told_as_such(tmp_path, side, told):
    text = "scenario: walk\nset: {fidelity: pendulum}\n"
    text += "bisect: {key: gait.com_height, low: 0.9, high: 0.95, tolerance: 0.05}\n"
    whole = swept(tmp_path, text, lambda one: Record(one.id, "fail" if side == "below" else "pass"))
    assert [*whole.lines()][1:3] == ["gait.com_height [m]", told]


def test_no_threshold_of_the_pendulum_is_beyond_the_limit(push_map):
    text = (push_map.folder / PAGE).read_text()
    thresholds = [float(value) for value in re.findall(r'data-value="([^"]*)"', text)]
    limits = [float(value) for value in re.findall(r'data-limit="([^"]*)"', text)]
    assert len(thresholds) == len(limits) == 3
    assert all(threshold <= limit < 4.0 for threshold, limit in zip(thresholds, limits, strict=True))
    assert "one-step capturability limit" in text


def test_a_real_page_asks_for_nothing_and_its_links_lead_to_files(push_map):
    text = (push_map.folder / PAGE).read_text()
    found = Page(text)
    assert found.asked == []
    assert "@import" not in text
    assert set(re.findall(r"url\((.)", text)) <= {"#"}
    assert len(found.links) > 4
    assert all((push_map.folder / unquote(link)).is_file() for link in found.links)
    for word in ("forward", "left", "backward", "right", "pushes.0.impulse [N·s/kg]"):
        assert word in text
