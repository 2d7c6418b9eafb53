"""The benchmark command runs; what it measures is for people to read."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from benchmarks import history  # noqa: E402  found by the line above
from benchmarks.stopwatch import PARTS, TimedWalk  # noqa: E402
from benchmarks.table import Section  # noqa: E402


def bench(*words):
    return subprocess.run(
        [sys.executable, "-m", "benchmarks", *words], cwd=ROOT, capture_output=True, text=True, timeout=300
    )


@pytest.mark.long
def test_every_section_runs_and_is_told_as_a_table_and_as_json():
    done = bench("--quick", "--json", "-")
    assert done.returncode == 0, done.stderr
    sections = json.loads(done.stdout)["sections"]
    assert len(sections) == done.stderr.count("== ") >= 12
    for section in sections.values():
        assert section["rows"] and all(len(row) == len(section["columns"]) for row in section["rows"])
        assert section["name"] in done.stderr
    ratios = [ratio for section in sections.values() for ratio in section["ratios"].values()]
    assert len(ratios) > 6 and all(ratio == ratio for ratio in ratios)


@pytest.mark.unit
def test_what_there_is_not_is_refused():
    done = bench("ticks")
    assert done.returncode == 2 and "there are tick, deadlines" in done.stderr
    assert bench("--quick", "--append", "counts").returncode == 2


@pytest.mark.physics
def test_the_stop_watch_sees_each_part_of_a_tick(tmp_path):
    walk = TimedWalk("diagonal-walk", ["duration=0.1"])
    ticks = list(walk.ticks(tmp_path / "log.mcap"))
    assert all(walk.laps[part] for part in PARTS)
    # Plans are seldom; what is logged and what is drawn has two methods. No part holds another, so all add up to less.
    once = {"measure", "sensors", "estimator", "Pinocchio terms", "plan sampled", "whole-body QP", "physics steps"}
    assert {part for part, laps in walk.laps.items() if len(laps) == len(ticks)} == once
    assert [len(walk.laps[part]) for part in ("logging", "viewers' channels")] == [2 * len(ticks)] * 2
    assert 0.5 * sum(ticks) < sum(sum(laps) for laps in walk.laps.values()) < sum(ticks)


@pytest.mark.unit
def test_a_table_aligns_its_numbers():
    section = Section("times", ("part", "us"), (("a", 1.25), ("longer", 1234.5), ("none", None)), "note")
    assert [len(line) for line in section.text().splitlines()[1:4]] == [12, 12, 12]


@pytest.mark.unit
def test_the_history_grows_by_a_row_for_each_ratio(tmp_path):
    file = tmp_path / "history.csv"
    for value in (1.234, 2.0):
        history.append({"tick over floor": value}, file)
    head, first, second = file.read_text().splitlines()
    assert head.split(",") == list(history.COLUMNS)
    assert first.endswith(",tick over floor,1.23") and second.endswith(",2")
    assert history.FILE.read_text().startswith(head)
