"""Rows of several channels: what their arrays hold at each append, wherever these are."""

import numpy as np
import pytest

from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, NoLog, read
from surefoot.scenarios.log.layout import RowLayout

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/a", "A", (FieldSpec("x", (3,)), FieldSpec("y", (2, 2)), FieldSpec("n")))
AT = {("/a", "x"): slice(4, 7), ("/a", "y"): slice(8, 12)}


def row_of(writer, at=None):
    channel = writer.channel(SPEC)
    return writer.rows(RowLayout(((channel, ("x", "y")),), ((channel, ("n",)),), at=at))


def logged(path):
    channel = read(path)["/a"]
    return np.hstack([channel.field(name).reshape(len(channel), -1) for name in ("x", "y", "n")])


def test_a_row_has_what_its_arrays_hold_now_whether_or_not_they_are_those_of_before(tmp_path):
    rng = np.random.default_rng(0)
    x, y, wanted = np.zeros(3), np.zeros((2, 2)), []
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        row = row_of(writer)
        for tick in range(200):
            x[:], y[:] = rng.normal(size=3), rng.normal(size=(2, 2))
            if tick % 7 == 3:
                y = y.copy()
            given = np.full(3, float(tick)) if tick % 5 == 2 else x
            if tick % 11 == 4:  # the same numbers in other pieces
                wanted.append((*given, *y.ravel(), tick))
                row.append(tick * 2_000_000, (tick,), np.concatenate((given, y.ravel())))
                continue
            wanted.append((*given, *y.ravel(), tick))
            row.append(tick * 2_000_000, (tick,), given, y)
    np.testing.assert_array_equal(logged(tmp_path / "log.mcap"), wanted)


def test_fields_may_be_at_columns_of_their_own(tmp_path):
    rng = np.random.default_rng(2)
    given = [(rng.normal(size=8), rng.normal(size=(2, 2)), rng.normal()) for _ in range(200)]
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        row = row_of(writer, AT)
        for tick, (point, y, n) in enumerate(given):
            row.append(tick * 2_000_000, (n,), point, y.ravel())
    np.testing.assert_array_equal(
        logged(tmp_path / "log.mcap"), [(*point[4:7], *y.ravel(), n) for point, y, n in given]
    )


@pytest.mark.parametrize(
    "vectors",
    [
        (np.zeros(3), np.zeros(3)),
        (np.zeros(3),),
        (np.zeros(3), np.zeros((4, 4))[:2, :2]),
        (np.zeros(3), np.zeros((2, 2), np.float32)),
        (np.zeros(3), np.zeros((2, 2), order="F")),
        (np.zeros(3), np.zeros(4, int)),
        (np.zeros(3), np.zeros(4), np.zeros(1)),
    ],
    ids=["too few", "one", "in pieces", "short numbers", "by columns", "whole numbers", "too many"],
)
def test_arrays_that_do_not_lie_as_a_row_is_read_are_refused_and_the_row_before_is_kept(tmp_path, vectors):
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        row = row_of(writer)
        row.append(0, (0.0,), np.ones(3), np.ones((2, 2)))
        with pytest.raises(ValueError, match="of a row"):
            row.append(1, (1.0,), *vectors)
        row.append(2, (2.0,), np.ones(3), np.ones((2, 2)))
    np.testing.assert_array_equal(logged(tmp_path / "log.mcap"), [(1.0,) * 7 + (0.0,), (1.0,) * 7 + (2.0,)])


def test_rows_of_no_log_are_forgotten():
    writer = NoLog()
    row = row_of(writer)
    for tick in range(300):
        row.append(tick * 2_000_000, (tick,), np.ones(3), np.ones((2, 2)))
    writer.close()
