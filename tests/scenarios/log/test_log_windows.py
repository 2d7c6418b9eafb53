"""Windows of logs, their export, and what bounds the memory."""

import csv
import errno
import json
import sys
import tempfile

import numpy as np
import pytest
from spoilt import opened, spoil

from surefoot.scenarios.columns import Columns, Memory
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import compute, digest
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.log.spec import layout_of
from surefoot.scenarios.record import channels
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.show.export import Joined, export, selected

pytestmark = pytest.mark.unit

SPEC = ChannelSpec("/x", "X", (FieldSpec("a"), FieldSpec("b", (2, 3)), FieldSpec("n", (), kind="int")))
TICKS = 2000


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("logs") / "log.mcap"
    with LogWriter(path, {}) as writer:
        x = writer.channel(SPEC)
        for tick in range(TICKS):
            x.append(tick * 2_000_000, tick / 4, np.full((2, 3), tick), tick)
    return read(path)


@pytest.mark.parametrize(("start", "end"), [(0, 4), (1.0, 1.5), (0.0399, 0.0401), (-5, 0.1), (3.9, 99), (2.0, 2.0)])
def test_a_window_is_the_part_of_the_whole_in_that_time(log, start, end):
    whole = read(log.path)["/x"]
    inside = (whole.time >= start - 1e-12) & (whole.time <= end + 1e-12)
    part = log.window("/x", start, end)
    assert np.array_equal(part.time_ns, whole.time_ns[inside])
    assert np.array_equal(part.field("b"), whole.field("b")[inside])


def test_a_window_decompresses_only_its_own_chunks(log, tmp_path):
    spoilt = opened(log.path, tmp_path)
    own = spoil(spoilt, lambda chunk: chunk.start_ns <= 1_200_000_000 and chunk.end_ns >= 1_000_000_000)
    assert 0 < own <= 4 < len(spoilt.contents.chunks)
    assert spoilt.window("/x", 1.0, 1.2).content() == log.window("/x", 1.0, 1.2).content()
    assert not spoilt.damage
    spoilt.window("/x", 1.0, 3.0)
    assert spoilt.damage, "what is read of other chunks would be seen"


def test_windows_together_are_the_whole(log):
    parts = [part["/x"] for part in log.windows(["/x"], 0.5)]
    assert len(parts) > 5
    assert np.array_equal(np.concatenate([part.field("n") for part in parts]), np.arange(TICKS))


def test_metrics_of_a_log_in_parts_are_those_of_the_whole(tmp_path, motion, two_steps, robot):
    path = run_scenario(two_steps, tmp_path, simulate=motion(duration=2.2), robot=robot).log
    parts, whole = compute(read(path)), RunView(read(path))
    for held in (0, Memory().held):
        gathered = digest(read(path, Memory(held, window=0.5)))
        for function in gathered.reduced:
            assert np.array_equal(gathered.reduced[function], function(whole), equal_nan=True)
        assert compute(gathered) == parts


def test_columns_hold_the_same_in_files_as_in_memory():
    held, filed = Columns(), Columns(Memory(held=0))
    for n in (3, 0, 2):
        for columns in (held, filed):
            columns.add("a", np.arange(4.0 * n).reshape(n, 4)[:, ::2])
            columns.add("none", np.zeros(0))
            columns.add("unlike", np.zeros((n, n)))
    assert list(held) == list(filed) == ["a", "none"]
    assert np.array_equal(held["a"], filed["a"])
    assert len(filed["none"]) == 0
    with pytest.raises(ValueError, match="read-only"):
        filed["a"][0] = 1.0


