"""Output for people: handy units, few digits, nothing rounded up to perfection."""

import pytest

from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import OWN
from surefoot.scenarios.judge.verdict import bound_text, shown_unit, value_text
from surefoot.scenarios.show.console import print_table

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("com_error_rms", [7.039e-05, 0.000489, 0.0041], "0.0704  0.489  4.1"),
        ("zmp_inside_fraction", 1.0, "100"),
        ("zmp_inside_fraction", 0.99996, "99.99"),
        ("zmp_inside_fraction", 0.29, "29"),
        ("planner_time", {"median": 0.00051, "p99": 0.0012}, "median 0.51  p99 1.2"),
        ("knee_angle_mean", 0.5235988, "30"),
        ("log_bytes", 12_345_678, "12.3"),
        ("fell", False, "false"),
        ("fall_time", None, "-"),
        ("foot_slip_max", 1.23456, "1235"),
    ],
)
def test_values(name, value, text):
    assert value_text(name, value) == text


def test_bounds_are_shown_in_the_unit_of_the_value():
    assert bound_text("zmp_error_rms", Bound(max=0.006)) == "<= 6"
    assert bound_text("zmp_error_rms", Bound(max=(0.006, 0.002))) == "<= 6  2"
    assert bound_text("speed_mean", Bound(min=0.4, max=1.0)) == ">= 0.4, <= 1"
    assert bound_text("steps_taken", Bound(equals="steps_planned")) == "= steps_planned"
    assert bound_text("speed_mean", None) == ""


def test_lengths_are_in_millimetres():
    lengths = [name for name, one in OWN.items() if one.unit == "m" and name.startswith(("foot", "zmp", "com"))]
    assert lengths
    assert {shown_unit(name) for name in lengths} == {"mm"}


@pytest.mark.parametrize("place", [{}, {"COLUMNS": "80"}, {"FORCE_COLOR": "1", "TERM": "dumb"}])
def test_no_table_is_cut_wherever_it_goes(capsys, monkeypatch, place):
    for name, value in place.items():
        monkeypatch.setenv(name, value)
    print_table(("metric", "value", "note"), [("m" * 60, "v" * 300, "n" * 60)])
    assert f"{'m' * 60} {'v' * 300} {'n' * 60}" in " ".join(capsys.readouterr().out.split())
