"""The page: whole without a network, its numbers those of the logs; and what the command says of it."""

import json
import re
from functools import partial
from html.parser import HTMLParser

import pytest
from paper_samples import FALL, outcome, results

from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.judge.verdict import judge
from surefoot.scenarios.log import read
from surefoot.scenarios.many.slots import InterruptedRunsError
from surefoot.scenarios.show.kit.html import number
from surefoot.scenarios.show.kit.svg import svg
from surefoot.studies.paper import page
from surefoot.studies.paper.figures import JERKS, PLATES, POSITIONS, PanelColumn, grid
from surefoot.studies.paper.page import balance_table, shove_table
from surefoot.studies.paper.page import paper as page_of
from surefoot.studies.paper.results import Spread, run_experiments, spread_cell, spread_text
from surefoot.studies.paper.studies import SHOVES, WALK, Experiment, Study

SHORT = ("gait.steps=1", "gait.single_support=0.6", "gait.initial_stand=0.2", "rates.control=100")
SHORT_WALK = Study("short", "Short walk", "paper-walk", SHORT)


class Page(HTMLParser):
    """Collects what a page asks for from elsewhere, and its anchors."""

    def __init__(self, text):
        super().__init__()
        self.asked, self.anchors, self.links = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.anchors.add(value)
            if name == "href" and tag == "a":
                self.links.append(value)
            elif name in ("src", "href", "xlink:href", "data") and not value.startswith("#"):
                self.asked.append(value)


@pytest.fixture(scope="module")
def walk(tmp_path_factory, worker):
    folder = tmp_path_factory.mktemp("runs")
    return run_experiments((Experiment(SHORT_WALK, "default", "pendulum"),), folder, [worker(folder)])[0]


def values(html):
    return [float(value) for value in re.findall(r'data-value="([^"]*)"', html)]


@pytest.mark.unit
def test_numbers_of_a_table_are_the_metrics_of_the_log(walk):
    metrics = judge(read(walk.log)).metrics
    shown = values(balance_table("t", results(walk).samples([SHORT_WALK])).html)
    expected = [1.0, *metrics["zmp_error_rms"], *metrics["zmp_error_max"]]
    assert shown == [*expected, metrics["zmp_excursion_max"], metrics["zmp_inside_fraction"]]


@pytest.mark.unit
def test_a_table_gives_median_and_range_and_marks_falls_and_failures():
    found = results(
        outcome(WALK, seed=0, zmp_error_rms=[0.001, 0.002]),
        outcome(WALK, seed=1, zmp_error_rms=[0.002, 0.002]),
        outcome(WALK, seed=2, **FALL),
        outcome(WALK, "lti", failure="no"),
    )
    title, first, second = balance_table("t", found.samples([WALK])).rows
    assert title == WALK.title
    assert (first[2].text, first[2].below) == ("1 of 3", "from 5 s on")
    assert (first[4].text, first[4].below, first[4].kind) == ("2", "1 … 3", "number past")
    assert second[2].text == "could not run"
    assert found.sample(WALK, "default").feasible == Spread(1.0, 1.0, 1.0)


@pytest.mark.unit
def test_the_shove_table_says_what_was_survived():
    html = shove_table(results(*(outcome(study) for study in SHOVES))).html
    assert values(html) == [14.0] * 8


@pytest.mark.unit
def test_every_figure_that_a_section_names_is_drawn_and_the_other_way_round():
    named = [one["name"] for part in page.sections() for one in part.figures]
    assert sorted(named) == sorted(PLATES)


@pytest.mark.unit
def test_numbers_as_text():
    assert [number(v) for v in (None, 0.0, -1.23456, 123.4, 0.001234)] == ["–", "0", "−1.23", "123", "0.00123"]
    assert spread_text(Spread(2.0, 1.0, 3.0), 10.0) == "20 (10 … 30)"
    assert spread_text(Spread(1.0, 1.0001, 1.0)) == "1"
    assert spread_cell(None).text == "–"


