"""Differences of two logs are found to the bit, and named by channel, field and time."""

import numpy as np
import pytest

from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.show.differences import compare_channels

pytestmark = pytest.mark.unit

TRUTH = ChannelSpec("/truth", "Truth", (FieldSpec("com", (3,)), FieldSpec("flag", (), kind="int")))
TORQUE = ChannelSpec("/torque", "Torque", (FieldSpec("command", (2,)),))
TICKS, PERIOD = 50, 2_000_000


@pytest.fixture
def log(tmp_path):
    """Write a log of two channels; changes are (topic, tick, function of the values)."""
    numbers = iter(range(100))

    def write(*changes, specs=(TORQUE, TRUTH), ticks=TICKS, skip=(), period=PERIOD):
        path = tmp_path / f"{next(numbers)}.mcap"
        with LogWriter(path, {}) as writer:
            channels = {spec.topic: writer.channel(spec) for spec in specs}
            for tick in range(ticks):
                values = {"/truth": [np.full(3, tick * 0.1), tick], "/torque": [np.array([tick, np.nan])]}
                for topic, when, change in changes:
                    if when == tick:
                        change(values[topic])
                for spec in specs:
                    if (spec.topic, tick) not in skip:
                        channels[spec.topic].append(tick * period, *values[spec.topic][: len(spec.fields)])
        return read(path)

    return write


def add(index, amount):
    def change(values):
        values[0][index] += amount

    return change


def by_topic(a, b, tolerance=1e-6):
    return {found.topic: found for found in compare_channels(a, b, tolerance)}


def test_the_same_content_is_the_same(log):
    found = compare_channels(log(), log(), 0.0)
    assert [one.topic for one in found] == ["/truth", "/torque"]
    assert all(one.same and one.exact is None and one.tolerated is None for one in found)


def test_one_bit_is_found_with_channel_field_and_time(log):
    found = by_topic(log(), log(("/truth", 20, add(2, 5e-16))))
    assert found["/torque"].same
    point = found["/truth"].exact
    assert (point.time, point.field) == (pytest.approx(0.04), "com[2]")
    assert point.b - point.a == pytest.approx(4.4e-16, rel=0.1)
    assert found["/truth"].tolerated is None
    assert not found["/truth"].same


def test_the_tolerance_is_relative_and_absolute_below_1(log):
    a, b = log(), log(("/torque", 3, add(0, 2e-5)), ("/torque", 40, add(0, 2e-3)))
    assert by_topic(a, b, 1e-5)["/torque"].tolerated.time == pytest.approx(0.08)
    assert by_topic(a, b, 1e-6)["/torque"].tolerated.time == pytest.approx(0.006)
    assert by_topic(a, b, 1.0)["/torque"].tolerated is None


def test_minus_zero_differs_by_a_bit_and_by_no_value(log):
    def negate(values):
        values[0][0] = -0.0

    found = by_topic(log(), log(("/truth", 0, negate)), 0.0)["/truth"]
    assert found.exact.time == 0.0
    assert found.tolerated is None


def test_a_value_that_becomes_no_number_differs_beyond_any_tolerance(log):
    found = by_topic(log(), log(("/truth", 9, add(0, np.nan))), 1e6)["/truth"]
    assert np.isnan(found.tolerated.b)


def test_channels_that_part_together_come_in_the_order_of_cause(log):
    changes = (("/torque", 5, add(0, 1.0)), ("/truth", 5, add(0, 1.0)))
    assert compare_channels(log(), log(*changes), 0.0)[0].topic == "/truth"
    changes = (("/torque", 4, add(0, 1.0)), ("/truth", 5, add(0, 1.0)))
    assert compare_channels(log(), log(*changes), 0.0)[0].topic == "/torque"


def test_a_message_in_one_log_only(log):
    found = by_topic(log(), log(skip={("/torque", 7)}))["/torque"]
    assert found.messages == (50, 49)
    assert found.only_one == pytest.approx(0.014)
    assert found.exact is None
    assert not found.same
    assert found.time == pytest.approx(0.014)


def test_a_shorter_log_does_not_part_where_it_ends(log):
    found = by_topic(log(), log(ticks=30))
    assert all(one.time is None and not one.same for one in found.values())
    cut_in_a_tick = by_topic(log(), log(ticks=30, skip={("/truth", 29)}))
    assert all(one.time is None for one in cut_in_a_tick.values())


def test_other_rates_are_compared_at_common_times(log):
    slow = log(ticks=25, period=2 * PERIOD)
    found = by_topic(slow, log())["/truth"]
    assert found.only_one == pytest.approx(0.002)
    assert found.exact.time == pytest.approx(0.004)


def test_fields_and_shapes_of_another_version(log):
    other = ChannelSpec("/truth", "Truth", (FieldSpec("com", (3,)),))
    found = by_topic(log(), log(specs=(other,)))
    assert set(found) == {"/truth"}
    assert found["/truth"].layout == ("flag only in A",)
    assert found["/truth"].exact is None
    swapped = by_topic(log(specs=(other,)), log())["/truth"]
    assert swapped.layout == ("flag only in B",)


def test_empty_channels(log):
    found = by_topic(log(), log(ticks=0))
    assert all(one.time is None and not one.same for one in found.values())
