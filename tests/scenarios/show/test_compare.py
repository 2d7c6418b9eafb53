"""Two logs side by side: settings, versions, metrics, channels; whatever state they are in."""

import json
import random

import numpy as np
import pytest
from mcap.writer import Writer

from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import AttachedFile, ChannelSpec, LogWriter, read
from surefoot.scenarios.record import channels
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.skeleton import End
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.show.compare import _metric as compare_metric
from surefoot.scenarios.show.compare import compare, distinct_texts
from surefoot.scenarios.show.differences import Difference
from surefoot.scenarios.show.figures.page import plot

pytestmark = pytest.mark.unit

SHORT = (
    *("fidelity=pendulum", "gait.steps=1", "gait.single_support=0.5", "gait.initial_stand=0.1", "duration=1.2"),
    *("rates.control=100", "sensing.com_noise=0.0", "start.position_noise=0.001"),
)


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Logs of seeds 1 and 2, and of seed 1 again."""

    def run(seed):
        scenario = load_scenario("diagonal-walk", (*SHORT, f"seed={seed}"))
        return run_scenario(scenario, tmp_path_factory.mktemp("runs")).log

    return run(1), run(2), run(1)


@pytest.fixture
def command(capsys):
    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.program([*map(str, arguments)])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return run


def test_a_run_with_itself_and_with_its_repetition_is_identical(logs):
    for other in (logs[0], logs[2]):
        found, _, _ = compare(logs[0], other)
        assert found.identical
        assert found.summary == "identical apart from wall-clock timing"
        assert found.settings == found.files == found.notes == ()
        assert all(one.a == one.b for one in found.metrics if one.name == "com_error_rms.x")


def test_two_seeds_part_with_the_true_state(logs):
    found, _, _ = compare(*logs[:2])
    assert not found.identical
    assert [(one.name, one.a, one.b) for one in found.settings] == [("seed", 1, 2)]
    assert (found.first.topic, found.first.exact.field, found.first.time) == ("/truth", "com[0]", 0.0)
    assert found.summary.startswith("first divergence: /truth com[0] at 0.000 s: ")


@pytest.mark.parametrize(
    ("a", "b", "told"),
    [
        (1.0, 2.5, ("1", "2.5")),
        (0.1 + 0.2, 0.3, ("0.3", "5.6e-17 less")),
        (-1.2345678, -1.2345671, ("-1.2346", "7e-07 more")),
        (0.0, -0.0, ("0", "-0")),
        (np.nan, np.nan, ("nan", "with other bits")),
        (np.inf, 1.0, ("inf", "1")),
    ],
)
def test_numbers_that_differ_are_told_apart_with_few_digits(a, b, told):
    assert distinct_texts(a, b) == told


def test_an_element_of_a_joint_is_told_by_its_name(tmp_path, robot, two_steps):
    def torques(more):
        def loop(walk, writer, on_progress):
            channel = writer.channel(channels.torque(channels.Sizes(nj=4, nq=11, nv=10, horizon=50)))
            for tick in range(3):
                channel.append(tick * 2_000_000, np.array([30.0, -40.0, 5.0 + tick * more, 0.0]), 0.4)
            return End("completed", 0.006)

        return run_scenario(two_steps, tmp_path, None, loop, robot).log

    found, _, _ = compare(torques(0.0), torques(1e-9))
    assert found.summary == "first divergence: /torque command.right_hip at 0.002 s: 5 and 1e-09 more"


def test_an_element_without_a_joint_is_told_by_its_place():
    sizes = channels.Sizes(nj=4, nq=11, nv=10, horizon=50)
    names = ("hip", "knee", "ankle", "toe")
    (com, *_) = channels.plan(sizes).fields
    assert com.element((3, 2), names) == "com[3][2]"
    (q, *_) = channels.truth(sizes).fields
    assert [q.element((place,), names) for place in (0, 7)] == ["q.base_x", "q.hip"]
    assert q.element((7,)) == "q[7]"


def test_a_truncated_log_is_compared_as_far_as_it_goes(logs, tmp_path):
    data = logs[0].read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: len(data) * 2 // 3])
    found, _, _ = compare(logs[0], cut)
    assert found.summary == "identical as far as both logs reach"
    assert found.unread[0].startswith("B is truncated: it can be read up to")


def test_other_fidelities_have_other_channels(logs, tmp_path, robot, motion, two_steps):
    body = run_scenario(two_steps, tmp_path, None, motion(duration=1.0), robot).log
    found, _, _ = compare(body, logs[0])
    assert {"/measurement", "/torque", "/wbc"} <= set(found.only_a)
    assert found.only_b == ("/footsteps", "/process")  # nothing was commanded
    truth = next(one for one in found.channels if one.topic == "/truth")
    assert "q only in A" in truth.layout
    assert "external_force only in B" in truth.layout


def test_foreign_logs_have_nothing_in_common_or_are_refused(logs, tmp_path):
    foreign = tmp_path / "foreign.mcap"
    with foreign.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for topic in ("/json", "/truth"):
            writer.add_message(writer.register_channel(topic, "json", 0), 1, b"{}", 1)
        writer.finish()
    found, _, _ = compare(logs[0], foreign)
    assert found.only_b == ("/json",)
    assert "no channel in common" in found.summary
    assert "/truth of B has no layout of fixed size: not compared" in found.unread
    with pytest.raises(LogError, match="holds messages of /json, /truth, and none of them is a channel of a run that"):
        plot(foreign, tmp_path / "x.png")


def test_damaged_logs_give_what_can_be_read_and_never_a_traceback(logs, tmp_path):
    data, path, rng = logs[0].read_bytes(), tmp_path / "damaged.mcap", random.Random(4)
    compared = 0
    for trial in range(30):
        damaged = bytearray(data[: rng.randrange(len(data))] if trial % 3 == 0 else data)
        for _ in range(trial % 3):
            if damaged:
                damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
        path.write_bytes(damaged)
        try:
            found, _, _ = compare(logs[0], path)
            json.dumps(found.to_json(), allow_nan=False)
            compared += 1
            if trial % 15 == 0:
                plot(path, tmp_path / "x.png", "balance")
        except LogError:
            continue
    assert compared >= 20


def test_the_command_answers_first_and_draws(command, logs, tmp_path):
    code, out, err = command("compare", *logs[:2], "--out", tmp_path / "both.svg")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("first divergence: /truth")
    assert any(line.split() == ["seed", "1", "2"] for line in lines)
    assert any(line.startswith("com_error_rms.x ") for line in lines)
    assert (tmp_path / "both.svg").read_bytes().startswith(b"<?xml")


@pytest.mark.parametrize(
    ("other", "tolerance", "code"), [(0, (), 0), (2, (), 0), (1, (), 1), (1, ("--tolerance", "1"), 1)]
)
def test_the_exit_code_tells_whether_they_are_the_same(command, logs, other, tolerance, code):
    assert command("compare", logs[0], logs[other], "--exit-code", *tolerance)[0] == code
    assert command("compare", logs[0], logs[other], *tolerance)[0] == 0


def altered(log, path, seconds=1e-9, **records):
    """A copy of a log whose CoM is a little higher, and with other metadata records."""
    with LogWriter(path, {name: records.get(name, record) for name, record in log.metadata.items()}) as writer:
        for name, data in log.attachments.items():
            writer.attach(AttachedFile(name, "text/plain", data))
        for topic in log.numeric:
            data, fields = log[topic], log.fields(topic)
            channel = writer.channel(ChannelSpec(topic, topic[1:].title(), fields))
            for row, time in enumerate(data.time_ns.tolist()):
                values = [data.field(field.name)[row] for field in fields]
                channel.append(time, *(value + seconds * (topic == "/truth") for value in values))


def test_same_is_to_the_bit_unless_a_tolerance_is_given(command, logs, tmp_path):
    log, near = read(logs[0]), tmp_path / "near.mcap"
    altered(log, near)
    assert compare(logs[0], near)[0].first.topic == "/truth"
    codes = [command("compare", logs[0], near, "--exit-code", *more)[0] for more in ((), ("--tolerance", "1e-6"))]
    assert codes == [1, 0]
    near.unlink()
    altered(log, near, seconds=0.0, end={**log.metadata["end"], "kind": "fell"})
    found, _, _ = compare(logs[0], near)
    assert (found.records, found.agree) == (("end",), False)
    assert "end" in command("compare", logs[0], near)[1].split("metadata records that differ: ")[1]


def test_what_cannot_be_read_is_never_the_same(command, logs, tmp_path):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(logs[0].read_bytes()[:-3000])
    code, out, _ = command("compare", cut, cut, "--exit-code")
    assert (code, out.splitlines()[0]) == (1, "identical as far as both logs reach")


def test_metrics_are_shown_in_the_units_of_the_verdict(logs):
    one = Difference("zmp_error_rms.x", 0.0015, 0.002)
    assert compare_metric(one) == ("zmp_error_rms.x", "1.5", "2", "+0.5", "mm")
    assert compare_metric(Difference("speed_mean", 0.5, None)) == ("speed_mean", "0.5", "-", "", "m/s")
    assert compare_metric(Difference("of_a_package", 1.5, 2.0)) == ("of_a_package", "1.5", "2", "+0.5", "")


def test_json_is_one_object(command, logs):
    code, out, err = command("compare", *logs[:2], "--json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert found["identical"] is False
    assert found["first_divergence"]["topic"] == "/truth"
    assert found["first_divergence"]["exact"]["field"] == "com[0]"
    assert found["settings"] == [{"name": "seed", "a": 1, "b": 2}]
    assert set(found["metrics"]["speed_mean"]) == {"a", "b", "difference"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["compare", "/dev/null", "/dev/null"], "not an MCAP file"),
        (["compare", "{log}", "/no/such"], "no such file"),
        (["compare", "{log}", "{log}", "--tolerance", "-1"], "not a tolerance"),
        (["compare", "{log}", "{log}", "--tolerance", "nan"], "not a tolerance"),
        (["compare", "{log}", "{log}", "--out", "x.txt"], "end the file's name with one of them"),
        (["compare", "{log}"], "missing argument"),
        (["plot", "{log}", "--what", "torque"], "did you mean 'torques'?"),
        (["plot", "{log}", "--from", "99"], "holds nothing from 99 s on"),
        (["plot", "/"], "a directory"),
        (["plot"], "missing argument"),
    ],
)
def test_bad_input_is_one_message_and_2(command, logs, arguments, message):
    code, out, err = command(*(argument.replace("{log}", str(logs[0])) for argument in arguments))
    assert (code, out) == (2, "")
    assert message in err
    assert "Traceback" not in err


def test_plot_prints_the_path_and_what_could_not_be_read(command, logs, tmp_path):
    data = logs[0].read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: len(data) // 2])
    code, out, err = command("plot", cut, "--what", "height")
    assert (code, out) == (0, f"{tmp_path / 'height.png'}\n")
    assert err.startswith("note: the file is truncated: it can be read up to")
