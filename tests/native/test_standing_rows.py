"""Rows that are read where their arrays lie, messages filled in place, and fields cut out of numbers when read."""

import pickle
from dataclasses import fields, replace

import numpy as np
import pytest
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from google.protobuf.timestamp_pb2 import Timestamp

from surefoot.native.library import VARIABLE
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.rows import RowLayout
from surefoot.scenarios.log.spec import NANOS, SECONDS, Template, slot
from surefoot.wbc.types import WbcReference

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/a", "A", (FieldSpec("x", (3,)), FieldSpec("y", (2, 2)), FieldSpec("n")))


def row_of(writer):
    channel = writer.channel(SPEC)
    return writer.rows(RowLayout(((channel, ("x", "y")),), ((channel, ("n",)),), standing=True))


def test_a_row_has_what_its_arrays_hold_now_whether_or_not_they_are_those_of_before(kernels, tmp_path):
    rng = np.random.default_rng(0)
    x, y, wanted = np.zeros(3), np.zeros((2, 2)), []
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        row = row_of(writer)
        for tick in range(200):
            x[:], y[:] = rng.normal(size=3), rng.normal(size=(2, 2))
            if tick % 7 == 3:
                y = y.copy()
            given = np.full(3, float(tick)) if tick % 5 == 2 else x
            wanted.append((*given, *y.ravel(), tick))
            row.append(tick * 2_000_000, (tick,), given, y)
    channel = read(tmp_path / "log.mcap")["/a"]
    found = [channel.field(name).reshape(200, -1) for name in ("x", "y", "n")]
    np.testing.assert_array_equal(np.hstack(found), wanted)


@pytest.mark.parametrize("switch", ["1", "0"])
def test_arrays_that_nobody_writes_into_wait_for_their_chunk(kernels, tmp_path, monkeypatch, switch):
    monkeypatch.setenv(VARIABLE, switch)
    rng = np.random.default_rng(2)
    given = [(rng.normal(size=8), rng.normal(size=(2, 2)), rng.normal()) for _ in range(200)]
    at = {("/a", "x"): slice(4, 7), ("/a", "y"): slice(8, 12)}
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        channel = writer.channel(SPEC)
        row = writer.rows(RowLayout(((channel, ("x", "y")),), ((channel, ("n",)),), fresh=True, at=at))
        for tick, (point, y, n) in enumerate(given):
            row.append(tick * 2_000_000, (n,), point, y.ravel())
    channel = read(tmp_path / "log.mcap")["/a"]
    found = [channel.field(name).reshape(200, -1) for name in ("x", "y", "n")]
    np.testing.assert_array_equal(np.hstack(found), [(*point[4:7], *y.ravel(), n) for point, y, n in given])


@pytest.mark.parametrize(
    "vectors",
    [
        (np.zeros(3), np.zeros(3)),
        (np.zeros(3),),
        (np.zeros(3), np.zeros((4, 4))[:2, :2]),
        (np.zeros(3), np.zeros((2, 2), np.float32)),
        (np.zeros(3), np.zeros((2, 2), order="F")),
    ],
    ids=["too few", "one", "in pieces", "short numbers", "by columns"],
)
def test_arrays_that_are_not_as_the_kernel_reads_them_are_refused(kernels, tmp_path, vectors):
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        row = row_of(writer)
        row.append(0, (0.0,), np.zeros(3), np.zeros((2, 2)))
        with pytest.raises(ValueError, match="of a row"):
            row.append(1, (1.0,), *vectors)


def test_a_message_is_that_of_plain_python_to_the_byte(kernels, monkeypatch):
    joints = [JointState(name=f"j{i}", position=slot(k), velocity=slot(1)) for i, k in enumerate((2, 0, 1))]
    blank = JointStates(timestamp=Timestamp(seconds=SECONDS, nanos=NANOS), joints=joints)
    compiled = Template(blank, 3)
    monkeypatch.setenv(VARIABLE, "0")
    plain = Template(blank, 3)
    rng = np.random.default_rng(1)
    for time_ns in (0, 1, 999_999_999, 10**9, 123_456_789_012_345_678, *rng.integers(0, 10**15, 20).tolist()):
        values = tuple(rng.normal(size=3).tolist())
        assert compiled.encode(time_ns, values) == plain.encode(time_ns, values)


def reference():
    return WbcReference.of_numbers(np.arange(55.0), (True, True), 0.5, -1, 1, 0.25, -1)


def test_fields_that_are_cut_out_late_are_like_others():
    one, other = reference(), reference()
    named = [field.name for field in fields(one)]
    assert all(getattr(one, name) is getattr(one, name) for name in named)
    changed = replace(other, **{named[1]: getattr(one, named[1])})
    copied = pickle.loads(pickle.dumps(reference()))
    for name in named:
        if name != "numbers":
            np.testing.assert_array_equal(getattr(changed, name), getattr(one, name))
            np.testing.assert_array_equal(getattr(copied, name), getattr(one, name))
    assert repr(one) == repr(reference())
    assert not hasattr(one, "no_such_field")
