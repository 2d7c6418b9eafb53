"""The command: what a user sees, what a killed one leaves, and the same table from a cluster."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fake_walks import with_worker
from strangers import listening

from surefoot.scenarios.cli import program as cli
from surefoot.scenarios.cli.program import INTERRUPTED
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.many import engine as cluster
from surefoot.scenarios.many.engine import perform
from surefoot.scenarios.many.journal import JOURNAL, LOGS, SCRATCH
from surefoot.scenarios.many.slots import CampaignBar
from surefoot.studies.campaigns.sweep import PAGE

CAMPAIGN = """
scenario: paper-walk
about: Short walks.
set: {fidelity: pendulum, gait.steps: 1, gait.single_support: 0.6, gait.initial_stand: 0.2, rates.control: 100}
grid: {gait.step_length: [0.1, 0.2, 9.0], criteria: [{fell: false}, {speed_mean: {min: 1.0}}]}
sample: {start.x: {uniform: [0.0, 1.0]}}
seeds: %d
"""


class Here:
    """A worker in the process of the tests."""

    def __init__(self, folder, keep_all):
        self._folder, self._keep_all = folder, keep_all

    def __call__(self, point):
        return perform(point, self._folder / SCRATCH, self._folder / LOGS, self._keep_all)

    def close(self):
        pass


@pytest.fixture
def surefoot(monkeypatch, capsys, tmp_path):
    """Run the command in this process."""
    with_worker(monkeypatch, Here)
    (tmp_path / "short.yaml").write_text(CAMPAIGN % 2)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.program(["sweep", *map(str, arguments)])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return run


def rows(folder, name="table.csv"):
    with (folder / name).open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.unit
def test_who_stops_a_campaign_has_tables_and_page_of_what_was_done(surefoot, monkeypatch, tmp_path):
    def stop(bar, record):
        raise KeyboardInterrupt

    monkeypatch.setattr(CampaignBar, "run", stop)
    code, _, err = surefoot("short.yaml", "--out", "out")
    assert code == INTERRUPTED
    assert err.startswith("interrupted; ")
    assert 0 < len(rows(tmp_path / "out")) < 12
    assert "of them have no result yet" in (tmp_path / "out" / PAGE).read_text()


@pytest.mark.unit
def test_tables_counts_and_logs(surefoot, tmp_path):
    code, out, err = surefoot("short.yaml")
    assert (code, err) == (0, "")
    assert out.startswith("short: 12 runs, 4 pass, 4 fail, 4 refused\n")
    assert "success rate" not in out  # of what varies each value has its own
    folder = tmp_path / "runs" / "short"
    table = rows(folder)
    assert [row["status"] for row in table] == ["pass"] * 2 + ["fail"] * 2 + ["pass"] * 2 + ["fail"] * 2 + [
        "refused"
    ] * 4
    assert len({row["start.x [m]"] for row in table}) == 2  # of the seeds, whatever the grid
    for row in table:
        assert bool(row["log"]) == (row["status"] == "fail")
        assert not row["log"] or (folder / row["log"]).is_file()
        assert row["command"].startswith("surefoot run paper-walk --set ")
    assert {row["steps_taken"] for row in table} == {"1", ""}
    assert "gait.step_length" in table[-1]["reasons"]


@pytest.mark.unit
def test_parquet_has_types_and_units(surefoot, tmp_path):
    import pyarrow.parquet

    surefoot("short.yaml", "--seeds", 1)
    table = pyarrow.parquet.read_table(tmp_path / "runs" / "short" / "table.parquet")
    types = {name: str(table.schema.field(name).type) for name in ("gait.step_length", "fell", "steps_taken", "status")}
    assert types == {"gait.step_length": "double", "fell": "bool", "steps_taken": "int64", "status": "string"}
    assert table.schema.field("com_error_rms.0").metadata[b"unit"] == b"m"
    assert table.schema.field("start.x").metadata[b"unit"] == b"m"
    assert table.num_rows == 6


@pytest.mark.unit
def test_the_command_of_a_run_makes_it_again(surefoot, tmp_path):
    import shlex

    surefoot("short.yaml", "--seeds", 1, "--set", "gait.step_length=0.1")
    row = rows(tmp_path / "runs" / "short")[1]
    with pytest.raises(SystemExit) as ended:
        cli.program([*shlex.split(row["command"])[1:], "--json", "--out", str(tmp_path / "again")])
    assert ended.value.code == 1
    (verdict,) = (tmp_path / "again").rglob("verdict.json")
    assert json.loads(verdict.read_text())["com_error_rms"][0] == float(row["com_error_rms.0 [m]"])


@pytest.mark.unit
def test_thresholds(surefoot, tmp_path):
    (tmp_path / "limit.yaml").write_text(
        (CAMPAIGN % 2).partition("grid:")[0] + "grid: {gait.double_support: [0.4, 0.5]}\n"
        "bisect: {key: gait.step_length, low: 0.1, high: 2.0, tolerance: 0.1}\nseeds: 2\n"
    )
    code, out, _ = surefoot("limit.yaml", "--json")
    assert code == 0
    assert "thresholds.csv" in json.loads(out)["files"]
    found = rows(tmp_path / "runs" / "limit", "thresholds.csv")
    assert [row["gait.double_support [s]"] for row in found] == ["0.4", "0.5"]
    assert all(0.1 < float(row["threshold [m]"]) < 2.0 and row["side"] == "inside" for row in found)


@pytest.mark.unit
def test_a_threshold_that_refusals_have_made_says_so(surefoot, tmp_path):
    (tmp_path / "limit.yaml").write_text(
        "scenario: walk-level\nset: {fidelity: pendulum}\n"
        "bisect: {key: gait.step_length, low: 1.8, high: 2.0, tolerance: 1}"
    )
    surefoot("limit.yaml")
    (row,) = rows(tmp_path / "runs" / "limit", "thresholds.csv")
    assert (row["threshold [m]"], row["side"]) == ("", "below")
    assert "gait.step_length" in row["reasons"]
    assert "out of reach" in row["reasons"]


@pytest.mark.unit
@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("nothing",), 2, "no such specification or campaign"),
        (("short.yaml", "--set", "gait.stepz=1"), 2, "unknown key 'stepz'"),
        (("short.yaml", "--jobs", "0"), 2, "--jobs"),
        (("short.yaml", "--jobs", "1", "--cluster", "x:1"), 2, "--jobs is of this machine"),
        (("short.yaml", "--out", "short.yaml"), 2, "cannot be created"),
        (("short.yaml", "--out", "."), 2, "holds something else than a campaign"),
        (("short.yaml", "--set", "gait.step_length=9"), 1, "every run was refused"),
    ],
)
def test_bad_input_is_one_sentence(surefoot, arguments, code, said):
    ended, out, err = surefoot(*arguments)
    assert ended == code
    assert said in err
    assert "Traceback" not in err + out


@pytest.mark.unit
@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1:9", ""])
def test_a_cluster_that_cannot_be_reached(tmp_path, address):
    begin = time.monotonic()
    with pytest.raises(ScenarioError, match=r"cannot be reached.*give the address of a running dask scheduler"):
        cluster.cluster_workers(address, tmp_path / "out", keep_all=False, patience=0.5)
    assert time.monotonic() - begin < 10
    assert not (tmp_path / "out").exists()


def begin(folder, *arguments):
    """The command in a process of its own."""
    words = [sys.executable, "-m", "surefoot", "sweep", "short.yaml", "--out", "out", *arguments]
    return subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def lines(folder):
    path = folder / "out" / JOURNAL
    return path.read_text().splitlines() if path.exists() else []


def wait_for(condition, patience=60.0):
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.02)


def children(pid):
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout
    return [int(word) for word in found.split()]


@pytest.mark.physics
def test_killed_and_begun_again_nothing_is_lost_and_nothing_done_twice(tmp_path):
    (tmp_path / "short.yaml").write_text(CAMPAIGN % 3)
    first = begin(tmp_path, "--jobs", "2")
    wait_for(lambda: len(lines(tmp_path)) >= 3)
    workers = children(first.pid)
    first.send_signal(signal.SIGKILL)
    first.wait()
    before = lines(tmp_path)
    second = begin(tmp_path, "--jobs", "2")
    out, _ = second.communicate(timeout=120)
    assert second.returncode == 0, out
    after = lines(tmp_path)
    whole = [line for line in before if line in after]
    assert len(whole) >= len(before) - 1  # the last line may have been under way
    ids = [json.loads(line)["id"] for line in after]
    assert len(ids) == len(set(ids)) == 18
    assert len(rows(tmp_path / "out")) == 18
    wait_for(lambda: not any(Path(f"/proc/{worker}").exists() for worker in workers), 20)
    assert not (tmp_path / "out" / SCRATCH).exists()


@pytest.mark.long
def test_a_cluster_gives_the_same_table_though_a_worker_is_killed(tmp_path):
    distributed = pytest.importorskip("distributed")
    (tmp_path / "short.yaml").write_text(CAMPAIGN % 3)
    begin(tmp_path, "--jobs", "2").communicate(timeout=120)
    local = rows(tmp_path / "out")
    (tmp_path / "out").rename(tmp_path / "local")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as machines:
        pids = list(distributed.Client(machines, set_as_default=False).run(os.getpid).values())
        away = begin(tmp_path, "--cluster", machines.scheduler_address)
        wait_for(lambda: len(lines(tmp_path)) >= 3)
        os.kill(pids[0], signal.SIGKILL)
        out, err = away.communicate(timeout=120)
    assert away.returncode == 0, out + err
    remote = rows(tmp_path / "out")
    assert len(remote) == 18
    timed = ("time", "log_bytes", "real_time_factor", "memory")
    for ours, theirs in zip(local, remote, strict=True):
        assert {k: v for k, v in ours.items() if not any(word in k for word in timed)} == {
            k: v for k, v in theirs.items() if not any(word in k for word in timed)
        }
        assert not theirs["log"] or (tmp_path / "out" / theirs["log"]).stat().st_size > 1000


@pytest.mark.physics
def test_the_scheduler_of_the_documentation_listens_on_this_machine_alone(tmp_path):
    pytest.importorskip("distributed")
    text = (Path(__file__).parents[3] / "docs" / "campaigns.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^dask scheduler .*(?= &$)", text, re.MULTILINE)
    words = [*line.replace("127.0.0.1:8787", "127.0.0.1:0").split()[1:], "--port", "0"]
    with (tmp_path / "said").open("w") as said:
        scheduler = subprocess.Popen([sys.executable, "-m", "dask", *words], cwd=tmp_path, stderr=said)
    try:
        wait_for(lambda: "dashboard at" in (tmp_path / "said").read_text())
        assert {place for place, _ in listening(scheduler.pid)} == {"0100007F"}
    finally:
        scheduler.terminate()
        scheduler.wait(30)
