"""Parts of a model that a robot has not are told by `robot new`, by `robot check`, and by the verdict of each run."""

import json
from pathlib import Path

import pytest
import yaml

import surefoot
from surefoot.models.names import SHIPPED
from surefoot.models.registry import explain
from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.setup.checks.notes import agenda
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

ROBOTS = ("talos", "alexander")


@pytest.fixture
def printed(capsys: pytest.CaptureFixture[str]):
    """Run a command; gives its standard output."""

    def command(*arguments: str) -> str:
        with pytest.raises(SystemExit):
            cli.program([*arguments])
        return capsys.readouterr().out

    return command


def lines(robot: str) -> tuple[str, ...]:
    found = explain(robot).description.left_out
    assert len(found) > 1 and all(line.startswith("left out: ") for line in found)
    return found


@pytest.mark.unit
@pytest.mark.parametrize("robot", ROBOTS)
def test_check_and_new_tell_them(printed, robot) -> None:
    told = json.loads(printed("robot", "check", robot, "--only", "stand", "--json"))["notes"]
    assert set(lines(robot)) < set(told)
    model = yaml.safe_load(Path(SHIPPED[robot]).read_text())["model"]
    drafted = printed("robot", "new", model).splitlines()
    assert {f"# Note: {line}" for line in lines(robot)} <= set(drafted)


@pytest.mark.unit
@pytest.mark.parametrize("robot", ROBOTS)
def test_the_agenda_of_a_run_tells_them_of_a_whole_body_alone(robot) -> None:
    said = {f"robot {robot}, {line}" for line in lines(robot)}
    assert said <= set(agenda(resolve(load("stand", {"robot": robot}))).notes)
    assert said.isdisjoint(agenda(resolve(load("walk-level", {"robot": robot, "fidelity": "pendulum"}))).notes)
    assert not any("left out" in note for note in agenda(resolve(load("stand"))).notes)


@pytest.mark.physics
def test_the_verdict_of_a_run_and_of_its_log_run_again_tells_them(tmp_path) -> None:
    first = surefoot.run(load("stand", {"robot": "alexander", "duration": 0.2}), out=tmp_path / "one")
    again = surefoot.run(first.log, out=tmp_path / "two")
    said = {f"robot alexander, {line}" for line in lines("alexander")}
    assert said <= set(first.verdict.notes)
    assert first.verdict.notes == again.verdict.notes
    assert json.loads((first.log.parent / "verdict.json").read_text())["notes"] == list(first.verdict.notes)
