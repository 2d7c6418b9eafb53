"""Pictures of a run that is about to start or goes on."""

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.run.skeleton import Progress
from surefoot.scenarios.show.replay import beside

pytestmark = pytest.mark.unit


class Process:
    """Stands for the replay's process."""

    def __init__(self):
        self.shown = []
        self.waited = self.ended = False

    def __call__(self, log):
        self.shown.append(log)
        return self

    def wait(self, timeout=None):
        self.waited = True
        if not self.ended:
            raise KeyboardInterrupt

    def terminate(self):
        self.ended = True


def test_the_first_progress_opens_one_replay_of_the_log_until_ctrl_c(tmp_path):
    process, told = Process(), []
    with beside.LiveView(told.append, process) as live:
        live.begin(tmp_path / "log.mcap")
        live.wait()
        for time in (0.1, 0.2):
            live(Progress(time, 1.0, "standing", 1.0))
        live.wait()
        assert not process.ended
    assert process.shown == [tmp_path / "log.mcap"]
    assert [progress.time for progress in told] == [0.1, 0.2]
    assert process.waited
    assert process.ended


def test_the_replay_ends_with_a_run_that_does_not():
    process = Process()
    with pytest.raises(LogError), beside.LiveView(lambda _: None, process) as live:
        live(Progress(0.1, 1.0, "standing", 1.0))
        raise LogError("no space left on device")
    assert process.ended


def test_a_pendulum_has_no_pictures():
    with pytest.raises(LogError, match="has no body to show"):
        beside.check("pendulum", video=Path("walk.mp4"), view=False)


@pytest.mark.parametrize(("video", "view", "module"), [(Path("walk.mp4"), False, "av"), (None, True, "viser")])
def test_a_missing_extra_is_said_before_the_run(video, view, module, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(LogError, match=f"needs the package {module}"):
        beside.check("full", video=video, view=view)


def test_the_command_line_refuses_them_for_a_pendulum_and_runs_nothing(tmp_path):
    arguments = ["run", "stand", "--set", "fidelity=pendulum", "--view", "--out", str(tmp_path)]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code != 0
    assert not list(tmp_path.iterdir())
