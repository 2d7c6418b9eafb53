"""The command line: exit codes, one message for what a user can mend, JSON alone on standard output."""

import importlib
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.main import get_command

from surefoot.errors import ParameterError
from surefoot.models.names import SHIPPED
from surefoot.scenarios import catalogue
from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.cli.starter import commented, starter
from surefoot.scenarios.errors import SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.judge.metrics import METRICS, OWN, register
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.record.foxglove.views import EventLog
from surefoot.scenarios.run import interrupts, run
from surefoot.scenarios.setup import walk
from surefoot.scenarios.setup.keys import scenario_problem
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.robot.robots import Robots

pytestmark = pytest.mark.unit


@pytest.fixture
def surefoot(monkeypatch, capsys, robot, robots, motion):
    """Run a command with the fake robot and loop; gives exit code, standard output and standard error."""

    def command(*arguments, loop=None):
        monkeypatch.setattr(walk, "describe", lambda name, options: robot)
        monkeypatch.setattr(run, "_simulate", loop or motion())
        monkeypatch.setattr(Robots, "names", lambda self: robots.names())
        monkeypatch.setattr(Robots, "facts", lambda self, *robot: robots.facts(*robot))
        with pytest.raises(SystemExit) as ended:
            cli.program([*map(str, arguments)])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return command


@pytest.fixture
def scenario(tmp_path):
    path = tmp_path / "two-steps.yaml"
    path.write_text("gait: {steps: 2}\n")
    return path


def test_list(surefoot):
    code, out, _ = surefoot("list")
    assert code == 0
    assert "diagonal-walk" in out
    assert "robot      humanoid100" in out
    assert "profile    repaired" in out
    assert "metric " not in out, "every verdict shows ours"
    summaries = [line for line in out.splitlines() if line.startswith(("scenario ", "control "))]
    assert len(summaries) == len(catalogue.OWN) + len(catalogue.CONTROLS)
    assert [line for line in summaries if not line.endswith(".")] == []


def test_list_json_has_the_same_and_the_metrics(surefoot):
    found = json.loads(surefoot("list", "--json")[1])
    robots = {entry.pop("name"): entry for entry in found["robot"]}
    assert robots["humanoid100"] == {"package": "surefoot", "doc": ""}
    assert set(robots) == {"humanoid100", *SHIPPED} and "33 kg" in robots["g1"]["doc"]
    assert "speed_mean" in [entry["name"] for entry in found["metric"]]
    assert all(
        entry["doc"] for kind in ("scenario", "control", "profile", "terrain", "metric") for entry in found[kind]
    )


def test_every_command_takes_h_for_help_and_is_told_in_full(surefoot):
    code, out, _ = surefoot("-h")
    commands = re.findall(r"(?m)^  ([a-z]+)  +(.*)$", out.partition("Commands:")[2])
    assert (code, len(commands)) == (0, len(get_command(app).commands))
    for name, help_ in commands:
        assert help_.endswith("."), f"{name}: {help_}"
        assert not help_.endswith("..."), f"{name}: {help_}"
        assert surefoot(name, "-h")[1].startswith(f"Usage: surefoot {name} ")


@pytest.mark.parametrize(
    ("words", "completed"),
    [
        ("run stairs-u", ["stairs-up-down", "stairs-up"]),
        ("show diag", ["diagonal-walk"]),
        ("run no-such-f", []),
        ("run walk --set gait.st", ["gait.steps=", "gait.step_length=", "gait.step_width="]),
        ("run walk --set wbc.weights.sw", ["wbc.weights.swing="]),
        ("insp", ["inspect"]),
    ],
)
def test_a_shell_completes_commands_scenarios_and_keys(surefoot, monkeypatch, words, completed):
    for name, value in (("COMP_WORDS", f"surefoot {words}"), ("COMP_CWORD", str(len(words.split())))):
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("_SUREFOOT_COMPLETE", "complete_bash")
    code, out, err = surefoot()
    assert (code, out.split(), err) == (0, completed, "")


