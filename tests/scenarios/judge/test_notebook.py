"""Views of a verdict and of a log in a notebook, and a channel as a data frame."""

import sys

import numpy as np
import pytest

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit


@pytest.fixture
def result(tmp_path, robot, motion):
    scenario = Scenario.model_validate({"name": "two-steps", "criteria": {"cop_ratio_p99": {"max": 0.3}}})
    return run_scenario(scenario, tmp_path, None, motion(), robot)


def test_a_verdict_says_why_and_the_first_metrics(result):
    first, second, *rest = repr(result.verdict).splitlines()
    assert first == "verdict fail"
    assert second == "  - cop_ratio_p99 is 0.4, bound is at most 0.3"
    assert "  footstep_error_max 6 mm" in rest
    assert len(rest) <= 10


def test_a_page_shows_the_same_without_markup_of_reasons(result):
    page = result.verdict._repr_html_()
    assert "<li>cop_ratio_p99 is 0.4, bound is at most 0.3</li>" in page
    assert "<td>footstep_error_max</td><td>6 mm</td>" in page
    passed = type(result.verdict)(True, ("<script>",), (), {"footstep_error_max": None}, {})
    assert "&lt;script&gt;" in passed._repr_html_()
    assert "footstep_error_max" not in repr(passed)


def test_metrics_are_found_by_name_and_part(result):
    verdict = result.verdict
    assert verdict["fell"] is False
    assert verdict["planner_time.p99"] == verdict.metrics["planner_time"]["p99"]
    for name, meant in (("cop_ratio", "cop_ratio_p99"), ("fell.x", "fell"), ("planner_time.p98", "planner_time")):
        with pytest.raises(KeyError, match=f"no metric '{name}'; did you mean '{meant}'"):
            verdict[name]


def test_a_log_says_where_it_is_and_what_it_holds(result):
    text = repr(read(result.log))
    assert text.startswith(f"Log('{result.log}', 0.000 to 3.998 s: /measurement 2000, ")
    assert "/footstep 2" in text
    result.log.write_bytes(result.log.read_bytes()[:-2000])
    assert ", truncated: " in repr(read(result.log))


def test_a_frame_has_a_column_for_every_element(result):
    pytest.importorskip("pandas")
    log = read(result.log)
    frame = log.frame("/truth")
    assert frame.index.name == "time"
    assert np.array_equal(frame.index, log["/truth"].time)
    assert np.array_equal(frame[["com_0", "com_1", "com_2"]], log["/truth"].field("com"))


def test_a_frame_needs_pandas(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(LogError, match=r"install .*\[frame\]', or use log\['/truth'\]\.field\(name\)"):
        read(result.log).frame("/truth")
