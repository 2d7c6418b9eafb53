"""``surefoot robot check``: exit codes, the table, and JSON alone on standard output."""

import json
from dataclasses import replace

import numpy as np
import pytest
from fake_walks import alone

from surefoot.apps.robots import taken
from surefoot.apps.robots.taken import CatalogueBar, CatalogueRow, rows
from surefoot.models import registry
from surefoot.models.humanoid100 import HUMANOID100
from surefoot.models.types import Robot, RobotDescription, RobotOptions
from surefoot.scenarios import catalogue
from surefoot.scenarios.cli import program as cli

pytestmark = pytest.mark.unit


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> tuple[str, ...]:
    """A catalogue of three."""
    names = ("stand", "walk", "stairs-tall")
    monkeypatch.setattr(catalogue, "OWN", {name: catalogue.OWN[name] for name in names})
    return names


@pytest.fixture
def surefoot(capsys: pytest.CaptureFixture[str], few: tuple[str, ...]):
    """Run a command; gives exit code, standard output and standard error."""

    def command(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            cli.program([*arguments])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return command


def test_a_sound_robot_is_told_with_all_that_it_accepts(surefoot) -> None:
    code, out, err = surefoot("robot", "check", "humanoid100")
    assert (code, err) == (0, "")
    assert "100.00 kg" in out and "fault" not in out
    assert out.rstrip().endswith("3 scenarios: 3 accepted")


def test_json_says_the_same_and_nothing_else(surefoot, few: tuple[str, ...]) -> None:
    code, out, _ = surefoot("robot", "check", "humanoid100", "--json")
    told = json.loads(out)
    assert code == 0
    assert [row["scenario"] for row in told["scenarios"]] == list(few)
    assert told["faults"] == [] and told["measured"]["parity"] < 1e-9


def test_what_is_no_robot_is_bad_input(surefoot) -> None:
    code, out, err = surefoot("robot", "check", "humanoid10")
    assert (code, out) == (2, "")
    assert err.count("\n") == 1 and "humanoid100" in err


def test_a_robot_with_a_fault_is_missed_and_what_is_refused_says_why(surefoot) -> None:
    """Knees too weak to stand, and legs too short for the stairs."""

    def build(options: RobotOptions) -> RobotDescription:
        robot = HUMANOID100.build(options)
        weak = np.array(robot.torque_limit)
        weak[list(robot.joint_indices(robot.roles.knees))] = 20.0
        return replace(robot, name="weak", torque_limit=weak)

    registry.ROBOTS.add("weak", Robot("weak", build))
    try:
        code, out, _ = surefoot("robot", "check", "weak")
    finally:
        registry.ROBOTS.discard("weak")
    assert code == 1
    assert "fault: joint 'left_knee' needs" in out or "fault: joint 'right_knee' needs" in out


def test_what_fails_is_told_with_its_reasons(surefoot, monkeypatch: pytest.MonkeyPatch) -> None:
    told = (
        CatalogueRow("stand", "walks"),
        CatalogueRow("walk", "fails", ("fell is true",)),
        CatalogueRow("stairs-tall", "refused", ("too tall",)),
    )
    monkeypatch.setattr(taken, "rows", lambda *_: told)
    code, out, _ = surefoot("robot", "check", "humanoid100", "--walk")
    assert code == 1
    assert "- fell is true" in out and "- too tall" in out
    assert out.rstrip().endswith("3 scenarios: 1 walks, 1 fails, 1 refused")


def test_what_cannot_be_taken_is_refused_before_any_run(few: tuple[str, ...], tmp_path) -> None:
    """A payload that no catalogue scenario asks for is none of its business; a scenario with a fault is."""
    found = list(rows("nobody", few, True, 1, tmp_path, lambda *_: None))
    assert [row.outcome for row in found] == ["refused"] * 3
    assert all("nobody" in row.why[0] for row in found)
    assert list(tmp_path.iterdir()) == []


def test_only_what_is_named_is_looked_at_in_the_order_of_the_catalogue(surefoot) -> None:
    code, out, _ = surefoot("robot", "check", "humanoid100", "--only", "walk", "--only", "stand", "--json")
    assert code == 0
    assert [row["scenario"] for row in json.loads(out)["scenarios"]] == ["stand", "walk"]


def test_a_scenario_that_the_catalogue_has_not_got_is_bad_input(surefoot) -> None:
    code, out, err = surefoot("robot", "check", "humanoid100", "--only", "wakl")
    assert (code, out) == (2, "")
    assert err.count("\n") == 1 and "did you mean 'walk'?" in err


def test_each_scenario_is_looked_at_once_and_the_longest_run_comes_first(monkeypatch, tmp_path) -> None:
    """Refusals are known before any run, and how much there is to run, too."""
    durations = {"stand": 1.0, "stairs-tall": 0.0, "walk": 2.0, "slope": 3.0}
    looked: list[str] = []

    def look(name: str, robot: str):
        looked.append(name)
        outcome = "accepted" if durations[name] else "refused"
        return taken._Looked(CatalogueRow(name, outcome, duration=durations[name]), name if durations[name] else None)

    alone(monkeypatch, taken)
    monkeypatch.setattr(taken, "_look", look)
    monkeypatch.setattr(taken, "_run", lambda row, scenario, out: replace(row, outcome="walks"))
    told: list[str] = []

    def begun(runs: int, duration: float) -> None:
        told.append(f"{runs} runs of {duration:.2f} s")

    names = tuple(durations)
    found = []
    for row in rows("humanoid100", names, True, 2, tmp_path, begun):
        told.append(f"{row.scenario} {row.outcome}")
        found.append(row)
    assert looked == list(durations)
    assert told == ["3 runs of 6.00 s", "stairs-tall refused", "slope walks", "walk walks", "stand walks"]
    with CatalogueBar(names, printing=False) as bar:
        assert [row.scenario for row in bar.shown(found)] == list(durations)
