"""Growth of cost with steps, joints, runs and cores."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.table import Section, Value, microseconds
from surefoot.planner.plan.sampling import PlanSampler
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.plants import IdealFeet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.many.engine import perform
from surefoot.scenarios.many.points import Base, Point
from surefoot.scenarios.record.walk import resident_memory
from surefoot.scenarios.run import run as running
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.setup.load import load, written
from surefoot.scenarios.setup.walk import resolve

STANCE = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
FRESH, STANDING = 60, 200
"""Steps of the planner that a long walk is held against, and plans of both that are left out, in which it stands."""


def steps(quick: bool) -> Section:
    """Plans at the end of a long walk beside those of a fresh planner, in turns, with an ideal CoM and ideal feet."""
    counts = (20, 200) if quick else (20, 2000, 20_000)
    making = {f"planner made for {count} steps": [_made(count) for _ in range(20)] for count in counts}
    rows: list[tuple[Value, ...]] = [(name, *microseconds(spent, 50), None) for name, spent in making.items()]
    fresh, asked = (10, 30) if quick else (FRESH, 1000)
    walked, ratio = _ticks(asked), float("nan")
    for step, _ in walked:
        if step and step == asked - fresh:
            both = [(old, new) for (_, old), (_, new) in zip(walked, _ticks(fresh), strict=False)][STANDING:]
            old, new = (float(np.median(one)) for one in zip(*both, strict=True))
            ratio = old / new
            rows.append((f"plan before step {asked}", 1e6 * old, ratio))
            break
    rows.append(("memory then, MB", resident_memory() / 1e6, None))
    columns = ("steps", "median us", "over a fresh planner")
    return Section("scaling with steps", columns, tuple(rows), "", {"plan late over fresh": ratio})


def _planner(count: int) -> WalkingPlanner:
    gait = GaitParameters(steps=count, step_length=0.3, single_support=0.5, double_support=0.16, com_height=0.99)
    return WalkingPlanner(gait, STANCE, 0.22, 0.11)


def _made(count: int) -> float:
    start = time.perf_counter()
    _planner(count)
    return time.perf_counter() - start


def _ticks(count: int):
    """Walk; the step swung last and the time taken [s] of each plan."""
    planner = _planner(count)
    t = planner.parameters.sample_time
    com, velocity, feet = np.array([0.0, 0.0, 0.99]), np.zeros(3), IdealFeet(STANCE)
    for tick in range(round(planner.gait.duration / t)):
        state = CentroidalState(t * tick, com, velocity)
        start = time.perf_counter()
        plan = planner.update(state, feet.state)
        spent = time.perf_counter() - start
        com, velocity = plan.com[1], plan.com_velocity[1]
        feet.follow(PlanSampler(plan), t * (tick + 1))
        yield plan.phase.step, spent


ROBOTS = ("humanoid100", "g1", "talos")


def robots(quick: bool) -> Section:
    """A control tick of robots with more and more joints, on the same walk at their size."""
    rows: list[tuple[Value, ...]] = []
    for name in ROBOTS[:1] if quick else ROBOTS:
        loop = closed_loop(
            resolve(load("walk-level", [f"robot={name}", "gait.steps=2", "sensing.source=truth"])), NoLog()
        )
        spent = []
        with one_thread():
            while not loop.done and not (quick and len(spent) > 300):
                start = time.perf_counter()
                loop.step()
                spent.append(time.perf_counter() - start)
        joints = loop.walker.plant.model.nv - 6
        rows.append((name, joints, *microseconds(spent, 50, 99), 1e6 * float(np.mean(spent))))
    ratios = {f"{row[0]} over {ROBOTS[0]}": float(row[-1] or 0) / float(rows[0][-1] or 1) for row in rows[1:]}
    columns = ("robot", "joints", "median us", "p99 us", "mean us")
    return Section("scaling with degrees of freedom", columns, tuple(rows), "walk at each one's size, no log", ratios)


def runs(quick: bool) -> Section:
    """Runs of one simulated second, one after another in a process: what each pays beside its ticks."""
    base, spent, ticking = Base("diagonal-walk", written("diagonal-walk")), [], []
    loop = running.run_loop

    def timed(*given):
        start = time.process_time()
        found = loop(*given)
        ticking.append(time.process_time() - start)
        return found

    running.run_loop = timed
    try:
        with tempfile.TemporaryDirectory() as folder:
            for seed in range(4 if quick else 40):
                point = Point(base, {"duration": 1.0, "seed": seed}, {}, f"run-{seed}")
                start = time.process_time()
                perform(point, Path(folder, "scratch"), Path(folder, "kept"), keep_all=False)
                spent.append(time.process_time() - start)
    finally:
        running.run_loop = loop
    beside = 1e3 * (np.array(spent) - ticking)
    warm = float(np.median(beside[2:]))
    rows = (
        ("first run", float(beside[0]), 1e3 * ticking[0]),
        ("later runs, median", warm, 1e3 * float(np.median(ticking[2:]))),
    )
    share = warm / (1e3 * float(np.median(spent[2:])))
    columns = ("run of 1 s", "beside its ticks, ms", "its ticks, ms")
    return Section("fixed cost of a run", columns, rows, "processor time", {"beside the ticks over all": share})


_WORK = """
import sys, time
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
with one_thread():
    for line in sys.stdin:
        loop = closed_loop(resolve(load("diagonal-walk", ["duration=30", "sensing.source=truth"])), NoLog())
        end, ticks = time.monotonic() + float(line), 0
        while time.monotonic() < end and not loop.done:
            loop.step()
            ticks += 1
        print(ticks, flush=True)
"""


def cores(quick: bool) -> Section:
    """Ticks that one process does in a time, and that two do, in turns."""
    rounds, seconds = (1, 0.3) if quick else (6, 3.0)
    workers = [
        subprocess.Popen([sys.executable, "-c", _WORK], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    try:
        _together(workers, 0.1)  # imports done
        one, two = [], []
        for _ in range(rounds):
            one.append(_together(workers[:1], seconds))
            two.append(_together(workers, seconds))
    finally:
        for worker in workers:
            worker.kill()
            worker.wait()
    ratio = float(np.median(np.array(two) / np.array(one)))
    rows = (("one process", float(np.median(one)) / seconds), ("two processes", float(np.median(two)) / seconds))
    note = f"two do {ratio:.2f} times what one does; less where the other core is busy"
    return Section("scaling with cores", ("processes", "ticks per s"), rows, note, {"two processes over one": ratio})


def _together(workers: list["subprocess.Popen[str]"], seconds: float) -> int:
    for worker in workers:
        assert worker.stdin is not None
        worker.stdin.write(f"{seconds}\n")
        worker.stdin.flush()
    return sum(int(worker.stdout.readline()) for worker in workers if worker.stdout is not None)