def test_show_prints_a_file_that_runs(surefoot, tmp_path):
    code, out, _ = surefoot("show", "diagonal-walk")
    assert code == 0
    (tmp_path / "mine.yaml").write_text(out)
    comment, hint, line, first, *rest = out.splitlines()
    assert comment.startswith("# The walk of the paper's table")
    assert "`surefoot schema > surefoot.schema.json`" in hint
    assert (line, first) == (
        "# yaml-language-server: $schema=surefoot.schema.json",
        "name: diagonal-walk",
    )
    explained = {key.strip(): meaning for key, _, meaning in (text.partition(" # ") for text in rest)}
    assert explained["steps: 5"] == Scenario.model_fields["gait"].annotation.model_fields["steps"].description
    assert explained["steps_taken: steps_planned"] == OWN["steps_taken"].meaning
    assert load(str(tmp_path / "mine.yaml")) == load("diagonal-walk")
    code, _, err = surefoot("show", "diagonal-wlk")
    assert code == 2
    assert "did you mean 'diagonal-walk'" in err


@pytest.mark.parametrize("name", catalogue.OURS)
def test_what_show_prints_says_what_the_file_says(name):
    shown, file = starter(name), catalogue.text(name)[0]
    assert yaml.safe_load(shown) == yaml.safe_load(file)
    assert "yaml-language-server" in shown
    unexplained = [line for line in shown.splitlines() if "#" not in line and line != f"name: {name}"]
    assert unexplained == [line for line in unexplained if line.lstrip().startswith(("-", "{"))]


def test_a_file_that_cannot_be_explained_is_shown_as_it_is():
    for text in ("gait: {steps: [1\n", "robot: 'two\n  lines: 3'\n"):
        assert commented(text) == text


def test_schema_is_json(surefoot):
    code, out, _ = surefoot("schema")
    assert code == 0
    assert json.loads(out)["properties"]["gait"]


def test_run_passes(surefoot, scenario, tmp_path):
    code, out, err = surefoot("run", scenario, "--out", tmp_path / "out")
    assert code == 0
    assert out.startswith("two-steps: verdict pass")
    assert "2 of 2" in out
    assert out.rstrip().endswith(str(tmp_path / "out" / "two-steps-0" / "log.mcap"))
    assert err == ""


def test_run_fails_with_1(surefoot, scenario, tmp_path, motion):
    code, out, _ = surefoot("run", scenario, "--out", tmp_path, loop=motion(fall_at=1.0))
    assert code == 1
    assert "fell is true at 1.000 s, must be false" in out


def test_run_json_is_one_object(surefoot, scenario, tmp_path):
    code, out, err = surefoot("run", scenario, "--json", "--seed", 7, "--set", "gait.steps=2", "--out", tmp_path)
    assert code == 0
    found = json.loads(out)
    assert found["verdict"] == "pass"
    assert found["log"].endswith("two-steps-7/log.mcap")
    assert err == ""


def test_interrupted(surefoot, scenario, tmp_path, motion):
    stopped = motion(stop_at=1.0, raises=KeyboardInterrupt())
    code, _, err = surefoot("run", scenario, "--out", tmp_path, loop=stopped)
    assert code == 130
    assert "interrupted; the log up to here is whole" in err


def test_a_defect_is_no_verdict(surefoot, scenario, tmp_path, motion):
    code, out, err = surefoot("run", scenario, "--out", tmp_path, loop=motion(raises=ZeroDivisionError("x")))
    assert code == 70
    assert out == ""
    assert "ZeroDivisionError: x" in err


@pytest.mark.parametrize(
    ("refusal", "message"),
    [
        (ParameterError(("gait", "steps"), "no stance", "use 3"), "two-steps.yaml:1:15: no stance; use 3"),
        (ParameterError(("gait", "apex_ss"), "too high", "use 0"), "two-steps.yaml:1:7: too high; use 0"),
        (
            ValueError("The legs are too short."),
            "two-steps.yaml:1:1: The legs are too short; change the scenario so that it fits",
        ),
    ],
)
def test_what_a_part_refuses_is_bad_input_at_the_key_it_names(surefoot, scenario, tmp_path, motion, refusal, message):
    code, out, err = surefoot(
        "run", scenario, "--out", tmp_path, loop=motion(raises=SetupError(scenario_problem(refusal)))
    )
    assert code == 2
    assert out == ""
    assert err.strip().endswith(message)
    assert not (tmp_path / "two-steps-0").exists()