@pytest.mark.unit
def test_a_figure_is_an_element_without_a_prolog_and_a_missing_run_is_said(walk):
    found = results(walk)
    columns = [PanelColumn("walk", (("", found.sample(SHORT_WALK, "default", "pendulum")),)),
               PanelColumn("absent", (("", found.sample(WALK, "default", "pendulum")),))]  # fmt: skip
    text = svg(grid(columns, (*POSITIONS, *JERKS)))
    assert text.startswith("<svg ")
    assert "metadata" not in text
    for word in ("ZMP reference", "planned support, bounds", "single support", "jerk x [m/s³]", "time [s]", "not run"):
        assert word in text


@pytest.mark.unit
def test_the_page_asks_for_nothing_and_its_links_lead_somewhere(walk):
    text = page.page(results(walk, outcome(WALK), outcome(WALK, "paper", failure="a <b> & 'c'")), plates={})
    found = Page(text)
    assert found.asked == []
    assert found.links
    assert {link.removeprefix("#") for link in found.links} <= found.anchors
    assert "@import" not in text
    assert "url(" not in text
    assert "a &lt;b&gt; &amp;" in text
    assert "surefoot run paper-walk --set name=walk.default.pendulum --set fidelity=pendulum" in text


@pytest.fixture
def surefoot(monkeypatch, capsys, tmp_path, worker):
    """Run the command with a few experiments, in this process and without figures."""

    def run(*arguments, studies=(SHORT_WALK,), paper=None):
        every = tuple(Experiment(study, "default", "pendulum") for study in studies)
        few = partial(page_of, every=every, workers=lambda folder, jobs, keep_all: [worker(folder)], plates={})
        monkeypatch.setattr(page, "paper", paper or few)
        with pytest.raises(SystemExit) as ended:
            cli.program(["paper", *map(str, arguments)])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return run


@pytest.mark.unit
def test_command_writes_page_and_numbers(surefoot, tmp_path):
    code, out, err = surefoot("--out", tmp_path / "out", "--jobs", 1)
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == str(tmp_path / "out" / "paper.html")
    (run,) = json.loads((tmp_path / "out" / "paper.json").read_text())["runs"]
    log = read(tmp_path / "out" / "runs" / "logs" / run["run"] / "log.mcap")
    assert run["metrics"] == judge(log).metrics


@pytest.mark.unit
def test_command_with_a_failure_writes_the_page_and_ends_with_1(surefoot, tmp_path):
    bad = Study("bad", "Bad", "paper-walk", ("gait.steps=many",))
    code, _, err = surefoot("--out", tmp_path, studies=(SHORT_WALK, bad))
    assert code == 1
    assert err == "could not run: bad.default.pendulum-0\n"
    assert "bad.default.pendulum-0" in (tmp_path / "paper.html").read_text()


@pytest.mark.unit
def test_bad_input_ends_with_2(surefoot, tmp_path):
    (tmp_path / "file").touch()
    code, _, err = surefoot("--out", tmp_path / "file")
    assert code == 2
    assert "cannot be created" in err
    assert surefoot("--jobs", 0)[0] == 2


@pytest.mark.unit
def test_an_interruption_ends_with_130_and_says_how_to_go_on(surefoot, tmp_path):
    def interrupted(*arguments, **named):
        raise InterruptedRunsError

    code, _, err = surefoot("--out", tmp_path, paper=interrupted)
    assert code == 130
    assert "goes on from there" in err


@pytest.mark.physics
def test_a_few_experiments_end_to_end(tmp_path):
    """In processes of their own, pendulum and full physics, with every figure."""
    short = Study("walk", "Walk", "paper-walk", SHORT[:3])
    every = tuple(Experiment(short, "default", world) for world in ("cart-table", "pendulum", "full"))
    written, found = page.paper(tmp_path, 2, every=every)
    assert (len(found.outcomes), found.falls, found.failures) == (3, 0, ())
    text = written.read_text()
    assert Page(text).asked == []
    assert text.count("<svg ") == 9
