"""A history of checks: what is kept, which commits changed something, and what damage does to it."""

import json
import os
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from surefoot.scenarios.check.check import cases, run_case, updated
from surefoot.scenarios.check.history import History, Keeper
from surefoot.scenarios.check.history_page import changed_commits, page, summary, to_json, walks
from surefoot.scenarios.check.lines import Commit, read_lines
from surefoot.scenarios.check.trends import trends
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.log import read

pytestmark = pytest.mark.unit

WALK = """
name: {name}
fidelity: pendulum
gait: {{steps: 2, step_length: {length}, single_support: 0.5, double_support: 0.1, initial_stand: 0.2}}
duration: 2.2
rates: {{control: 100}}
criteria: {{fell: false, zmp_error_rms: {{max: 0.05}}, speed_mean: {{min: 0.01}}}}
"""

LENGTHS = {"as it was": 0.2, "longer": 0.22, "a little": 0.2 + 1e-6, "long": 0.25}
"""Step lengths; one that is off by less than any tolerance is as it was."""


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Checks of two scenarios by how long their steps are, held against the baseline of the first."""
    folder = tmp_path_factory.mktemp("runs")
    found = {}
    for word, length in LENGTHS.items():
        for name in ("stroll", "amble"):
            (folder / f"{name}.yaml").write_text(WALK.format(name=name, length=length))
        held = [run_case(case, folder / word) for case in cases([str(folder)])]
        if word == "as it was":
            held = [run_case(updated(one).case, folder / "again") for one in held]
        # A program that has changed, not the scenario.
        settings = found["as it was"][0].case if found else None
        found[word] = [
            replace(one, case=(settings and replace(one.case, scenario=_as(one, found))) or one.case) for one in held
        ]
    return found


def _as(one, found):
    (same,) = (first for first in found["as it was"] if first.case.scenario.name == one.case.scenario.name)
    return same.case.scenario


def commit(number, message="words"):
    return Commit(f"{number:08x}" * 5, f"2026-01-01T{number // 60:02d}:{number % 60:02d}:00Z", message)


def keep(keeper, checked):
    """Keep what was checked, as a check does."""
    keeper.hold(checked)
    return keeper.keep(checked)


def kept(folder, runs, words):
    """A history of commits, each with the check of a program."""
    keeper = Keeper(folder, commit(1))
    for number, word in enumerate(words, 1):
        keeper.commit = commit(number)
        for one in runs[word]:
            status = "same" if word in ("as it was", "a little") else "moved"
            now = replace(one.now, settings=runs["as it was"][0].now.settings)
            keep(keeper, replace(one, status=status, reasons=(), now=now))
    return History(folder)


def test_of_sixty_commits_those_three_are_marked_that_change_something_and_no_other(tmp_path, runs):
    words = ["as it was"] * 16 + ["longer"] * 11 + ["as it was"] * 16 + ["long"] * 17
    words[5] = words[9] = words[30] = "a little"  # within the tolerances, as on another processor
    history = kept(tmp_path / "history", runs, words)
    found = changed_commits(walks(history))
    assert [int(line.commit.short, 16) for line, _ in found] == [17, 28, 44]
    assert all({walk.scenario for walk, _ in changes} == {"stroll", "amble"} for _, changes in found)
    told = to_json(history)
    assert (told["checks"], [one["commit"] for one in told["changes"]]) == (60, [commit(n).name for n in (17, 28, 44)])
    text = page(history)
    assert [text.count(f'id="change-{n}"') for n in (1, 2, 3, 4)] == [1, 1, 1, 0]
    assert f"{commit(17).short}" in text and f"{commit(16).short}" in text
    for short in (commit(n).short for n in range(1, 61) if n not in (17, 28, 44)):
        assert f">{short} " not in text and f". {short} " not in text


def test_without_a_change_none_is_marked_and_a_drift_is_where_it_leaves_the_tolerance(tmp_path, runs):
    assert changed_commits(walks(kept(tmp_path / "none", runs, ["as it was", "a little"] * 10))) == []
    drifting = {str(n): [replace(one, now=moved(one.now, 0.3 * n)) for one in runs["as it was"]] for n in range(8)}
    history = kept(tmp_path / "drift", {**runs, **drifting}, [str(n) for n in range(8)])
    assert [int(line.commit.short, 16) for line, _ in changed_commits(walks(history))] == [5]


def moved(baseline, tolerances):
    """A run whose path is longer by so many tolerances."""
    length = baseline.metrics["path_length"]
    return replace(
        baseline, metrics={**baseline.metrics, "path_length": length + tolerances * 0.98 * (0.003 + 0.001 * length)}
    )


def test_a_commit_that_cannot_run_is_marked_and_so_is_the_one_that_runs_again(tmp_path, runs):
    broken = [
        replace(one, now=None, log=None, status="could not run", reasons=("no such robot",))
        for one in runs["as it was"]
    ]
    folder = tmp_path / "history"
    kept(folder, runs, ["as it was"] * 2)
    keeper = Keeper(folder, commit(3))
    for one in broken:
        keep(keeper, one)
    keeper = Keeper(folder, commit(4))
    for one in runs["as it was"]:
        keep(keeper, one)
    found = changed_commits(walks(History(folder)))
    assert [(int(line.commit.short, 16), changes[0][1].reasons) for line, changes in found] == [
        (3, ("no such robot",)),
        (4, ("it runs again",)),
    ]


def test_it_is_ordered_by_commits_whenever_they_were_checked(tmp_path, runs):
    folder = tmp_path / "history"
    for number, word in ((4, "longer"), (1, "as it was"), (3, "longer"), (2, "as it was")):
        keeper = Keeper(folder, commit(number))
        for one in runs[word]:
            keep(keeper, replace(one, now=replace(one.now, settings=runs["as it was"][0].now.settings)))
    assert [int(line.commit.short, 16) for line, _ in changed_commits(walks(History(folder)))] == [3]


def test_few_logs_are_kept_of_the_last_run_and_the_last_good_one(tmp_path, runs):
    history = kept(tmp_path / "history", runs, ["as it was", "longer", "long"])
    logs = {path.name for path in (tmp_path / "history" / "logs").iterdir()}
    digests = [line.copy for line in history.lines if line.scenario == "stroll"]
    assert logs == {
        f"{name}-{digest}.mcap"
        for name, each in (
            ("stroll", digests),
            ("amble", [line.copy for line in history.lines if line.scenario == "amble"]),
        )
        for digest in (each[0], each[2])
    }
    small = read(history.copy_of("stroll", digests[2]))
    steps = np.diff(small["/truth"].time)
    assert steps.min() >= 0.04 - 1e-9
    assert small.metadata["run"] and "/plan" not in small
    held = history.lines[-1].beside
    assert held.commit == commit(1).name  # the last good one
    assert held.channels and held.pictures == ()
    assert held.note == "no pictures: a pendulum has no body to replay"


def test_damage_is_told_and_takes_nothing_else_away(tmp_path, runs):
    folder = tmp_path / "history"
    kept(folder, runs, ["as it was", "longer"])
    good = len(read_lines(folder)[0])
    first = next((folder / "checks").glob("*.jsonl")).read_text().splitlines()[0]
    for number, text in enumerate((
        "{", "[]", '{"format": 2}', '{"format": 1}', "NaN", "[" * 100_000, '{"format": 1, "took": 1e400}',
        first.replace('"scenario": "', '"scenario": "../'),
    )):  # fmt: skip
        (folder / "checks" / f"z{number}.jsonl").write_text(text)
    (folder / "checks" / "folder.jsonl").mkdir()
    os.mkfifo(folder / "checks" / "pipe.jsonl")
    (folder / "checks" / "bytes.jsonl").write_bytes(b"\xff\xfe\n")
    lines, notes = read_lines(folder)
    assert len(lines) == good
    assert len(notes) == 11 and all(str(folder) in note for note in notes)
    for path in (folder / "runs").iterdir():
        path.write_text("scenario: 5")
    history = History(folder)
    assert changed_commits(walks(history)) == []
    assert page(history) and any("runs/" in note for note in history.notes)


def test_an_interrupted_check_keeps_what_it_has_done(tmp_path, runs):
    keeper = Keeper(tmp_path / "history", commit(1))
    keep(keeper, runs["as it was"][0])
    file = next((tmp_path / "history" / "checks").iterdir())
    with file.open("a") as opened:
        opened.write('{"format": 1, "time": "20')
    lines, notes = read_lines(tmp_path / "history")
    assert len(lines) == 1 and len(notes) == 1 and "it is no JSON" in notes[0]


def test_two_checks_at_once_have_files_of_their_own(tmp_path, runs):
    keepers = [Keeper(tmp_path / "history", commit(1)) for _ in range(3)]
    for keeper in keepers:
        keep(keeper, runs["as it was"][0])
    assert len([*(tmp_path / "history" / "checks").iterdir()]) == 3
    assert len(History(tmp_path / "history").lines) == 3


def test_trends_have_every_number_of_every_metric_and_the_time_it_took(tmp_path, runs):
    history = kept(tmp_path / "history", runs, ["as it was", "longer", "as it was"])
    found = {one.name: one for one in trends([line for line in history.lines if line.scenario == "stroll"])}
    assert found["took"].unit == "s" and not found["took"].repeatable
    assert not found["real_time_factor"].repeatable
    assert found["zmp_error_rms[1]"].repeatable and [*found["zmp_error_rms[1]"].limits()] == [0.05]
    speed = found["speed_mean"].values
    assert speed[0] == speed[2] != speed[1]
    assert found["fell"].values == (0.0, 0.0, 0.0)


def test_the_commands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walks").mkdir()
    walk = tmp_path / "walks" / "stroll.yaml"
    walk.write_text(WALK.format(name="stroll", length=0.2))

    def git(*words):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True, capture_output=True)

    def surefoot(*words):
        return CliRunner().invoke(app, [*words])

    git("init", "-q")
    git("add", "--all")
    git("commit", "-qm", "First walk")
    assert surefoot("check", "walks", "--jobs", "1", "--update", "--history", "past").exit_code == 0
    assert surefoot("check", "walks", "--jobs", "1", "--history", "past").exit_code == 0
    assert surefoot("history", "past").stdout == "no commit changed anything\n"
    walk.write_text(WALK.format(name="stroll", length=0.25))
    git("commit", "-qam", "Longer steps")
    red = surefoot("check", "walks", "--jobs", "1", "--history", "past", "--markdown", "check.md", "--json")
    assert red.exit_code == 1
    (one,) = json.loads(red.stdout)["scenarios"]
    assert one["beside"]["note"] == "no pictures: a pendulum has no body to replay"
    assert len(one["beside"]["channels"]) == 3
    assert "No pictures: a pendulum has no body to replay." in Path("check.md").read_text()
    told = surefoot("history", "past", "--out", "past.html")
    assert "Longer steps\n  stroll: other scenario, gait.step_length is 0.25, the default before" in told.stdout
    assert Path("past.html").read_text().count("<svg") > 3
    assert surefoot("history", "past", "--out", "past.html").exit_code != 0
    assert [one["subject"] for one in json.loads(surefoot("history", "past", "--json").stdout)["changes"]] == [
        "Longer steps"
    ]
    (line,) = (line for line in read_lines(tmp_path / "past")[0] if line.status == "other scenario")
    assert not line.commit.name.endswith("-dirty") and line.commit.subject == "Longer steps"
    assert {"mujoco", "machine"} <= line.versions.keys()


def test_runs_of_several_seeds_are_the_same_until_the_program_is_another(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walks").mkdir()
    walk = tmp_path / "walks" / "stroll.yaml"
    noisy = WALK.format(name="stroll", length=0.2) + "sensing: {com_noise: 0.002}\nseeds: 4\n"
    walk.write_text(noisy)

    def check(*words):
        return CliRunner().invoke(app, ["check", "walks", "--jobs", "1", "--history", "past", *words])

    assert check("--update").exit_code == 0
    assert check().exit_code == 0
    history = History(tmp_path / "past")
    assert changed_commits(walks(history)) == []
    assert len(history.lines[-1].seeds.passed) > 1
    (rate,) = (one for one in trends(history.lines) if one.name == "pass rate")
    assert rate.spread and all(low <= value <= high for value, (low, high) in zip(rate.values, rate.spans, strict=True))
    walk.write_text(noisy.replace("step_length: 0.2", "step_length: 0.25"))
    check()
    ((_, changes),) = changed_commits(walks(History(tmp_path / "past")))
    assert any(reason.startswith("path_length over seeds: ") for reason in changes[0][1].reasons)


def test_no_history_and_no_place_for_one_is_refused(tmp_path):
    with pytest.raises(ScenarioError, match="holds no history; give a folder that `surefoot check --history`"):
        History(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match=r"cannot be written.*give another --history"):
        Keeper(tmp_path / "file")


def test_outside_of_a_repository_checks_are_in_the_order_of_their_times(tmp_path, runs):
    for word in ("as it was", "longer"):
        keeper = Keeper(tmp_path / "history", Commit())
        keeper.time = f"2026-01-01T00:00:0{len(word)}Z"
        for one in runs[word]:
            keep(keeper, replace(one, now=replace(one.now, settings=runs["as it was"][0].now.settings)))
    assert list(summary(walks(History(tmp_path / "history"))))
