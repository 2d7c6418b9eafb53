"""Logs that others have written again: of one run, and then judged as that, or refused, or told what is missing."""

import json

import pytest
from rewritten import Records, alike, filtered, joined, left_out, of_two_runs, unproven
from typer.testing import CliRunner

import surefoot
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError, ScenarioError
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.log import read
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.show.compare import compare
from surefoot.scenarios.show.differences import WALL_CLOCK

WALK = {
    "fidelity": "pendulum", "duration": 2.6, "seed": 3,
    "criteria": {"fell": {"equals": False}, "steps_taken": {"equals": "steps_planned"}},
    "gait": {"steps": 2, "step_length": 0.2, "single_support": 0.4, "double_support": 0.1, "initial_stand": 0.1},
}  # fmt: skip
FALL = {**WALK, "pushes": [{"time": 0.3, "duration": 0.3, "force": [3000, 0, 0]}]}


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """A run that passes, and one of the same scenario that a push throws over."""
    folder = tmp_path_factory.mktemp("runs")
    good, fallen = (surefoot.run(surefoot.load("walk-level", keys), out=folder) for keys in (WALK, FALL))
    assert good.verdict.passed, good.verdict.reasons
    assert fallen.verdict["fell"]
    return good.log, fallen.log


@pytest.fixture
def written(logs, tmp_path):
    """Writes the passing log again with a change; gives the file."""

    def write(change, options):
        log, other = (Records.of(path.read_bytes()) for path in logs)
        if change is not None:
            change(log, other)
        path = tmp_path / "again.mcap"
        path.write_bytes(log.bytes(**options))
        return path

    return write


def everything(path):
    """All that a log holds of its run but wall-clock times, by name."""
    log = read(path)
    channels = {
        topic: [(time, data) for time, data in sorted(log.messages(topic))]
        for topic in log.topics
        if topic not in WALL_CLOCK
    }
    return log.metadata | log.attachments | channels


def commands(path, tmp_path):
    """Every command that reads a log, each with an answer or a sentence; gives what inspect says, and all refusals."""
    outputs, refusals = [], []
    for command in (
        ["inspect", path, "--json"],
        ["inspect", path, "--json", "--strict"],
        ["inspect", path, "--topic", "/truth", "--export", tmp_path / "truth.csv", "--force"],
        ["inspect", path, "--topic", "/events"],
        ["compare", path, path, "--json"],
        ["plot", path, "--what", "height", "--out", tmp_path / "height.png", "--force"],
        ["recover", path, tmp_path / "recovered.mcap", "--force"],
        ["replay", path, "--html", tmp_path / "page.html", "--force"],
    ):
        done = CliRunner().invoke(app, [str(word) for word in command])
        outputs.append(done.stdout)
        if isinstance(done.exception, LogError | ScenarioError):
            assert "\n" not in str(done.exception)
            refusals.append(str(done.exception))
        else:
            assert done.exception is None or isinstance(done.exception, SystemExit), (command, done.exception)
    return json.loads(outputs[0]) if outputs[0] else None, refusals


QUICK = (
    *("unchunked", "merged into its channels", "scenario.yaml twice", "a second channel, empty"),
    *("a tenth of a second left out", "moved in time"),
)
"""Changes that the quick tests make; the long ones make all."""


def ways(found):
    return pytest.mark.parametrize(
        ("change", "options"),
        [
            pytest.param(*rest, id=name, marks=pytest.mark.unit if name in QUICK else pytest.mark.long)
            for name, *rest in found
        ],
    )


@ways(alike())
def test_the_same_written_again_is_the_same(logs, written, tmp_path, change, options):
    path = written(change, options)
    found = inspect(read(path), strict=True)
    assert found.verdict.passed, found.verdict.reasons
    assert not read(path).losses()
    assert everything(path) == everything(logs[0])
    assert compare(logs[0], path)[0].identical
    commands(path, tmp_path)
    recover(path, tmp_path / "made.mcap")
    assert inspect(read(tmp_path / "made.mcap")).verdict.passed


@ways([*unproven(), *filtered()])
def test_what_cannot_be_proven_is_judged_and_told(written, tmp_path, change, options):
    path = written(change, options)
    found, strict = inspect(read(path)), inspect(read(path), strict=True)
    assert found.verdict.passed, found.verdict.reasons
    commands(path, tmp_path)
    assert any("not proven to be whole" in note for note in found.verdict.notes)
    assert not strict.verdict.passed
    assert strict.verdict.reasons[0].startswith("the log is not proven to be whole: ")


@ways((name, change, {"enable_data_crcs": True}) for name, change in of_two_runs())
def test_what_is_of_two_runs_is_refused_by_every_command(written, tmp_path, change, options):
    path = written(change, options)
    with pytest.raises(LogError, match="not the log of one run"):
        surefoot.read(path)
    with pytest.raises(ScenarioError, match="not the log of one run"):
        load(path)
    said, refusals = commands(path, tmp_path)
    assert said is None
    assert len(refusals) == 8
    assert all("not the log of one run" in refusal for refusal in refusals)


@pytest.mark.parametrize("checksum", [True, False])
@ways((name, change, {}) for name, change in left_out())
def test_what_is_missing_is_no_pass_and_named(written, tmp_path, change, options, checksum):
    path = written(change, {**options, "enable_data_crcs": checksum})
    said, refusals = commands(path, tmp_path)
    assert said is None or (said["verdict"] == "fail" and said["reasons"])
    assert said or refusals


@pytest.mark.unit
def test_one_file_behind_another_one_is_refused(logs, tmp_path):
    first, second = (path.read_bytes() for path in logs)
    for data in joined(first, second).values():
        (tmp_path / "joined.mcap").write_bytes(data)
        with pytest.raises(LogError, match="another log follows behind its end"):
            surefoot.read(tmp_path / "joined.mcap")
