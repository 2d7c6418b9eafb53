"""Criteria against metrics, and runs that did not come to their end."""

import json
import math
from contextlib import suppress

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

import surefoot
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.digest import always
from surefoot.scenarios.judge.verdict import judge, missed
from surefoot.scenarios.log import read
from surefoot.scenarios.log.recover import recover
from surefoot.scenarios.record.provenance import SCENARIO_FILE
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.run.skeleton import End

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("name", "bound", "value", "reason"),
    [
        ("a", {"max": 0.6}, 0.71, "a is 0.71, bound is at most 0.6"),
        ("a", {"max": 0.6}, 0.6, None),
        ("a", {"min": 1}, 0.5, "a is 0.5, bound is at least 1"),
        ("a", {"min": 1, "max": 2}, 1.5, None),
        ("a", {"max": 0.003}, [0.001, 0.004], "a[1] is 0.004, bound is at most 0.003"),
        ("a", {"max": [0.003, 0.005]}, [0.001, 0.004], None),
        ("a", {"max": 1}, None, "a is not available, so its bound cannot be checked"),
        ("a", False, True, "a is true, must be false"),
        ("a", False, False, None),
        ("a", 5, 5, None),
        ("a", "b", 6, "a is 6, must be 7"),
        ("a.p99", {"max": 1e-3}, {"median": 1.0, "p99": 2e-3}, "a.p99 is 0.002, bound is at most 0.001"),
    ],
)
def test_reasons_are_readable(name, bound, value, reason):
    found = missed({"a": value, "b": 7}, {name: Bound.model_validate(bound)})
    assert found == ([reason] if reason else [])


def judged(tmp_path, robot, motion, **keys):
    scenario = Scenario.model_validate({"name": "two-steps", "gait": {"steps": 2}, **keys})
    return run_scenario(scenario, tmp_path, None, motion, robot).verdict


def test_a_run_that_meets_its_criteria_passes(tmp_path, robot, motion):
    verdict = judged(tmp_path, robot, motion())
    assert verdict.passed
    assert verdict.reasons == ()


def test_every_missed_criterion_is_a_reason(tmp_path, robot, motion):
    criteria = {"cop_ratio_p99": {"max": 0.3}, "fell": False, "torque_ratio_max": {"max": 0.5}}
    verdict = judged(tmp_path, robot, motion(), criteria=criteria)
    assert not verdict.passed
    assert verdict.reasons == ("cop_ratio_p99 is 0.4, bound is at most 0.3",)


def test_a_fall_fails(tmp_path, robot, motion):
    verdict = judged(tmp_path, robot, motion(fall_at=1.2, end=End("fall", 1.2, "the robot fell")))
    assert not verdict.passed
    assert "fell is true at 1.200 s, must be false" in verdict.reasons


def test_a_fall_that_is_asked_for_passes(tmp_path, robot, motion):
    falling = motion(fall_at=1.2, end=End("fall", 1.2, "the robot fell"))
    assert judged(tmp_path, robot, falling, criteria={"fell": True}).passed


def test_a_fault_is_the_first_reason(tmp_path, robot, motion):
    broken = motion(end=End("fault", 1.5, "NaN in the simulator's state"))
    verdict = judged(tmp_path, robot, broken)
    assert not verdict.passed
    assert verdict.reasons[0] == "the run ended at 1.500000 s: NaN in the simulator's state"


def test_a_truncated_log_is_no_pass(tmp_path, robot, motion):
    judged(tmp_path, robot, motion())
    path = tmp_path / "two-steps-0" / "log.mcap"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    verdict = judge(read(path))
    assert not verdict.passed
    assert "the run was cut off; its log ends at" in verdict.reasons[0]
    json.dumps(verdict.to_json(), allow_nan=False)


def test_a_fall_in_damaged_chunks_is_no_pass_nor_after_recovery(tmp_path, robot, motion):
    scenario = Scenario(name="any", gait={"steps": 2}, criteria={"fell": False})
    path = run_scenario(scenario, tmp_path, None, motion(duration=1.6, fall_at=1.4), robot).log
    log, data = read(path), bytearray(path.read_bytes())
    for chunk in log.contents.chunks:
        if chunk.end_ns >= 1.4e9:
            data[chunk.data.start + 100] ^= 1
    path.write_bytes(data)
    recover(path, tmp_path / "once.mcap")
    recover(tmp_path / "once.mcap", tmp_path / "twice.mcap")
    for damaged in (path, tmp_path / "once.mcap", tmp_path / "twice.mcap"):
        verdict = judge(read(damaged))
        assert verdict["fell"] is False
        assert not verdict.passed
        assert verdict.reasons[0].startswith("the log is incomplete: ")


def test_a_log_without_its_index_is_whole_and_judged(tmp_path, robot, motion, two_steps):
    path = run_scenario(two_steps, tmp_path, None, motion(), robot).log
    passed, end = judge(read(path)), read(path).contents.data_end
    path.write_bytes(path.read_bytes()[: end + 100])
    recover(path, tmp_path / "whole.mcap")
    for log in (read(path), read(tmp_path / "whole.mcap")):
        assert judge(log).reasons == ()
        assert {**judge(log).metrics, "log_bytes": 0} == {**passed.metrics, "log_bytes": 0}


def test_a_log_with_edited_records_is_no_pass(tmp_path, robot, motion, two_steps):
    path = run_scenario(two_steps, tmp_path, None, motion(), robot).log
    data = path.read_bytes()
    for before, after in {b"kind": b"mind", b"com_height": b"com_weight", b"steps: 2": b"steps: 3"}.items():
        path.write_bytes(data.replace(before, after))
        assert path.read_bytes() != data
        with suppress(LogError):
            assert not judge(read(path)).passed


