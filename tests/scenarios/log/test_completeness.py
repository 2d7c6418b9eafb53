"""Numbers of messages show which are missing, which stand twice, and when they show nothing."""

import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.records import Chunk, MessageIndex

from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.completeness import _HEADER, Numbering
from surefoot.scenarios.log.encoding import MAGIC, Summary, chunk_head, encoded

pytestmark = pytest.mark.unit


def headers(channel, sequences):
    made = np.zeros(len(sequences), _HEADER)
    made["channel"], made["sequence"] = channel, sequences
    return made


def count(*parts):
    numbering = Numbering()
    for channel, sequences in parts:
        numbering.add(headers(channel, sequences))
    return numbering.count()


NUMBERS = st.lists(st.integers(0, 60), min_size=2, max_size=80).filter(lambda found: len(set(found)) > 1)


@settings(max_examples=200)
@given(NUMBERS, st.integers(1, 9))
def test_gaps_and_doubles_are_those_of_the_sorted_numbers(numbers, size):
    parts = [(3, numbers[start : start + size]) for start in range(0, len(numbers), size)]
    found = count(*parts)
    begin = int(min(numbers) == 1)
    span = max(numbers) + 1 - min(numbers) - len(set(numbers))
    assert found.missing == ({3: span} if span else {})
    assert found.before == ({3: min(numbers) - begin} if min(numbers) > begin else {})
    assert found.again == ({3: len(numbers) - len(set(numbers))} if len(numbers) > len(set(numbers)) else {})


def test_channels_count_by_themselves():
    found = count((1, [0, 1, 2, 5]), (2, [0, 1]), (3, [2, 3]))
    assert (found.missing, found.before, found.again) == ({1: 2}, {3: 2}, {})


@pytest.mark.parametrize("parts", [[(1, [0, 0, 0]), (2, [0, 1])], [(1, [0, 2, 4]), (2, [1, 3, 5])]])
def test_one_number_for_all_and_one_counter_over_all_tell_nothing(parts):
    assert count(*parts) is None


def test_others_count_from_1():
    found = count((1, [1, 2, 3]), (2, [1, 2]))
    assert found.missing == found.before == {}


SPEC = ChannelSpec("/x", "X", (FieldSpec("a"),))


@pytest.fixture
def parts(tmp_path):
    """Chunk and index of a log of ours, and what writes a file of a changed one."""
    path = tmp_path / "log.mcap"
    with LogWriter(path, {}, compression="") as writer:
        x = writer.channel(SPEC)
        for tick in range(30):
            x.append(2_000_000 * tick, tick)
    log = read(path)
    (place,) = log.contents.chunks
    start = place.position

    def write(body, entries, times=(place.start_ns, place.end_ns), skip=0):
        data = path.read_bytes()[:start]
        chunk = Chunk("", body, times[1], times[0], zlib.crc32(body), len(body))
        head, index = chunk_head(chunk), encoded(MessageIndex(1, entries))
        summary = Summary()
        summary.add_chunk(chunk, len(data), len(head) + len(body), [(1, index)])
        out = data + head + body + index
        path.write_bytes(out + summary.finish(len(out), {}, zlib.crc32(out)))
        return read(path)

    assert log.contents.chunks[0].compression == ""
    assert path.read_bytes()[:8] == MAGIC
    return write, bytes(log.data[place.data]), place.entries(1, log.data).tolist()


def test_a_chunk_is_what_its_index_says(parts):
    write, body, entries = parts
    assert write(body, entries).faults() == ()


def test_messages_that_no_index_lists_are_seen(parts):
    write, body, entries = parts
    assert "holds 3 messages that its index does not list" in write(body, entries[:9] + entries[12:]).faults()[0]


def test_messages_that_are_not_there_are_seen(parts):
    write, body, entries = parts
    later = [(time + 1, place) for time, place in entries[-2:]]
    faults = write(body, entries[:-2] + later).faults()
    assert "has not got 2 of the messages that its index lists" in faults[0]
    assert "holds 2 messages" in faults[-1]


def test_times_of_a_chunk_are_those_of_its_messages(parts):
    write, body, entries = parts
    assert "states other times" in write(body, entries, times=(0, 10**9)).faults()[0]


def test_messages_left_out_are_counted(parts):
    write, body, entries = parts
    size = len(body) // 30
    without = body[: 5 * size] + body[9 * size :]
    places = [
        (time, place - 4 * size * (place > 5 * size)) for time, place in entries if not 5 * size <= place < 9 * size
    ]
    log = write(without, places)
    assert log.lacks() == ("4 messages of /x are missing",)
    assert log.faults() == ()


def test_a_message_bears_the_time_it_is_logged_at(parts):
    write, body, entries = parts
    size = len(body) // 30
    first, second = body[:size], body[size : 2 * size]
    swapped = first[:31] + second[31:] + second[:31] + first[31:]
    assert (
        "2 messages of /x are logged at other times than they bear"
        in write(swapped + body[2 * size :], entries).faults()
    )


def test_a_log_may_say_that_it_dropped_its_beginning(tmp_path):
    for dropped, lacks in (("10", ()), ("9", ("10 messages of /x are missing",))):
        path = tmp_path / f"{dropped}.mcap"
        with LogWriter(path, {"kept": {"keep": "1.0", "from": "0.02", "messages_dropped": dropped}}) as writer:
            x = writer.channel(SPEC)
            x.total = 10
            for tick in range(10, 30):
                x.append(2_000_000 * tick, tick)
        assert read(path).lacks() == lacks