def test_interrupted_before_the_run(surefoot, scenario, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("surefoot.scenarios.setup.load.load", interrupt)
    code, _, err = surefoot("run", scenario)
    assert code == 130
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "no-such"], "no such scenario file or catalogue name"),
        (["run", "walk", "--set", "gait.steps=x", "--set", "seed=-1"], "--set gait.steps: gait.steps is 'x'"),
        (["run", "walk", "--out", "/dev/null/x"], "cannot be created"),
        (
            ["run", "walk", "--vidoe", "x"],
            "surefoot run: no such option: --vidoe (Possible options: --video, --view); ",
        ),
        (["run", "walk", "--video", "x"], "a name that ends in .mp4"),
        (["run"], "surefoot run: missing argument 'scenario'; `surefoot run -h` tells what there is"),
        (["run", "walk", "stand"], "surefoot run: got unexpected extra argument(s) (stand); "),
        (["run", "walk", "--fidelity", "pendulum"], "a key of the scenario is given as --set fidelity=VALUE"),
        (["run", "walk", "--seed", "x"], "surefoot run: invalid value for '--seed': Input should be a valid integer"),
        (["run", "walk", "--seed", "-1"], "invalid value for '--seed': Input should be greater than or equal to 0"),
        (["run", "walk", "--set", "gait.steps"], "--set gait.steps: not a setting; write --set key=value"),
        (["run", "{folder}"], "a directory; give a scenario file or a catalogue name"),
        (["run", "{folder}/none.yaml"], "none.yaml: no such scenario file or catalogue name"),
        (["run", "stand", "--out", "{file}", "--set", "duration=0.1"], "cannot be created, not a directory"),
        (["rnu", "walk"], "surefoot: no such command 'rnu'. Did you mean 'run'?"),
        (["help"], "surefoot: no such command 'help'; `surefoot -h` tells what there is"),
        (["-V"], "surefoot: no such option: -V; `surefoot -h` tells"),
        (["fly"], "surefoot: no such command 'fly'"),
        (["show", "{file}"], "no such catalogue name; valid are blocks, "),
        (["list", "walk"], "surefoot list: got unexpected extra argument(s) (walk)"),
        (["inspect", "{file}"], "not an MCAP file; give a log that `surefoot run` has written"),
        (["inspect", "{folder}"], "a directory; give {folder}/x.mcap"),
        (["inspect", "{folder}/x.mcap"], "not an MCAP file"),
        (["replay", "{folder}/x.mcap"], "give one of --html FILE, --video FILE, --rrd FILE and --live"),
        (["compare", "{file}"], "surefoot compare: missing argument 'B'"),
        (["paper", "--jobs", "0"], "invalid value for '--jobs': Input should be greater than or equal to 1"),
        (["inspect", "/dev/null"], "not an MCAP file"),
        (["inspect", "/"], "a directory"),
        (["inspect", "/dev/zero"], "not an MCAP file but a device or a pipe"),
        (["inspect", "x", "--from", "nan"], "nan is no time of a log"),
        (["plot", "x", "--to", "1e300"], "is no time of a log"),
        (["replay", "x", "--live", "--to=-inf"], "is no time of a log"),
        (["inspect", "/no/such"], "no such file"),
        (["recover", "/dev/null", "whole.mcap"], "not an MCAP file"),
    ],
)
def test_bad_input_is_one_sentence_and_2(surefoot, arguments, message, tmp_path):
    (tmp_path / "mine.yaml").write_text("name: mine\n")
    (tmp_path / "x.mcap").touch()
    places = {"{folder}": str(tmp_path), "{file}": str(tmp_path / "mine.yaml")}
    for place, path in places.items():
        arguments, message = [word.replace(place, path) for word in arguments], message.replace(place, path)
    code, out, err = surefoot(*arguments)
    assert code == 2
    assert message in err
    assert out == ""
    sentences = err.splitlines()
    assert len(sentences) == arguments.count("--set") or len(sentences) == 1
    assert all("; " in sentence and not sentence.endswith(".") for sentence in sentences)


