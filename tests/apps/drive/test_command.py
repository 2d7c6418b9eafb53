"""The command `surefoot drive` refuses what cannot be driven, and its own scenario stands."""

import re
import sys
from pathlib import Path

import pytest

import surefoot
from surefoot.apps.drive.command import LONGEST, OWN, drive_scenario, log_size
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import LogError, MissingExtraError

unit, physics = pytest.mark.unit, pytest.mark.physics


@unit
def test_a_pendulum_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    scenario = surefoot.load("walk-level", {"fidelity": "pendulum"})
    with pytest.raises(LogError, match="a pendulum has no body"):
        drive_scenario(scenario, tmp_path / "runs", None, print)
    assert not (tmp_path / "runs").exists()


@unit
def test_it_says_what_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(MissingExtraError, match=r"surefoot drive needs the package viser; install it with: .*replay"):
        app(["drive", "--out", str(tmp_path)], standalone_mode=False)
    assert not list(tmp_path.iterdir())


@unit
def test_its_own_scenario_stands_for_as_long_as_one_wants() -> None:
    key, _, value = LONGEST.partition("=")
    scenario = surefoot.load(str(OWN), {key: float(value)})
    assert (scenario.name, scenario.gait.steps, scenario.duration) == ("drive", 0, 3600.0)


KEPT = {"log.keep": 1, "log.rate": 5}


@physics
@pytest.mark.parametrize(("robot", "more"), [("humanoid100", {}), ("g1", {}), ("humanoid100", KEPT), ("g1", KEPT)])
def test_it_says_what_its_log_takes(tmp_path: Path, robot: str, more: dict[str, object]) -> None:
    """Within a tenth; what a flight recorder takes at most it never exceeds."""
    keys = {"robot": robot, "gait.steps": 8, "gait.initial_stand": 0.2, "duration": 5.0}
    path, sizes = tmp_path / "log.mcap", []
    with surefoot.Simulation(surefoot.load("walk-level", {**keys, **more}), log=path) as sim:
        said = log_size(sim, path)
        assert sim.time < 0.3
        while not sim.done:
            sizes.append((sim.time, sum(one.stat().st_size for one in tmp_path.iterdir())))
            sim.advance()
    numbers = [float(number) for number in re.findall(r"\d+(?:\.\d+)?", said)]
    if more:
        most = max(size for _, size in sizes)
        assert 0.4e6 * numbers[-1] < most < 1e6 * numbers[-1]
    else:
        (begin, first), (end, last) = sizes[500], sizes[-1]
        assert numbers[0] == pytest.approx(3600e-9 * (last - first) / (end - begin), rel=0.1)
