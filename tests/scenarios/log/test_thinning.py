"""Channels that do not judge can be thinned: to so many messages in a second, without a change of the verdict."""

import numpy as np
import pytest
from mcap_doctor import complaints

import surefoot
from surefoot.scenarios.judge.inspection import inspect
from surefoot.scenarios.judge.metric import RunView, metric
from surefoot.scenarios.judge.metrics import METRICS, OWN, judged_topics, register
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, PublishedSchema, Thinning, read
from surefoot.scenarios.log.layout import RowLayout
from surefoot.scenarios.log.thinning import THINNED, Sieve
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/x", "X", (FieldSpec("a"),))
WALK = {"fidelity": "pendulum", "gait.steps": 2, "duration": 2.0}


@pytest.mark.parametrize("rate", [1, 3, 20, 333, 500, 1000])
@pytest.mark.parametrize("ticks", [500, 999])
def test_the_first_message_from_each_multiple_of_the_period_on_is_taken(rate, ticks):
    times = [tick * 10**9 // ticks for tick in range(3 * ticks)]
    sieve = Sieve(rate)
    taken = [time for time in times if sieve.takes(time)]
    periods = [time * rate // 10**9 for time in times]
    assert taken == [time for time, now, before in zip(times, periods, [-1, *periods], strict=False) if now > before]


def test_each_way_of_writing_is_thinned_and_none_of_the_others(tmp_path):
    thinning = Thinning(10, frozenset({"/whole", "/whole_row"}))
    with LogWriter(tmp_path / "log.mcap", {}, thinning=thinning) as writer:
        whole, appended, filled = (
            writer.channel(ChannelSpec(topic, "X", SPEC.fields)) for topic in ("/whole", "/a", "/f")
        )
        fill = filled.filler({}, ["a"])
        rows = []
        for topic in ("/row", "/whole_row"):
            channel = writer.channel(ChannelSpec(topic, "R", (FieldSpec("v", (2,)), FieldSpec("b"))))
            rows.append(writer.rows(RowLayout(((channel, ("v",)),), ((channel, ("b",)),))))
        schema = PublishedSchema("text", b"")
        sampled, said = (writer.message_channel(f"/{name}", schema, "words", name == "s") for name in ("s", "t"))
        values = np.zeros(2)
        for tick in range(1000):
            time, values[:] = tick * 2_000_000, tick
            whole.append(time, tick)
            appended.put(time, a=tick)
            fill(time, None, tick)
            for row in rows:
                row.append(time, (tick,), values)
            sampled.append(time, b"%d" % tick)
            said.append(time, b"%d" % tick)
    log = read(tmp_path / "log.mcap")
    assert not complaints(log.path)
    assert not log.losses()
    counts = {topic: log.count(topic) for topic in log.topics}
    whole_ones = {"/whole": 1000, "/whole_row": 1000, "/t": 1000}
    assert counts == {"/a": 20, "/f": 20, "/row": 20, "/s": 20, **whole_ones}
    assert log["/row"].field("v")[:, 0].tolist() == log["/row"].field("b").tolist() == list(range(0, 1000, 50))
    notes = {channel.topic: channel.metadata.get(THINNED) for channel in log.contents.channels.values()}
    assert notes == {topic: None if topic in whole_ones else "10" for topic in log.topics}


def test_rows_are_thinned_together_or_not_at_all(tmp_path):
    with LogWriter(tmp_path / "log.mcap", {}, thinning=Thinning(10, frozenset({"/x"}))) as writer:
        one, other = writer.channel(SPEC), writer.channel(ChannelSpec("/y", "Y", SPEC.fields))
        with pytest.raises(ValueError, match="of which /x are not thinned"):
            writer.rows(RowLayout((), ((one, ("a",)), (other, ("a",)))))


def told(path):
    """Text of an inspection, but for what the clock on the wall measures, and for the rates of topics."""
    said = inspect(read(path)).to_json()
    apart = {"log", "topics", "health"} | {name for name, metric in OWN.items() if not metric.repeatable}
    return {name: value for name, value in said.items() if name not in apart}


@pytest.mark.parametrize("rate", [1, 17])
def test_a_thinned_log_has_the_verdict_of_the_whole_one(tmp_path, rate):
    logs = [
        run_scenario(surefoot.load("walk-level", {**WALK, **more}), tmp_path).log for more in ({}, {"log.rate": rate})
    ]
    whole, thinned = map(read, logs)
    assert told(logs[0]) == told(logs[1])
    judged = judged_topics()
    for topic in whole.topics:
        same = list(whole.messages(topic)) == list(thinned.messages(topic))
        assert same or topic in ("/timing", "/process") or topic not in judged, topic
        assert topic in judged or topic == "/events" or thinned.count(topic) <= 2 * rate + 1
    assert thinned.count("/footsteps") < whole.count("/footsteps")


def test_it_is_walked_again_to_the_bit(tmp_path, same_content):
    first = run_scenario(surefoot.load("walk-level", {**WALK, "log.rate": 5}), tmp_path).log
    again = run_scenario(surefoot.load(str(first)), tmp_path).log
    assert not same_content(first, again)


def test_what_a_metric_reads_is_not_thinned():
    """Also one that another package brings; without it the negative control."""
    assert "/footsteps" not in judged_topics()

    @metric(reads={"/footsteps": ("next",)})
    def steps_seen(run: RunView) -> int:
        """Plans with a footstep to come."""
        return len(run.log["/footsteps"].field("next"))

    register(steps_seen)
    try:
        assert "/footsteps" in judged_topics()
    finally:
        METRICS.discard("steps_seen")
