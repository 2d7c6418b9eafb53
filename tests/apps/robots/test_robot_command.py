"""``surefoot robot check``: exit codes, the table, and JSON alone on standard output."""

import json
from dataclasses import replace

import numpy as np
import pytest

from surefoot.apps.robots import taken
from surefoot.apps.robots.taken import CatalogueBar, CatalogueRow, Looked, longest_first, rows
from surefoot.models import registry
from surefoot.models.humanoid100 import HUMANOID100
from surefoot.models.types import Robot, RobotDescription, RobotOptions
from surefoot.scenarios.cli import program as cli

pytestmark = pytest.mark.unit


FEW = ("stairs-tall", "stand", "walk")
"""Some scenarios in the order of the catalogue."""

ONLY = tuple(word for name in FEW for word in ("--only", name))


@pytest.fixture
def surefoot(capsys: pytest.CaptureFixture[str]):
    """Run a command; gives exit code, standard output and standard error."""

    def command(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            cli.program([*arguments])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return command


def test_a_sound_robot_is_told_with_all_that_it_accepts(surefoot) -> None:
    code, out, err = surefoot("robot", "check", "humanoid100", *ONLY)
    assert (code, err) == (0, "")
    assert "100.00 kg" in out and "fault" not in out
    assert out.rstrip().endswith("3 scenarios: 3 accepted")


def test_json_says_the_same_and_nothing_else(surefoot) -> None:
    code, out, _ = surefoot("robot", "check", "humanoid100", *ONLY, "--json")
    told = json.loads(out)
    assert code == 0
    assert [row["scenario"] for row in told["scenarios"]] == list(FEW)
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
        code, out, _ = surefoot("robot", "check", "weak", *ONLY)
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
    code, out, _ = surefoot("robot", "check", "humanoid100", *ONLY, "--walk")
    assert code == 1
    assert "- fell is true" in out and "- too tall" in out
    assert out.rstrip().endswith("3 scenarios: 1 walks, 1 fails, 1 refused")


def test_what_cannot_be_taken_is_refused_before_any_run(tmp_path) -> None:
    """A payload that no catalogue scenario asks for is none of its business; a scenario with a fault is."""
    begun = []
    found = list(rows("nobody", FEW, True, 1, tmp_path, lambda *runs: begun.append(runs)))
    assert begun == [(0, 0.0)]
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


def test_the_longest_run_comes_first_and_the_bar_gives_the_rows_in_the_order_of_the_names() -> None:
    durations = {"stand": 1.0, "stairs-tall": 0.0, "walk": 2.0, "slope": 3.0}
    looked = [
        Looked(CatalogueRow(name, "accepted" if lasts else "refused", duration=lasts), name if lasts else None)
        for name, lasts in durations.items()
    ]
    runs = longest_first(looked)
    assert [one.row.scenario for one in runs] == ["slope", "walk", "stand"]
    found = [looked[1].row, *(replace(one.row, outcome="walks") for one in runs)]
    with CatalogueBar(tuple(durations), printing=False) as bar:
        bar.begun(3, 6.0)
        assert [row.scenario for row in bar.shown(found)] == list(durations)
