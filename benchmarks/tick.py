"""A control tick: its parts, the floor below it, deadlines, and the share of logging."""

import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin

from benchmarks.stopwatch import TimedWalk
from benchmarks.table import Section, microseconds
from surefoot.models.convert import mujoco_to_pinocchio
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.log import LogWriter, NoLog
from surefoot.scenarios.run.run import closed_loop, one_thread
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

WALK = "diagonal-walk"

TURN = 450
"""Ticks of a turn with and without a log: a whole number of chunks, plans and pictures."""


def settings(quick: bool) -> list[str]:
    return ["duration=1.8"] if quick else []


def parts(quick: bool) -> Section:
    """Microseconds of each part of a control tick, and what the engines alone take on states of the same walk."""
    walk = TimedWalk(WALK, settings(quick))
    states, ticks = [], []
    with tempfile.TemporaryDirectory() as folder:
        for number, spent in enumerate(walk.ticks(Path(folder, "parts.mcap"))):
            ticks.append(spent)
            if number % 25 == 0:
                data = walk.loop.walker.plant.data
                states.append((data.qpos.copy(), data.qvel.copy(), data.ctrl.copy()))
    model = walk.loop.walker.plant.model
    steps = round(1.0 / (walk.rate * model.opt.timestep))
    floor = _floor(model, states, steps)
    mean = 1e6 * float(np.mean(ticks))
    rows = [
        (name, *microseconds(spent, 50, 90, 99), 1e6 * sum(spent) / len(ticks))
        for name, spent in walk.laps.items()
        if spent
    ]
    rest = mean - sum(row[-1] for row in rows)
    rows += [("rest", None, None, None, rest), ("whole tick", *microseconds(ticks, 50, 90, 99), mean)]
    rows.append(("floor: engines alone", None, None, None, floor))
    ratio = mean / floor
    note = f"{WALK} at {walk.rate} Hz; a tick takes {ratio:.2f} times the floor, {steps} physics steps and all terms"
    return Section(
        "parts of a control tick",
        ("part", "median us", "p90 us", "p99 us", "mean us per tick"),
        tuple(rows),
        note,
        {"tick over floor": ratio},
    )


def _floor(model: mujoco.MjModel, states: list[tuple[np.ndarray, ...]], steps: int) -> float:
    """Physics steps and rigid-body terms of a tick by the engines alone, hot: the least of five on each state [us]."""
    data, body = mujoco.MjData(model), pinocchio_model(describe("humanoid100", RobotOptions()))
    terms = body.createData()
    q, v, least = pin.neutral(body), np.zeros(body.nv), []
    for qpos, qvel, ctrl in states:
        tries = []
        for _ in range(5):
            data.qpos[:], data.qvel[:], data.ctrl[:] = qpos, qvel, ctrl
            mujoco_to_pinocchio(qpos, qvel, q, v)
            start = time.perf_counter()
            mujoco.mj_step(model, data, steps)
            pin.computeAllTerms(body, terms, q, v)
            tries.append(time.perf_counter() - start)
        least.append(min(tries))
    return 1e6 * float(np.mean(least))


def deadlines(quick: bool) -> Section:
    """Wall-clock time of whole ticks, with every channel logged and with none, in turns."""
    walk = resolve(load(WALK, ["sensing.source=truth", *(["duration=3.6"] if quick else [])]))
    with tempfile.TemporaryDirectory() as folder, one_thread(), LogWriter(Path(folder, "on.mcap"), {}) as writer:
        loops = {"with every channel logged": closed_loop(walk, writer), "without a log": closed_loop(walk, NoLog())}
        spent: dict[str, list[float]] = {name: [] for name in loops}
        while not any(loop.done for loop in loops.values()):
            for name, loop in loops.items():
                for _ in range(TURN):
                    if not loop.done:
                        start = time.perf_counter()
                        loop.step()
                        spent[name].append(time.perf_counter() - start)
    rows = [(name, *microseconds(one, 50, 90, 99, 99.9), 1e6 * float(np.mean(one))) for name, one in spent.items()]
    logged, bare = (float(np.median(_turns(one))) for one in spent.values())
    share = 1.0 - bare / logged
    factor = 1.0 / (walk.rates.control * 1e-6 * rows[0][-1])
    note = f"logging takes {100 * share:.1f} % of the loop; {factor:.1f} times real time with it"
    columns = ("tick", "median us", "p90 us", "p99 us", "p99.9 us", "mean us")
    return Section("deadlines", columns, tuple(rows), note, {"log over all": share})


def _turns(spent: list[float]) -> np.ndarray:
    whole = len(spent) // TURN * TURN
    return np.array(spent[:whole]).reshape(-1, TURN).sum(axis=1)
