"""The command `surefoot drive` refuses what cannot be driven, and its own scenario stands."""

import sys
from pathlib import Path

import pytest

import surefoot
from surefoot.scenarios.apps.cli import app
from surefoot.scenarios.apps.drive.command import LONGEST, OWN, drive_scenario
from surefoot.scenarios.errors import LogError, MissingExtraError

pytestmark = pytest.mark.unit


def test_a_pendulum_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    scenario = surefoot.load("walk", {"fidelity": "pendulum"})
    with pytest.raises(LogError, match="a pendulum has no body"):
        drive_scenario(scenario, tmp_path / "runs", None, print)
    assert not (tmp_path / "runs").exists()


def test_it_says_what_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(MissingExtraError, match=r"surefoot drive needs the package viser; install it with: .*replay"):
        app(["drive", "--out", str(tmp_path)], standalone_mode=False)
    assert not list(tmp_path.iterdir())


def test_its_own_scenario_stands_for_as_long_as_one_wants() -> None:
    key, _, value = LONGEST.partition("=")
    scenario = surefoot.load(str(OWN), {key: float(value)})
    assert (scenario.name, scenario.gait.steps, scenario.duration) == ("drive", 0, 3600.0)