def test_no_room_for_a_long_log_is_a_sentence(monkeypatch):
    def full(**_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    with pytest.raises(LogError, match="no space left on device; set TMPDIR"):
        Columns(Memory(held=0)).add("a", np.zeros(1))


def test_csv_npz_and_columns_agree(log, tmp_path):
    part = log.window("/x", 1.0, 1.1)
    chosen = selected(log, "/x", 1.0, 1.1, None)
    assert export(chosen, tmp_path / "x.csv") == len(part)
    with (tmp_path / "x.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["time [s]", "a", *(f"b_{i}_{j}" for i in range(2) for j in range(3)), "n"]
    assert np.array_equal(np.array(rows[1:], float), np.column_stack(list(part.columns().values())))
    export(chosen, tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz") as data:
        assert np.array_equal(data["b"], part.field("b"))
        assert np.array_equal(data["time"], part.time)


ROBOT = (
    FieldSpec("q", (9,), "m, -, rad", "world", "configuration"),
    FieldSpec("v", (8,), "m/s, rad/s", "base", "velocity"),
    FieldSpec("command", (2,), "N m", "", "commanded [at the output]"),
    FieldSpec("cop", (2,), "m", "left sole"),
    FieldSpec("wrench", (6,), "N, N m", "left sole"),
    FieldSpec("step", (2, 4), "m, rad", "world", "x y z yaw"),
    FieldSpec("stance", kind="int"),
)
JOINTS = ("left_knee", "right_knee")


@pytest.fixture(scope="module")
def moved(tmp_path_factory):
    """The log of a robot with two joints."""
    path = tmp_path_factory.mktemp("robot") / "log.mcap"
    with LogWriter(path, {"run": {"joint_names": json.dumps(JOINTS)}}) as writer:
        writer.channel(ChannelSpec("/r", "R", ROBOT)).append(0, *(np.ones(field.shape) for field in ROBOT[:-1]), 1)
    return read(path)


def test_a_field_that_is_read_has_its_unit_frame_and_meaning(moved):
    assert moved["/r"].fields == moved.fields("/r") == ROBOT
    sizes = channels.Sizes(nj=25, nq=32, nv=31, horizon=80)
    made = [make(sizes) for make in (channels.measurement, channels.truth, channels.contact, channels.plan)]
    assert all(layout_of(spec.metadata) == spec.fields for spec in made)
    assert layout_of({"layout": '[["a", "double", []]]', "field.a": "no note"}) == (FieldSpec("a", doc="no note"),)


def test_columns_are_called_by_their_joints_and_have_the_unit_of_their_element(moved):
    units = {name: note["unit"] for name, note in moved["/r"].notes().items()}
    assert list(units) == list(moved["/r"].columns())
    assert [units[f"q.{name}"] for name in ("base_z", "base_qx", "left_knee")] == ["m", "-", "rad"]
    assert [units[f"v.base_{name}"] for name in ("linear_z", "angular_x")] == ["m/s", "rad/s"]
    assert units["command.right_knee"] == "N m"
    assert [units[f"wrench_{i}"] for i in (2, 3)] == ["N", "N m"]
    assert [units[f"step_1_{i}"] for i in (2, 3)] == ["m", "rad"]
    assert {"cop_0", "cop_1", "stance"} < set(units), "as many as joints, and not by joint"


def test_exports_keep_units(moved, tmp_path):
    export(selected(moved, "/r", None, None, "command"), tmp_path / "r.csv")
    head = (tmp_path / "r.csv").read_text().splitlines()[0]
    assert head == "time [s],command.left_knee [N m],command.right_knee [N m]"
    parquet = pytest.importorskip("pyarrow.parquet")
    export(selected(moved, "/r", None, None, None), tmp_path / "r.parquet")
    field = parquet.read_schema(tmp_path / "r.parquet").field("command.left_knee")
    assert field.metadata == {b"unit": b"N m", b"frame": b"", b"doc": b"commanded [at the output]"}


def test_a_frame_keeps_units(moved):
    pytest.importorskip("pandas")
    frame = moved.frame("/r")
    assert frame.attrs["q.base_x"] == {"unit": "m", "frame": "world", "doc": "configuration"}
    assert frame["command.left_knee"].iloc[0] == 1.0


@pytest.mark.parametrize("names", ["[1, 2]", '["a", "a"]', '"ab"', "{", "[" * 100_000])
def test_a_log_with_no_sound_joint_names_has_numbered_columns(tmp_path, names):
    path = tmp_path / "log.mcap"
    with LogWriter(path, {"run": {"joint_names": names}}) as writer:
        writer.channel(ChannelSpec("/r", "R", ROBOT[2:3])).append(0, np.ones(2))
    assert list(read(path)["/r"].columns()) == ["time", "command_0", "command_1"]


def test_one_field_alone(log, tmp_path):
    export(selected(log, "/x", None, None, "n"), tmp_path / "n.csv")
    assert (tmp_path / "n.csv").read_text().splitlines()[:2] == ["time [s],n", "0.0,0"]
    with pytest.raises(LogError, match="no field 'm'"):
        selected(log, "/x", None, None, "m")


def test_parquet_needs_pyarrow(log, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(LogError, match=r"package pyarrow; install it with: .*\[parquet\]', or export to .csv"):
        export(selected(log, "/x", None, None, None), tmp_path / "x.parquet")


def test_parquet_holds_the_columns(log, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    export(selected(log, "/x", 1.0, 1.1, None), tmp_path / "x.parquet")
    table = parquet.read_table(tmp_path / "x.parquet")
    assert np.array_equal(table["b_1_2"].to_numpy(), log.window("/x", 1.0, 1.1).field("b")[:, 1, 2])


def test_what_cannot_be_exported_is_said(log, tmp_path):
    part = selected(log, "/x", None, None, None)
    with pytest.raises(LogError, match=r"unknown kind of file '\.xls'; end its name in \.csv, \.npz, \.parquet"):
        export(part, tmp_path / "x.xls")
    with pytest.raises(LogError, match="cannot be written"):
        export(part, tmp_path / "none" / "x.csv")
    with pytest.raises(LogError, match=r"no message of /x in that time; the log is from 0\.000 s to 3\.998 s"):
        selected(log, "/x", 7.0, 8.0, None)


def test_several_topics_are_one_table_with_the_latest_of_each(tmp_path):
    path = tmp_path / "two.mcap"
    with LogWriter(path, {}) as writer:
        quick = writer.channel(ChannelSpec("/quick", "Q", (FieldSpec("a", unit="m"),)))
        slow = writer.channel(ChannelSpec("/slow/one", "S", (FieldSpec("b", (2,), "N"), FieldSpec("n", kind="int"))))
        for tick in range(1000):
            quick.append(tick * 2_000_000, float(tick))
            if tick % 30 == 20:
                slow.append(tick * 2_000_000, np.array([tick, -tick], float), tick)
    log = read(path)

    def joined(log):
        return Joined(tuple(selected(log, topic, 0.0, None, None) for topic in ("/quick", "/slow/one")))

    assert export(joined(log), tmp_path / "x.csv") == 980
    with (tmp_path / "x.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["time [s]", "quick.a [m]", "slow/one.b_0 [N]", "slow/one.b_1 [N]", "slow/one.n"]
    table = np.array(rows, float)
    tick = np.arange(20, 1000)
    latest = (tick - 20) // 30 * 30 + 20
    assert table[:, 0] == pytest.approx(0.002 * tick)
    assert np.array_equal(table[:, 1:], np.column_stack((tick, latest, -latest, latest)))
    export(joined(read(path, Memory(window=0.07))), tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz") as data:
        assert np.array_equal(data["slow/one.b"], table[:, 2:4])
        assert np.array_equal(data["time"], table[:, 0])