@pytest.mark.parametrize(
    ("end", "fall_at", "reason"),
    [
        (End("completed", 0.4), 0.2, "was completed, and its data show a fall at 0.200 s"),
        (End("completed", 9.0), 99.0, "was completed at 9.000 s, and its data end at 0.400 s"),
        (End("fall", 0.2), 99.0, "fell at 0.200 s, and its data show no fall"),
        (End("fall", 0.1), 0.2, "fell at 0.100 s, and its data show a fall at 0.200 s"),
    ],
)
def test_the_record_of_the_end_and_the_data_must_agree(tmp_path, robot, motion, end, fall_at, reason):
    criteria = {"duration": {"min": 0.1}, "fell": {"equals": fall_at < 1.0}}
    verdict = judged(tmp_path, robot, motion(duration=0.4, fall_at=fall_at, end=end), criteria=criteria)
    assert not verdict.passed
    assert verdict.reasons[0].endswith(reason)


@pytest.mark.parametrize("value", [1e-3, -2.5, 0.0, 7.0])
def test_a_bound_holds_to_the_last_digit(value):
    """A value at a bound meets it, and the next number beyond does not."""
    for side, beyond in (("min", -math.inf), ("max", math.inf)):
        for limit in (value, (value,)):
            criteria = {"speed_mean": Bound.model_validate({side: limit})}
            given = [value] if isinstance(limit, tuple) else value
            over = math.nextafter(value, beyond)
            assert missed({"speed_mean": given}, criteria) == []
            assert len(missed({"speed_mean": [over] if isinstance(limit, tuple) else over}, criteria)) == 1


@pytest.fixture
def again(tmp_path, robot, motion, two_steps):
    """Writes a passing log again by the stock library, without a checksum of its data, and without some topics."""
    path = run_scenario(two_steps, tmp_path, None, motion(), robot).log

    def write(*left_out, **options):
        out = tmp_path / "again.mcap"
        with path.open("rb") as source, out.open("wb") as target:
            reader, writer = make_reader(source), Writer(target, **options)
            writer.start()
            for one in reader.iter_metadata():
                writer.add_metadata(one.name, one.metadata)
            for one in reader.iter_attachments():
                writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)
            numbers = {}
            for schema, channel, one in reader.iter_messages():
                if channel.topic in left_out:
                    continue
                if channel.id not in numbers:
                    known = writer.register_schema(schema.name, schema.encoding, schema.data)
                    numbers[channel.id] = writer.register_channel(channel.topic, "protobuf", known, channel.metadata)
                writer.add_message(numbers[channel.id], one.log_time, one.data, one.publish_time, one.sequence)
            writer.finish()
        return read(out)

    return write


@pytest.mark.parametrize("options", [{}, {"use_chunking": False}, {"enable_crcs": False}])
def test_a_log_without_a_checksum_of_its_data_is_judged_and_strictly_fails(again, options):
    verdict, strict = judge(again(**options)), judge(again(**options), strict=True)
    unproven = "the log is not proven to be whole: it has no checksum of its data"
    assert verdict.passed
    assert unproven in verdict.notes
    assert strict.reasons == (unproven,)
    assert unproven not in strict.notes
    assert judge(again(enable_data_crcs=True), strict=True).passed


def test_a_log_that_lacks_a_topic_names_it(again):
    unneeded = judge(again("/timing", enable_data_crcs=True))
    assert unneeded.passed
    assert unneeded.notes == ("the log is not proven to be whole: it has no topic /timing",)
    needed = judge(again("/contact", enable_data_crcs=True))
    assert needed.reasons[0] == "the log has no messages of /contact, which its verdict needs"
    assert all(isinstance(note, str) and "KeyError" not in note for note in needed.notes)
    lame = judge(again("/measurement", enable_data_crcs=True))
    assert "the log is not proven to be whole: it has no topic /measurement" in lame.notes


def test_every_run_writes_the_topics_that_are_said_to_be_in_each(tmp_path):
    for fidelity in ("full", "pendulum"):
        run = surefoot.run(surefoot.load("stand", {"fidelity": fidelity, "duration": 0.3}), out=tmp_path)
        assert set(always(fidelity)) <= set(read(run.log).topics)
        assert not [note for note in run.verdict.notes if "proven" in note]


@pytest.mark.parametrize("extra", ["seed: 5\n", "criteria: {fell: false}\n"])
@pytest.mark.parametrize("first", [True, False])
def test_a_key_twice_in_the_scenario_of_a_log_decides_nothing(tmp_path, robot, motion, two_steps, extra, first):
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    text = log.attachments["scenario.yaml"].decode()
    log.attachments["scenario.yaml"] = (extra + text if first else text + extra).encode()
    with pytest.raises(LogError, match=f"its criteria are unknown, .*'{extra.partition(':')[0]}' is given twice"):
        judge(log)


def test_thousands_of_unknown_criteria_make_no_long_verdict(tmp_path, robot, motion, two_steps):
    log = read(run_scenario(two_steps, tmp_path, None, motion(), robot).log)
    text = log.attachments[SCENARIO_FILE].decode()
    head, _, rest = text.partition("criteria:\n")
    unknown = "".join(f"  nobody_knows_{number}: {{max: 1.0}}\n" for number in range(3000))
    log.attachments[SCENARIO_FILE] = f"{head}criteria:\n{unknown}{rest}".encode()
    reasons = judge(log).reasons
    assert reasons[0].startswith("nobody_knows_0 is not known here")
    assert sum(map(len, reasons)) < 10_000
    assert "and 2980 more like these" in reasons
