"""`surefoot scenario from` on a pendulum: what it writes, says and refuses, by its exit code."""

import json

import pytest
import yaml

import surefoot
from surefoot.scenarios.cli import program

pytestmark = pytest.mark.physics

FALLS = {
    "fidelity": "pendulum",
    "gait.steps": 3,
    "sensing": {"source": "truth", "com_noise": 0.0005},
    "pushes": [{"time": 1.6, "impulse": 3.0}],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A log that falls and one that does not."""
    made = tmp_path_factory.mktemp("incident")
    for name, values in {"falls": FALLS, "walks": {**FALLS, "pushes": [], "criteria": {"fell": False}}}.items():
        surefoot.run(surefoot.load("walk-level", values), out=made / "runs").log.rename(made / f"{name}.mcap")
    (made / "taken.yaml").write_text("mine\n")
    return made


@pytest.fixture
def command(folder, monkeypatch, capsys):
    """Gives a command in the folder: its exit code and what it says on both streams."""
    monkeypatch.chdir(folder)

    def given(*words):
        capsys.readouterr()
        with pytest.raises(SystemExit) as end:
            program.program(words)
        return end.value.code or 0, *capsys.readouterr()

    return given


def test_it_writes_a_scenario_that_check_takes(folder, command):
    code, said, progress = command("scenario", "from", "falls.mcap")
    assert code == 0, progress
    assert "1 of 2 causes are needed" in said
    text = (folder / "walk-level-incident.yaml").read_text()
    assert text.startswith("# Falls at 1.")
    assert yaml.safe_load(text)["criteria"] == {"fell": False}
    assert [line for line in progress.splitlines() if line.startswith("with ")]
    assert command("check", "walk-level-incident.yaml", "--out", "red")[0] == 1
    green = ("check", "walk-level-incident.yaml", "--set", "pushes=[]", "--out", "green")
    assert command(*green, "--update")[0] == 0
    assert command(*green)[0] == 0


def test_whole_keeps_all_and_json_is_one_object(command):
    code, said, _ = command("scenario", "from", "falls.mcap", "--whole", "--json", "--out", "whole.yaml")
    told = json.loads(said)
    assert (code, told["again"]["likeness"]["to_the_bit"]) == (0, True)
    assert all(one["needed"] for one in told["causes"])
    assert len(told["trials"]) == 1


def test_a_pendulum_begins_where_its_run_began(command):
    code, said, _ = command("scenario", "from", "falls.mcap", "--seconds", "0.5", "--out", "later.yaml", "--json")
    assert (code, [one["begin"] for one in json.loads(said)["starts"]]) == (0, [0.0])


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["walks.mcap"], "shows no incident"),
        (["nowhere.mcap"], "no such file"),
        (["taken.yaml"], "taken.yaml"),
        (["falls.mcap", "--out", "taken.yaml"], "exists already"),
        (["falls.mcap", "--out", "no/such/folder.yaml"], "no such folder"),
        (["falls.mcap", "--seconds", "nan"], "--seconds"),
        (["falls.mcap", "--around", "inf"], "no time of a log"),
        (["falls.mcap", "--seconds", "-1"], "seconds"),
    ],
)
def test_what_it_cannot_do_is_refused_in_a_sentence(folder, command, words, says):
    code, said, error = command("scenario", "from", *words)
    assert (code, said) == (2, "")
    assert says in error
    assert "Traceback" not in error
    assert (folder / "taken.yaml").read_text() == "mine\n"
