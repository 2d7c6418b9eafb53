"""Messages stand in a log in the order of their time, as the stock doctor asks, whoever writes how often."""

import numpy as np
import pytest
from mcap.writer import Writer
from mcap_doctor import complaints

import surefoot
from surefoot.scenarios.log import AttachedFile, ChannelSpec, FieldSpec, LogWriter, PublishedSchema, read
from surefoot.scenarios.log.layout import RowLayout
from surefoot.scenarios.log.scan import records_in

pytestmark = pytest.mark.unit

FIELDS = (FieldSpec("a"), FieldSpec("b", (3,)), FieldSpec("n", kind="int"))
TEXT = PublishedSchema("text", b"")


def written(path, rate, seconds, seed=0, gaps=False, more=lambda writer, tick: None):
    """Write channels of the control rate, slower ones, some at any time, and messages of any size; gives what is in."""
    rng, sent = np.random.default_rng(seed), {}
    with LogWriter(path, {"run": {"seed": "3"}}) as writer:
        specs = [ChannelSpec(f"/c{i}", f"C{i}", FIELDS) for i in range(4)]
        control = [writer.channel(spec) for spec in specs[:2]]
        slow, odd = (writer.channel(spec) for spec in specs[2:])
        filled = slow.filler({}, [field.name for field in FIELDS])
        row = writer.channel(ChannelSpec("/row", "Row", (FieldSpec("a", (2,)), FieldSpec("b"))))
        rows = writer.rows(RowLayout(((row, ("a",)),), ((row, ("b",)),)))
        text = writer.message_channel("/text", TEXT, "words")
        late = 0
        for tick in range(round(seconds * rate)):
            late += 300_000_000 if gaps and rng.random() < 0.02 else 0
            time = tick * 1_000_000_000 // rate + late

            def put(append, topic, time=time):
                values = rng.normal(), rng.normal(size=3), int(rng.integers(100))
                append(time, *values)
                sent.setdefault(topic, []).append((time, values[0]))

            if tick % 10 == 0:
                put(lambda time, *values: filled(time, None, *values), "/c2")
            if rng.random() < 0.1:
                put(odd.append, "/c3")
            for number, channel in enumerate(control):
                put(channel.append, f"/c{number}")
            values = rng.normal(size=2)
            rows.append(time, (float(tick),), values)
            sent.setdefault("/row", []).append((time, float(tick)))
            for _ in range(int(rng.random() < 0.2) + int(rng.random() < 0.1)):
                data = bytes(rng.integers(0, 255, int(rng.integers(1, 2000)), dtype=np.uint8))
                text.append(time, data)
                sent.setdefault("/text", []).append((time, data))
            more(writer, tick)
    return sent


def holds(path, sent):
    """Return true if a log has what was sent, channel by channel in its order."""
    log = read(path)
    assert not log.losses()
    for topic, messages in sent.items():
        if topic == "/text":
            assert list(log.messages(topic)) == messages
        else:
            name = "b" if topic == "/row" else "a"
            found = zip(log[topic].time_ns.tolist(), log[topic].field(name).tolist(), strict=True)
            assert list(found) == messages, topic


@pytest.mark.parametrize("rate", [100, 500, 2000])
@pytest.mark.parametrize("gaps", [False, True])
def test_the_doctor_finds_nothing(tmp_path, rate, gaps):
    sent = written(tmp_path / "log.mcap", rate, 0.6, seed=rate, gaps=gaps)
    assert not complaints(tmp_path / "log.mcap")
    holds(tmp_path / "log.mcap", sent)


def test_also_of_what_comes_in_between(tmp_path):
    def more(writer, tick):
        if tick % 37 == 0:
            writer.add_metadata(f"push {tick}", {"push": "hard"})
        if tick == 100:
            writer.attach(AttachedFile("a", "text/plain", b"b"))

    sent = written(tmp_path / "log.mcap", 500, 1.0, more=more)
    assert not complaints(tmp_path / "log.mcap")
    holds(tmp_path / "log.mcap", sent)


def test_a_chunk_has_whole_ticks(tmp_path):
    """So that no tick has a part of its messages in one chunk and a part in another, but where the disk asks."""
    written(tmp_path / "log.mcap", 500, 1.0)
    log = read(tmp_path / "log.mcap")
    for place, data in log.sound_chunks():
        times = {topic: place.entries(number, log.data)["time"].tolist() for topic, number in log._ids.items()}
        assert times["/c0"] == times["/c1"] == times["/row"]
        assert min(map(min, filter(None, times.values()))) == times["/c0"][0]
        assert max(map(max, filter(None, times.values()))) == times["/c0"][-1]
        assert len(list(records_in(data))) == sum(map(len, times.values()))


def test_what_the_doctor_finds(tmp_path):
    """The negative control: of messages that go back, and of a file without its end."""
    with (tmp_path / "back.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/x", "json", writer.register_schema("x", "jsonschema", b"{}"))
        for time in (20, 10):
            writer.add_message(channel, time, b"{}", time)
        writer.finish()
    assert [said for said in complaints(tmp_path / "back.mcap") if "after one at 20" in said]
    written(tmp_path / "log.mcap", 500, 0.3)
    whole = (tmp_path / "log.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(whole[: len(whole) // 2])
    assert complaints(tmp_path / "cut.mcap")


def test_a_run_with_pushes_and_commands(tmp_path):
    scenario = surefoot.load("walk-level", {"fidelity": "pendulum", "gait.steps": 6, "duration": 4.0})
    with surefoot.Simulation(scenario, log=tmp_path / "log.mcap") as sim:
        while not sim.done:
            if sim.time in (1.0, 1.111, 2.5):
                sim.push((5.0, 0.0, 0.0), duration=0.1)
            sim.step()
    assert not complaints(tmp_path / "log.mcap")


def test_messages_that_the_index_places_beyond_their_chunk_are_left_out(tmp_path):
    from surefoot.scenarios.log.messages import gathered
    from surefoot.scenarios.log.scan import INDEX_ENTRY

    data = memoryview(bytes(range(100)))
    for offsets in ([0, 50, 90], [0, 50, 91, 2**63], [], [500]):
        index = np.array([(0, offset) for offset in offsets], INDEX_ENTRY)
        wanted = b"".join(bytes(data[offset : offset + 10]) for offset in offsets if offset <= 90)
        assert bytes(gathered(data, index, 10)) == wanted
    assert bytes(gathered(data[:5], np.array([(0, 0)], INDEX_ENTRY), 10)) == b""