def test_a_command_alone_shows_what_there_is(surefoot):
    code, out, err = surefoot()
    assert code == 2
    assert "Commands:" in out + err


def test_a_window_that_ends_before_it_begins(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    code, _, err = surefoot("inspect", log, "--topic", "/truth", "--from", "2", "--to", "1")
    assert (code, err) == (2, "--from 2 is after --to 1; give the earlier time as --from\n")


def test_a_log_of_any_name_is_known_by_how_it_begins(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    other = log.rename(log.with_name("kept.log"))
    code, out, _ = surefoot("run", other, "--out", tmp_path / "again")
    assert (code, out.splitlines()[0]) == (0, "two-steps: verdict pass")


def test_a_run_that_fails_says_where_to_look(surefoot, scenario, tmp_path):
    out = tmp_path / "my runs"
    code, said, _ = surefoot("run", scenario, "--set", "criteria.fell=true", "--out", out)
    assert code == 1
    assert said.splitlines()[-1] == f"why: surefoot inspect '{out}/two-steps-0/log.mcap'"
    assert "why:" not in surefoot("run", scenario, "--out", out)[1]
    code, said, _ = surefoot("run", scenario, "--set", "criteria.fell=true", "--out", out, "--json")
    assert code == 1 and json.loads(said)["verdict"] == "fail"


def test_inspect_repeats_the_verdict(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    code, out, _ = surefoot("inspect", log, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["verdict"] == "pass"
    assert found["truncated"] is False
    assert {"topic": "/truth", "messages": 2000, "rate": pytest.approx(500, rel=1e-3)} in found["topics"]
    assert {**json.loads(log.with_name("verdict.json").read_text()), **found} == found


def test_metrics_without_a_value_are_named_in_one_line_and_have_no_row(surefoot, scenario, tmp_path):
    """But for one that is judged: what could not be computed is missed, and has to be seen."""
    surefoot("run", scenario, "--set", "criteria={place_error: {max: 1.0}}", "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    for command in (("inspect", log), ("compare", log, log)):
        lines = surefoot(*command)[1].splitlines()
        (named,) = (line for line in lines if line.startswith("without a value: "))
        rows = {line.split()[0]: line for line in lines if line.strip()}
        assert "waypoints_missed" in named and "waypoints_missed" not in rows
        assert ("place_error" in rows) == (command[0] == "inspect") == ("place_error" not in named)


def test_inspect_and_recover_a_truncated_log(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    code, out, _ = surefoot("inspect", log)
    assert code == 1
    assert "truncated" in out
    assert "the run was cut off" in out
    code, out, err = surefoot("recover", log, tmp_path / "whole.mcap")
    assert code == 0
    assert "messages from 0.000 s" in err
    assert not read(tmp_path / "whole.mcap").truncated
    assert surefoot("inspect", tmp_path / "whole.mcap")[0] == 1


def test_inspect_a_topic(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    code, out, _ = surefoot("inspect", log, "--topic", "/truth", "--json")
    assert code == 0
    com = json.loads(out)["com"]
    assert (com["shape"], com["messages"], com["not_finite"], com["min"], com["max"]) == ([3], 2000, 0, 0.0, 1.0)
    assert "com_velocity" in surefoot("inspect", log, "--topic", "/truth")[1]
    assert surefoot("inspect", log, "--topic", "/trut")[0] == 2


def test_inspect_several_topics_and_when_something_holds(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    code, out, _ = surefoot("inspect", log, "--topic", "/truth", "--topic", "/contact", "--json")
    assert code == 0 and {"truth.com", "contact.zmp"} <= json.loads(out).keys()
    both = tmp_path / "both.csv"
    assert surefoot("inspect", log, "--topic", "/truth", "--topic", "/plan", "--export", both)[0] == 0
    assert both.read_text().startswith("time [s],truth.")
    assert surefoot("inspect", log, "--topic", "/truth", "--topic", "/truth")[0] == 2
    assert surefoot("inspect", log, "--topic", "/truth", "--topic", "/plan", "--field", "com")[0] == 2
    code, out, _ = surefoot("inspect", log, "--where", "/truth:com_2 >= 0.5", "--json")
    (found,) = json.loads(out)
    assert code == 0 and found["worst"] == pytest.approx(1.0) and found["end"] == pytest.approx(3.998)
    code, out, _ = surefoot("inspect", log, "--where", "/truth:com_2 >= 0.5 and zmp_edge > 0", "--to", "3")
    assert code == 0 and "worst" not in out
    assert surefoot("inspect", log, "--where", "com_0 < 1")[2].startswith(f"{log}: com_0 is of 4 topics")
    for wrong in (("--field", "com"), ("--export", tmp_path / "x.csv"), ("--strict",)):
        assert surefoot("inspect", log, "--where", "/truth:com_2 >= 0.5", *wrong)[0] == 2


def test_events_are_printed_as_words(surefoot, tmp_path):
    with LogWriter(tmp_path / "said.mcap", {}) as writer:
        said = EventLog(writer)
        said.update(1_500_000_000, (True, False), np.zeros(3), False, False, False)
        said.update(2_500_000_000, (True, True), np.zeros(3), False, False, True)
    said = tmp_path / "said.mcap"
    code, out, _ = surefoot("inspect", said, "--topic", "/events")
    assert code == 0
    assert out.splitlines()[0].split() == ["time", "[s]", "kind", "event"]
    assert [line.split()[:2] for line in out.splitlines()[1:]] == [
        ["1.500", "lift-off"], ["2.500", "touchdown"], ["2.500", "fall"],
    ]  # fmt: skip
    found = json.loads(surefoot("inspect", said, "--topic", "/events", "--from", "2", "--json")[1])
    assert found[-1] == {"time": 2.5, "kind": "fall", "text": "the robot falls"}
    assert len(found) == 2
    code, _, err = surefoot("inspect", said, "--topic", "/events", "--field", "text")
    assert code == 2
    assert "has words" in err
    assert surefoot("inspect", said, "--topic", "/event")[0] == 2


def test_a_fall_that_is_taken_back_is_an_event(surefoot, tmp_path):
    with LogWriter(tmp_path / "said.mcap", {}) as writer:
        said = EventLog(writer)
        for tick, falling in enumerate((False, True, True, False, False, True)):
            said.update(tick * 10**8, (True, True), np.zeros(3), False, falling, False)
    found = json.loads(surefoot("inspect", tmp_path / "said.mcap", "--topic", "/events", "--json")[1])
    assert [(event["time"], event["kind"]) for event in found] == [(t, "falling") for t in (0.1, 0.3, 0.5)]
    assert "no step will save the robot" in found[0]["text"] == found[2]["text"]
    assert "steps can save the robot again" in found[1]["text"]


def test_a_rule_that_begins_to_act_is_an_event(surefoot, tmp_path):
    with LogWriter(tmp_path / "said.mcap", {}) as writer:
        said = EventLog(writer)
        for tick, acted in enumerate(((), ("adjusts",), ("adjusts", "retimes"), ("adjusts",), (), ("adjusts",))):
            said.update(tick * 10**8, (True, True), np.zeros(3), False, False, False, acted)
    found = json.loads(surefoot("inspect", tmp_path / "said.mcap", "--topic", "/events", "--json")[1])
    assert [(event["time"], event["text"]) for event in found] == [
        (0.1, "the rule adjusts acts"), (0.2, "the rule retimes acts"), (0.5, "the rule adjusts acts"),
    ]  # fmt: skip
    assert {event["kind"] for event in found} == {"rule"}


def test_no_file_is_replaced_without_being_told(surefoot, scenario, tmp_path):
    surefoot("run", scenario, "--out", tmp_path)
    log = tmp_path / "two-steps-0" / "log.mcap"
    for name, command in {
        "a.mcap": ["recover", log],
        "a.csv": ["inspect", log, "--topic", "/torque", "--to", "0.1", "--export"],
        "a.png": ["plot", log, "--what", "height", "--out"],
        "b.png": ["compare", log, log, "--out"],
        "a.html": ["replay", log, "--html"],
        "a.mp4": ["replay", log, "--video"],
    }.items():
        file = tmp_path / name
        file.write_text("precious")
        code, out, err = surefoot(*command, file)
        assert (code, out) == (2, ""), command
        assert err.strip() == f"{file}: exists already; choose another file, or replace it with --force"
        assert file.read_text() == "precious"
    assert surefoot("recover", log, tmp_path / "a.mcap", "--force")[0] == 0
    assert read(tmp_path / "a.mcap").count("/truth") == 2000
    assert not list(tmp_path.glob(".*"))


def test_a_pipe_is_no_log_and_does_not_hang(surefoot, tmp_path):
    os.mkfifo(tmp_path / "pipe.mcap")
    for command in (["inspect"], ["plot"], ["run"], ["replay", "--live"]):
        code, _, err = surefoot(*command, tmp_path / "pipe.mcap")
        assert code == 2
        assert "device" in err and "pipe" in err, err


def test_names_that_are_no_text(surefoot, scenario, tmp_path):
    folder = tmp_path / os.fsdecode(b"\xff")
    for stream in (sys.stdout, sys.stderr):  # as `main` sets up the true ones
        stream.reconfigure(errors="backslashreplace")
    assert surefoot("run", scenario, "--out", folder)[0] == 0
    log = folder / "two-steps-0" / os.fsdecode(b"\xfe.mcap")
    log.with_name("log.mcap").rename(log)
    for command in (
        ["inspect", log, "--json"],
        ["recover", log, folder / "whole.mcap"],
        ["plot", log, "--what", "height"],
    ):
        code, _, err = surefoot(*command)
        assert (code, err.count("Traceback")) == (0, 0)


@pytest.mark.usefixtures("heeding")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, 130)])
@pytest.mark.parametrize("moment", ["set-up", "loop", "judging"])
def test_every_signal_ends_a_run_in_order(surefoot, scenario, tmp_path, motion, number, code, moment):
    def loop(walk, writer, on_progress):
        if moment == "set-up":
            signal.raise_signal(number)
        end = motion(duration=0.2)(walk, writer, on_progress)
        if moment == "loop":
            signal.raise_signal(number)
        return end

    @metric()
    def signalled(run):
        """Truth of whether the signal came while the log was judged."""
        if moment == "judging":
            signal.raise_signal(number)
        return moment == "judging"

    register(signalled)
    try:
        ended, out, err = surefoot("run", scenario, "--out", tmp_path, loop=loop)
    finally:
        METRICS.discard("signalled")
    interrupts._received.clear()
    assert (ended, err.count("Traceback")) == (code, 0)
    log = read(tmp_path / "two-steps-0" / "log.mcap")
    assert not log.truncated
    assert not log.losses()
    assert ("interrupted by the user" in out) == (moment != "judging")
    assert log.path.with_name("verdict.json").exists()


@pytest.mark.parametrize(("ended", "code", "said"), [("pipe", 141, ""), ("full", 2, "no space left on device")])
def test_output_that_nobody_takes_is_no_verdict(ended, code, said):
    """Exit code 1 would say that criteria were missed."""
    if ended == "full":
        with Path("/dev/full").open("w") as full:
            done = subprocess.run([sys.executable, "-m", "surefoot", "--version"], stdout=full, stderr=subprocess.PIPE)
    else:
        child = [sys.executable, "-m", "surefoot", "--version"]
        piped = subprocess.Popen(child, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        piped.stdout.close()
        done = subprocess.CompletedProcess(child, piped.wait(), None, piped.stderr.read())
        piped.stderr.close()
    assert done.returncode == code
    assert said in done.stderr.decode()
    assert "Traceback" not in done.stderr.decode()
    assert done.stderr.decode() or not said


@pytest.mark.parametrize("missed", [True, False])
def test_a_run_says_once_that_it_was_interpreted_and_why(surefoot, scenario, tmp_path, monkeypatch, missed):
    modules = importlib.import_module("surefoot.native.modules")
    monkeypatch.setattr(modules, "missing", lambda: "there is no C compiler 'cc'; install one" if missed else "")
    _, out, err = surefoot("run", scenario, "--out", tmp_path, "--json")
    assert json.loads(out)
    told = f"run interpreted, about {modules.SLOWER} times slower: there is no C compiler 'cc'; install one\n"
    assert err.count(told) == missed
