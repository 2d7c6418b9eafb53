"""Templates of foreign messages, rows of several channels, and what is derived in them."""

import numpy as np
import pytest
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from google.protobuf.timestamp_pb2 import Timestamp

from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.channel import Slab
from surefoot.scenarios.log.layout import RowLayout
from surefoot.scenarios.log.template import NANOS, SECONDS, Template, slot

pytestmark = pytest.mark.unit


def message(*values):
    joints = [JointState(name=f"j{i}", position=value) for i, value in enumerate(values)]
    return JointStates(timestamp=Timestamp(seconds=SECONDS, nanos=NANOS), joints=joints)


@pytest.mark.parametrize("time_ns", [0, 1, 999_999_999, 10**9, 123_456_789_012_345_678])
@pytest.mark.parametrize("values", [(0.0, -0.0, 1e-300), (np.pi, np.inf, -1.5)])
def test_a_template_decodes_to_its_values_and_never_changes_its_size(time_ns, values):
    template = Template(message(slot(0), slot(2), slot(1)), 3)
    data = template.encode(time_ns, values)
    back = JointStates.FromString(data)
    assert [joint.position for joint in back.joints] == [values[0], values[2], values[1]]
    assert back.timestamp.seconds * 10**9 + back.timestamp.nanos == time_ns
    assert len(data) == len(template.encode(0, (1.0, 2.0, 3.0)))


def test_a_value_may_stand_in_several_places_but_not_in_none():
    data = Template(message(slot(0), slot(0)), 1).encode(5, [2.5])
    assert [joint.position for joint in JointStates.FromString(data).joints] == [2.5, 2.5]
    with pytest.raises(ValueError, match="value 1 has no place"):
        Template(message(slot(0)), 2)


A = ChannelSpec("/a", "A", (FieldSpec("x", (3,)), FieldSpec("n", (), kind="int"), FieldSpec("twice", (2,))))
B = ChannelSpec("/b", "B", (FieldSpec("y", (2, 2)), FieldSpec("z")))


class Twice:
    """Derives a field from inputs that are in no channel."""

    def __init__(self, table):
        self._table = table

    def derive(self, rows):
        table = self._table
        twice = 2 * table["extra"] + table["shift"] + 0 * table["/b", "z"]
        table["/a", "twice"][:rows] = twice[:rows]


def test_rows_give_the_same_log_as_single_appends(tmp_path):
    rng = np.random.default_rng(0)
    with LogWriter(tmp_path / "rows.mcap", {}) as rows, LogWriter(tmp_path / "single.mcap", {}) as single:
        a, b = rows.channel(A), rows.channel(B)
        layout = RowLayout(
            ((b, ("y",)), (a, ("x",))), ((a, ("n",)), (b, ("z",))), ((a, ("twice",)),), Twice, {"extra": 2}, ("shift",)
        )  # fmt: skip
        row = rows.rows(layout)
        one, two = single.channel(A), single.channel(B)
        for tick in range(200):
            x, y, extra = rng.normal(size=3), rng.normal(size=(2, 2)), rng.normal(size=2)
            row.append(tick * 2_000_000, (tick, 0.5 * tick, tick), y.ravel(), x, extra)
            one.append(tick * 2_000_000, x, tick, 2 * extra + tick)
            two.append(tick * 2_000_000, y, 0.5 * tick)
    first, second = read(tmp_path / "rows.mcap"), read(tmp_path / "single.mcap")
    assert len(first["/a"]) == 200
    assert all(first[topic].content() == second[topic].content() for topic in ("/a", "/b"))


def test_a_row_may_be_of_vectors_alone(tmp_path):
    spec = ChannelSpec("/c", "C", (FieldSpec("x", (3,)),))
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        c = writer.channel(spec)
        row = writer.rows(RowLayout(((c, ("x",)),), ()))
        row.append(5, (), np.array([1.0, 2.0, 3.0]))
    assert read(tmp_path / "log.mcap")["/c"].field("x").tolist() == [[1.0, 2.0, 3.0]]


def test_a_row_must_be_complete(tmp_path):
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        a = writer.channel(A)
        with pytest.raises(ValueError, match="every field"):
            writer.rows(RowLayout(((a, ("x",)),), ((a, ("n",)),)))


@pytest.mark.parametrize("numbers", [(1,), (1, 2.0, 3.0)])
def test_a_number_too_few_or_too_many_shifts_nothing_in_silence(tmp_path, numbers):
    writer = LogWriter(tmp_path / "log.mcap", {})
    b = writer.channel(B)
    row = writer.rows(RowLayout(((b, ("y",)),), ((b, ("z",)),), more_numbers=("more",)))
    with pytest.raises(ValueError, match="where there are places for 2"), writer:
        row.append(0, numbers, np.zeros(4))


@pytest.mark.parametrize(("row", "column", "size"), [(0, 0, 12), (0, 5, 3), (2, 0, 4), (1, 5, 7), (2, 11, 1)])
def test_a_piece_of_a_slab_is_that_of_its_row_and_column(row, column, size):
    slab = Slab(3, 12)
    slab.memory[:] = np.arange(36).reshape(3, 12)
    assert bytes(slab.piece(row, column, size)) == slab.memory[row, column : column + size].tobytes()
    slab.piece(row, column, size)[:] = bytes(size)
    assert not slab.memory[row, column : column + size].any()
