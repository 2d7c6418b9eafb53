"""Behaviour to the bit: a digest of every walk, to hold a change of the code against the code before it.

    python benchmarks/digests.py --out before.json            # on the old code
    python benchmarks/digests.py --against before.json        # on the new; exits 1 where a walk differs

A digest covers time, CoM, its velocity, ZMP, the fall and the plan's CoM and ZMP reference of each tenth control tick.
Physics amplifies what differs between them. Walks that are refused count with their refusal. All have the true state,
so that code before the sensors can be held against as well.
"""

import argparse
import hashlib
import json
import multiprocessing
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import surefoot
from surefoot.scenarios.catalogue import CONTROLS, OWN

Overrides = dict[str, Any]

EVERY = 10
"""Control ticks per tick that is looked at."""

PENDULUM: Overrides = {"fidelity": "pendulum"}


def pushed(force: tuple[float, float], step: int, phase: str, fraction: float, body: str | None = None) -> Overrides:
    """A push of 0.1 s at a phase of a step, in the world frame [N]."""
    push = {"step": step, "phase": phase, "fraction": fraction, "duration": 0.1, "force": [*force, 0.0]}
    return {"pushes": [push if body is None else {**push, "body": body}]}


def catalogue() -> Iterator[tuple[str, Overrides]]:
    """The whole catalogue in both fidelities, and the controls."""
    for name in OWN:
        yield name, PENDULUM
        yield name, {"fidelity": "full"}
    for name in CONTROLS:
        yield name, {}


def pushes() -> Iterator[tuple[str, Overrides]]:
    """Pushed walks: four directions, three phases, what may change about a step, walks on faces, told ones, stands."""
    directions = ((200.0, 0.0), (-200.0, 0.0), (0.0, 160.0), (0.0, -160.0))
    for number, force in enumerate(directions):
        for adaptation in ("location", "timing", "crossing"):
            phase, fraction = (("single", 0.1), ("single", 0.6), ("double", 0.3))[number % 3]
            yield "walk", {**PENDULUM, "planner.step_adaptation": adaptation, **pushed(force, 6, phase, fraction)}
        yield "walk", pushed(force, 6, "single", 0.2)
        yield "walk", pushed(force, 7, "double", 0.5)
        yield "stand", {**PENDULUM, "pushes": [{"time": 1.0, "duration": 0.1, "force": [*(2.0 * np.array(force)), 0]}]}
        yield "walk-sideways", {**PENDULUM, **pushed(force, 5, "single", 0.4)}
        yield "stairs-up", {**PENDULUM, **pushed(tuple(0.5 * np.array(force)), 5, "single", 0.4)}
    for name in ("walk-backward", "walk-curve", "walk-fast", "slope", "commanded", "waypoints"):
        yield name, {**PENDULUM, "pushes": [{"time": 4.0, "duration": 0.1, "force": [120, 90, 0]}]}
    for name in ("stairs-up", "stairs-down", "blocks"):
        yield name, {"pushes": [{"time": 4.0, "duration": 0.1, "force": [80, 40, 0]}]}


def robots() -> Iterator[tuple[str, Overrides]]:
    """Other robots on the walk and on stairs."""
    for name in ("g1", "talos", "alexander"):
        sized = {"robot": name, "sized_for": "humanoid100"}
        yield "walk", sized
        yield "walk", {**sized, **pushed((40.0, 20.0), 6, "single", 0.3)}
        yield "stairs-up", {**sized, **PENDULUM}


QUICK = ("walk", "paper-push", "stairs-up", "commanded")
"""Walks in full physics of the quick set, beside all on the pendulum."""


def walks(quick: bool) -> list[tuple[str, Overrides]]:
    """Scenario and overrides of each walk."""
    every = [*catalogue(), *pushes(), *robots()]
    if not quick:
        return every
    full = [(name, {"fidelity": "full"}) for name in QUICK]
    return [walk for walk in every if walk[1].get("fidelity") == "pendulum" or walk[0] in CONTROLS or walk in full]


def digest(walk: tuple[str, Overrides]) -> tuple[str, str]:
    """Name of a walk, and what it did in one line."""
    name, overrides = walk
    label = f"{name} {json.dumps(overrides, sort_keys=True)}"
    try:
        simulation = surefoot.Simulation(surefoot.load(name, {"sensing.source": "truth", **overrides}))
    except (surefoot.ScenarioError, surefoot.SetupError) as error:
        return label, f"refused: {error}"
    found, ticks = hashlib.sha256(), 0
    with simulation:
        while not simulation.done:
            simulation.advance()
            ticks += 1
            if ticks % EVERY == 0 or simulation.done:
                tick = simulation.look()
                plan = tick.plan
                seen = (tick.time, tick.com, tick.com_velocity, tick.zmp, tick.fell, plan.com, plan.zmp_reference)
                for value in seen:
                    found.update(np.asarray(value, dtype=np.float64).tobytes())
        return label, f"{found.hexdigest()[:16]} {ticks} ticks, {simulation.end.kind}"


def main() -> int:
    """Make the digests, and tell those that differ."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--out", type=Path, help="file to write the digests to")
    parser.add_argument("--against", type=Path, help="digests to hold these against")
    parser.add_argument("--quick", action="store_true", help="walks on the pendulum and four in full physics")
    parser.add_argument("--only", default="", help="walks whose line contains this")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    chosen = [walk for walk in walks(options.quick) if options.only in f"{walk[0]} {json.dumps(walk[1])}"]
    begin = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool(options.jobs, maxtasksperchild=12) as pool:
        found = dict(pool.imap_unordered(digest, chosen, chunksize=1))
    print(f"{len(found)} walks in {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    if options.out is not None:
        options.out.write_text(json.dumps(found, indent=1, sort_keys=True) + "\n")
    if options.against is None:
        return 0
    before = json.loads(options.against.read_text())
    moved = [label for label in found if found[label] != before.get(label)]
    for label in sorted(moved):
        print(f"{label}\n    before: {before.get(label, 'no such walk')}\n    now:    {found[label]}")
    print(f"{len(found) - len(moved)} of {len(found)} equal to the bit")
    return 1 if moved else 0


if __name__ == "__main__":
    sys.exit(main())
